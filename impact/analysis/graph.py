"""The message-flow graph of a workspace, and of its base: from a path to graphs."""

import os
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from ...edges import processes
from ..config import SystemSetting
from ..facts.store import Store
from ..model.flow.definitions import Sections
from ..model.flow.graph import Graph
from ..model.flow.select import get_kind
from ..model.flow.system import ChosenLaunch
from ..model.flow.workspace import link_for_flow, make_graph
from ..model.workspace import Workspace
from ..tree import Tree
from .session import CheckError, link_flow, load_settings, open_tree

_ARGUMENT = re.compile(r"\s+(?=[A-Za-z_][\w.-]*:=)")


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
    path: Path, *, rev: str = "", base: Sequence[str] = (), launch: Sequence[str] = (),
    arguments: Mapping[str, str] | None = None, system: str = "", config: Path | None = None, jobs: int | None = None,
    progress: Callable[[int, int], None] | None = None, follow_links: bool = False, code_alone: bool = False,
) -> Graphs:  # fmt: skip
    """The message-flow graph of the workspace at a path.

    rev, base, config, jobs, follow_links: as for check. launch: launch files, each as a path, relative to the
    workspace's root or to a package, and any arguments of its own behind it (`a.launch.py sim:=true`): then only what
    they start together, under the names they give; arguments: for all of them. system: the name of launch files and
    arguments in rosimpact.toml instead. code_alone: all programs, as if no launch file started them. Raises CheckError,
    ConfigError, TreeError and BaseError with a text for the user.
    """
    tree = open_tree(path, rev, follow_links=follow_links)
    given = dict(arguments or {})
    option = "--launch"
    if system:
        found = _find_system(path, tree, system, config, follow_links)
        option, launch, given = f"--system {system}:", found.launch, {**found.arguments, **given}
    with Store() as store:
        workspace = link_flow(path, tree, store, jobs, progress)
        own = [parse_launch(path, workspace, tree, option, text) for text in launch]
        chosen = [one._replace(arguments={**given, **one.arguments}) for one in own]
        how = {"code_alone": code_alone, "jobs": jobs or processes.count_cores()}
        now = make_graph(workspace, store, os.fspath(path), rev, chosen if launch else None, **how)
        strangers = (*_describe_refused(path, workspace, now), *_describe_undeclared(workspace, own, given))
        if not base:
            return Graphs(now, None, strangers, workspace)
        from .revision_compare import open_base_tree

        old_tree, notes = open_base_tree(tree, tuple(base))
        had = [one for one in chosen if old_tree.exists(one.path)]
        old = link_for_flow(old_tree, store, jobs)
        before = make_graph(old, store, os.fspath(path), " ".join(base), had if launch else None, **how)
        return Graphs(now, before, (*strangers, *notes), workspace)


def _find_system(path: Path, tree: Tree, name: str, config: Path | None, follow_links: bool) -> SystemSetting:
    """A system of rosimpact.toml. Raises CheckError."""
    settings = load_settings(path, tree, config, follow_links=follow_links)
    if name in settings.systems:
        return settings.systems[name]
    where = settings.path or path / "rosimpact.toml"
    known = ", ".join(f"`{each}`" for each in sorted(settings.systems))
    remedy = f"known are {known}" if known else "add it with its launch files, or name these with --launch"
    raise CheckError(f"--system {name}: {where} has no [systems.{name}]; {remedy}")


def _describe_refused(path: Path, workspace: Workspace, graph: Graph) -> Iterator[str]:
    """A note on packages whose manifests colcon and catkin refuse, so that little may be known of what they build.
    Raises CheckError where all are refused and no code was found."""
    found = [
        f"{package.linked.manifest_path}:{problem.line}: {problem.message}"
        for package in workspace
        for problem in package.manifest.problems[:1]
    ]
    more = f"; and {len(found) - 3} more" if len(found) > 3 else ""
    named = f"{'; '.join(found[:3])}{more}"
    if found and len(found) == len(workspace.packages) and not graph.coverage.files:
        raise CheckError(f"{path}: no package could be read ({named}); correct the manifest")
    if found:
        yield f"{named}: colcon and catkin refuse such a manifest, so nodes may be missing; correct it"


def _describe_undeclared(
    workspace: Workspace, chosen: Sequence[ChosenLaunch], given: Mapping[str, str]
) -> Iterator[str]:  # fmt: skip
    """A note for each argument that no launch file it is meant for declares, nor any that this includes. chosen: launch
    files with arguments of their own; given: those for all."""
    from ..model.flow.started import follow_workspace_launch  # of no use to a graph of code alone

    if not given and not any(one.arguments for one in chosen):
        return
    declared = [follow_workspace_launch(workspace, one.path, {**given, **one.arguments}).arguments for one in chosen]
    for one, names in zip(chosen, declared, strict=True):
        for name in one.arguments:
            if name not in names:
                yield f"{name}:={one.arguments[name]}: `{one.path}` has no such argument; {_list_declared(names)}"
    for name in given:
        if not any(name in names for names in declared):
            files, have = (f"`{chosen[0].path}`", "has") if len(chosen) == 1 else ("the launch files", "have")
            every = frozenset[str]().union(*declared)
            yield f"--set {name}: {files} {have} no such argument; {_list_declared(every, len(chosen))}"


def _list_declared(names: frozenset[str], files: int = 1) -> str:
    who = "it declares" if files == 1 else "they declare"
    return f"{who} {', '.join(f'`{name}`' for name in sorted(names)) or 'none'}"


def parse_launch(path: Path, workspace: Workspace, tree: Tree, option: str, text: str) -> ChosenLaunch:
    """A launch file with its own arguments, from `FILE NAME:=VALUE ...`. Raises CheckError."""
    file, *rest = _ARGUMENT.split(text.strip())
    given = {name: value for name, _, value in (argument.strip().partition(":=") for argument in rest)}
    return ChosenLaunch(_find_launch_file(path, workspace, tree, option, file), given)


def _find_launch_file(path: Path, workspace: Workspace, tree: Tree, option: str, launch: str) -> str:
    """The launch file's path relative to the workspace's root; a bare name is looked for. Raises CheckError."""
    package, _, inner = launch.partition("/")
    owner = workspace.packages.get(package)
    of_package = f"{owner.path}/{inner}".lstrip("/") if owner is not None and inner else launch
    for candidate in (launch, of_package, os.path.relpath(os.path.realpath(launch), os.path.realpath(path))):
        inside = candidate.replace(os.sep, "/").removeprefix("./")
        if not inside.startswith("..") and tree.exists(inside) and not tree.is_dir(inside):
            return inside
    found = [entry.path for entry in tree.list_entries() if entry.path == launch or entry.path.endswith(f"/{launch}")]
    if len(found) == 1:
        return found[0]
    if found:
        raise CheckError(
            f"{option} {launch}: there are {len(found)} of them ({', '.join(found[:3])}); give the whole path"
        )
    raise CheckError(f"{option} {launch}: no such file in the workspace; give its path")
