"""Questions of Robotics Stack Exchange through the Stack Exchange API 2.3, the migrated ones of ROS Answers included.

A migrated question starts with a logo that links to where it was and ends with `Originally posted by NAME on ROS
Answers with karma: 21 on 2015-05-20`: both are taken out of the text, the date and the name are believed rather than
the migration's, and the id on ROS Answers is kept, so that a question counts once wherever it was gathered.
Documentation: api.stackexchange.com/docs (paging, throttle, wrapper).
"""

from __future__ import annotations

import html
import json
import re
from collections.abc import Iterable, Iterator
from datetime import datetime, timedelta, timezone
from typing import TYPE_CHECKING, Any, NamedTuple
from urllib.parse import urlsplit

from ..polite import Client, StatusError, normalize_address
from ..report import BugReport, CorpusError
from ..store import AskedReport, GatheredPage, GatheredReport, hash_bytes
from .in_order import AnswerPage, read_in_order
from .markup import convert_to_markdown, parse_html
from .person import make_public_name

if TYPE_CHECKING:
    from bs4 import Tag

API = "https://api.stackexchange.com/2.3"
SITE = "robotics"
PAGE_SIZE = 100
# Beyond it the API wants a key; reading on from the last date never gets there but for one second's posts.
_LAST_PAGE = 25
_OLD = re.compile(r"https?://answers\.ros\.org\.?/questions?/(\d+)")
_FOOTER = re.compile(
    r"Originally posted by\s+(?P<name>.{1,200}?)\s+on\s+(?P<site>ROS|Gazebo) Answers"
    r"(?:\s+with karma:\s*-?\d+)?(?:\s+on\s+(?P<date>\d{4}-\d\d-\d\d))?"
)
_PASTED = re.compile(r"(?:Original comments\b|Comment by .* on \d{4}-\d\d-\d\d)")
_THROTTLED = re.compile(r"([0-9]{1,9}) seconds")
_KEPT = (
    "question_id", "title", "body", "tags", "creation_date", "last_activity_date", "last_edit_date", "closed_date",
    "closed_reason", "score", "view_count", "answer_count", "is_answered", "accepted_answer_id", "link",
    "content_license",
)  # fmt: skip


class Original(NamedTuple):
    """What a migrated post says of where it came from; all empty when it was never migrated.

    id: on ROS Answers. date: ISO day. text: the body's HTML without logo and footer.
    """

    id: str
    name: str
    date: str
    text: str


class StackExchange:
    """The API at an address, with a key or none. The quota is 300 requests a day without one, 10,000 with one."""

    def __init__(self, client: Client, api: str = API, key: str = "", site: str = SITE):
        self.client = client
        self.api = normalize_address(api, API)
        self.site = site
        self._key = key

    def get(self, method: str, lane: str, **asked: object) -> dict[str, Any]:
        """One answer's wrapper. Obeys `backoff`, which also comes with good answers, and the quota."""
        params = {"site": self.site, **asked}
        if self._key:
            params["key"] = self._key
        for _ in range(4):
            answer, found = self.client.get_json(f"{self.api}/{method}", params, lane=lane, accept=(400, 404))
            if found is None:
                # the API tells of its limits with status 400 and words of its own
                try:
                    found = answer.parse_json()
                except ValueError:
                    found = {}
            if not _is_wrapper(found):
                raise CorpusError(f"{self.client.service}: answered with something unforeseen; check --api")
            if isinstance(found.get("backoff"), int):
                self.client.hold(lane, found["backoff"], "it asks for a pause")
            if "error_id" not in found:
                if found.get("quota_remaining") == 0:
                    self._hold_until_tomorrow()
                return found
            said = str(found.get("error_message") or "")[:200]
            if found.get("error_name") != "throttle_violation":
                raise StatusError(
                    f"{self.client.service}: refused ({found.get('error_name')}: {said}); check what is asked for",
                    found["error_id"],
                )
            seconds = _THROTTLED.search(said)
            self.client.wait(float(seconds[1]) + 1 if seconds else 60.0, "too many requests came from here")
        raise CorpusError(f"{self.client.service}: refuses requests again and again; try tomorrow")

    def _hold_until_tomorrow(self) -> None:
        now = datetime.fromtimestamp(self.client.clock.get_time(), timezone.utc)
        tomorrow = (now + timedelta(days=1)).replace(hour=0, minute=0, second=0, microsecond=0)
        for lane in ("questions", "ids"):
            self.client.hold(lane, (tomorrow - now).total_seconds(), "the quota of the day is used up")

    def ask(self, known: Iterable[tuple[str, str]]) -> Iterator[AskedReport]:
        """Asks for `robotics-se:98659` and the like, a hundred a request. known: (id, anything)."""
        ids = {id.rpartition(":")[2]: id for id, _ in known}
        wanted = list(ids)
        for start in range(0, len(wanted), PAGE_SIZE):
            part = wanted[start : start + PAGE_SIZE]
            found = self.get(
                f"questions/{';'.join(part)}", "ids", filter="withbody", pagesize=PAGE_SIZE, sort="creation"
            )
            there = {str(item.get("question_id")): item for item in found["items"]}
            for number in part:
                if number in there:
                    yield AskedReport(ids[number], "here", convert(there[number]))
                else:
                    yield AskedReport(ids[number], "gone")


