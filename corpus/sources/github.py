"""Issues and pull requests of GitHub, or of a GitHub Enterprise server.

Lists are read in the order of their last update, each request starting at the time where the one before ended: numbered
pages of that order shift, and lose reports, whenever somebody comments while they are read. Search gives a thousand
results at most, so it is read in the order of creation and asked anew from the day where it ended.
PyGithub parses what comes and runs the searches, over our own client: it alone knows 429, wants no hour of sleep, keeps
the query of an address that redirects, and asks conditionally for lists.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Iterator
from datetime import datetime, timedelta
from email.utils import parsedate_to_datetime
from typing import TYPE_CHECKING, Any, NamedTuple
from urllib.parse import urlencode, urlsplit

from ..polite import Client, ServiceAnswer, StatusError, normalize_address
from ..report import BugReport, CorpusError
from ..store import AskedReport, GatheredPage, GatheredReport, hash_bytes
from .in_order import AnswerPage, read_in_order

if TYPE_CHECKING:
    from github import Github
    from github.Issue import Issue
    from github.Requester import Requester

API = "https://api.github.com"
PER_PAGE = 100
SEARCH_LIMIT = 1_000
"""Results that a search gives at most."""
_OVER = 2  # seconds after which nothing more is updated at a time, by the server's clock
_NAME = re.compile(r"[\w-][\w.-]*/(?!\.{1,2}\Z)[\w.-]+\Z", re.ASCII)
_ID = re.compile(
    r"(?:https://api\.github\.com/repos/)?([\w-][\w.-]*/(?!\.{1,2}[#/])[\w.-]+)(?:#|/(?:issues|pulls?)/)(\d{1,12})\Z",
    re.ASCII,
)
_PAGE = re.compile(r"https?://[^/]+/(?:repos/)?([\w.-]+/[\w.-]+)/(?:issues|pulls?)/(\d+)")
_KEPT = (
    "number", "title", "body", "state", "state_reason", "created_at", "updated_at", "closed_at", "html_url", "url",
    "comments", "locked", "active_lock_reason", "draft",
)  # fmt: skip


class Quota(NamedTuple):
    """Requests that are left, of how many an hour."""

    remaining: int
    limit: int


class GitHub:
    """A GitHub server. api: its address (`https://api.github.com`, `https://HOST/api/v3`). token: empty for none."""

    def __init__(self, client: Client, api: str = API, token: str = ""):
        self.client = client
        self.api = normalize_address(api, API)
        self._token = token
        self._parser: Github | None = None

    @property
    def parser(self) -> Github:
        """PyGithub over our client."""
        if self._parser is None:
            self._parser = _make_pygithub(self)
        return self._parser

    @property
    def requester(self) -> Requester:
        """What PyGithub sends its requests with."""
        own = getattr(self.parser, "requester", None)  # public since PyGithub 2.3
        return own if own is not None else self.parser._Github__requester  # type: ignore[attr-defined]

    def make_headers(self, etag: str = "") -> dict[str, str]:
        headers = {"Accept": "application/vnd.github+json", "X-GitHub-Api-Version": "2022-11-28"}
        if self._token:
            headers["Authorization"] = f"Bearer {self._token}"
        if etag:
            headers["If-None-Match"] = etag
        return headers

    @property
    def has_token(self) -> bool:
        return bool(self._token)

    def fetch_quota(self) -> Quota | None:
        """What is left of the main quota; None where the server has none, or does not tell."""
        from github import GithubException

        try:
            found = self.parser.get_rate_limit()
        except (GithubException, CorpusError):
            return None
        core: Any = getattr(found, "resources", found)  # `resources` came with PyGithub 2.7
        return Quota(core.core.remaining, core.core.limit)

    def parse_report(self, raw: dict[str, Any], *, etag: str = "", asked: str = "") -> GatheredReport:
        """What one object of an answer holds. Raises CorpusError when it is no issue."""
        from github.Issue import Issue

        try:
            issue: Issue = self.parser.create_from_raw_data(Issue, raw)
            return _make_report(issue, raw, etag, asked)
        except CorpusError:
            raise
        except Exception as error:  # PyGithub raises what it likes when a field is of another type
            raise CorpusError(
                f"{self.client.service}: an answer holds something that is no issue ({type(error).__name__}); "
                "check that --api leads to a GitHub server"
            ) from None

    def ask(self, known: Iterable[tuple[str, str]]) -> Iterator[AskedReport]:
        """Asks for reports one by one. known: (id, ETag or nothing). What has not changed costs no quota."""
        for id, etag in known:
            found = _ID.match(id)
            if found is None:
                raise CorpusError(f"{id}: is no issue's id; write owner/name#12")
            url = f"{self.api}/repos/{found[1]}/issues/{found[2]}"
            answer, raw = self.client.get_json(
                url, headers=self.make_headers(etag), lane="core", accept=(301, 304, 404, 410, 451)
            )
            if answer.status == 304:
                yield AskedReport(id, "same")
            elif answer.status == 200 and isinstance(raw, dict):
                yield AskedReport(id, "here", self.parse_report(raw, etag=answer.headers.get("etag", ""), asked=id))
            else:
                yield AskedReport(id, "gone")


class Listed:
    """The issues of a repository, and its pull requests where asked for, posted since a day (`2024-01-01`) or ever."""

    def __init__(self, server: GitHub, repository: str, *, since: str = "", kinds: tuple[str, ...] = ("issue",)):
        if not _NAME.match(repository):
            raise CorpusError(f"github:{repository}: names no repository; write github:owner/name")
        self._server = server
        self._repository = repository
        self._since = since
        self._kinds = kinds
        where = "" if server.api == API else f" at {urlsplit(server.api).netloc}"
        self.name = f"github:{repository.lower()}{where} {'+'.join(kinds)}{f' since {since}' if since else ''}"

    def read_pages(self, state: dict[str, Any] | None) -> Iterator[GatheredPage]:
        """From a state (None: from the start) to the end of the list. State: the time from which to ask, and the ETag
        of the last answer, so that asking when nothing is new costs nothing."""
        state = state or {}
        start = str(state.get("since") or (f"{self._since}T00:00:00Z" if self._since else ""))
        etag = str(state.get("etag") or "")
        etags = [etag]  # for the first request alone
        done, total = 0, None
        steps = read_in_order(
            lambda since, place: self._fetch(since, place, etags.pop() if etags else ""),
            start,
            lambda row: str(row.get("updated_at") or ""),
            lambda row: str(row.get("number")),
            lambda: self._server.client.wait(_OVER, "issues are being changed there this very second"),
            self._server.client.service,
        )
        for step in steps:
            answer: ServiceAnswer = step.part.about
            if answer.status == 304:
                yield GatheredPage([], {"since": start, "etag": etag}, finished=True, done=done, of=total)
                return
            done += len(step.fresh)
            total = done if step.finished else done + _count_left(answer.links, len(step.part.rows))
            # An ETag is of one page: that it is the same says that nothing is new only where that page has room.
            kept = answer.headers.get("etag", "") if step.whole and len(step.part.rows) < PER_PAGE else ""
            state = {"since": step.since, "etag": kept} if kept else {"since": step.since}
            reports = list(self._parse_reports(step.fresh))
            yield GatheredPage(
                reports, state, finished=step.finished, done=done, of=total, moved=self._find_move(step.part.rows)
            )

    def _fetch(self, since: str, place: str | None, etag: str) -> AnswerPage:
        """A page of what was updated since a time; place: the address of a further one. Raises CorpusError."""
        client = self._server.client
        answer, rows = client.get_json(
            place or self._make_address(since), headers=self._server.make_headers(etag), lane="core",
            accept=(304,) if etag else (),
        )  # fmt: skip
        if answer.status == 304:
            return AnswerPage([], about=answer)
        if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
            raise CorpusError(f"{client.service}: answered with no list; check --api")
        onward = answer.links.get("next")
        return AnswerPage(rows, self._check_address(onward) if onward else None, _is_over(since, answer), answer)

    def _find_move(self, rows: list[dict[str, Any]]) -> tuple[str, str] | None:
        """(old, new) name of the repository, where it is no longer the one that was asked for."""
        place = _PAGE.match(str(rows[0].get("html_url") or "")) if rows else None
        if place is None or place[1].lower() == self._repository.lower():
            return None
        return self._repository, place[1]

    def _make_address(self, since: str) -> str:
        asked = {"state": "all", "sort": "updated", "direction": "asc", "per_page": PER_PAGE}
        if since:
            asked["since"] = since
        return f"{self._server.api}/repos/{self._repository}/issues?{urlencode(asked)}"

    def _check_address(self, url: str) -> str:
        """An address of a Link header, which must be the server's own: the token goes there."""
        mine, theirs = urlsplit(self._server.api), urlsplit(url)
        if (mine.scheme, mine.netloc) != (theirs.scheme, theirs.netloc):
            raise CorpusError(
                f"{self._server.client.service}: leads to {theirs.netloc} for its next page; check that --api is right"
            )
        return url

    def _parse_reports(self, rows: list[dict[str, Any]]) -> Iterator[GatheredReport]:
        for row in rows:
            kind = "pull" if row.get("pull_request") else "issue"
            if kind not in self._kinds or (self._since and str(row.get("created_at") or "")[:10] < self._since):
                continue
            yield self._server.parse_report(row, asked=f"{self._repository}#{row.get('number')}")


