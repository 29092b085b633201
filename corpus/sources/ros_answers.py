"""Questions of ROS Answers: from its archive, from saved pages, or from a mirror that still runs Askbot.

answers.ros.org itself moved to Robotics Stack Exchange in August 2023 and went offline in 2024. The archive is the
repository ros-infrastructure/answers-archive: a file `content/question/ID.md` for each question, YAML above Markdown,
its keys in snake_case or, in older commits, in CamelCase. Questions of Gazebo Answers lie in the same folder and have
numbers of the same range: only `original_post_url` tells them apart.
"""

from __future__ import annotations

import errno
import json
import lzma
import os
import re
import tarfile
import zlib
from collections.abc import Callable, Iterable, Iterator
from datetime import datetime, timezone
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

import msgspec

from ...edges.documents import DocumentError, load_json, load_yaml_as_text
from ...edges.files import open_regular, read_file
from ...edges.limits import get_limits
from ..polite import Client, StatusError, normalize_address
from ..report import BugReport, CorpusError
from ..store import AskedReport, GatheredPage, GatheredReport, hash_bytes
from .markup import convert_to_markdown, parse_html
from .person import make_public_name

if TYPE_CHECKING:
    from bs4 import BeautifulSoup, Tag

ARCHIVE = "https://github.com/ros-infrastructure/answers-archive"
FILES = "https://raw.githubusercontent.com/ros-infrastructure/answers-archive/HEAD"
TARBALL = "https://codeload.github.com/ros-infrastructure/answers-archive/tar.gz/HEAD"
LICENCE = "CC-BY-SA-3.0"
_FOLDER = "content/question"
_MAP = "answers/ros-to-robotics.json"
# A question of the archive that was migrated and will not go away
_SURELY_THERE = "10010"
_AT_ONCE = 200
_UNPACKED = 4 << 30
"""Bytes that an archive may unpack to."""
_ROS = re.compile(r"https?://answers\.ros\.org\.?/")
_QUESTION = re.compile(r"/questions?/(\d+)")
_MIGRATED = re.compile(r"https?://robotics\.stackexchange\.com/(?:questions|q)/(\d+)")
_NAME = re.compile(r"([0-9]{1,12})\.md\Z")
_HEAD = re.compile(r"\A---[ \t]*\r?\n(.*?)^---[ \t]*\r?$\n?(.*)\Z", re.DOTALL | re.MULTILINE)
_POST = ("original_post_id", "body_markdown", "creation_date", "owner_display_name", "owner_profile_url",
         "upvote_count", "accepted")  # fmt: skip
_WHOLE = (*_POST, "original_post_url", "migrated_url", "tags", "title")

GONE = (
    "answers.ros.org went offline in 2024; gather its archive with `rosimpact corpus gather ros-answers` "
    f"(or with --archive DIR from a clone of {ARCHIVE}), or the migrated questions with "
    "`rosimpact corpus gather stack-exchange`"
)


def is_live_site(address: str) -> bool:
    """Whether an address is of the site that is no more."""
    try:
        host = urlsplit(address if "//" in address else f"//{address}").hostname or ""
    except ValueError:  # half of an IPv6 address
        return False
    return host.rstrip(".").lower() == "answers.ros.org"


