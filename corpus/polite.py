"""The client that speaks to the services: waits when told to, tries again when that helps, and gives up cleanly.

What the services ask of a client, and where that is written:
    GitHub           docs.github.com/rest: "Best practices for using the REST API", "Rate limits for the REST API"
    Stack Exchange   api.stackexchange.com/docs/throttle (`backoff`, quota)
"""

from __future__ import annotations

import contextlib
import logging
import os
import random
import re
import time
import zlib
from collections.abc import Callable, Iterable, Iterator, Mapping
from datetime import datetime, timedelta, timezone
from email.utils import parsedate_to_datetime
from pathlib import Path
from typing import IO, Any, NamedTuple
from urllib.parse import urlencode, urljoin, urlsplit, urlunsplit

import requests
from urllib3.exceptions import HTTPError, ReadTimeoutError

from ..edges.documents import load_json
from ..edges.limits import format_size
from .report import CorpusError

AGENT = "rosimpact-corpus (https://pypi.org/project/rosimpact)"
PATIENCE = 3_600.0
"""Seconds that a command waits in all, unless told otherwise."""
_TRIES = 6
_LONGEST_BACKOFF = 120.0
_SECONDARY = 60.0
_REDIRECTS = (301, 302, 303, 307, 308)
_CHUNK = 1 << 16
_LARGEST = 64 << 20
_LARGEST_FILE = 1 << 30
_FILE_SECONDS = 3_600.0
_LONGEST_WAIT = 366 * 86_400.0
_LONE_SURROGATE = re.compile("[\ud800-\udfff]")
_ESCAPED_SURROGATE = re.compile(rb"\\u[dD][89a-fA-F]")
_SECONDARY_WORDS = re.compile(r"secondary rate limit|abuse detection|rate limit exceeded|too many requests", re.I)


class Clock:
    """The time and the waiting, so that tests need not wait."""

    def get_time(self) -> float:
        """Seconds since 1970."""
        return time.time()

    def sleep(self, seconds: float) -> None:
        time.sleep(seconds)


class Later(CorpusError):
    """The service asks for a longer wait than allowed. until: seconds since 1970 from when on it may be asked again."""

    def __init__(self, message: str, until: float):
        super().__init__(message)
        self.until = until


class StatusError(CorpusError):
    """The service answered with a status that no second try mends."""

    def __init__(self, message: str, status: int):
        super().__init__(message)
        self.status = status


class ServiceAnswer(NamedTuple):
    """What a service said. headers: names in lower case. url: where it came from after redirects, without its query."""

    status: int
    url: str
    headers: Mapping[str, str]
    body: bytes

    def parse_json(self) -> Any:
        """The body, parsed; halves of characters, which no file can hold, are replaced. Raises ValueError."""
        found = load_json(self.body)
        return _replace_surrogates(found) if _ESCAPED_SURROGATE.search(self.body) else found

    @property
    def links(self) -> dict[str, str]:
        """The addresses of the Link header by relation (`next`, `last`)."""
        from requests.utils import parse_header_links

        found = parse_header_links(self.headers.get("link", "").strip() or "<>")
        return {link["rel"]: urljoin(self.url, link["url"]) for link in found if link.get("rel")}