def _is_wrapper(found: object) -> bool:
    """Whether an answer is what the API wraps its answers in."""
    if not isinstance(found, dict):
        return False
    items = found.get("items")
    listed = isinstance(items, list) and all(isinstance(item, dict) for item in items)
    return listed or isinstance(found.get("error_id"), int)


class TaggedQuestions:
    """The questions with a tag, posted since a day (`2024-01-01`) or ever, in the order of their posting."""

    def __init__(self, server: StackExchange, tag: str, *, since: str = ""):
        self._server = server
        self._tag = tag
        self._since = since
        where = "" if server.api == API else f" at {urlsplit(server.api).netloc}"
        self.name = f"stack-exchange:{server.site} {tag}{where}{f' since {since}' if since else ''}"

    def read_pages(self, state: dict[str, Any] | None) -> Iterator[GatheredPage]:
        """From a state (None: from the start) to the end. State: the second of the last question's posting."""
        since = (state or {}).get("since")
        if since is None:
            day = datetime.fromisoformat(self._since).replace(tzinfo=timezone.utc) if self._since else None
            since = int(day.timestamp()) if day else 0
        client, done = self._server.client, 0
        for step in read_in_order(
            self._fetch, int(since), _read_date, lambda item: str(item.get("question_id")), lambda: None, client.service
        ):
            done += len(step.fresh)
            # at the end it goes on with the last question, which tells whether anything is new
            newest = max((_read_date(item) for item in step.part.rows), default=step.since)
            reports = [convert(item) for item in step.fresh]
            state = {"since": max(newest, step.since) if step.finished else step.since}
            yield GatheredPage(reports, state, finished=step.finished, done=done)
            if step.finished:
                return

    def _fetch(self, since: int, place: int | None) -> AnswerPage:
        """A page of what was posted since a second; place: the number of a further one. Raises CorpusError."""
        page = place or 1
        if page > _LAST_PAGE:
            raise CorpusError(
                f"{self._server.client.service}: more than {_LAST_PAGE * PAGE_SIZE} questions of one second; "
                "narrow the tag"
            )
        asked: dict[str, object] = {"tagged": self._tag} if self._tag else {}
        if since:
            asked["fromdate"] = since
        found = self._server.get(
            "questions", "questions", **asked, sort="creation", order="asc", page=page, pagesize=PAGE_SIZE,
            filter="withbody",
        )  # fmt: skip
        return AnswerPage(found["items"], page + 1 if found.get("has_more") and found["items"] else None)


def _read_date(item: dict[str, Any]) -> int:
    try:
        return int(item["creation_date"])
    except (KeyError, TypeError, ValueError):
        raise CorpusError("Stack Exchange: an answer holds something that is no question; check --api") from None