class Archive:
    """The archive in a folder (a clone) or in a tarball of it; those questions that were posted since a day, or all.

    known: gives the digest of what was read for an id before, so that a file that did not change is not parsed again.
    unread: a line for each file that holds no question.
    """

    def __init__(self, place: Path, *, since: str = "", known: Callable[[str], bytes] = lambda id: b""):
        self._place = place
        self._since = since
        self._known = known
        self.unread: list[str] = []
        where = place.resolve() if place.is_dir() else place.name
        self.name = f"ros-answers archive {where}{f' since {since}' if since else ''}"
        if not place.is_file() and not (place / _FOLDER).is_dir():
            raise CorpusError(f"{place}: holds no `{_FOLDER}`; give a clone of {ARCHIVE}, on its newest commit")

    def read_pages(self, state: dict[str, Any] | None) -> Iterator[GatheredPage]:
        """State: the number of the last file of a folder that was read. At the end it is forgotten: next time all files
        are looked at, and those that did not change are passed over."""
        entries: Iterable[tuple[int, Callable[[], bytes]]] = self._list_entries(int((state or {}).get("after", 0)))
        total = None
        if self._place.is_dir():
            entries = list(entries)
            total = len(entries)
        copies = self._read_mapping()
        part: list[tuple[int, bytes]] = []
        count = 0
        for number, read in entries:
            count += 1
            try:
                part.append((number, read()))
            except CorpusError as error:
                self.unread.append(str(error))
            if len(part) == _AT_ONCE:
                yield self._make_page(part, copies, count, total)
                part, copies = [], ()
        if not count and not state:
            raise CorpusError(
                f"{self._place}: holds no questions; give a clone of {ARCHIVE}, on a commit that has `{_FOLDER}`, "
                "with --archive DIR"
            )
        yield self._make_page(part, copies, count, count)._replace(state={}, finished=True)

    def ask(self, known: Iterable[tuple[str, str]]) -> Iterator[AskedReport]:
        """Asks for `ros-answers:10010` and the like. known: (id, anything)."""
        wanted = {_parse_number(id): id for id, _ in known}
        if self._place.is_dir():
            files = ((number, self._place / _FOLDER / f"{number}.md") for number in list(wanted))
            found = ((number, lambda file=file: _read(file)) for number, file in files if os.path.lexists(file))
        else:
            found = self._list_entries(0)
        for number, read in found:
            if number in wanted:
                yield _make_answer(wanted.pop(number), read(), f"{number}.md")
        for id in wanted.values():
            yield AskedReport(id, "gone")

    def _make_page(
        self, part: list[tuple[int, bytes]], copies: Iterable[tuple[str, str]], count: int, total: int | None
    ):
        reports, pairs = [], list(copies)
        for number, data in part:
            if self._known(f"ros-answers:{number}") == hash_bytes(data):
                continue
            try:
                found = parse_archived(data, f"{_FOLDER}/{number}.md")
            except CorpusError as error:
                self.unread.append(str(error))
                continue
            if found is None:
                continue
            gathered, copy = found
            if copy:
                pairs.append((copy, gathered.report.id))
            if not self._since or (gathered.report.date or "9999") >= self._since:
                reports.append(gathered)
        return GatheredPage(reports, {"after": part[-1][0]} if part else {}, done=count, of=total, copies=tuple(pairs))

    def _list_entries(self, after: int) -> Iterator[tuple[int, Callable[[], bytes]]]:
        """(number, what reads it) of the files beyond a number; those of a folder in the order of their numbers."""
        if self._place.is_dir():
            files = [(int(name[1]), file) for file in (self._place / _FOLDER).iterdir()
                     if (name := _NAME.match(file.name))]  # fmt: skip
            for number, file in sorted(files):
                if number > after:
                    yield number, lambda file=file: _read(file)
            return
        try:
            with open(open_regular(self._place), "rb") as file, tarfile.open(
                fileobj=file, mode="r|*", tarinfo=_Member
            ) as tar:  # fmt: skip
                for count, member in enumerate(tar):
                    if count > get_limits().entries or tar.offset > _UNPACKED:
                        raise tarfile.ReadError("unpacks to too much")
                    tar.members = []  # type: ignore[attr-defined]  # which are kept for whoever looks names up
                    folder, _, name = member.name.rpartition("/")
                    number = _NAME.match(name)
                    if number and folder.endswith(_FOLDER) and member.isreg() and (content := tar.extractfile(member)):
                        data = content.read(get_limits().text)
                        yield int(number[1]), lambda data=data: data
        except (OSError, EOFError, ValueError, zlib.error, lzma.LZMAError, tarfile.TarError):
            raise CorpusError(f"{self._place}: is damaged; delete it, and it is fetched again") from None

    def _read_mapping(self) -> tuple[tuple[str, str], ...]:
        """(copy, original) of the archive's own list of migrated questions, which a clone may hold."""
        file = self._place / _MAP
        if not file.is_file():
            return ()
        try:
            posts = load_json(read_file(file, get_limits().capture, follow=False))["Posts"]
            found = [(_MIGRATED.match(str(post["NewUrl"])), int(post["OriginalPostID"])) for post in posts]
        except (OSError, ValueError, TypeError, KeyError, OverflowError):
            return ()  # the questions name their copies themselves; the list only adds to them
        return tuple((f"robotics-se:{new[1]}", f"ros-answers:{old}") for new, old in found if new)


