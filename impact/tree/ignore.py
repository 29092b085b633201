"""What git tracks in a repository, told by its index alone; git itself is not needed for that.

The index's format is described in gitformat-index(5), versions 2 to 4.
"""

from __future__ import annotations

import os
from bisect import bisect_left
from collections.abc import Iterator

from ...edges import files
from ...edges.limits import KB, get_limits
from .paths import LONGEST_PATH

# So many questions are answered by a search through the index's bytes, before its paths are taken apart.
_SEARCHES = 64
# Extensions of split and sparse indexes, which do not hold every path.
_PARTIAL = (b"link\0\0", b"sdir\0\0\0\0")
_LINK_FILE = 64 * KB


def find_enclosing_repository(folder: str) -> str | None:
    """The nearest folder at or above this one that holds .git."""
    while True:
        if os.path.lexists(os.path.join(folder, ".git")):
            return folder
        parent = os.path.dirname(folder)
        if parent == folder:
            return None
        folder = parent


def find_git_dir(repository: str) -> str:
    """The folder that holds a repository's HEAD and index: .git, or what the file .git names, as in worktrees and
    submodules. Raises OSError where it names none."""
    place = os.path.join(repository, ".git")
    if os.path.isdir(place):
        return place
    text = os.fsdecode(files.read_file(place, _LINK_FILE))
    if not text.startswith("gitdir:"):
        raise OSError(22, "names no folder of git", place)
    target = text[7:].strip()
    if "\0" in target:
        raise OSError(22, "names no folder of git", place)
    return os.path.join(repository, target)


class Index:
    """What git tracks in a repository. Its paths are only taken apart where searching its bytes would take longer."""

    def __init__(self, data: bytes):
        self._data = data
        self._searches = 0
        self._paths: list[bytes] | None = None
        self._unknown = False

    @classmethod
    def open_index(cls, repository: str) -> Index | None:
        """None when the index cannot be read, and so nothing may be called untracked."""
        try:
            place = find_git_dir(repository)
            if not os.path.exists(os.path.join(place, "HEAD")):
                return None
            return cls(files.read_file(os.path.join(place, "index"), get_limits().index))
        except FileNotFoundError:
            return cls(b"")
        except OSError:
            return None

    def tracks_below(self, folder: str) -> bool:
        """True when a tracked file lies below the folder (relative to the repository), or when that is not known."""
        if not self._data:
            return False
        prefix = (folder + "/").encode("utf-8", "surrogateescape")
        if self._paths is None and not self._unknown:
            self._searches += 1
            plain = self._data[4:8] in (b"\0\0\0\2", b"\0\0\0\3") and self._searches <= _SEARCHES
            if plain and not any(mark in self._data for mark in (prefix, *_PARTIAL)):
                return False
            try:
                self._paths = sorted(_list_paths(self._data))
            except (ValueError, IndexError):
                self._unknown = True
        if self._paths is None:
            return True
        at = bisect_left(self._paths, prefix)
        return at < len(self._paths) and self._paths[at].startswith(prefix)

    def tracks(self, path: str) -> bool:
        """True when git tracks a file or link of this path, or when that is not known."""
        try:
            return os.fsencode(path) in _list_paths(self._data) if self._data else False
        except (ValueError, IndexError):
            return True


def _list_paths(data: bytes) -> Iterator[bytes]:
    """The paths of an index. Raises ValueError or IndexError where it is damaged, split or sparse."""
    version = int.from_bytes(data[4:8], "big")
    if data[:4] != b"DIRC" or version not in (2, 3, 4):
        raise ValueError("no index")
    at, path = 12, b""
    for _ in range(int.from_bytes(data[8:12], "big")):
        start = at
        at += 64 if version > 2 and data[at + 60] & 0x40 else 62
        if version == 4:
            cut, at = _read_varint(data, at)
            end = data.index(b"\0", at)
            path = path[: max(0, len(path) - cut)] + data[at:end]
            if len(path) > LONGEST_PATH:
                raise ValueError("damaged")
            at = end + 1
        else:
            end = data.index(b"\0", at)
            path = data[at:end]
            at = start + (end - start + 8) // 8 * 8
        yield path
    rest = data[at:-20]
    if any(mark in rest for mark in _PARTIAL):
        raise ValueError("not every path")


def _read_varint(data: bytes, at: int) -> tuple[int, int]:
    """A number in git's encoding, and where it ends."""
    byte = data[at]
    value = byte & 0x7F
    at += 1
    while byte & 0x80:
        byte = data[at]
        value = ((value + 1) << 7) | (byte & 0x7F)
        at += 1
        if value > len(data):
            raise ValueError("damaged")
    return value, at