class Client:
    """Fetches from one service.

    service: its name in messages. patience: seconds to wait in all before Later is raised. spacing: seconds between two
    requests. timeout: seconds until a connection, or the next bytes, must be there; a whole body may take ten times as
    long. secrets: what must appear in no message and no log. tell: called with a line for each wait.

    Errors name the host and path of an address, never its query, since keys go there.
    """

    def __init__(
        self,
        service: str,
        *,
        clock: Clock | None = None,
        patience: float = PATIENCE,
        spacing: float = 0.0,
        timeout: float = 30.0,
        secrets: Iterable[str] = (),
        tell: Callable[[str], None] | None = None,
        tries: int = _TRIES,
    ):
        self.service = service
        self.clock = clock or Clock()
        self.patience = patience
        self.waited = 0.0
        self.requests = 0
        self._spacing = spacing
        self._timeout = timeout
        self._tries = tries
        self.tell = tell or (lambda line: None)
        self._last = 0.0
        self._not_before: dict[str, tuple[float, str]] = {}
        self._session = requests.Session()
        self._session.headers.update({"User-Agent": AGENT, "Accept-Encoding": "gzip"})
        # Otherwise requests would take a password from ~/.netrc, and would send it instead of ours.
        self._session.auth = lambda request: request
        _hide(secrets)

    def close(self) -> None:
        self._session.close()

    def hold(self, lane: str, seconds: float, why: str) -> None:
        """Lets no request of a lane (a part of the service with limits of its own) go out for so long."""
        until = self.clock.get_time() + min(seconds, _LONGEST_WAIT)
        if until > self._not_before.get(lane, (0.0, ""))[0]:
            self._not_before[lane] = (until, why)

    def get(
        self,
        url: str,
        params: Mapping[str, object] | None = None,
        headers: Mapping[str, str] | None = None,
        *,
        lane: str = "",
        accept: Iterable[int] = (),
    ) -> ServiceAnswer:
        """Fetches an address. Redirects are followed on the same host alone, never from https to http.

        accept: statuses besides 200 that are an answer and no fault (304, 404, 410). Waits and tries again on rate
        limits, on 5xx, and on connections that fail, stall or end early. Raises Later when that would take longer than
        the patience that is left, StatusError when the service means no, CorpusError when it cannot be reached.
        """
        return self._get(url, params, headers, lane, frozenset(accept), None)

    def get_json(
        self,
        url: str,
        params: Mapping[str, object] | None = None,
        headers: Mapping[str, str] | None = None,
        *,
        lane: str = "",
        accept: Iterable[int] = (),
    ) -> tuple[ServiceAnswer, Any]:
        """The same, with the body parsed (None where the status is not 200). A body that is no JSON counts as a fault
        of the moment: gateways answer with a page of their own."""

        def find_fault(answer: ServiceAnswer) -> str:
            try:
                answer.parse_json()
            except ValueError:
                kind = answer.headers.get("content-type", "").partition(";")[0] or "something unnamed"
                return f"answered with {kind} that is no JSON"
            return ""

        answer = self._get(url, params, headers, lane, frozenset(accept), find_fault)
        return answer, answer.parse_json() if answer.status == 200 else None

    def download(self, url: str, file: Path, headers: Mapping[str, str] | None = None) -> None:
        """Fetches a large file, whole or not at all. What a killed download of it left behind is removed."""
        import tempfile

        file.parent.mkdir(parents=True, exist_ok=True)
        prefix = f".{file.name}-"
        for left in file.parent.glob(f"{prefix}*"):
            _remove_if_left(left)
        handle, name = tempfile.mkstemp(prefix=prefix, dir=file.parent)
        try:
            with os.fdopen(handle, "wb") as target:
                _hold(target)
                self._get(url, None, headers, "", frozenset(), None, target)
            os.replace(name, file)
        except BaseException:
            with contextlib.suppress(OSError):
                os.unlink(name)
            raise

    def wait(self, seconds: float, why: str) -> None:
        """Waits, or raises Later when patience does not last so long."""
        seconds = min(max(0.0, seconds), _LONGEST_WAIT)
        if seconds == 0:
            return
        until = self.clock.get_time() + seconds
        if self.waited + seconds > self.patience:
            raise Later(
                f"{self.service}: {why}, and says to come back {_format_moment(until, seconds)}; "
                "what was gathered is kept, so run the same command again then",
                until,
            )
        if seconds >= 1:
            self.tell(f"{self.service}: {why}; waiting {_format_span(seconds)}")
        self.waited += seconds
        self.clock.sleep(seconds)

    def _get(self, url, params, headers, lane, accept, whole, target=None) -> ServiceAnswer:
        sent = _add_query(url, params)
        at = _shorten_url(url)
        limited = attempt = 0
        fault = ""
        for attempt in range(self._tries):
            self._wait_for_turn(lane)
            try:
                answer = self._send_request(sent, dict(headers or {}), target)
            except _Fault as error:
                fault = str(error)
            else:
                self._heed(answer, lane)
                if answer.status == 200 or answer.status in accept:
                    fault = whole(answer) if whole and answer.status == 200 else ""
                    if not fault:
                        return answer
                elif answer.status >= 500:
                    asked = _retry_after(answer, self.clock.get_time())
                    fault = f"answered with status {answer.status}"
                    if asked is not None:
                        self.wait(asked, f"{at} {fault}")
                        continue
                else:
                    seconds = self._limit(answer, limited)
                    if seconds is None:
                        raise _make_refusal(self.service, at, answer)
                    limited += 1
                    fault = "is over its rate limit"
                    self.wait(seconds, "the rate limit is reached")
                    continue
            pause = _compute_backoff(attempt)
            if attempt + 1 == self._tries or self.waited + pause > self.patience:
                break
            self.wait(pause, f"{at} {fault}")
        often = f", {attempt + 1} times in a row" if attempt else ""
        raise CorpusError(
            f"{self.service}: {at} {fault}{often}; "
            "what was gathered is kept, so check the address and the network and run the same command again"
        )

    def _send_request(self, url: str, headers: dict[str, str], target) -> ServiceAnswer:
        for _ in range(6):
            self.requests += 1
            try:
                response = self._session.get(
                    url, headers=headers, timeout=self._timeout, stream=True, allow_redirects=False
                )
            except requests.Timeout:
                raise _Fault("did not answer in time") from None
            except requests.exceptions.SSLError:
                raise _Fault("has a certificate that cannot be verified") from None
            except (requests.ConnectionError, requests.exceptions.ChunkedEncodingError):
                raise _Fault("cannot be reached") from None
            except (requests.RequestException, HTTPError, ValueError) as error:
                raise CorpusError(
                    f"{self.service}: {_shorten_url(url)}: cannot be asked ({type(error).__name__}); check the address"
                ) from None
            with response:
                place = response.headers.get("location", "")
                if response.status_code in _REDIRECTS and place:
                    onward = _resolve_redirect(self.service, url, place)
                    if _get_origin(onward) != _get_origin(url):
                        headers.pop("Authorization", None)
                    url = onward
                    continue
                return ServiceAnswer(
                    response.status_code,
                    urlunsplit(urlsplit(url)._replace(query="")),
                    {name.lower(): value for name, value in response.headers.items()},
                    self._read_body(response, target if response.status_code == 200 else None),
                )
        raise _Fault("redirects in circles")

    def _read_body(self, response: requests.Response, target) -> bytes:
        """The whole body; a fault when it stalls, ends early or cannot be unpacked. Raises CorpusError for one that is
        too large, packed or unpacked."""
        largest, seconds = (_LARGEST, 10 * self._timeout) if target is None else (_LARGEST_FILE, _FILE_SECONDS)
        until = time.monotonic() + seconds
        parts: list[bytes] = []
        size = 0
        if target is not None:
            target.seek(0)
            target.truncate()
        try:
            for chunk in _unpack_body(response):
                size += len(chunk)
                if size > largest:
                    raise CorpusError(
                        f"{self.service}: {_shorten_url(response.url or '')} sends more than {format_size(largest)}; "
                        "check the address"
                    )
                if time.monotonic() > until:
                    raise _Fault("sends its answer too slowly")
                if target is not None:
                    target.write(chunk)
                else:
                    parts.append(chunk)
        except zlib.error:
            raise _Fault("sent a body that cannot be unpacked") from None
        except (requests.RequestException, HTTPError) as error:
            stalled = isinstance(error, requests.Timeout | ReadTimeoutError) or "timed out" in str(error)
            raise _Fault("sends its answer too slowly" if stalled else "ended its answer early") from None
        promised = response.headers.get("content-length", "")
        # urllib3 before 2 does not compare; tell() counts bytes as they came, before unpacking
        if _is_number(promised) and response.raw is not None and response.raw.tell() < int(promised):
            raise _Fault("ended its answer early")
        return b"".join(parts)

    def _wait_for_turn(self, lane: str) -> None:
        now = self.clock.get_time()
        until, why = self._not_before.get(lane, (0.0, ""))
        if until > now:
            self.wait(until - now, why)
            now = self.clock.get_time()
        rest = self._last + self._spacing - now
        if self._spacing and rest > 0:
            self.clock.sleep(min(rest, self._spacing))
        self._last = self.clock.get_time()

    def _heed(self, answer: ServiceAnswer, lane: str) -> None:
        """Keeps in mind that nothing remains of a quota, rather than running into its end."""
        reset = answer.headers.get("x-ratelimit-reset", "")
        if answer.headers.get("x-ratelimit-remaining") == "0" and _is_number(reset):
            self.hold(lane, int(reset) + 1 - self.clock.get_time(), "the rate limit is reached")

    def _limit(self, answer: ServiceAnswer, before: int) -> float | None:
        """Seconds to wait after a 4xx, in the order that GitHub's documentation gives; None when it is no limit.

        before: how often that was asked already for this request.
        """
        if answer.status not in (403, 429):
            return None
        asked = _retry_after(answer, self.clock.get_time())
        if asked is not None:
            return asked
        reset = answer.headers.get("x-ratelimit-reset", "")
        if answer.headers.get("x-ratelimit-remaining") == "0" and _is_number(reset):
            return max(1.0, int(reset) + 1 - self.clock.get_time())
        if answer.status == 429 or _SECONDARY_WORDS.search(answer.body[:4000].decode("utf-8", "replace")):
            return _SECONDARY * 2**before * random.uniform(1.0, 1.25)
        return None