class ArchivedFiles:
    """Single questions of the archive over the network."""

    def __init__(self, client: Client, address: str = FILES):
        self._client = client
        self._address = address.rstrip("/")
        self._there = False

    def ask(self, known: Iterable[tuple[str, str]]) -> Iterator[AskedReport]:
        """As Archive.ask()."""
        for id, _ in known:
            number = str(_parse_number(id))
            data = self._fetch_file(number)
            if data is None and not self._there:
                # that one question is missing means something only where others are there
                self._there = self._fetch_file(_SURELY_THERE) is not None
                if not self._there:
                    raise CorpusError(
                        f"{self._client.service}: is not at {self._address} any more; clone {ARCHIVE} and give it with "
                        "--archive DIR"
                    )
            yield AskedReport(id, "gone") if data is None else _make_answer(id, data, f"{number}.md")

    def _fetch_file(self, number: str) -> bytes | None:
        answer = self._client.get(f"{self._address}/{_FOLDER}/{number}.md", accept=(404, 410))
        self._there = self._there or answer.status == 200
        return answer.body if answer.status == 200 else None


def _parse_number(id: str) -> int:
    """The number in `ros-answers:10010`. Raises CorpusError."""
    number = re.fullmatch(r"ros-answers:([0-9]{1,12})", id)
    if number is None:
        raise CorpusError(f"{id[:80]}: is no id of ROS Answers; write ros-answers:10010")
    return int(number[1])


class _Member(tarfile.TarInfo):
    """A file of a tarball. Raises ReadError for one that is too large for a question, or for its own name."""

    @classmethod
    def frombuf(cls, buf: bytes | bytearray, encoding: str, errors: str):
        member = super().frombuf(buf, encoding, errors)
        largest = _UNPACKED // 4 if member.type in (*tarfile.REGULAR_TYPES, tarfile.DIRTYPE) else 1 << 20
        if not 0 <= member.size <= largest:
            raise tarfile.ReadError("holds a file that is too large")
        return member


class SavedPages:
    """Question pages that were saved as HTML, in a folder and those below it. unread: files that hold no question."""

    def __init__(self, folder: Path, *, since: str = ""):
        self._folder = folder
        self._since = since
        self.name = f"ros-answers pages {folder.resolve()}{f' since {since}' if since else ''}"
        self.unread: list[str] = []
        if not folder.is_dir():
            raise CorpusError(f"{folder}: is no folder; give one with saved question pages (*.html)")

    def read_pages(self, state: dict[str, Any] | None) -> Iterator[GatheredPage]:
        """All of them, the first of several pages of a question alone. State: the last file that was read."""
        after = (state or {}).get("after", "")
        named = sorted(
            (file.relative_to(self._folder).as_posix(), file)
            for file in self._folder.rglob("*")
            if file.suffix.lower() in (".html", ".htm") and file.is_file()
        )
        if not named:
            raise CorpusError(f"{self._folder}: holds no *.html; give a folder with saved question pages")
        rest = [pair for pair in named if pair[0] > after]
        for start in range(0, len(rest), _AT_ONCE):
            part = rest[start : start + _AT_ONCE]
            reports = []
            for name, file in part:
                try:
                    found = parse_page(_read(file).decode("utf-8", "replace"))
                except CorpusError as error:
                    self.unread.append(str(error))
                    continue
                except RecursionError:
                    self.unread.append(f"{name}: is nested too deeply")
                    continue
                if found is None:
                    self.unread.append(f"{name}: holds no question")
                elif not self._since or (found.report.date or "9999") >= self._since:
                    reports.append(found)
            yield GatheredPage(reports, {"after": part[-1][0]}, done=min(len(rest), start + _AT_ONCE), of=len(rest))
        yield GatheredPage([], {}, finished=True, done=len(rest), of=len(rest))


