"""Where paths and bytes come from: a directory as it stands, or any revision of a git repository without a checkout.

WorkingTree and GitTree answer the same questions, name a file's content by the same id (git's blob id) and skip the
same folders, so whatever is known about a file's bytes holds for both.

Skipped, as colcon 0.21 and colcon-ros 0.5 do: folders that hold COLCON_IGNORE, AMENT_IGNORE, CATKIN_IGNORE, or the
_setup_util.py and _order_isolated_packages.py of an install space. Beyond colcon: the database folders of version
control; build, install, devel and log at the root, hidden folders and virtual environments, each only where git
governs the folder and tracks nothing below it. Without git every file counts as tracked.

A link to a file counts as that file. A link to a folder is followed once per target, never into its own parents.
"""

from __future__ import annotations

import contextlib
import hashlib
import os
import posixpath
import re
import stat
import time
from array import array
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, Protocol

import msgspec

from ..edges.console import UserError
from ..edges.console import visible as shown

IGNORE_MARKERS = frozenset(
    ("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE", "_setup_util.py", "_order_isolated_packages.py")
)
PRODUCTS = frozenset(("build", "install", "devel", "log"))
VERSION_CONTROL = frozenset((".git", ".hg", ".svn", ".bzr", ".jj"))
# A file whose time stamp is this close to the moment it was read may change once more without its time stamp showing
# it (FAT keeps two seconds), so its id is not remembered. Git calls such entries racy.
RACY_NS = 2_000_000_000
LINKED_FILES_AT_MOST = 20_000
_HOPS_AT_MOST = 40
_INDEX_FORMAT = 1


