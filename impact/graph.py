"""The message-flow graph of a workspace, and of its base: from a path to graphs."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from .check import CheckError, open_tree
from .facts.store import Store
from .model.flow.graph import Graph
from .model.flow.workspace import graph_of, linked
from .tree import Tree, shown


class Graphs(NamedTuple):
    """The graph asked for, that of the base when there is one, and what to know about the base."""

    now: Graph
    before: Graph | None
    notes: tuple[str, ...]


def graphs(
    path: Path, *, rev: str = "", base: Sequence[str] = (), launch: str = "",
    arguments: Mapping[str, str] | None = None, jobs: int | None = None,
    progress: Callable[[int, int], None] | None = None, cache: Path | None = None,
) -> Graphs:  # fmt: skip
    """The message-flow graph of the workspace at a path.

    rev, base, jobs, cache: as for check. launch: a launch file, as a path or relative to the workspace's root: then
    only what it starts, under the names it gives; arguments: those of the launch file. Raises CheckError, TreeError
    and BaseError with a text for the user.
    """
    tree = open_tree(path, rev)
    with Store(cache) as store:
        file = _launch_file(path, tree, launch) if launch else ""
        now = _graph(path, tree, store, rev, file, arguments, jobs, progress)
        if not base:
            return Graphs(now, None, ())
        from .base import base_tree

        old_tree, notes = base_tree(tree, tuple(base))
        had = not file or old_tree.exists(file)
        before = _graph(path, old_tree, store, " ".join(base), file if had else "", arguments, jobs, None, empty=True)
        return Graphs(now, before, tuple(notes))


def _graph(
    path: Path, tree: Tree, store: Store, rev: str, launch: str, arguments: Mapping[str, str] | None, jobs: int | None,
    progress: Callable[[int, int], None] | None, empty: bool = False,
) -> Graph:  # fmt: skip
    workspace = linked(tree, store, jobs, progress)
    if not workspace.packages and not empty:
        raise CheckError(
            f"{shown(os.fspath(path))}: no package was found (no package.xml outside of ignored folders); give the "
            "folder of a workspace"
        )
    return graph_of(workspace, store, os.fspath(path), rev, launch, arguments)


def _launch_file(path: Path, tree: Tree, launch: str) -> str:
    """The launch file's path relative to the workspace's root; a bare name is looked for. Raises CheckError."""
    for candidate in (launch, os.path.relpath(os.path.realpath(launch), os.path.realpath(path))):
        inside = candidate.replace(os.sep, "/").removeprefix("./")
        if not inside.startswith("..") and tree.exists(inside) and not tree.is_dir(inside):
            return inside
    found = [entry.path for entry in tree.entries() if entry.path == launch or entry.path.endswith(f"/{launch}")]
    if len(found) == 1:
        return found[0]
    if found:
        raise CheckError(
            f"--launch {launch}: there are {len(found)} of them ({', '.join(found[:3])}); give the whole path"
        )
    raise CheckError(f"--launch {launch}: no such file in the workspace; give its path")