class Askbot:
    """The JSON API of a mirror (`https://HOST`), as Askbot has it at /api/v1/."""

    def __init__(self, client: Client, api: str, *, since: str = ""):
        if is_live_site(api):
            raise CorpusError(GONE)
        self._client = client
        self._api = re.sub(r"/api/v1\Z", "", normalize_address(api, "https://answers.example.org"))
        self._since = since
        self.name = f"ros-answers api {self._api}{f' since {since}' if since else ''}"

    def read_pages(self, state: dict[str, Any] | None) -> Iterator[GatheredPage]:
        """All questions, oldest first. State: the page to go on with, and how many questions there were. A page beyond
        the end would be the first one again; a question that was deleted moves the others up by one, so the page before
        is read once more."""
        number, before, done = int((state or {}).get("page", 1)), (state or {}).get("count"), 0
        while True:
            _, found = self._client.get_json(
                f"{self._api}/api/v1/questions/", {"page": number, "sort": "age-asc"}, lane="questions"
            )
            if not isinstance(found, dict) or not isinstance(found.get("questions"), list):
                raise CorpusError(f"{self._client.service}: answered with no questions; check that --api runs Askbot")
            count, last = int(found.get("count") or 0), int(found.get("pages") or 1)
            if before is not None and count < before and number > 1:
                number, before = min(number - 1, last), count
                continue
            before = count
            if number > last:
                number = last
                continue
            items = [parse_item(item) for item in found["questions"]]
            done += len(items)
            reports = [item for item in items if not self._since or (item.report.date or "9999") >= self._since]
            finished = number >= last
            # the last page fills up later
            state = {"page": number if finished else number + 1, "count": count}
            yield GatheredPage(reports, state, finished=finished, done=done, of=max(done, count))
            if finished:
                return
            number += 1


def _make_answer(id: str, data: bytes, name: str) -> AskedReport:
    found = parse_archived(data, name)
    return AskedReport(id, "here", found[0]) if found else AskedReport(id, "gone")


def parse_archived(data: bytes, name: str) -> tuple[GatheredReport, str] | None:
    """(the question, the id of its migrated copy or nothing) of a file of the archive; None for one of Gazebo Answers.
    Raises CorpusError, naming the file, when it is no question."""
    found = _HEAD.match(data.decode("utf-8-sig", "replace"))
    try:
        # everything is text: titles like `2013` or `no` stay so
        head = load_yaml_as_text(found[1]) if found else None
    except DocumentError as error:
        at = f", line {error.line + 1}" if error.line else ""
        raise CorpusError(f"{name}{at}: is no YAML; mend it, or take the file out") from None
    if not found or not isinstance(head, dict):
        raise CorpusError(f"{name}: has no YAML between lines of `---` at its top; take the file out")
    head = _convert_keys(head)
    url = str(head.get("original_post_url") or "")
    number = str(head.get("original_post_id") or "")
    if not re.fullmatch("[0-9]{1,12}", number):
        raise CorpusError(f"{name}: has no `original_post_id`; take the file out")
    if url and not _ROS.match(url):
        return None
    copy = _MIGRATED.match(str(head.get("migrated_url") or ""))
    body = found[2].replace("\r\n", "\n").strip("\n")
    report = BugReport(
        id=f"ros-answers:{number}",
        url=url or f"https://answers.ros.org/question/{number}/",
        source="ros-answers",
        date=_parse_day(head.get("creation_date")),
        title=str(head.get("title") or ""),
        body=body,
        kind="question",
        tags=tuple(tag.strip() for tag in str(head.get("tags") or "").split(",") if tag.strip()),
        author=make_public_name(head.get("owner_display_name")),
        licence=LICENCE,
    )
    kept: dict[str, Any] = _reduce_owner_name({key: head[key] for key in _WHOLE if key in head})
    kept["answers"] = [_reduce_post(answer) for answer in head.get("answers") or () if isinstance(answer, dict)]
    kept["comments"] = [_reduce_post(comment) for comment in head.get("comments") or () if isinstance(comment, dict)]
    kept["body_markdown"] = body
    raw = json.dumps(kept, ensure_ascii=False, sort_keys=True).encode()
    return GatheredReport(report, raw, hash_bytes(data), origin="archive"), f"robotics-se:{copy[1]}" if copy else ""


