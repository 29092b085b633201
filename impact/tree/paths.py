"""What every tree answers, and what its answers are made of."""

import errno
import hashlib
import posixpath
from collections.abc import Collection, Iterable, Iterator
from functools import cache
from typing import Protocol

import msgspec

from ...edges.console import UserError, escape
from ...edges.limits import get_limits

_IGNORE_MARKERS = frozenset((
    "COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE", "_setup_util.py", "_order_isolated_packages.py",
    "colcon_build.rc",
))  # fmt: skip
VERSION_CONTROL = frozenset((".git", ".hg", ".svn", ".bzr", ".jj"))
# Characters of all paths together, for each file that a tree may hold: deep folders make long paths.
CHARACTERS = 100
# What a working copy can hold: Linux opens no longer paths (PATH_MAX).
LONGEST_PATH = 4096
shown = escape
LEAVES = "the link leads out of the workspace, not followed; --follow-links follows it"


_VENDORED = frozenset((
    "third_party", "thirdparty", "third-party", "3rdparty", "3rd_party", "3rd-party", "external", "externals", "extern",
    "vendor", "vendored",
))  # fmt: skip


def find_ignore_marker(names: Collection[str]) -> str | None:
    """The file of a folder for which it is skipped; None where it is not. names: of what the folder holds. A cache of
    CMake beside no CMakeLists.txt is that of a build folder."""
    found = min(_IGNORE_MARKERS.intersection(names), default=None)
    if found is None and "CMakeCache.txt" in names and "CMakeLists.txt" not in names:
        return "CMakeCache.txt"
    return found


def is_vendored(path: str) -> bool:
    """Whether a path lies in a folder that is called as those for other people's code are."""
    return any(part.lower() in _VENDORED for part in path.split("/")[:-1])


