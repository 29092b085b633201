"""The commits of a repository and the packages of each, read from git's objects; nothing is checked out."""

import contextlib
import hashlib
import os
import re
from collections.abc import Iterable, Iterator, Mapping
from datetime import datetime, timezone
from typing import Any, NamedTuple

from ...edges.limits import get_limits
from ...edges.memory import cache_method
from ..facts import kinds
from ..model.package import find_folder_role
from ..tree import GitTree, TreeError, find_ignore_marker, shown

_MODE_FOLDER, _MODE_LINK, _MODE_SUBMODULE = 0o040000, 0o120000, 0o160000
_COMMENT = re.compile(rb"<!--.*?(?:-->|\Z)", re.DOTALL)
_NAME = re.compile(rb"<name\b[^>]*>\s*([^<\s]+)\s*</name>")
_AMENT = re.compile(rb"\bament_(?:cmake|python)|<build_type>\s*ament")
_WANTED = frozenset(("cpp", "python", "cmake", "setup_py"))
# What a commit may hold, with folders that stand at many places counted at each.
_PACKAGES_AT_MOST, _FILES_AT_MOST = 20_000, 200_000
# Of the years 1 to 9999, which is what dates can be of.
_FIRST_SECOND, _LAST_SECOND = -62_135_596_800, 253_402_300_799


class Commit(NamedTuple):
    """A commit that is compared with its parent. parent: empty for the first of a history. date: of the commit, ISO
    8601 in UTC; summary: the first line of its message."""

    id: str
    parent: str
    date: str
    summary: str


class PackageFile(NamedTuple):
    """A file of a package. path: relative to the package; kind: `cpp`, `python`, `cmake` or `setup_py`."""

    path: str
    id: str
    kind: str


class PackageState(NamedTuple):
    """A package as one commit has it. path: of its folder in the repository; ros: the generation its manifest is
    written for. files: those that tell of the flow of messages, tests left out. key: the same for packages of one name
    and generation that hold the same files, wherever they lie."""

    name: str
    path: str
    ros: int
    files: tuple[PackageFile, ...]
    key: bytes

    def locate(self, path: str) -> str:
        """A path of the package as a path of the repository."""
        return f"{self.path}/{path}" if self.path else path


def compute_key(name: str, ros: int, files: Iterable[PackageFile]) -> bytes:
    """The key of a PackageState."""
    stamp = hashlib.sha1(f"{name} {ros}\n".encode())
    for file in files:
        stamp.update(f"{file.path} {file.id} {file.kind}\n".encode("utf-8", "surrogateescape"))
    return stamp.digest()


class _Found(NamedTuple):
    """A folder with a manifest. path: below the folder that was asked for."""

    path: str
    folder: Any
    manifest: Any
    rosbuild: bool