def parse_item(item: dict[str, Any]) -> GatheredReport:
    """A question of the JSON API. Raises CorpusError when it is none."""
    try:
        number = int(item["id"])
        posted = datetime.fromtimestamp(int(item["added_at"]), timezone.utc).date().isoformat()
    except (KeyError, TypeError, ValueError, OverflowError, OSError):
        raise CorpusError("Askbot: an answer holds something that is no question; check --api") from None
    given, listed = item.get("author"), item.get("tags")
    author = given if isinstance(given, dict) else {}
    tags = listed if isinstance(listed, list) else []
    title, _ = _split_title(str(item.get("title") or ""))
    kept = {
        name: item[name]
        for name in ("id", "title", "url", "summary", "text", "tags", "added_at", "last_activity_at", "answer_count",
                     "answer_ids", "accepted_answer_id", "view_count", "score", "closed", "closed_reason")
        if name in item
    }  # fmt: skip
    kept["author"] = {"username": make_public_name(author.get("username"))}
    report = BugReport(
        id=f"ros-answers:{number}",
        url=str(item.get("url") or ""),
        source="ros-answers",
        date=posted,
        title=title,
        body=convert_to_markdown(str(item.get("text") or item.get("summary") or "")),
        kind="question",
        tags=tuple(str(tag) for tag in tags),
        author=make_public_name(author.get("username")),
        licence=LICENCE,
    )
    raw = json.dumps(kept, ensure_ascii=False, sort_keys=True).encode()
    return GatheredReport(report, raw, hash_bytes(msgspec.json.encode(report)), origin="askbot")


def parse_page(html: str) -> GatheredReport | None:
    """The question of a saved page, of the theme that answers.ros.org had from 2018 on or of a newer Askbot; None where
    it holds none, or is not the first of a question's pages."""
    page = parse_html(html)
    block = page.select_one(".js-question.post, .post.js-question, .js-post.js-question")
    if block is None:
        return None
    number = _find_number(page, block)
    heading = page.select_one("h1[id^=js-question-title], h1.js-question-title, h1")
    body = _find_body(block)
    if not number or heading is None or body is None:
        return None
    title, closed = _split_title(_extract_words(heading.select_one(".js-editable-content") or heading))
    tags = [_extract_words(tag) for tag in page.select("#question-tags .js-tag-name, .js-question-tags .js-tag-name")]
    card = block.select_one(".js-avatar-box, .user-info a, .user-card a, .js-user-card a")
    links = [card, *block.select(".user-info a, .user-card a, .js-user-info a")]
    author = next((name for link in links if link is not None and (name := _extract_words(link))), "")
    link = page.select_one("link[rel=canonical]")
    url = str(link.get("href") or "") if link is not None else ""
    report = BugReport(
        id=f"ros-answers:{number}",
        url=url if _QUESTION.search(url) else f"https://answers.ros.org/question/{number}/",
        source="ros-answers",
        date=_find_day(page, block),
        title=title,
        body=convert_to_markdown(body),
        kind="question",
        tags=tuple(dict.fromkeys(tag for tag in tags if tag)),
        author=make_public_name(author),
        licence=LICENCE,
    )
    # The page itself shows everybody's pictures and scores: only what the report was read from is kept.
    kept = {
        "html": body.decode_contents(),
        "title": title,
        "tags": tags,
        "author": make_public_name(author),
        "closed": closed,
    }
    raw = json.dumps(kept, ensure_ascii=False, sort_keys=True).encode()
    return GatheredReport(report, raw, origin="pages")


def fetch_archive(client: Client, file: Path, address: str = TARBALL) -> Path:
    """Downloads the archive as one file. Raises CorpusError."""
    try:
        client.download(address, file)
    except StatusError as error:
        raise CorpusError(f"{error}; or clone {ARCHIVE} and give it with --archive DIR") from None
    return file