class Entry(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A file. path: relative to the tree's root, with slashes, bytes that are no UTF-8 as surrogate escapes. size: in
    bytes, 0 where a partial clone does not hold the file."""

    path: str
    size: int


class PathProblem(msgspec.Struct, frozen=True, array_like=True, gc=False, order=True):
    """A path that could not be read, or was left out, and in one clause why."""

    path: str
    message: str


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

    def entries(self) -> list[Entry]:
        """Every file, sorted by path."""
        ...

    def content_id(self, path: str) -> str:
        """Git's blob id of the file's bytes, 40 hex digits. Raises OSError when it cannot be read."""
        ...

    def known_id(self, path: str) -> str | None:
        """The same where it is known without reading the file, else None."""
        ...

    def read(self, path: str) -> bytes:
        """The file's bytes. Raises OSError when it cannot be read."""
        ...

    def read_with_id(self, path: str) -> tuple[bytes, str]:
        """The file's bytes and their id, which fit together even while somebody edits the file."""
        ...

    def exists(self, path: str) -> bool:
        """True for files and folders, skipped ones included."""
        ...

    def is_dir(self, path: str) -> bool:
        """True for folders, skipped ones included."""
        ...

    def memory_key(self) -> bytes | None:
        """A name under which `memory` may be kept until the next run; None when there is nothing to keep."""
        ...

    def recall(self, memory: bytes) -> None:
        """Takes over what an earlier run knew; anything that does not fit is dropped."""
        ...

    def memory(self) -> bytes | None:
        """What the next run would like to know; None when it would be the same as what was recalled."""
        ...


def blob_id(data: bytes) -> str:
    """Git's id for these bytes as a blob (SHA-1 object format)."""
    return hashlib.sha1(b"blob %d\0" % len(data) + data, usedforsecurity=False).hexdigest()


def inside(path: str) -> str | None:
    """The path in its shortest form, `` for the root; None when it leads out of the tree."""
    if not path or path == ".":
        return ""
    if path[0] == "/":
        return None
    path = posixpath.normpath(path)
    if path == ".." or path.startswith("../"):
        return None
    return "" if path == "." else path


def _join(folder: str, name: str) -> str:
    return f"{folder}/{name}" if folder else name


def _within(path: str, folder: str) -> bool:
    """True when path is the folder or lies below it (both absolute, or both relative to one root)."""
    return path == folder or not folder or path.startswith(folder if folder.endswith("/") else folder + "/")


def _name_problems(entries: Iterable[Entry]) -> Iterator[PathProblem]:
    for entry in entries:
        if not entry.path.isascii():
            try:
                entry.path.encode("utf-8")
            except UnicodeEncodeError:
                yield PathProblem(entry.path, "the name is not valid UTF-8")


class _Walked:
    """A tree that is walked once, when its entries are first asked for."""

    problems: list[PathProblem]
    skipped: list[PathProblem]
    _entries: list[Entry] | None

    def _walk(self, found: list[Entry]) -> None:
        raise NotImplementedError

    def entries(self) -> list[Entry]:
        if self._entries is None:
            found: list[Entry] = []
            self._walk(found)
            found.sort(key=lambda entry: entry.path)
            self._entries = found
            self.problems.extend(_name_problems(found))
            self.problems.sort()
            self.skipped.sort()
        return self._entries


class WorkingTree(_Walked):
    """A directory as it stands, uncommitted and untracked files included.

    root: a folder; raises TreeError when it is none. Nothing is read before entries() or another question is asked.
    """

    def __init__(self, root: str | os.PathLike[str]):
        self.root = os.path.abspath(os.fsdecode(root))
        if not os.path.isdir(self.root):
            what = "is a file, not a folder" if os.path.exists(self.root) else "does not exist"
            raise TreeError(f"`{shown(self.root)}` {what}; give the folder of a workspace or a package")
        self.name = os.path.basename(self.root)
        self.label = shown(self.name or self.root)
        self.problems: list[PathProblem] = []
        self.skipped: list[PathProblem] = []
        self.aliases: dict[str, str] = {}
        self._entries: list[Entry] | None = None
        self._repositories: dict[str, str] = {}
        self._folders: set[str] = set()
        self._stats: dict[str, tuple[int, int, int, int]] = {}
        self._ids: dict[str, str] = {}
        self._remembered: dict[str, tuple[tuple[int, int, int, int], str]] = {}
        self._fresh = False
        self._indexes: dict[str, _Index | None] = {}

    @property
    def repositories(self) -> dict[str, str]:
        self.entries()
        return self._repositories

    def _walk(self, found: list[Entry]) -> None:
        real_root = os.path.realpath(self.root)
        enclosing = _enclosing_repository(real_root)
        if enclosing and enclosing != real_root:
            self._repositories[""] = enclosing
        links: list[tuple[str, str, tuple[str, ...]]] = []
        # (folder relative to the root, its real path, the repository that governs it)
        stack = [("", real_root, enclosing)]
        while stack:
            folder, real, repository = stack.pop()
            self._folder(folder, real, repository, (), stack, links, found)
        followed: set[str] = set()
        visited: set[str] = set()
        for link, target, parents in links:  # grows while links lead to further links
            if any(_within(parent, target) for parent in parents):
                self.problems.append(PathProblem(link, "the link leads to one of its own parent folders, not followed"))
                continue
            if target in followed:
                self.skipped.append(PathProblem(link, "another link to the same folder was followed"))
                continue
            followed.add(target)
            in_tree = _within(target, real_root)
            self.aliases[link] = os.path.relpath(target, real_root) if in_tree else target
            stack = [(link, target, _enclosing_repository(target))]
            limit = len(found) + LINKED_FILES_AT_MOST
            while stack:
                folder, real, repository = stack.pop()
                if real in visited:
                    continue
                visited.add(real)
                if not in_tree and len(found) > limit:
                    message = f"the link leads to more than {LINKED_FILES_AT_MOST} files, the rest is left out"
                    self.problems.append(PathProblem(link, message))
                    break
                self._folder(folder, real, repository, parents, stack, links, found)

    def _folder(
        self,
        folder: str,
        real: str,
        repository: str | None,
        parents: tuple[str, ...],
        stack: list[tuple[str, str, str | None]],
        links: list[tuple[str, str, tuple[str, ...]]],
        found: list[Entry],
    ) -> None:
        """Lists one folder: files go to found, folders onto the stack, links to folders into links."""
        try:
            with os.scandir(os.path.join(self.root, folder)) as scan:
                items = list(scan)
        except OSError as error:
            self.problems.append(PathProblem(folder or ".", f"the folder cannot be listed: {_reason(error)}"))
            return
        names = {item.name for item in items}
        if not IGNORE_MARKERS.isdisjoint(names):
            marker = min(IGNORE_MARKERS & names)
            self.skipped.append(PathProblem(folder or ".", f"holds {marker}"))
            return
        if ".git" in names:
            repository = real
            self._repositories[folder] = real
        self._folders.add(folder)
        prefix = folder + "/" if folder else ""
        for item in items:
            name = item.name
            path = prefix + name
            try:
                if item.is_dir(follow_symlinks=False):
                    why = self._untracked(name, path, os.path.join(real, name), repository)
                    if why:
                        self.skipped.append(PathProblem(path, why))
                    elif name not in VERSION_CONTROL:
                        stack.append((path, os.path.join(real, name), repository))
                    continue
                if name in VERSION_CONTROL:
                    continue
                is_link = item.is_symlink()
                status = os.stat(os.path.join(self.root, path)) if is_link else item.stat(follow_symlinks=False)
            except OSError as error:
                self.problems.append(PathProblem(path, self._why_unreadable(path, error)))
                continue
            if stat.S_ISREG(status.st_mode):
                found.append(Entry(path, status.st_size))
                self._stats[path] = _stamp(status)
            elif stat.S_ISDIR(status.st_mode):
                links.append((path, os.path.realpath(os.path.join(self.root, path)), (*parents, real)))
            else:
                self.problems.append(PathProblem(path, "neither a file nor a folder"))
        if ".gitmodules" in names:
            self._submodules(folder)

    def _why_unreadable(self, path: str, error: OSError) -> str:
        try:
            target = os.readlink(os.path.join(self.root, path))
        except OSError:
            return f"cannot be read: {_reason(error)}"
        return f"the link to `{shown(target)}` is broken: {_reason(error)}"

    def _untracked(self, name: str, path: str, real: str, repository: str | None) -> str:
        """Why a folder is left out, or an empty string."""
        if name in VERSION_CONTROL or repository is None:
            return ""
        if path in PRODUCTS:
            why = "looks like a product of the build, and git tracks nothing in it"
        elif name[0] == "." and name != ".github":
            why = "hidden, and git tracks nothing in it"
        elif name == "node_modules" or (name.endswith(("env", "ENV")) and os.path.exists(f"{real}/pyvenv.cfg")):
            why = "holds installed packages, and git tracks nothing in it"
        else:
            return ""
        if os.path.lexists(os.path.join(real, ".git")):
            return ""
        if repository not in self._indexes:
            self._indexes[repository] = _Index.of(repository)
        index = self._indexes[repository]
        inner = os.path.relpath(real, repository).replace(os.sep, "/")
        return "" if index is None or index.tracks_below(inner) else why

    def _submodules(self, folder: str) -> None:
        try:
            with open(os.path.join(self.root, folder, ".gitmodules"), "rb") as file:
                text = file.read(1 << 20)
        except OSError:
            return
        for match in re.finditer(rb"(?m)^[ \t]*path[ \t]*=[ \t]*(.+?)[ \t]*\r?$", text):
            path = inside(_join(folder, match[1].strip(b'"').decode("utf-8", "surrogateescape")))
            if not path:
                continue
            place = os.path.join(self.root, path)
            try:
                empty = not os.listdir(place)
            except OSError:
                empty = True
            if empty:
                self.problems.append(PathProblem(path, "submodule that is not checked out"))

    def known_id(self, path: str) -> str | None:
        known = self._ids.get(path)
        if known is None:
            remembered = self._remembered.get(path)
            if remembered is not None and remembered[0] == self._stats.get(path):
                known = self._ids[path] = remembered[1]
        return known

    def content_id(self, path: str) -> str:
        return self.known_id(path) or self.read_with_id(path)[1]

    def read(self, path: str) -> bytes:
        with open(self._readable(path), "rb") as file:
            return file.read()

    def read_with_id(self, path: str) -> tuple[bytes, str]:
        with open(self._readable(path), "rb") as file:
            data = file.read()
            status = os.fstat(file.fileno())
        content = blob_id(data)
        self._ids[path] = content
        stamp = _stamp(status)
        self._stats[path] = stamp
        if max(status.st_mtime_ns, status.st_ctime_ns) < time.time_ns() - RACY_NS and status.st_size == len(data):
            self._remembered[path] = (stamp, content)
            self._fresh = True
        elif self._remembered.pop(path, None):
            self._fresh = True
        return data, content

    def _readable(self, path: str) -> str:
        """The absolute path of a regular file; opening a named pipe would wait for ever."""
        place = self._absolute(path)
        if path not in self._stats and stat.S_ISFIFO(os.stat(place).st_mode):
            raise OSError(22, "neither a file nor a folder", path)
        return place

    def _absolute(self, path: str) -> str:
        clean = inside(path)
        if clean is None:
            raise FileNotFoundError(2, "outside of the tree", path)
        return os.path.join(self.root, clean)

    def exists(self, path: str) -> bool:
        if path in self._stats or path in self._folders:
            return True
        clean = inside(path)
        return clean is not None and os.path.exists(os.path.join(self.root, clean))

    def is_dir(self, path: str) -> bool:
        if path in self._stats:
            return False
        if path in self._folders:
            return True
        clean = inside(path)
        return clean is not None and os.path.isdir(os.path.join(self.root, clean))

    def memory_key(self) -> bytes | None:
        return self.root.encode("utf-8", "surrogateescape")

    def recall(self, memory: bytes) -> None:
        self._remembered = _decode_memory(memory)

    def memory(self) -> bytes | None:
        stale = len(self._remembered) > 2 * len(self._stats) + 100
        if not self._fresh and not stale:
            return None
        stats = self._stats
        return _encode_memory({path: kept for path, kept in self._remembered.items() if path in stats})


def _stamp(status: os.stat_result) -> tuple[int, int, int, int]:
    return (status.st_size, status.st_mtime_ns, status.st_ino & 0x7FFFFFFFFFFFFFFF, status.st_ctime_ns)


def _reason(error: OSError) -> str:
    return (error.strerror or type(error).__name__).lower()


def _encode_memory(remembered: dict[str, tuple[tuple[int, int, int, int], str]]) -> bytes:
    stamps = array("q")
    for stamp, _ in remembered.values():
        stamps.extend(stamp)
    paths = "\0".join(remembered).encode("utf-8", "surrogateescape")
    ids = bytes.fromhex("".join(content for _, content in remembered.values()))
    return msgspec.msgpack.encode((_INDEX_FORMAT, paths, stamps.tobytes(), ids))


def _decode_memory(memory: bytes) -> dict[str, tuple[tuple[int, int, int, int], str]]:
    try:
        version, paths, packed, ids = msgspec.msgpack.decode(memory, type=tuple[int, bytes, bytes, bytes])
        stamps = array("q")
        stamps.frombytes(packed)
    except (msgspec.MsgspecError, ValueError):
        return {}
    names = paths.decode("utf-8", "surrogateescape").split("\0") if paths else []
    if version != _INDEX_FORMAT or len(stamps) != 4 * len(names) or len(ids) != 20 * len(names):
        return {}
    digits = ids.hex()
    four = iter(stamps)
    rows = zip(four, four, four, four, strict=True)
    return {
        name: (stamp, digits[40 * at : 40 * at + 40]) for at, (name, stamp) in enumerate(zip(names, rows, strict=True))
    }


def _enclosing_repository(folder: str) -> str | None:
    """The nearest folder at or above this one that holds .git."""
    while True:
        if os.path.lexists(os.path.join(folder, ".git")):
            return folder
        parent = os.path.dirname(folder)
        if parent == folder:
            return None
        folder = parent


class _Index:
    """What git tracks in a repository. The bytes of its index are asked first, since importing pygit2 takes longer.

    The index's format is described in gitformat-index(5): versions 2 and 3 hold each path in full.
    """

    def __init__(self, repository: str, data: bytes):
        self._repository = repository
        self._data = data
        self._paths: list[str] | None = None

    @classmethod
    def of(cls, repository: str) -> _Index | None:
        """None when the index cannot be read, and so nothing may be called untracked."""
        place = os.path.join(repository, ".git")
        try:
            if not os.path.isdir(place):
                with open(place, encoding="utf-8", errors="surrogateescape") as file:
                    text = file.read(4096)
                if not text.startswith("gitdir:"):
                    return None
                place = os.path.join(repository, text[7:].strip())
            if not os.path.exists(os.path.join(place, "HEAD")):
                return None
            with open(os.path.join(place, "index"), "rb") as file:
                return cls(repository, file.read())
        except FileNotFoundError:
            return cls(repository, b"")
        except OSError:
            return None

    def tracks_below(self, folder: str) -> bool:
        """True when a tracked file lies below the folder (relative to the repository)."""
        if not self._data:
            return False
        needle = (folder + "/").encode("utf-8", "surrogateescape")
        # split and sparse indexes (extensions `link` and `sdir`) do not hold every path
        plain = self._data[4:8] in (b"\0\0\0\2", b"\0\0\0\3")
        if plain and not any(mark in self._data for mark in (needle, b"link\0\0", b"sdir\0\0\0\0")):
            return False
        if self._paths is None:
            import pygit2

            _trust_any_owner(pygit2)
            try:
                self._paths = [entry.path for entry in pygit2.Repository(self._repository).index]
            except (pygit2.GitError, OSError, ValueError, UnicodeDecodeError):
                return True
        prefix = folder + "/"
        return any(path.startswith(prefix) for path in self._paths)


def _trust_any_owner(pygit2) -> None:
    # Git refuses repositories of other users because it would run their hooks. Here only objects are read.
    pygit2.option(pygit2.enums.Option.SET_OWNER_VALIDATION, False)


class GitTree(_Walked):
    """One revision of a git repository, read from its objects; bare repositories too, nothing is checked out.

    repository: the repository or any folder in it. revision: whatever git rev-parse takes; a branch that exists only at
    `origin` is found there. folder: makes a folder of the revision the tree's root.
    Raises TreeError when there is no such repository, revision or folder.
    """

    def __init__(self, repository: str | os.PathLike[str], revision: str = "HEAD", folder: str = ""):
        self.repository = os.fsdecode(repository)
        self._repo: Any = _open_repository(self.repository)
        commit, tree = _resolve(self._repo, revision, self.repository)
        self.commit: str = commit
        # folders already read, by id: revisions of one repository share most of theirs
        self._read_folders: dict[Any, tuple[tuple[str, int, Any], ...]] = {}
        self._start(revision, tree, folder)

    def _start(self, revision: str, tree, folder: str) -> None:
        self.revision = revision
        short = self.commit[:10]
        self.label = short if self.commit.startswith(revision) else f"{revision} ({short})"
        self.problems: list[PathProblem] = []
        self.skipped: list[PathProblem] = []
        self.aliases: dict[str, str] = {}
        self.folder = inside(folder) or ""
        place = self.repositories[""].removesuffix("/.git")
        self.name = posixpath.basename(self.folder or place).removesuffix(".git")
        self._top = tree.id
        self._root_path = self.folder
        self._entries: list[Entry] | None = None
        self._blobs: dict[str, Any] = {}
        self._folders: set[str] = set()
        if self.folder and self._find(self.folder)[1] != _FOLDER:
            raise TreeError(f"`{shown(self.folder)}` is no folder of {self.label}; give one that this revision has")

    @property
    def repositories(self) -> dict[str, str]:
        place = self._repo.path if self._repo.is_bare else self._repo.workdir or self._repo.path
        return {"": place.rstrip("/")}

    def at(self, revision: str) -> GitTree:
        """Another revision of the same repository and folder; folders they share are read once."""
        other = object.__new__(GitTree)
        other.repository, other._repo, other._read_folders = self.repository, self._repo, self._read_folders
        other.commit, tree = _resolve(self._repo, revision, self.repository)
        other._start(revision, tree, self.folder)
        return other

    def merge_base(self, revision: str) -> GitTree:
        """The tree at the merge base of this revision and another. Raises TreeError when they share no history."""
        other, _ = _resolve(self._repo, revision, self.repository)
        base = self._repo.merge_base(self.commit, other)
        if base is None:
            raise TreeError(
                f"`{revision}` and {self.label} share no history here; fetch more of it (git fetch --unshallow)"
            )
        return self.at(str(base))

    def _list(self, oid) -> tuple[tuple[str, int, Any], ...]:
        """(name, mode, id) of everything in a folder."""
        listing = self._read_folders.get(oid)
        if listing is None:
            listing = tuple(
                (item.raw_name.decode("utf-8", "surrogateescape"), int(item.filemode), item.id)
                for item in self._repo[oid]
            )
            self._read_folders[oid] = listing
        return listing

    def _walk(self, found: list[Entry]) -> None:
        root = self.folder
        _, kind, top = self._find(root)
        if kind != _FOLDER:
            return
        links: list[tuple[str, str, tuple[str, ...]]] = []
        stack = [("", root, top)]
        while stack:
            folder, real, oid = stack.pop()
            self._walk_folder(folder, real, oid, (), stack, links, found)
        followed: set[str] = set()
        visited: set[str] = set()
        for link, target, parents in links:
            if any(_within(parent, target) for parent in parents):
                self.problems.append(PathProblem(link, "the link leads to one of its own parent folders, not followed"))
                continue
            if target in followed:
                self.skipped.append(PathProblem(link, "another link to the same folder was followed"))
                continue
            followed.add(target)
            in_tree = _within(target, root)
            self.aliases[link] = posixpath.relpath(target or ".", root or ".") if in_tree else "/" + target
            stack = [(link, target, self._find(target)[2])]
            while stack:
                folder, real, oid = stack.pop()
                if real not in visited:
                    visited.add(real)
                    self._walk_folder(folder, real, oid, parents, stack, links, found)

    def _walk_folder(self, folder, real, oid, parents, stack, links, found: list[Entry]) -> None:
        try:
            items = self._list(oid)
        except (KeyError, ValueError):
            self.problems.append(PathProblem(folder or ".", "the folder's object is missing from this repository"))
            return
        markers = [name for name, _, _ in items if name in IGNORE_MARKERS]
        if markers:
            self.skipped.append(PathProblem(folder or ".", f"holds {min(markers)}"))
            return
        self._folders.add(folder)
        for name, mode, item in items:
            path = _join(folder, name)
            if mode == _MODE_FOLDER:
                if name not in VERSION_CONTROL:
                    stack.append((path, _join(real, name), item))
            elif mode == _MODE_SUBMODULE:
                self.problems.append(PathProblem(path, f"submodule at {str(item)[:10]}, kept in another repository"))
            elif mode == _MODE_LINK:
                target, kind, oid_of_target = self._find(_join(real, name))
                if kind == _FILE:
                    self._add(path, oid_of_target, found)
                elif kind == _FOLDER:
                    links.append((path, target, (*parents, real)))
                else:
                    self.problems.append(PathProblem(path, f"the link is broken: {target}"))
            elif name not in VERSION_CONTROL:
                self._add(path, item, found)

    def _add(self, path: str, oid, found: list[Entry]) -> None:
        try:
            size = _size(self._repo, oid)
        except (KeyError, ValueError):
            size = 0  # a partial clone; whoever needs the bytes is told when reading
        self._blobs[path] = oid
        found.append(Entry(path, size))

    def _find(self, path: str) -> tuple[str, int, Any]:
        """Follows a path of the whole revision through links: (path without links, kind, id); kind 0 when it leads
        nowhere, and then the first item says why."""
        pending = [part for part in reversed(path.split("/")) if part]
        names: list[str] = []
        oids = [self._top]
        hops = 0
        while pending:
            name = pending.pop()
            if name == "." or not name:
                continue
            if name == "..":
                if not names:
                    return "it leads out of the repository", 0, None
                names.pop()
                oids.pop()
                continue
            try:
                match = next(((mode, oid) for other, mode, oid in self._list(oids[-1]) if other == name), None)
            except (KeyError, ValueError):
                match = None
            if match is None:
                return "no such file or directory", 0, None
            mode, oid = match
            if mode == _MODE_LINK:
                hops += 1
                if hops > _HOPS_AT_MOST:
                    return "too many levels of symbolic links", 0, None
                try:
                    target = self._repo[oid].data.decode("utf-8", "surrogateescape")
                except (KeyError, ValueError):
                    return "its object is missing from this repository", 0, None
                if target.startswith("/"):
                    return "it leads out of the repository", 0, None
                pending.extend(reversed(target.split("/")))
            elif mode == _MODE_FOLDER:
                names.append(name)
                oids.append(oid)
            elif mode == _MODE_SUBMODULE:
                return "it leads into a submodule", 0, None
            elif pending:
                return "not a directory", 0, None
            else:
                return "/".join((*names, name)), _FILE, oid
        return "/".join(names), _FOLDER, oids[-1]

    def _lookup(self, path: str) -> tuple[int, Any]:
        if path in self._blobs:
            return _FILE, self._blobs[path]
        clean = inside(path)
        if clean is None:
            return 0, None
        _, kind, oid = self._find(_join(self.folder, clean) if clean else self.folder)
        return kind, oid

    def known_id(self, path: str) -> str | None:
        kind, oid = self._lookup(path)
        return str(oid) if kind == _FILE else None

    def content_id(self, path: str) -> str:
        known = self.known_id(path)
        if known is None:
            raise FileNotFoundError(2, f"not in {self.label}", path)
        return known

    def read(self, path: str) -> bytes:
        return self.read_with_id(path)[0]

    def read_with_id(self, path: str) -> tuple[bytes, str]:
        kind, oid = self._lookup(path)
        if kind != _FILE:
            raise FileNotFoundError(2, f"not in {self.label}", path)
        try:
            return self._repo[oid].data, str(oid)
        except (KeyError, ValueError):
            raise FileNotFoundError(2, "its object is missing from this repository", path) from None

    def exists(self, path: str) -> bool:
        return self._lookup(path)[0] != 0

    def is_dir(self, path: str) -> bool:
        return path in self._folders or self._lookup(path)[0] == _FOLDER

    def memory_key(self) -> bytes | None:
        return None

    def recall(self, memory: bytes) -> None:
        del memory

    def memory(self) -> bytes | None:
        return None


class JoinedTree:
    """Several trees under one root, such as a workspace whose repositories stand at different revisions.

    mounts: tree by folder. Where folders contain each other the inner tree hides what the outer one has there.
    """

    def __init__(self, mounts: Mapping[str, Tree], label: str = ""):
        self.mounts = dict(sorted(mounts.items(), key=lambda mount: -len(mount[0])))
        outermost = list(self.mounts.values())[-1] if self.mounts else None
        self.label = label or ", ".join(f"{folder or '.'} at {tree.label}" for folder, tree in sorted(mounts.items()))
        self.name = outermost.name if outermost is not None and "" in self.mounts else ""
        self.problems: list[PathProblem] = []
        self.skipped: list[PathProblem] = []
        self.aliases: dict[str, str] = {}
        self._entries: list[Entry] | None = None

    @property
    def repositories(self) -> dict[str, str]:
        found = {}
        for mount, tree in self.mounts.items():
            for folder, place in tree.repositories.items():
                if self._mount(_join(mount, folder)) == mount:
                    found[_join(mount, folder) if folder else mount] = place
        return found

    def _mount(self, path: str) -> str | None:
        return next((mount for mount in self.mounts if _within(path, mount)), None)

    def _inner(self, path: str) -> tuple[Tree, str]:
        mount = self._mount(path)
        if mount is None:
            raise FileNotFoundError(2, "in none of the trees", path)
        return self.mounts[mount], path[len(mount) + 1 :] if mount else path

    def entries(self) -> list[Entry]:
        if self._entries is None:
            found = []
            for mount, tree in self.mounts.items():
                inner = [other for other in self.mounts if other != mount and _within(other, mount)]
                prefix = mount + "/" if mount else ""

                def kept(path: str, inner: list[str] = inner) -> bool:
                    return not any(_within(path, other) for other in inner)

                found += [Entry(prefix + e.path, e.size) for e in tree.entries() if kept(prefix + e.path)]
                for own, theirs in ((self.problems, tree.problems), (self.skipped, tree.skipped)):
                    own += [PathProblem(prefix + p.path, p.message) for p in theirs if kept(prefix + p.path)]
                for link, target in tree.aliases.items():
                    if kept(prefix + link):
                        self.aliases[prefix + link] = target if target.startswith("/") else prefix + target
            found.sort(key=lambda entry: entry.path)
            self._entries = found
        return self._entries

    def known_id(self, path: str) -> str | None:
        tree, inner = self._inner(path)
        return tree.known_id(inner)

    def content_id(self, path: str) -> str:
        tree, inner = self._inner(path)
        return tree.content_id(inner)

    def read(self, path: str) -> bytes:
        tree, inner = self._inner(path)
        return tree.read(inner)

    def read_with_id(self, path: str) -> tuple[bytes, str]:
        tree, inner = self._inner(path)
        return tree.read_with_id(inner)

    def exists(self, path: str) -> bool:
        clean = inside(path)
        if clean is None:
            return False
        if any(_within(mount, clean) for mount in self.mounts):
            return True
        mount = self._mount(clean)
        return mount is not None and self._inner(clean)[0].exists(self._inner(clean)[1])

    def is_dir(self, path: str) -> bool:
        clean = inside(path)
        if clean is None:
            return False
        if any(_within(mount, clean) for mount in self.mounts):
            return True
        mount = self._mount(clean)
        return mount is not None and self._inner(clean)[0].is_dir(self._inner(clean)[1])

    def memory_key(self) -> bytes | None:
        return self.mounts[""].memory_key() if "" in self.mounts else None

    def recall(self, memory: bytes) -> None:
        if "" in self.mounts:
            self.mounts[""].recall(memory)

    def memory(self) -> bytes | None:
        return self.mounts[""].memory() if "" in self.mounts else None


def at_merge_bases(tree: Tree, revisions: Mapping[str, str], default: str = "") -> Tree:
    """The tree as it was at the merge base of each repository's commit and a revision.

    revisions: by the repository's folder relative to the tree. default: of the repositories not named; they are left as
    they are when it is empty. What lies in no repository is left as it is. Raises TreeError when a named folder is no
    repository, a revision is not known, or nothing at all is under git.
    """
    if isinstance(tree, GitTree):
        return tree.merge_base(revisions.get("", default))
    named = {inside(folder): revision for folder, revision in revisions.items()}
    unknown = sorted(shown(folder or ".") for folder in named if folder is None or folder not in tree.repositories)
    known = ", ".join(f"`{shown(folder or '.')}`" for folder in sorted(tree.repositories)) or "none"
    if unknown:
        raise TreeError(f"`{unknown[0]}` is no git repository of {tree.label}; those it has: {known}")
    mounts: dict[str, Tree] = {"": tree}
    failed = []
    for folder, place in tree.repositories.items():
        revision = named.get(folder, default)
        if not revision:
            continue
        inner = ""
        if not folder and isinstance(tree, WorkingTree):
            inner = os.path.relpath(os.path.realpath(tree.root), place)
        try:
            mounts[folder] = GitTree(place, "HEAD", inner).merge_base(revision)
        except TreeError as error:
            failed.append((folder, error))
    if failed:
        more = "" if len(tree.repositories) == 1 else "; repositories may differ: --base PATH=REV"
        raise TreeError(f"{failed[0][1]}{more}")
    if not tree.repositories:
        raise TreeError(f"{tree.label} holds no git repository, so there is no base to compare with")
    return JoinedTree(mounts)


_FILE, _FOLDER = 1, 2
_MODE_FOLDER, _MODE_LINK, _MODE_SUBMODULE = 0o040000, 0o120000, 0o160000


def _open_repository(place: str):
    import pygit2

    _trust_any_owner(pygit2)
    try:
        found = pygit2.discover_repository(place)
        if found is None:
            if not os.path.exists(place):
                raise TreeError(f"`{shown(place)}` does not exist; give a git repository, or a folder in one")
            raise TreeError(f"`{shown(place)}` is not in a git repository; give a folder that is in one")
        return pygit2.Repository(found)
    except (pygit2.GitError, KeyError, ValueError, OSError) as error:
        raise TreeError(f"the git repository `{shown(place)}` cannot be opened: {error}") from None


def _resolve(repo, revision: str, place: str) -> tuple[str, Any]:
    """(id of the commit, its tree) of a revision."""
    import pygit2

    for spelling in (revision, f"origin/{revision}"):
        try:
            found = repo.revparse_single(spelling)
            tree = found.peel(pygit2.Tree)
        except (KeyError, ValueError, pygit2.GitError):
            continue
        with contextlib.suppress(ValueError, pygit2.GitError):  # a tree without a commit will do
            found = found.peel(pygit2.Commit)
        return str(found.id), tree
    cure = "its history is cut off (shallow), fetch more of it" if repo.is_shallow else "git rev-parse must know it"
    raise TreeError(f"`{shown(revision)}` is no revision of `{shown(place)}`; {cure}")


def _size(repo, oid) -> int:
    """Bytes of a blob. Reads the object's header alone where this pygit2 can."""
    read_header = getattr(repo.odb, "read_header", None)
    if read_header is None:
        return repo[oid].size
    header = read_header(oid)
    return header[1] if isinstance(header, tuple) else header.size