class Searched:
    """What a search finds. query: as on GitHub's search page (`org:ros2 "undefined symbol"`)."""

    def __init__(self, server: GitHub, query: str, *, since: str = "", kinds: tuple[str, ...] = ("issue",)):
        self._server = server
        self._since = since
        kind = "" if len(kinds) > 1 else " is:issue" if kinds == ("issue",) else " is:pr"
        self._query = f"{query.strip()}{kind}"
        where = "" if server.api == API else f" at {urlsplit(server.api).netloc}"
        self.name = f"github search{where} {self._query}{f' since {since}' if since else ''}"

    def read_pages(self, state: dict[str, Any] | None) -> Iterator[GatheredPage]:
        """From a state (None: from the start) to the end. State: the moment of creation from which to search."""
        since = str((state or {}).get("created") or self._since)
        total, done = None, 0
        for step in read_in_order(
            self._fetch, since, lambda row: str(row.get("created_at") or ""), lambda row: str(row.get("url")),
            lambda: None, self._server.client.service,
        ):  # fmt: skip
            count: int = step.part.about
            total = count if total is None else total
            done += len(step.fresh)
            newest = max([step.since, *(str(row.get("created_at") or "") for row in step.part.rows)])
            state = {"created": newest if step.finished else step.since}
            reports = [self._server.parse_report(row) for row in step.fresh]
            yield GatheredPage(reports, state, finished=step.finished, done=done, of=max(total, done))

    def _fetch(self, since: str, place: int | None) -> AnswerPage:
        """A page of what was posted since a moment; place: the number of a further one. Raises CorpusError."""
        number = place or 1
        if number > SEARCH_LIMIT // PER_PAGE:
            raise CorpusError(
                f"{self._server.client.service}: more than {SEARCH_LIMIT} results of one second, {since}; "
                "narrow the search"
            )
        count, rows = self._fetch_page(f"{self._query} created:>={since}" if since else self._query, number)
        return AnswerPage(rows, number + 1 if rows and number * PER_PAGE < count else None, about=count)

    def _fetch_page(self, query: str, number: int) -> tuple[int, list[dict[str, Any]]]:
        """(how many there are in all, those of one page). Asks again while the server says that it ran out of time."""
        from github import GithubException

        client = self._server.client
        asked = {"q": query, "sort": "created", "order": "asc", "per_page": PER_PAGE, "page": number}
        for attempt in range(4):
            try:
                _, found = self._server.requester.requestJsonAndCheck("GET", "/search/issues", parameters=asked)
            except GithubException as error:
                said = str(error.data.get("message", ""))[:200] if isinstance(error.data, dict) else ""
                says = f" ({said})" if said else ""
                raise StatusError(
                    f"{client.service}: the search answered with status {error.status}{says}; check the query",
                    error.status,
                ) from None
            if not found.get("incomplete_results"):
                count, rows = found.get("total_count"), found.get("items")
                if isinstance(count, int) and isinstance(rows, list) and all(isinstance(row, dict) for row in rows):
                    return count, rows
                raise CorpusError(f"{client.service}: the search answered with no list; check --api")
            client.wait(5.0 * 2**attempt, "the search ran out of time")
        raise CorpusError(f"{client.service}: the search runs out of time again and again; narrow it")