def _read(file: Path) -> bytes:
    try:
        return read_file(file, get_limits().text, follow=False)
    except OSError as error:
        why = "is a link, and links are not followed" if error.errno == errno.ELOOP else error.strerror
        raise CorpusError(f"{file}: cannot be read: {why}; check the folder") from None


def _convert_keys(mapping: dict) -> dict[str, Any]:
    """Keys as the newer files have them: `OriginalPostURL` becomes `original_post_url`."""
    return {
        re.sub(r"(?<=[a-z])(?=[A-Z])|(?<=[A-Z])(?=[A-Z][a-z])", "_", str(key)).lower(): value
        for key, value in mapping.items()
    }


def _reduce_post(post: dict) -> dict[str, Any]:
    post = _convert_keys(post)
    kept = _reduce_owner_name({key: post[key] for key in _POST if key in post})
    comments = [_reduce_post(comment) for comment in post.get("comments") or () if isinstance(comment, dict)]
    return {**kept, "comments": comments} if comments else kept


def _reduce_owner_name(post: dict[str, Any]) -> dict[str, Any]:
    if "owner_display_name" in post:
        post["owner_display_name"] = make_public_name(post["owner_display_name"])
    return post


def _parse_day(stamp: object) -> str | None:
    found = re.match(r"\d{4}-\d\d-\d\d", str(stamp or ""))
    return found[0] if found else None


def _split_title(text: str) -> tuple[str, bool]:
    bare = re.sub(r"\s*\[closed\]\s*\Z", "", text)
    return bare.strip(), bare != text


def _extract_words(element: Tag) -> str:
    return " ".join(element.get_text().split())


def _find_number(page: BeautifulSoup, block: Tag) -> str:
    """The question's id: of its block, else of the page's own address."""
    for element in (block, *block.select("[id^=post-id-], [id^=js-post-]")):
        found = re.match(r"(?:post-id|js-post)-(\d+)\Z", str(element.get("id") or ""))
        if found:
            return found[1]
    if block.get("data-post-id"):
        return str(block["data-post-id"])
    for selector, attribute in (
        ("link[rel=canonical]", "href"),
        ("meta[property='og:url']", "content"),
        ("h1 a", "href"),
    ):
        element = page.select_one(selector)
        found = _QUESTION.search(str(element.get(attribute) or "")) if element is not None else None
        if found:
            return found[1]
    return ""


def _find_body(block: Tag) -> Tag | None:
    """The element that holds the question's text and nothing else: comments and the author's card stand beside it."""
    for selector in (
        "[id^=js-post-body] .js-editable-content",
        ".js-post-body .js-editable-content",
        ".post-body .js-editable-content",
        ".js-editable-content",
        ".js-post-body",
        ".post-body",
    ):
        for found in block.select(selector):
            if not any("comment" in " ".join(parent.get("class") or ()) for parent in found.parents if parent.name):
                for noise in found.select(".comments, .js-comments, .post-update-info-container, .js-post-controls, "
                                          ".post-controls, .user-card"):  # fmt: skip
                    noise.extract()
                return found
    return None


def _find_day(page: BeautifulSoup, block: Tag) -> str | None:
    """The UTC day of a page. Askbot writes local time with its offset, hours away from UTC's."""
    stamps = block.select(".post-update-info abbr.timeago, .js-post-update-info abbr.js-timeago")
    stamps += page.select(".statsWidget abbr.timeago, .statsWidget abbr.js-timeago, .js-question-stats abbr")
    stamps += block.select("abbr.timeago, abbr.js-timeago")
    for stamp in stamps:
        if stamp.find_parent(class_=re.compile("comment")) is not None:
            continue
        text = str(stamp.get("title") or "").strip()
        for form in ("%Y-%m-%d %H:%M:%S %z", "%Y-%m-%dT%H:%M:%S%z"):
            try:
                return datetime.strptime(text, form).astimezone(timezone.utc).date().isoformat()
            except ValueError:
                continue
        if _parse_day(text):
            return _parse_day(text)
    return None
