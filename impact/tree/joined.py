"""Several trees under one root, and a workspace at the merge bases of its repositories."""

import os
from collections.abc import Callable, Mapping

from .git import GitTree
from .paths import PathProblem, Tree, TreeEntry, TreeError, is_within, join, normalize_path, shown
from .working import WorkingTree


class JoinedTree:
    """Several trees under one root, such as a workspace whose repositories stand at different revisions.

    mounts: tree by folder. Where folders contain each other the inner tree hides what the outer one has there.
    """

    def __init__(self, mounts: Mapping[str, Tree]):
        self.mounts = dict(sorted(mounts.items(), key=lambda mount: -len(mount[0])))
        outermost = list(self.mounts.values())[-1] if self.mounts else None
        self.label = ", ".join(f"{folder or '.'} at {tree.label}" for folder, tree in sorted(mounts.items()))
        self.name = outermost.name if outermost is not None and "" in self.mounts else ""
        self.problems: list[PathProblem] = []
        self.skipped: list[PathProblem] = []
        self.aliases: dict[str, str] = {}
        self._entries: list[TreeEntry] | None = None

    @property
    def repositories(self) -> dict[str, str]:
        found = {}
        for mount, tree in self.mounts.items():
            for folder, place in tree.repositories.items():
                if self._find_mount(join(mount, folder)) == mount:
                    found[join(mount, folder) if folder else mount] = place
        return found

    def _find_mount(self, path: str) -> str | None:
        """The innermost folder at or above a path that a tree is mounted at."""
        while path not in self.mounts:
            if not path:
                return None
            path = path.rpartition("/")[0]
        return path

    def _resolve_mounted(self, path: str) -> tuple[Tree, str]:
        mount = self._find_mount(path)
        if mount is None:
            raise FileNotFoundError(2, "in none of the trees", path)
        return self.mounts[mount], path[len(mount) + 1 :] if mount else path

    def list_entries(self) -> list[TreeEntry]:
        if self._entries is None:
            found = []
            for mount, tree in self.mounts.items():
                prefix = mount + "/" if mount else ""
                plain = not any(other != mount and is_within(other, mount) for other in self.mounts)

                def is_kept(path: str, mount: str = mount, plain: bool = plain) -> bool:
                    return plain or self._find_mount(path) == mount

                found += [TreeEntry(prefix + e.path, e.size) for e in tree.list_entries() if is_kept(prefix + e.path)]
                for own, theirs in ((self.problems, tree.problems), (self.skipped, tree.skipped)):
                    own += [PathProblem(prefix + p.path, p.message) for p in theirs if is_kept(prefix + p.path)]
                for link, target in tree.aliases.items():
                    if is_kept(prefix + link):
                        self.aliases[prefix + link] = target if target.startswith("/") else prefix + target
            found.sort(key=lambda entry: entry.path)
            self._entries = found
        return self._entries

    def find_known_id(self, path: str) -> str | None:
        tree, inner = self._resolve_mounted(path)
        return tree.find_known_id(inner)

    def find_content_id(self, path: str) -> str:
        tree, inner = self._resolve_mounted(path)
        return tree.find_content_id(inner)

    def read(self, path: str, limit: int = 0) -> bytes:
        tree, inner = self._resolve_mounted(path)
        return tree.read(inner, limit)

    def read_with_id(self, path: str, limit: int = 0) -> tuple[bytes, str]:
        tree, inner = self._resolve_mounted(path)
        return tree.read_with_id(inner, limit)

    def _stands(self, path: str, asked: Callable[[Tree, str], bool]) -> bool:
        """Whether a path leads to a tree, or to what a tree says of it when asked."""
        clean = normalize_path(path)
        if clean is None:
            return False
        if any(is_within(mount, clean) for mount in self.mounts):
            return True
        return self._find_mount(clean) is not None and asked(*self._resolve_mounted(clean))

    def exists(self, path: str) -> bool:
        return self._stands(path, lambda tree, inner: tree.exists(inner))

    def is_dir(self, path: str) -> bool:
        return self._stands(path, lambda tree, inner: tree.is_dir(inner))

    def make_memory_key(self) -> bytes | None:
        return self.mounts[""].make_memory_key() if "" in self.mounts else None

    def recall(self, memory: bytes) -> None:
        if "" in self.mounts:
            self.mounts[""].recall(memory)

    def make_memory(self) -> bytes | None:
        return self.mounts[""].make_memory() if "" in self.mounts else None


def open_merge_bases(tree: Tree, revisions: Mapping[str, str], default: str = "") -> Tree:
    """The tree as it was at the merge base of each repository's commit and a revision.

    revisions: by the repository's folder relative to the tree. default: of the repositories not named; they are left as
    they are when it is empty. What lies in no repository is left as it is. Raises TreeError when a named folder is no
    repository, a revision is not known, or nothing at all is under git.
    """
    if isinstance(tree, GitTree):
        return tree.merge_base(revisions.get("", default))
    named = {normalize_path(folder): revision for folder, revision in revisions.items()}
    unknown = sorted(shown(folder or ".") for folder in named if folder is None or folder not in tree.repositories)
    known = ", ".join(f"`{shown(folder or '.')}`" for folder in sorted(tree.repositories)) or "none"
    if unknown:
        raise TreeError(f"`{unknown[0]}` is no git repository of {tree.label}; those it has: {known}")
    mounts: dict[str, Tree] = {"": tree}
    failed = []
    follow = isinstance(tree, WorkingTree) and tree.follow_links
    for folder, place in tree.repositories.items():
        revision = named.get(folder, default)
        if not revision:
            continue
        inner = ""
        if not folder and isinstance(tree, WorkingTree):
            inner = os.path.relpath(os.path.realpath(tree.root), place)
        try:
            mounts[folder] = GitTree(place, "HEAD", inner, follow_links=follow).merge_base(revision)
        except TreeError as error:
            failed.append((folder, error))
    if failed:
        more = "" if len(tree.repositories) == 1 else "; repositories may differ: --base PATH=REV"
        raise TreeError(f"{failed[0][1]}{more}")
    if not tree.repositories:
        raise TreeError(f"{tree.label} holds no git repository, so there is no base to compare with")
    return JoinedTree(mounts)