def _hold(file: IO[bytes]) -> bool:
    """Whether an open file is now held by this process, until it ends or closes the file, and was by no other."""
    try:
        import fcntl
    except ImportError:
        return False  # Windows: nobody can tell whether another one writes
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True


def _remove_if_left(part: Path) -> None:
    with contextlib.suppress(OSError), part.open("r+b") as file:
        if _hold(file):
            part.unlink()


def normalize_address(api: str, like: str) -> str:
    """The address of a service without a slash at its end. like: one, for the message. Raises CorpusError when it is
    none."""
    try:
        parts = urlsplit(api)
        usable = parts.scheme in ("http", "https") and bool(parts.hostname) and (parts.port or 1) > 0
    except ValueError:  # half of an IPv6 address, a port that is none
        usable, parts = False, urlsplit("")
    if parts.username is not None or parts.query or parts.fragment:
        raise CorpusError(f"--api: takes no user name, password or query; give an address like {like}")
    if not usable or re.search(r"[\s\x00-\x20\\]", api):
        raise CorpusError(f"--api {api}: is no address; give one like {like}")
    return api.rstrip("/")


def _read_chunks(response: requests.Response) -> Iterator[bytes]:
    """A body as it arrives, still packed. requests itself waits for whole chunks, so a body that drips would never be
    given up."""
    read = getattr(response.raw, "read1", None)
    if read is None:  # urllib3 before 2
        while chunk := response.raw.read(1 << 10, decode_content=False):
            yield chunk
        return
    while chunk := read(_CHUNK, decode_content=False):
        yield chunk


