"""The message-flow graph of a workspace, and of its base: from a path to graphs."""

import os
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from ...edges import processes
from ..facts.store import Store
from ..model.flow.definitions import Sections
from ..model.flow.graph import Graph
from ..model.flow.select import get_kind
from ..model.flow.workspace import link_for_flow, make_graph
from ..model.workspace import Workspace
from ..tree import Tree
from .session import CheckError, link_flow, open_tree


class Graphs(NamedTuple):
    """The graph asked for, that of the base when there is one, what to know about both, and the workspace."""

    now: Graph
    before: Graph | None
    notes: tuple[str, ...]
    workspace: Workspace

    def describe_interfaces(self) -> dict[str, Sections]:
        """What the types of both graphs consist of, see model/flow/definitions.py."""
        from ..model.flow.definitions import describe_interfaces  # of use to the page alone

        graphs = [self.now, *([self.before] if self.before is not None else [])]
        types = {(get_kind(one), one.type) for graph in graphs for one in graph.endpoints if "/" in one.type}
        return describe_interfaces(self.workspace, sorted(types))


def build_graphs(
    path: Path, *, rev: str = "", base: Sequence[str] = (), launch: str = "",
    arguments: Mapping[str, str] | None = None, jobs: int | None = None,
    progress: Callable[[int, int], None] | None = None, follow_links: bool = False, code_alone: bool = False,
) -> Graphs:  # fmt: skip
    """The message-flow graph of the workspace at a path.

    rev, base, jobs, follow_links: as for check. launch: a launch file, as a path or relative to the workspace's
    root: then only what it starts, under the names it gives; arguments: those of the launch file. code_alone: all
    programs, as if no launch file started them. Raises CheckError, TreeError and BaseError with a text for the user.
    """
    tree = open_tree(path, rev, follow_links=follow_links)
    with Store() as store:
        file = _launch_file(path, tree, launch) if launch else ""
        workspace = link_flow(path, tree, store, jobs, progress)
        how = {"code_alone": code_alone, "jobs": jobs or processes.count_cores()}
        now = make_graph(workspace, store, os.fspath(path), rev, file, arguments, **how)
        strangers = _describe_undeclared(workspace, file, arguments) if file and arguments else ()
        if not base:
            return Graphs(now, None, strangers, workspace)
        from .revision_compare import open_base_tree

        old_tree, notes = open_base_tree(tree, tuple(base))
        had = not file or old_tree.exists(file)
        old = link_for_flow(old_tree, store, jobs)
        before = make_graph(old, store, os.fspath(path), " ".join(base), file if had else "", arguments, **how)
        return Graphs(now, before, (*strangers, *notes), workspace)


def _describe_undeclared(workspace: Workspace, launch: str, arguments: Mapping[str, str]) -> tuple[str, ...]:
    """A note for each argument that neither the launch file nor any that it includes declares."""
    from ..model.flow.started import follow_workspace_launch  # of no use to a graph of code alone

    declared = sorted(follow_workspace_launch(workspace, launch, arguments).arguments)
    known = f"it declares {', '.join(f'`{name}`' for name in declared)}" if declared else "it declares none"
    return tuple(
        f"--set {name}: `{launch}` has no such argument; {known}" for name in arguments if name not in declared
    )


def _launch_file(path: Path, tree: Tree, launch: str) -> str:
    """The launch file's path relative to the workspace's root; a bare name is looked for. Raises CheckError."""
    for candidate in (launch, os.path.relpath(os.path.realpath(launch), os.path.realpath(path))):
        inside = candidate.replace(os.sep, "/").removeprefix("./")
        if not inside.startswith("..") and tree.exists(inside) and not tree.is_dir(inside):
            return inside
    found = [entry.path for entry in tree.list_entries() if entry.path == launch or entry.path.endswith(f"/{launch}")]
    if len(found) == 1:
        return found[0]
    if found:
        raise CheckError(
            f"--launch {launch}: there are {len(found)} of them ({', '.join(found[:3])}); give the whole path"
        )
    raise CheckError(f"--launch {launch}: no such file in the workspace; give its path")
