"""Comparison with a base revision: what is new because of the change."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

from . import findings as after
from .facts.store import Store
from .gather import gather
from .model.view import View
from .model.watch import watched
from .model.workspace import Workspace, link
from .report.report import Sources
from .rules.rule import Finding, Rule
from .tree import GitTree, Tree, TreeError, WorkingTree


class BaseError(TreeError):
    """The base cannot be found; the text names the repository and what to write."""


def base_tree(tree: Tree, base: Sequence[str]) -> Tree:
    """The tree to compare with: every repository of the workspace at its merge base with the revision asked for.

    base: `REV` for all, `PATH=REV` for one repository, or the path of a pinned .repos file.
    """
    pinned: dict[str, str] = {}
    everywhere = ""
    for item in base:
        if item.endswith((".repos", ".rosinstall")) and os.path.isfile(item):
            pinned.update(_pinned(Path(item)))
        elif "=" in item:
            path, _, rev = item.partition("=")
            pinned[path.strip("/")] = rev
        else:
            everywhere = item
    if isinstance(tree, GitTree):
        return tree.merge_base(everywhere or next(iter(pinned.values()), "HEAD"))
    trees = {}
    for folder, where in tree.repositories.items():
        rev = pinned.get(folder) or next((r for p, r in pinned.items() if folder.endswith("/" + p)), "") or everywhere
        if not rev:
            continue
        trees[folder] = merge_base_tree(tree, where, folder, rev)
    if not trees:
        raise BaseError("--base: no git repository was found in the workspace; run it inside a clone")
    return CompositeTree(tree, trees)


def merge_base_tree(tree: Tree, where: str, folder: str, rev: str) -> GitTree:
    """One repository of a workspace at its merge base with rev, restricted to the part that the workspace shows."""
    repository = Path(where)
    inside = ""
    root = Path(getattr(tree, "root", "."))
    if not folder:
        try:
            inside = root.resolve().relative_to(repository.resolve()).as_posix()
        except ValueError:
            inside = ""
    return GitTree(repository, "HEAD", "" if inside == "." else inside).merge_base(rev)


def _pinned(path: Path) -> dict[str, str]:
    import yaml

    data = yaml.safe_load(path.read_text(encoding="utf-8")) or {}
    return {name: str(entry["version"]) for name, entry in (data.get("repositories") or {}).items() if entry.get("version")}


class CompositeTree:
    """Several revisions put together in the folders where their working trees stand; what no repository owns is taken
    from the working tree as it is."""

    def __init__(self, working: Tree, parts: dict[str, GitTree]):
        self.working, self.parts = working, parts
        self.label = "base"
        self.repositories = getattr(working, "repositories", {})
        self._order = sorted(parts, key=lambda f: -len(f))
        self._entries = None

    @property
    def problems(self):
        return [p for part in self.parts.values() for p in part.problems]

    def _part(self, path: str):
        for folder in self._order:
            if not folder:
                return self.parts[folder], path
            if path.startswith(folder + "/"):
                return self.parts[folder], path[len(folder) + 1 :]
        return None, path

    def entries(self):
        if self._entries is None:
            found = [e for e in self.working.entries() if self._part(e.path)[0] is None]
            for folder, part in self.parts.items():
                for entry in part.entries():
                    found.append(type(entry)(f"{folder}/{entry.path}" if folder else entry.path, entry.size))
            self._entries = sorted(found, key=lambda e: e.path)
        return self._entries

    def _ask(self, name: str, path: str):
        part, inside = self._part(path)
        return getattr(part or self.working, name)(inside)

    def content_id(self, path: str) -> str:
        return self._ask("content_id", path)

    def known_id(self, path: str):
        return self._ask("known_id", path)

    def read(self, path: str) -> bytes:
        return self._ask("read", path)

    def read_with_id(self, path: str):
        return self._ask("read_with_id", path)

    def exists(self, path: str) -> bool:
        return self._ask("exists", path)

    def is_dir(self, path: str) -> bool:
        return self._ask("is_dir", path)

    def memory_key(self):
        return None

    def recall(self, memory: bytes) -> None:
        return None

    def memory(self):
        return None


def against_base(
    before_tree: Tree, found: list[Finding], workspace: Workspace, views: Sequence[View], rules: dict[str, Rule],
    store: Store, sources: Sources, judge,
) -> list[Finding]:  # fmt: skip
    """Marks what is new against the base, and adds what the interfaces family says of the change.

    judge(workspace, views, sources): findings of a workspace, as check.py makes them."""
    gathered = gather(before_tree, store)
    before = link(before_tree, gathered, store, workspace.ros, watched())
    old_sources = Sources(lambda p: before_tree.read(p) if before_tree.exists(p) else None)
    old_views = [View(before, view.target, view.providers, view.config) for view in views]
    marked = after.marked_new(found, judge(before, old_views, old_sources)[0])
    hits = [(rule.name, "", hit) for rule in rules.values() if rule.family == "interfaces" for hit in rule.run(workspace, before)]
    names = [view.target.name for view in views]
    changed = after.merge(hits, targets=names, rules=rules, line_text=sources.line)
    return sorted([*marked, *changed], key=lambda f: (f.path, f.line, f.column, f.rule))


def compare(path: str | os.PathLike[str], base: str | os.PathLike[str], options=None):
    """Checks the workspace at path against another folder as its base; returns a Report. For tools that keep both
    states as folders; `check` with Options(base=...) reads them from git."""
    from . import check as checking

    options = options or checking.Options()
    return checking.check(path, options, base_tree=WorkingTree(base))