def _unpack_body(response: requests.Response) -> Iterator[bytes]:
    """A body in small pieces, however many bytes one that arrives stands for. Raises zlib.error."""
    coding = response.headers.get("content-encoding", "").strip().lower()
    if coding in ("", "identity"):
        yield from _read_chunks(response)
        return
    if coding not in ("gzip", "x-gzip"):
        raise _Fault("packed its answer in a way that was not asked for")
    unpacker = zlib.decompressobj(31)
    for chunk in _read_chunks(response):
        while chunk:
            yield unpacker.decompress(chunk, _CHUNK)
            chunk = unpacker.unconsumed_tail
    yield unpacker.flush()
    if not unpacker.eof:
        raise zlib.error("ended early")


def _resolve_redirect(service: str, url: str, place: str) -> str:
    """Where a redirect leads, which is the same host: nobody asked for another one, and who answers may not choose
    which addresses this machine asks. Raises CorpusError, and _Fault for what is no address."""
    try:
        onward = urljoin(url, place)
        here, there = urlsplit(url), urlsplit(onward)
        ports = here.port, there.port
    except ValueError:
        raise _Fault("redirects to an address that is none") from None
    if there.scheme not in ("http", "https") or not there.hostname:
        raise _Fault("redirects to an address that is none")
    encrypted = (here.scheme, there.scheme) == ("http", "https") and ports == (None, None)
    if here.hostname != there.hostname or there.username or not (_get_origin(url) == _get_origin(onward) or encrypted):
        raise CorpusError(
            f"{service}: {_shorten_url(url)} redirects to {there.scheme}://{there.hostname}, which is not asked; "
            "check the address"
        )
    return onward


