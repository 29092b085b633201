"""What each repository released in a distro over time, from the history of rosdistro's distribution files.

Three forms of file are read: `DISTRO/distribution.yaml` (REP 141 and later), before 2014 `DISTRO/release.yaml` (REP
137) and before April 2013 `releases/DISTRO.yaml`. A version of a file is split into one block of text for each
repository, and only blocks that the version before did not have are parsed.
"""

import re
from collections.abc import Callable, Sequence
from typing import Any

import msgspec
import yaml

from .git import FileVersion

_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
_REPOSITORIES = re.compile(rb"^repositories:[ \t]*\r?\n", re.MULTILINE)
_NEXT_SECTION = re.compile(rb"^[^\s#]", re.MULTILINE)
_BLOCK = re.compile(rb"\n(?=  [^\s#])")
_SYSTEMS = ("ubuntu", "debian", "fedora", "rhel")


class RepositoryEntry(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One repository at one time. version None: it releases nothing."""

    version: str | None = None
    packages: tuple[str, ...] = ()
    url: str = ""
    branch: str = ""
    status: str = ""


class EntryEvent(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A repository's entry from `ts` on; None: it is no longer listed."""

    ts: int
    repository: str
    entry: RepositoryEntry | None


class PlatformEvent(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """Platforms that packages are built for from `ts` on, such as `ubuntu jammy`."""

    ts: int
    names: tuple[str, ...]


class DistroHistory(msgspec.Struct, frozen=True, array_like=True):
    """All events of one distro, oldest first. read: file versions gone through; last: the newest one's blob.

    unreadable: time and reason for each version that is no YAML of the expected form; it changes nothing.
    """

    events: tuple[EntryEvent, ...] = ()
    platforms: tuple[PlatformEvent, ...] = ()
    read: int = 0
    last: str = ""
    unreadable: tuple[tuple[int, str], ...] = ()


def list_distribution_paths(distro: str) -> tuple[str, ...]:
    """Where rosdistro kept a distro's releases, newest form first."""
    return f"{distro}/distribution.yaml", f"{distro}/release.yaml", f"releases/{distro}.yaml"


def split_file(data: bytes) -> tuple[bytes, list[bytes]] | None:
    """A distribution file as its head and one block for each repository; None when it lists no repositories.

    A block starts at a line indented by exactly two blanks.
    """
    start = _REPOSITORIES.search(data)
    if start is None:
        return None
    body = data[start.end() :]
    end = _NEXT_SECTION.search(body)
    tail = b""
    if end:
        body, tail = body[: end.start()], body[end.start() :]
    return data[: start.start()] + tail, [block for block in _BLOCK.split(b"\n" + body)[1:] if block.strip()]


def parse_block(block: bytes, path: str) -> tuple[str, RepositoryEntry] | None:
    """(repository, entry) of one block; None when it is no YAML mapping of one name. path tells the file's form."""
    try:
        parsed = yaml.load(block, Loader=_LOADER)
    except (yaml.YAMLError, ValueError):
        return None
    if not isinstance(parsed, dict) or len(parsed) != 1:
        return None
    ((name, value),) = parsed.items()
    value = value if isinstance(value, dict) else {}
    release = _ensure_mapping(value.get("release")) if path.endswith("/distribution.yaml") else value
    source = _ensure_mapping(value.get("source")) or _ensure_mapping(value.get("doc"))
    version = release.get("version")
    packages: tuple[str, ...] = ()
    if version is not None:
        listed = release.get("packages")
        packages = tuple(sorted(str(package) for package in listed)) if listed else (str(name),)
    return str(name), RepositoryEntry(
        None if version is None else str(version),
        packages,
        str(source.get("url") or ""),
        str(source.get("version") or ""),
        str(value.get("status") or ""),
    )


def _ensure_mapping(value: Any) -> dict:
    return value if isinstance(value, dict) else {}


def parse_platforms(head: bytes) -> tuple[str, ...]:
    """Platforms named in the head of a distribution file, `ubuntu jammy` first; empty when it names none."""
    try:
        parsed = _ensure_mapping(yaml.load(head, Loader=_LOADER))
    except (yaml.YAMLError, ValueError):
        return ()
    platforms = _ensure_mapping(parsed.get("release_platforms") or parsed.get("platforms"))
    names = []
    for system in sorted(platforms, key=lambda s: _SYSTEMS.index(s) if s in _SYSTEMS else len(_SYSTEMS)):
        names.extend(f"{system} {release}".lower() for release in platforms[system] or ())
    return tuple(names)


def read_history(
    versions: Sequence[FileVersion],
    blob: Callable[[str], bytes],
    known: DistroHistory | None = None,
    stop: int | None = None,
) -> DistroHistory:
    """Goes through the versions of a distribution file. blob gives the bytes of an id.

    known: what an earlier, shorter run found; it is continued when its versions are the beginning of these.
    stop: how many versions to read at most in this call, so that progress can be saved; None: all.
    """
    known = known or DistroHistory()
    if not (known.read and known.read <= len(versions) and versions[known.read - 1].blob == known.last):
        known = DistroHistory()
    reader = _Reader()
    if known.read:
        reader.restore(versions[known.read - 1], blob)
    events, platforms = list(known.events), list(known.platforms)
    unreadable = list(known.unreadable)
    end = len(versions) if stop is None else min(len(versions), known.read + stop)
    for version in versions[known.read : end]:
        data = blob(version.blob) if version.blob else b""
        if not version.blob:
            continue
        problem = reader.apply(data, version, events, platforms)
        if problem:
            unreadable.append((version.ts, problem))
    last = versions[end - 1].blob if end else ""
    return DistroHistory(tuple(events), tuple(platforms), end, last, tuple(unreadable))


class _Reader:
    """State between two versions: the blocks of the last one and what they say."""

    def __init__(self) -> None:
        self.blocks: set[bytes] = set()
        self.names: dict[bytes, str] = {}
        self.state: dict[str, RepositoryEntry] = {}
        self.head = b""
        self.path = ""

    def restore(self, version: FileVersion, blob: Callable[[str], bytes]) -> None:
        self.apply(blob(version.blob), version, [], [])

    def apply(self, data: bytes, version: FileVersion, events: list[EntryEvent], platforms: list[PlatformEvent]) -> str:
        """Adds what changed with a version; gives the reason when it cannot be read."""
        parts = split_file(data)
        if parts is None:
            return "no repositories"
        head, listed = parts
        blocks = set(listed)
        if version.path != self.path:
            # Another form of file: a block that looks the same may say something else.
            self.blocks, self.names, self.path = set(), {}, version.path
        found: dict[str, RepositoryEntry] = {}
        added = blocks - self.blocks
        named: dict[bytes, str] = {}
        for block in listed if len(added) == len(listed) else (b for b in listed if b in added):
            parsed = parse_block(block, version.path)
            if parsed is None:
                return f"unreadable block {block[:40].decode('utf-8', 'replace').strip()!r}"
            named[block] = parsed[0]
            found[parsed[0]] = parsed[1]
        self.names.update(named)
        present = {self.names[block] for block in blocks}
        for name, entry in found.items():
            if self.state.get(name) != entry:
                events.append(EntryEvent(version.ts, name, entry))
                self.state[name] = entry
        for name in sorted(set(self.state) - present):
            events.append(EntryEvent(version.ts, name, None))
            del self.state[name]
        for block in self.blocks - blocks:
            self.names.pop(block, None)
        self.blocks = blocks
        if head != self.head:
            self.head = head
            names = parse_platforms(head)
            if names and (not platforms or platforms[-1].names != names):
                platforms.append(PlatformEvent(version.ts, names))
        return ""