def _make_report(issue: Issue, raw: dict[str, Any], etag: str, asked: str) -> GatheredReport:
    place = _PAGE.match(issue.html_url or issue.url or "")
    if place is None:
        raise CorpusError(f"{issue.html_url}: is no address of an issue; check that --api leads to a GitHub server")
    created = issue.created_at
    kept = _reduce_issue(raw)
    report = BugReport(
        id=f"{place[1]}#{place[2]}",
        url=issue.html_url,
        source="github",
        date=created.date().isoformat() if created else None,
        title=issue.title or "",
        body=(issue.body or "").replace("\r\n", "\n"),
        kind="pull" if raw.get("pull_request") else "issue",
        tags=tuple(label.name for label in issue.labels),
        author=(raw.get("user") or {}).get("login") or "",
    )
    return GatheredReport(report, kept, hash_bytes(kept), etag, asked, "github")


def _is_over(moment: str, answer: ServiceAnswer) -> bool:
    """Whether a second (`2024-01-31T10:00:00Z`) has passed by the clock of who answered; so where there is no clock."""
    try:
        now = parsedate_to_datetime(answer.headers.get("date", ""))
        return now - datetime.fromisoformat(moment.replace("Z", "+00:00")) >= timedelta(seconds=_OVER)
    except (TypeError, ValueError, OverflowError):
        return True