def _replace_surrogates(value: Any) -> Any:
    """What was read from JSON, with U+FFFD for halves of characters."""
    if isinstance(value, str):
        return _LONE_SURROGATE.sub("\ufffd", value)
    if isinstance(value, list):
        return [_replace_surrogates(each) for each in value]
    if isinstance(value, dict):
        return {_replace_surrogates(name): _replace_surrogates(each) for name, each in value.items()}
    return value


def _is_number(text: str) -> bool:
    return re.fullmatch(r"[0-9]{1,15}", text) is not None


class _Fault(Exception):
    """What went wrong with one request, as a clause whose subject is the address."""


def _make_refusal(service: str, at: str, answer: ServiceAnswer) -> StatusError:
    said = ""
    with contextlib.suppress(ValueError, AttributeError):
        said = _clean(str(answer.parse_json().get("message") or answer.parse_json().get("error_message") or ""))[:200]
    help = {
        401: "the token is not accepted: give a valid one, or none",
        403: "give a token that may read it",
        404: "check the name, or give a token that may read it",
        410: "nothing is there any more",
        422: "check what is asked for",
    }.get(answer.status, "check what is asked for")
    says = f" ({said})" if said else ""
    return StatusError(f"{service}: {at} answered with status {answer.status}{says}; {help}", answer.status)


def _retry_after(answer: ServiceAnswer, now: float) -> float | None:
    """Seconds asked for by a Retry-After header, which holds seconds or a date; None without one."""
    value = answer.headers.get("retry-after", "").strip()
    if _is_number(value):
        return max(1.0, float(value))
    if not value:
        return None
    try:
        return max(1.0, parsedate_to_datetime(value).timestamp() - now)
    except (TypeError, ValueError, OverflowError):
        return None


def _compute_backoff(attempt: int) -> float:
    """Seconds before another try: doubled each time, with jitter, so that many clients do not come back together."""
    return min(_LONGEST_BACKOFF, 2.0**attempt) * random.uniform(0.5, 1.0)


def _add_query(url: str, params: Mapping[str, object] | None) -> str:
    if not params:
        return url
    return f"{url}{'&' if '?' in url else '?'}{urlencode({name: str(value) for name, value in params.items()})}"


def _shorten_url(url: str) -> str:
    try:
        parts = urlsplit(url)
    except ValueError:
        return "an address that is none"
    return f"{parts.hostname or ''}{parts.path}"


def _get_origin(url: str) -> tuple[str, str | None, int | None]:
    parts = urlsplit(url)
    return parts.scheme, parts.hostname, parts.port


def _format_moment(until: float, seconds: float) -> str:
    if seconds < 60:
        return f"in {_format_span(seconds)}"
    # rounded up, so that nobody comes back a minute early
    moment = datetime.fromtimestamp(until, timezone.utc) + timedelta(seconds=59)
    return f"at {moment:%Y-%m-%d %H:%M} UTC (in {_format_span(seconds)})"


def _format_span(seconds: float) -> str:
    if seconds < 90:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.0f} min" if seconds < 5400 else f"{seconds / 3600:.1f} h"


_hidden: set[str] = set()


def _clean(text: str) -> str:
    """A text without secrets, which who answers may have repeated."""
    for secret in _hidden:
        text = text.replace(secret, "***")
    return text


class _Hider(logging.Filter):
    """Takes secrets out of log records: urllib3 logs whole addresses when somebody asks it to."""

    def filter(self, record: logging.LogRecord) -> bool:
        text = record.getMessage()
        clean = _clean(text)
        if clean != text:
            record.msg, record.args = clean, ()
        return True


def _hide(secrets: Iterable[str]) -> None:
    _hidden.update(secret for secret in secrets if secret)
    if not _hidden:
        return
    # a filter of a logger does not see records of its children, so each that may speak of addresses gets one
    for name in ("urllib3.connectionpool", "urllib3.util.retry", "github.Requester", "requests"):
        logger = logging.getLogger(name)
        if not any(isinstance(known, _Hider) for known in logger.filters):
            logger.addFilter(_Hider())