class CommitHistory:
    """The commits of a repository.

    repository: it, or a folder in it: then only the packages below that folder are looked at. Raises TreeError when
    there is no such repository.
    """

    def __init__(self, repository: str | os.PathLike[str]):
        self.tree = GitTree(repository)
        self.repo = self.tree._repo
        self.path = self.repo.path
        self.name = self.tree.name
        self.folder = _find_folder(os.fsdecode(repository), self.repo)
        self._packages: dict[Any, tuple[_Found, ...]] = {}
        self._files: dict[tuple[Any, bool], tuple[PackageFile, ...]] = {}
        self._roots: dict[str, dict[str, PackageState]] = {}

    def list_commits(self, range: str = "", number: int | None = None, since: str = "") -> list[Commit]:
        """The commits that are compared with their parent, newest first; merges are left out, each side's commits are
        there by themselves.

        range: `A..B`, those of B that A has not; `B` alone: all of its history; HEAD's when empty. number: the newest
        so many of them. since: a day or time in ISO 8601. Raises TreeError for what git does not know, ValueError for
        a time that cannot be read.
        """
        import pygit2

        start, dots, end = range.partition("..")
        if not dots:
            start, end = "", range
        oldest = _parse_time(since) if since else None
        first, hidden = self._commit(end.lstrip(".") or "HEAD"), self._commit(start or "HEAD") if dots else None
        found: list[Commit] = []
        try:
            walker = self.repo.walk(first, pygit2.enums.SortMode.TOPOLOGICAL | pygit2.enums.SortMode.TIME)
            if hidden is not None:
                walker.hide(hidden)
            for commit in walker:
                parents = commit.parent_ids
                if len(parents) > 1 or (oldest is not None and commit.commit_time < oldest):
                    continue
                if number is not None and len(found) >= number:
                    break
                summary = commit.raw_message.decode("utf-8", "replace").strip().partition("\n")[0]
                parent = str(parents[0]) if parents else ""
                found.append(Commit(str(commit.id), parent, _format_date(commit.commit_time), summary.strip()))
        except (KeyError, ValueError, TypeError, pygit2.GitError) as error:
            reason = shown(" ".join(str(error).split()))
            raise TreeError(f"the history of {self.name} cannot be read: {reason}; `git fsck` says more") from None
        return found

    def _commit(self, revision: str):
        import pygit2

        return pygit2.Oid(hex=self.tree.open_revision(revision).commit)

    def find_packages(self, commit: str) -> Mapping[str, PackageState]:
        """The packages of a commit by their names; of several with one name, those after the first by name and path.

        Packages are catkin's, ament's and rosbuild's, told by their manifests. None for the parent of a first commit.
        Raises KeyError when the commit is not in the repository (a history that was cut off), is damaged, or holds far
        too much.
        """
        if not commit:
            return {}
        known = self._roots.get(commit)
        if known is None:
            if len(self._roots) > 64:
                self._roots.clear()
            known = self._roots[commit] = dict(self._iterate_states(self._find_root(commit)))
        return known

    def has_same_tree(self, one: str, other: str) -> bool:
        """Whether two commits hold the same files."""
        return bool(one and other) and self._find_root(one) == self._find_root(other)

    def _find_root(self, commit: str):
        """The id of the folder that is looked at, None where the commit has none. Raises KeyError."""
        import pygit2

        try:
            # The id alone: the tree itself may be damaged, and is looked at before libgit2 reads it.
            found = self.repo[commit].peel(pygit2.Commit).tree_id
        except (ValueError, TypeError, pygit2.GitError) as error:
            raise KeyError(commit) from error
        for part in self.folder.split("/") if self.folder else ():
            items = {name: item for name, mode, item in self._list_folder(found) if mode == _MODE_FOLDER}
            found = items.get(part)
            if found is None:
                return None
        return found

    def _list_folder(self, folder) -> tuple[tuple[str, int, Any], ...]:
        """What a folder holds, nothing where it cannot be read."""
        try:
            return self.tree.list(folder)
        except OSError:
            return ()

    def _iterate_states(self, root) -> Iterator[tuple[str, PackageState]]:
        seen: set[str] = set()
        for found in self._search_folder(root) if root is not None else ():
            path = _join_path(self.folder, found.path)
            name, ros = self._read_manifest(found.manifest, found.rosbuild)
            name = name or path.rpartition("/")[2] or self.name
            files, key = self._read_package(found.folder, found.rosbuild, name, ros)
            state = PackageState(name, path, ros, files, key)
            yield (name if name not in seen else f"{name} in {path}"), state
            seen.add(name)

    @cache_method
    def _read_package(self, folder: Any, rosbuild: bool, name: str, ros: int) -> tuple[tuple[PackageFile, ...], bytes]:
        files = self._list_files(folder, rosbuild, top=True)
        files = tuple(file for file in files if find_folder_role(file.path) != "test")
        return files, compute_key(name, ros, files)

    def _search_folder(self, folder, level: int = 0) -> tuple[_Found, ...]:
        """The packages at and below a folder, in the order of their paths. Raises KeyError where there are too many."""
        known = self._packages.get(folder)
        if known is not None:
            return known
        items = self._list_folder(folder) if level < get_limits().depth else ()
        names = {name: item for name, mode, item in items if mode not in (_MODE_FOLDER, _MODE_LINK, _MODE_SUBMODULE)}
        found: list[_Found] = []
        if not find_ignore_marker(names):
            if "package.xml" in names:
                found.append(_Found("", folder, names["package.xml"], False))
            else:
                if "manifest.xml" in names:
                    found.append(_Found("", folder, names["manifest.xml"], True))
                for name, mode, item in items:
                    if mode == _MODE_FOLDER:
                        inner = self._search_folder(item, level + 1)
                        found.extend(one._replace(path=_join_path(name, one.path)) for one in inner)
                        if len(found) > _PACKAGES_AT_MOST:
                            raise KeyError("too many packages")
        known = self._packages[folder] = tuple(found)
        return known

    @cache_method
    def _read_manifest(self, blob, rosbuild: bool) -> tuple[str, int]:
        """Name (empty where the manifest has none) and generation that a manifest tells."""
        data = b"" if rosbuild else _COMMENT.sub(b"", self.read(blob)[:200_000])
        match = _NAME.search(data)
        return match[1].decode("utf-8", "replace") if match else "", 2 if _AMENT.search(data) else 1

    def _list_files(self, folder, rosbuild: bool, top: bool = False, level: int = 0) -> tuple[PackageFile, ...]:
        """The files of interest at and below a folder, packages below a rosbuild package left out. Raises KeyError
        where there are too many."""
        known = self._files.get((folder, rosbuild)) if not top else None
        if known is not None:
            return known
        found: list[PackageFile] = []
        items = self._list_folder(folder) if level < get_limits().depth else ()
        for name, mode, item in items:
            if mode == _MODE_FOLDER:
                if not (rosbuild and self._search_folder(item, level + 1)):
                    inner = self._list_files(item, rosbuild, level=level + 1)
                    found.extend(file._replace(path=f"{name}/{file.path}") for file in inner)
                    if len(found) > _FILES_AT_MOST:
                        raise KeyError("too many files")
            elif mode not in (_MODE_LINK, _MODE_SUBMODULE):
                kind = kinds.find_kind(name)
                if kind == "script" and not name.endswith(".cfg") and self._is_python(item):
                    kind = "python"
                if kind in _WANTED:
                    found.append(PackageFile(name, str(item), kind))
        known = tuple(found)
        if not top:
            self._files[folder, rosbuild] = known
        return known

    @cache_method
    def _is_python(self, blob) -> bool:
        return kinds.find_script_kind(self.read(blob)[:512]) == "python"

    def read(self, blob) -> bytes:
        """The bytes of a file; none where the object is missing (a partial clone), damaged or too large."""
        with contextlib.suppress(OSError):
            return self.tree.read_blob(blob)
        return b""

    def find_renames(self, parent: str, commit: str) -> dict[str, str]:
        """Files of the parent to what they are called in the commit, as git's similarity has it; none where it would
        have to read what is damaged or too large."""
        import pygit2

        if not parent:
            return {}
        try:
            self._check_folders(*(self.repo[each].peel(pygit2.Commit).tree_id for each in (parent, commit)))
            diff = self.repo[parent].tree.diff_to_tree(self.repo[commit].tree, context_lines=0)
            for delta in diff.deltas:
                if delta.status != pygit2.enums.DeltaStatus.MODIFIED and self._is_large(delta):
                    return {}
            diff.find_similar(pygit2.enums.DiffFind.FIND_RENAMES, 50, 50, 50, 400)
            return {
                delta.old_file.path: delta.new_file.path
                for delta in diff.deltas
                if delta.status == pygit2.enums.DeltaStatus.RENAMED
            }
        except (OSError, KeyError, ValueError, TypeError, AttributeError, pygit2.GitError):
            return {}

    def _check_folders(self, one, other) -> None:
        """Reads the folders in which two trees differ, as libgit2 will. Raises OSError where one is damaged."""
        pairs = [(one, other)]
        while pairs:
            sides = [
                {name: item for name, mode, item in self.tree.list(side) if mode == _MODE_FOLDER} if side else {}
                for side in pairs.pop()
            ]
            names = sides[0].keys() | sides[1].keys()
            both = ((sides[0].get(name), sides[1].get(name)) for name in names)
            pairs += [(old, new) for old, new in both if old != new]

    def _is_large(self, delta) -> bool:
        sides = (delta.old_file.id, delta.new_file.id)
        return any(self.tree.read_size(oid) > get_limits().object for oid in sides if any(oid.raw))


def _join_path(folder: str, path: str) -> str:
    return f"{folder}/{path}" if folder and path else folder or path


def _find_folder(place: str, repo) -> str:
    """The folder of the repository that a path names, empty for its root."""
    real = os.path.realpath(place)
    if repo.is_bare or not repo.workdir or f"{real}/".startswith(f"{os.path.realpath(repo.path)}/"):
        return ""
    inner = os.path.relpath(real, os.path.realpath(repo.workdir)).replace(os.sep, "/")
    return "" if inner == "." or inner.startswith("..") else inner


def _format_date(seconds: int) -> str:
    """A commit's time in ISO 8601; a damaged one is the nearest that can be written."""
    when = datetime.fromtimestamp(min(max(seconds, _FIRST_SECOND), _LAST_SECOND), timezone.utc)
    return when.strftime("%Y-%m-%dT%H:%M:%SZ")


def _parse_time(text: str) -> int:
    try:
        when = datetime.fromisoformat(text.strip().replace("Z", "+00:00"))
    except ValueError:
        raise ValueError(f"`{shown(text)}` is no date; write it as 2024-03-01") from None
    return int((when if when.tzinfo else when.replace(tzinfo=timezone.utc)).timestamp())