def convert(item: dict[str, Any]) -> GatheredReport:
    """A question of the API. Raises CorpusError when it is none."""
    try:
        number = int(item["question_id"])
        posted = datetime.fromtimestamp(int(item["creation_date"]), timezone.utc).date().isoformat()
        body = str(item["body"])
    except (KeyError, TypeError, ValueError, OverflowError, OSError):
        raise CorpusError("Stack Exchange: an answer holds something that is no question; check --api") from None
    original = find_original(body)
    given, listed = item.get("owner"), item.get("tags")
    owner = given if isinstance(given, dict) else {}
    tags = listed if isinstance(listed, list) else []
    report = BugReport(
        id=f"robotics-se:{number}",
        url=str(item.get("link") or "") or f"https://robotics.stackexchange.com/questions/{number}",
        source="robotics-se",
        date=original.date or posted,
        title=html.unescape(str(item.get("title") or "")),
        body=convert_to_markdown(original.text),
        kind="question",
        tags=tuple(str(tag) for tag in tags),
        author=make_public_name(original.name or html.unescape(str(owner.get("display_name") or ""))),
        licence=normalize_licence(item.get("content_license")),
        same_as=f"ros-answers:{original.id}" if original.id else "",
    )
    kept = {name: item[name] for name in _KEPT if name in item}
    kept["owner"] = {name: make_public_name(owner[name]) for name in ("display_name", "link") if name in owner}
    raw = json.dumps(kept, ensure_ascii=False, sort_keys=True).encode()
    # views and votes change all the time, and change no report
    steady = {name: kept[name] for name in ("title", "body", "tags", "owner", "content_license") if name in kept}
    return GatheredReport(report, raw, hash_bytes(json.dumps(steady, sort_keys=True).encode()), origin="stack-exchange")


def find_original(body: str) -> Original:
    """What the HTML of a body says of where it was posted first."""
    page = parse_html(body)
    footers = [(block, found) for block in _leaves(page) if (found := _FOOTER.search(_extract_text(block)))]
    if not footers:
        return Original("", "", "", body)
    block, found = footers[-1]
    id = ""
    if found["site"] == "ROS":
        links = [*page.find_all(_is_logo), *block.find_all("a"), *_find_heading_link(page)]
        ids = [_OLD.match(str(link.get("href") or "")) for link in links]
        id = next((match[1] for match in ids if match), "")
    _cut(block)
    for image in page.find_all(_is_logo):
        image.extract()
    return Original(id, " ".join(found["name"].split()), found["date"] or "", str(page))


def normalize_licence(name: object) -> str:
    """`CC BY-SA 4.0` as SPDX names it."""
    return str(name or "").strip().replace(" ", "-")


def _leaves(page: Tag) -> list[Tag]:
    """The blocks that hold no other block; the page itself where it has none."""
    blocks = page.find_all(["p", "div", "li"])
    return [block for block in blocks if block.find(["p", "div", "li"]) is None] or [page]


def _extract_text(block: Tag) -> str:
    return " ".join(block.get_text().split())


def _is_logo(tag: Tag) -> bool:
    """The image at the head of a migrated post, in the link around it where there is one."""
    if tag.name == "img":
        alt = str(tag.get("alt") or "").lower()
        return "answers logo" in alt and not (tag.parent is not None and tag.parent.name == "a")
    return tag.name == "a" and any("answers logo" in str(i.get("alt") or "").lower() for i in tag.find_all("img"))


def _find_heading_link(page: Tag) -> list[Tag]:
    """A link that stands before all text: the logo's, where the image itself was lost."""
    first = page.find("a", href=_OLD)
    if first is None or any(str(text).strip() for text in first.find_all_previous(string=True)):
        return []
    return [first]


def _cut(block: Tag) -> None:
    """Takes out a footer, with the score after it, the rule before it, and the comments that were pasted below."""
    following = [node for node in block.find_next_siblings() if node.name]
    for place, node in enumerate(following):
        text = _extract_text(node)
        if _PASTED.match(text):
            for gone in following[place:]:
                gone.extract()
            break
        if node.name == "hr" or text.startswith("Post score:"):
            node.extract()
    before = block.find_previous_sibling()
    if before is not None and before.name == "hr":
        before.extract()
    start = re.search(r"(?:<a[^>]*>\s*)?Originally posted", block.decode_contents())
    rest = parse_html(block.decode_contents()[: start.start()] if start else "")
    block.clear()
    block.append(rest)