class TreeEntry(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A file. path: relative to the tree's root, with slashes, bytes that are no UTF-8 as surrogate escapes. size: in
    bytes, 0 where a partial clone does not hold the file."""

    path: str
    size: int


class PathProblem(msgspec.Struct, frozen=True, array_like=True, gc=False, order=True):
    """A path that could not be read, or was left out, and in one clause why."""

    path: str
    message: str

    @property
    def is_submodule(self) -> bool:
        """True for a submodule that is not checked out."""
        return self.message.startswith("submodule ")


class TreeError(UserError):
    """There is no tree to read: no such folder, no such repository, no such revision. The text says what to do."""


class Tree(Protocol):
    """What WorkingTree, GitTree and JoinedTree have in common.

    label: what this tree is, for people. name: what its root folder is called. problems: what could not be read.
    skipped: folders left out on purpose. aliases: folders reached through a link, with the path they lead to.
    repositories: folders that are the root of a git repository, relative to the tree, with an absolute path for each.
    """

    label: str
    name: str
    problems: list[PathProblem]
    skipped: list[PathProblem]
    aliases: dict[str, str]

    @property
    def repositories(self) -> dict[str, str]: ...

    def list_entries(self) -> list[TreeEntry]:
        """Every file, sorted by path."""
        ...

    def find_content_id(self, path: str) -> str:
        """Git's blob id of the file's bytes, 40 hex digits. Raises OSError when it cannot be read."""
        ...

    def find_known_id(self, path: str) -> str | None:
        """The same where it is known without reading the file, else None."""
        ...

    def read(self, path: str, limit: int = 0) -> bytes:
        """The file's bytes. limit: how many it may have at most, as many as the largest kind of source may when 0.
        Raises OSError when it cannot be read, with EFBIG when it is larger."""
        ...

    def read_with_id(self, path: str, limit: int = 0) -> tuple[bytes, str]:
        """The file's bytes and their id, which fit together even while somebody edits the file."""
        ...

    def exists(self, path: str) -> bool:
        """True for files and folders, skipped ones included; False for what is reached through links that leave the
        tree."""
        ...

    def is_dir(self, path: str) -> bool:
        """True for folders, skipped ones included, as exists()."""
        ...

    def make_memory_key(self) -> bytes | None:
        """A name under which `memory` may be kept until the next run; None when there is nothing to keep."""
        ...

    def recall(self, memory: bytes) -> None:
        """Takes over what an earlier run knew; anything that does not fit is dropped."""
        ...

    def make_memory(self) -> bytes | None:
        """What the next run would like to know; None when it would be the same as what was recalled."""
        ...


def compute_blob_id(data: bytes) -> str:
    """Git's id for these bytes as a blob (SHA-1 object format)."""
    return hashlib.sha1(b"blob %d\0" % len(data) + data, usedforsecurity=False).hexdigest()


def normalize_path(path: str) -> str | None:
    """The path in its shortest form, `` for the root; None when it leads out of the tree."""
    if not path or path == ".":
        return ""
    if path[0] == "/" or "\0" in path:
        return None
    path = posixpath.normpath(path)
    if path == ".." or path.startswith("../"):
        return None
    return "" if path == "." else path


def join(folder: str, name: str) -> str:
    return f"{folder}/{name}" if folder else name


def is_within(path: str, folder: str) -> bool:
    """True when path is the folder or lies below it (both absolute, or both relative to one root)."""
    return path == folder or not folder or path.startswith(folder if folder.endswith("/") else folder + "/")


def make_outside_error(path: str) -> OSError:
    """The error for a path that leads out of the tree."""
    return FileNotFoundError(errno.ENOENT, "outside of the tree", path)


@cache
def find_file_size_limit() -> int:
    """Bytes that a file of a workspace may have at most, whatever kind it is of."""
    known = get_limits()
    return max(
        known.manifest, known.cmake, known.interface, known.cpp, known.python, known.launch, known.parameters,
        known.script, known.settings, known.text,
    )  # fmt: skip


def _find_name_problems(entries: Iterable[TreeEntry]) -> Iterator[PathProblem]:
    for entry in entries:
        if not entry.path.isascii():
            try:
                entry.path.encode("utf-8")
            except UnicodeEncodeError:
                yield PathProblem(entry.path, "the name is not valid UTF-8")


class Walked:
    """A tree that is walked once, when its entries are first asked for."""

    def _begin(self) -> None:
        self.problems: list[PathProblem] = []
        self.skipped: list[PathProblem] = []
        self.aliases: dict[str, str] = {}
        self._entries: list[TreeEntry] | None = None
        self._left = get_limits().entries
        self._characters_left = self._left * CHARACTERS

    def _count(self, folder: str, items: int, shown: str) -> None:
        """Takes what a folder holds from what the tree may hold; names the folder where that is used up."""
        most = get_limits().entries
        if items > self._left:
            message = f"more than {most:,} files and folders, the rest is left out"
            self.problems.append(PathProblem(folder or ".", message))
        self._left -= items
        self._characters_left -= items * len(folder)
        if self._characters_left < 0 < self._left:
            message = f"the paths have {most * CHARACTERS:,} characters in all, the rest is left out"
            self.problems.append(PathProblem(shown, message))
            self._left = 0

    def _walk(self, found: list[TreeEntry]) -> None:
        raise NotImplementedError

    def _may_follow(self, link: str, target: str, parents: tuple[str, ...], followed: set[str]) -> bool:
        """Whether a link to a folder is followed: once for each folder, and never into its own parents."""
        if any(is_within(parent, target) for parent in parents):
            self.problems.append(PathProblem(link, "the link leads to one of its own parent folders, not followed"))
            return False
        if target in followed:
            self.skipped.append(PathProblem(link, "another link to the same folder was followed"))
            return False
        followed.add(target)
        return True

    def list_entries(self) -> list[TreeEntry]:
        if self._entries is None:
            found: list[TreeEntry] = []
            self._walk(found)
            found.sort(key=lambda entry: entry.path)
            self._entries = found
            self.problems.extend(_find_name_problems(found))
            self.problems.sort()
            self.skipped.sort()
        return self._entries