def _reduce_issue(raw: dict[str, Any]) -> bytes:
    """An issue as the server gave it, without what identifies people beyond the name and page of its author."""
    kept: dict[str, Any] = {name: raw[name] for name in _KEPT if name in raw}
    kept["labels"] = [label.get("name") for label in raw.get("labels") or () if isinstance(label, dict)]
    if raw.get("pull_request"):
        kept["pull_request"] = {name: raw["pull_request"].get(name) for name in ("url", "html_url", "merged_at")}
    if raw.get("milestone"):
        kept["milestone"] = {"title": raw["milestone"].get("title")}
    user = raw.get("user")
    kept["user"] = {"login": user.get("login"), "html_url": user.get("html_url")} if user else None
    return json.dumps(kept, ensure_ascii=False, sort_keys=True).encode()


def _count_left(links: dict[str, str], size: int) -> int:
    """How many reports follow a page, by the number of the last page; that one is taken for half full."""
    last = re.search(r"[?&]page=(\d+)", links.get("last", ""))
    return max(0, (int(last[1]) - 1) * size - size // 2) if last else 0


def _make_pygithub(server: GitHub) -> Github:
    """PyGithub, its connection replaced by our client. The replacement is of the class, so it is undone at once."""
    import github
    from github import Auth
    from github.Requester import Requester

    class Connection:
        """What PyGithub takes for a connection; a request is one get() of ours."""

        def __init__(self, host: str, port: int | None = None, **unused: Any):
            self.host, self.port = host, port
            self._sent: tuple[str, dict[str, str]] = ("", {})

        def request(self, verb: str, url: str, input: Any, headers: dict[str, str], stream: bool = False) -> None:
            if verb != "GET":
                raise CorpusError(f"{verb} {url}: only reading is allowed")
            parts = urlsplit(server.api)
            self._sent = (f"{parts.scheme}://{parts.netloc}{url}" if url.startswith("/") else url, headers)

        def getresponse(self) -> Reply:
            url, headers = self._sent
            lane = "search" if "/search/" in urlsplit(url).path else "core"
            # a refused search is PyGithub's to explain; our own errors go through as they are
            answer, _ = server.client.get_json(url, headers=headers, lane=lane, accept=(404, 422))
            return Reply(answer.status, answer.headers, answer.body.decode("utf-8", "replace"))

        def close(self) -> None:
            pass

    class Reply:
        def __init__(self, status: int, headers: Any, text: str):
            self.status = status
            self.headers = headers
            self._text = text

        def getheaders(self) -> Any:
            return self.headers.items()

        def read(self) -> str:
            return self._text

        def close(self) -> None:
            pass

    try:
        Requester.injectConnectionClasses(Connection, Connection)  # type: ignore[arg-type]
        return github.Github(
            auth=Auth.Token(server._token) if server._token else None,
            base_url=server.api,
            per_page=PER_PAGE,
            retry=None,
            seconds_between_requests=None,
            seconds_between_writes=None,
        )
    finally:
        Requester.resetConnectionClasses()
