"""A revision of a git repository, read from its objects."""

from __future__ import annotations

import os
import posixpath
from collections import Counter
from typing import Any

from .paths import (
    LEAVES,
    LONGEST_PATH,
    VERSION_CONTROL,
    PathProblem,
    TreeEntry,
    TreeError,
    Walked,
    find_file_size_limit,
    find_ignore_marker,
    is_within,
    join,
    normalize_path,
    shown,
)
from .repository import MODE_FOLDER, MODE_LINK, MODE_SUBMODULE, RepositoryObjects, merge_base, open_repository, resolve

_FILE, _FOLDER = 1, 2
_HOPS_AT_MOST = 40
# Parts of paths that following links may look at in all; a link may name thousands, and lead to further ones.
_STEPS_AT_MOST = 5_000_000
# At so many places the same folder may stand: a folder that holds ten of one that holds ten, and so on, is no end.
_PLACES_AT_MOST = 2_000
_REPOSITORY = "it leads out of the repository"


def find_name(place: str, folder: str) -> str:
    """What a folder of a repository is called, or the repository when it is its root."""
    return posixpath.basename(folder or place.removesuffix("/.git")).removesuffix(".git")


class GitTree(Walked):
    """One revision of a git repository, read from its objects; bare repositories too, nothing is checked out.

    repository: the repository or any folder in it. revision: whatever git rev-parse takes; a branch that exists only at
    `origin` is found there. folder: makes a folder of the revision the tree's root. follow_links: also follow links
    that leave that folder, as far as the revision has what they lead to.
    Raises TreeError when there is no such repository, revision or folder.
    """

    def __init__(
        self, repository: str | os.PathLike[str], revision: str = "HEAD", folder: str = "", *,
        follow_links: bool = False,
    ):  # fmt: skip
        self.repository = os.fsdecode(repository)
        self.follow_links = follow_links
        opened = open_repository(self.repository)
        self._repo: Any = opened.repository
        self._objects = RepositoryObjects(opened)
        commit, tree = resolve(self._repo, revision, self.repository)
        self.commit: str = commit
        self._start(revision, tree, folder)

    def _start(self, revision: str, tree, folder: str) -> None:
        self.revision = revision
        short = self.commit[:10]
        self.label = short if self.commit.startswith(revision) else f"{revision} ({short})"
        self._begin()
        self.folder = normalize_path(folder) or ""
        self.name = find_name(self.repositories[""], self.folder)
        self._top = tree
        self._blobs: dict[str, Any] = {}
        self._folders: set[str] = set()
        self._places: Counter[Any] = Counter()
        self._steps = _STEPS_AT_MOST
        if self.folder and self._find(self.folder)[1] != _FOLDER:
            raise TreeError(f"`{shown(self.folder)}` is no folder of {self.label}; give one that this revision has")

    @property
    def repositories(self) -> dict[str, str]:
        place = self._repo.path if self._repo.is_bare else self._repo.workdir or self._repo.path
        return {"": place.rstrip("/")}

    def count_levels_in_repository(self) -> int:
        """How far below the root of its repository the tree is."""
        return self.folder.count("/") + 1 if self.folder else 0

    def open_folder_of_repository(self, folder: str) -> GitTree:
        """A folder of the same revision, by its path in the repository. Raises TreeError where there is none."""
        return GitTree(self.repository, self.revision, folder)

    @property
    def is_checked_out(self) -> bool:
        """Whether it is the commit that HEAD means, asked for by its id."""
        by_id = self.commit.startswith(self.revision) and not self._repo.head_is_unborn
        return by_id and str(self._repo.head.target) == self.commit

    def open_revision(self, revision: str) -> GitTree:
        """Another revision of the same repository and folder; folders they share are read once."""
        other = object.__new__(GitTree)
        other.repository, other.follow_links = self.repository, self.follow_links
        other._repo, other._objects = self._repo, self._objects
        other.commit, tree = resolve(self._repo, revision, self.repository)
        other._start(revision, tree, self.folder)
        return other

    def merge_base(self, revision: str) -> GitTree:
        """The tree at the merge base of this revision and another. Raises TreeError when they share no history."""
        other, tree = resolve(self._repo, revision, self.repository)
        for each, commit, top in ((revision, other, tree), (self.revision, self.commit, self._top)):
            if commit == str(top):
                raise TreeError(f"`{shown(each)}` is a folder without a commit; give a branch, a tag or a commit")
        base = merge_base(self._repo, self.commit, other)
        if base is None:
            raise TreeError(
                f"`{shown(revision)}` and {shown(self.label)} share no history here; fetch more of it "
                "(git fetch --unshallow)"
            )
        return self.open_revision(base)

    def list(self, oid: Any) -> tuple[tuple[str, int, Any], ...]:
        """(name, mode, id) of everything in a folder of the repository. Raises OSError when it cannot be read."""
        return self._objects.read_folder(oid)

    def read_blob(self, oid: Any, limit: int = 0) -> bytes:
        """The bytes of a file of the repository. Raises OSError when it cannot be read."""
        return self._objects.read_blob(oid, limit or find_file_size_limit())

    def read_size(self, oid: Any) -> int:
        """How many they are. Raises OSError."""
        return self._objects.read_size(oid)

    def _walk(self, found: list[TreeEntry]) -> None:
        root = self.folder
        _, kind, top = self._find(root)
        if kind != _FOLDER:
            return
        links: list[tuple[str, str, tuple[str, ...]]] = []
        stack = [("", root, top)]
        while stack and self._left > 0:
            folder, real, oid = stack.pop()
            self._walk_folder(folder, real, oid, (), stack, links, found)
        followed: set[str] = set()
        visited: set[str] = set()
        for link, target, parents in links:
            if not self._may_follow(link, target, parents, followed):
                continue
            in_tree = is_within(target, root)
            self.aliases[link] = posixpath.relpath(target or ".", root or ".") if in_tree else "/" + target
            stack = [(link, target, self._find(target)[2])]
            while stack and self._left > 0:
                folder, real, oid = stack.pop()
                if real not in visited:
                    visited.add(real)
                    self._walk_folder(folder, real, oid, parents, stack, links, found)

    def _walk_folder(self, folder, real, oid, parents, stack, links, found: list[TreeEntry]) -> None:
        if len(folder) > LONGEST_PATH:
            self.problems.append(PathProblem(folder[:100] + "…", "the folder cannot be listed: file name too long"))
            return
        self._places[oid] += 1
        if self._places[oid] > _PLACES_AT_MOST:
            if self._places[oid] == _PLACES_AT_MOST + 1:
                message = f"the same folder stands at more than {_PLACES_AT_MOST:,} places, the rest is left out"
                self.problems.append(PathProblem(folder, message))
            return
        try:
            items = self._objects.read_folder(oid)
        except OSError as error:
            why = str(error.strerror).replace("its object", "the folder's object")
            self.problems.append(PathProblem(folder or ".", why))
            return
        if marker := find_ignore_marker({name for name, _, _ in items}):
            self.skipped.append(PathProblem(folder or ".", f"holds {marker}"))
            return
        room = max(self._left, 0)
        self._count(folder, len(items), folder[:100] + "…")
        self._folders.add(folder)
        for name, mode, item in items[:room]:
            path = join(folder, name)
            if mode == MODE_FOLDER:
                if name not in VERSION_CONTROL:
                    stack.append((path, join(real, name), item))
            elif mode == MODE_SUBMODULE:
                self.problems.append(PathProblem(path, f"submodule at {str(item)[:10]}, kept in another repository"))
            elif mode == MODE_LINK:
                target, kind, oid_of_target = self._find(join(real, name))
                if target == _REPOSITORY or (kind and self._leaves(target)):
                    self.problems.append(PathProblem(path, LEAVES))
                elif kind == _FILE:
                    self._add(path, oid_of_target, found)
                elif kind == _FOLDER:
                    links.append((path, target, (*parents, real)))
                else:
                    self.problems.append(PathProblem(path, f"the link is broken: {target}"))
            elif name not in VERSION_CONTROL:
                self._add(path, item, found)

    def _leaves(self, target: str) -> bool:
        return not self.follow_links and not is_within(target, self.folder)

    def _add(self, path: str, oid, found: list[TreeEntry]) -> None:
        try:
            size = self._objects.read_size(oid)
        except OSError:
            size = 0  # whoever needs the bytes of one that is missing or damaged is told when reading
        self._blobs[path] = oid
        found.append(TreeEntry(path, size))

    def _find(self, path: str) -> tuple[str, int, Any]:
        """Follows a path of the whole revision through links: (path without links, kind, id); kind 0 when it leads
        nowhere, and then the first item says why."""
        pending = [part for part in reversed(path.split("/")) if part]
        names: list[str] = []
        oids = [self._top]
        hops = 0
        while pending:
            self._steps -= 1
            if self._steps < 0:
                return "there are too many links to follow", 0, None
            name = pending.pop()
            if name == "." or not name:
                continue
            if name == "..":
                if not names:
                    return _REPOSITORY, 0, None
                names.pop()
                oids.pop()
                continue
            try:
                match = self._objects.index_folder(oids[-1]).get(name)
            except OSError:
                match = None
            if match is None:
                return "no such file or directory", 0, None
            mode, oid = match
            if mode == MODE_LINK:
                hops += 1
                if hops > _HOPS_AT_MOST:
                    return "too many levels of symbolic links", 0, None
                try:
                    target = self._objects.link(oid)
                except OSError as error:
                    return str(error.strerror), 0, None
                if target.startswith("/"):
                    return _REPOSITORY, 0, None
                pending.extend(reversed(target.split("/")))
            elif mode == MODE_FOLDER:
                names.append(name)
                oids.append(oid)
            elif mode == MODE_SUBMODULE:
                return "it leads into a submodule", 0, None
            elif pending:
                return "not a directory", 0, None
            else:
                return "/".join((*names, name)), _FILE, oid
        return "/".join(names), _FOLDER, oids[-1]

    def _lookup(self, path: str) -> tuple[int, Any]:
        if path in self._blobs:
            return _FILE, self._blobs[path]
        clean = normalize_path(path)
        if clean is None or len(clean) > LONGEST_PATH:
            return 0, None
        target, kind, oid = self._find(join(self.folder, clean) if clean else self.folder)
        return (0, None) if kind and self._leaves(target) else (kind, oid)

    def find_known_id(self, path: str) -> str | None:
        kind, oid = self._lookup(path)
        return str(oid) if kind == _FILE else None

    def find_content_id(self, path: str) -> str:
        known = self.find_known_id(path)
        if known is None:
            raise FileNotFoundError(2, f"not in {self.label}", path)
        return known

    def read(self, path: str, limit: int = 0) -> bytes:
        return self.read_with_id(path, limit)[0]

    def read_with_id(self, path: str, limit: int = 0) -> tuple[bytes, str]:
        kind, oid = self._lookup(path)
        if kind != _FILE:
            raise FileNotFoundError(2, f"not in {self.label}", path)
        try:
            return self._objects.read_blob(oid, limit or find_file_size_limit()), str(oid)
        except OSError as error:
            raise OSError(error.errno, error.strerror, path) from None

    def exists(self, path: str) -> bool:
        return self._lookup(path)[0] != 0

    def is_dir(self, path: str) -> bool:
        return path in self._folders or self._lookup(path)[0] == _FOLDER

    def make_memory_key(self) -> bytes | None:
        return None

    def recall(self, memory: bytes) -> None:
        del memory

    def make_memory(self) -> bytes | None:
        return None
