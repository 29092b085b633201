"""The message-flow graph of a workspace: which files are read for it, what is built of them, and the join."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property

import msgspec

from ....edges.memory import cache_in_derived
from ...facts.extract import ExtractedFacts, extract_all
from ...facts.flow import FlowFile
from ...facts.kinds import find_kind
from ...facts.store import Store, recall
from ...tree.paths import Tree
from ..package import Watched
from ..workspace import Package, Workspace, link
from .build_constants import BuildConstants, GivenMacros
from .callers import Callers, build_callers
from .defined import DefinedInterfaces
from .documents import Documents
from .file_selection import BUILD, compute_code_key, is_code, list_run_by_hand, make_code_selector
from .graph import COPIED, Graph, Unresolved
from .join import Join
from .launches import Launch
from .nodes import BuiltPackage, asks_for_name, find_entry_point
from .plugins import assign_plugins, list_plugin_loads
from .simulated import add_simulated
from .system import ChosenLaunch, join_launched, merge_launches
from .text_search import add_text_coverage
from .uncompiled import find_uncompiled

_LIBRARIES = frozenset(("library", "module", "interface"))
_STARTED = frozenset(("launch_xml", "launch_yaml", "params", "xacro"))

Progress = Callable[[int, int], None]


class WorkspaceFlow:
    """The message flow of a workspace; each part is worked out once, when it is asked for."""

    def __init__(self, workspace: Workspace):
        self._workspace, self._store = workspace, workspace.extraction.store
        # Processes to use.
        self.jobs = 1
        # Launch files that are started together, by the name of their system.
        self.systems: dict[str, tuple[ChosenLaunch, ...]] = {}

    @cached_property
    def code(self) -> Join:
        """Its code, joined."""
        return join_code(self._workspace)

    @cached_property
    def key(self) -> bytes:
        """Differs whenever the code does, or what is built of it."""
        return compute_code_key(self._workspace, get_facts(self._workspace))

    @cached_property
    def graph(self) -> Graph:
        """The message-flow graph of its code, without a launch file."""
        found = make_graph(self._workspace, self._store, code_alone=True)
        if "code" in self.__dict__:
            _ = self.callers  # remembered beside the graph, so that they are not what needs the code joined anew
        return found

    @cached_property
    def system(self) -> Graph:
        """The graph of what its launch files start, and of the programs that none of them does."""
        launches = self.launches
        found = assign_plugins(merge_launches(self.graph, launches), list_plugin_loads(self._workspace))
        return add_simulated(found, self._workspace)

    @cached_property
    def callers(self) -> Callers:
        """Who calls whom in its code, and what triggers it."""
        return recall(self._store, "callers", self.key, Callers, lambda: build_callers(self.code))

    @cached_property
    def launches(self) -> tuple[Launch, ...]:
        """What its launch files start, see launches()."""
        from .launches import list_launches

        return list_launches(self._workspace, self._prepare_code, self.jobs)

    def _prepare_code(self) -> Join:
        """Its code, joined, with all that its graph found out, which the processes that are forked then need not find
        out again. Most that ask for launches ask for the graph too."""
        _ = self.code, self.graph
        self._store.close()  # no process that is forked now may go on with a connection of this one
        return self.code


@cache_in_derived
def get_flow(workspace: Workspace) -> WorkspaceFlow:
    """The message flow of a workspace; the same object for as long as the workspace lives."""
    return WorkspaceFlow(workspace)


def link_for_flow(tree: Tree, store: Store, jobs: int | None = None, progress: Progress | None = None) -> Workspace:
    """A workspace as far as message flow needs it: its packages, their builds, and the flow facts of its code.

    Rules on dependencies cannot be asked of it: the facts that they need are not read. progress: as gather() has it.
    """

    def select_build(path: str) -> str | None:
        kind = find_kind(path)
        return kind if kind in BUILD or kind in _STARTED else None

    extraction = extract_all(
        tree, store, jobs=jobs, progress=progress, kind_of=select_build, second=make_code_selector(tree)
    )
    return link(tree, extraction, store, None, Watched(), jobs)


def get_facts(workspace: Workspace) -> ExtractedFacts:
    """The flow facts of a workspace: those extracted with it, or else read now."""
    main = workspace.extraction
    if main.second is None:
        main.second = extract_all(main.tree, main.store, kind_of=make_code_selector(main.tree))
    return main.second


def list_code(workspace: Workspace) -> dict[str, str]:
    """The code of the packages, by path the package it belongs to, and programs outside of all packages, with an empty
    name; tests are left out."""
    extraction = get_facts(workspace)
    found = dict.fromkeys(list_run_by_hand(extraction.kinds, workspace.extraction.kinds), "")
    for package in workspace:
        start = len(package.path) + 1 if package.path else 0
        for path in package.linked.files:
            if path in extraction.kinds and is_code(path, start, package.name):
                found[path] = package.name
    return found


def list_built(workspace: Workspace, files: Mapping[str, FlowFile]) -> Iterator[BuiltPackage]:
    """What the build of each package makes. files: flow facts by path."""
    libraries = {
        target.name: target.sources
        for package in workspace
        for target in package.build.targets
        if target.kind in _LIBRARIES
    }
    links = {
        name: tuple(link.item for link in target.links if link.how == "link" and link.item in libraries)
        for package in workspace
        for target in package.build.targets
        for name in {target.name, target.output_name or target.name}
    }
    for package in workspace:
        targets = package.build.targets
        components: dict[str, tuple[str, ...]] = {}
        for exported in package.build.exports:
            if exported.how == "component":
                alone = (exported.executable,) if exported.executable else ()
                components[exported.item] = tuple(dict.fromkeys((*components.get(exported.item, ()), *alone)))
        running = {executable for executables in components.values() for executable in executables}
        executables = {
            target.output_name or target.name: target.sources
            for target in targets
            if target.kind == "executable" and (target.sources or target.name not in running)
        }
        scripts, plugins = _find_scripts(package, files), _collect_plugins(package)
        yield BuiltPackage(package.name, executables, libraries, components, scripts, links, plugins)
    loose = [path for path, owner in list_code(workspace).items() if not owner and path in files and _runs(files[path])]
    if loose:
        yield BuiltPackage("", {}, {}, {}, {path: path for path in loose}, {})


def _collect_plugins(package: Package) -> dict[str, str]:
    """Classes of a package by the names that its plugin descriptions give them."""
    return {plugin.name: plugin.type for _, plugin in package.linked.plugins if plugin.name and plugin.type}


def _find_scripts(package: Package, files: Mapping[str, FlowFile]) -> dict[str, str]:
    """Python programs of a package: entry points, installed programs, and files that run when they are started."""
    present = set(package.linked.files)
    found: dict[str, str] = {}
    for path, setup in package.linked.setup:
        folder = path.rpartition("/")[0]
        for name, module, _, function in setup.entry_points:
            where = find_entry_point(module, function, folder, present)
            if where:
                found[name] = where
    reached = {where.partition(":")[0] for where in found.values()}
    # With the name that a program is installed under.
    programs = {
        item: install.rename
        for install in package.build.installs
        if install.kind == "programs"
        for item in install.items
    }
    runs = [path for path in package.linked.files if path in files and _runs(files[path])]
    for path in (*sorted(programs.keys() & files.keys()), *runs):
        name = programs.get(path) or path.rpartition("/")[2]
        if path not in reached and name not in ("setup.py", "conf.py"):
            found.setdefault(name, path)
            reached.add(path)
    return found


def _runs(file: FlowFile) -> bool:
    """Whether a Python file does something when it is started: it asks for its name, or makes itself a node."""
    top = (function for function in file.functions if not function.name)
    begins = any(call.callee == "rospy.init_node" for function in top for call in function.calls)
    return file.language == "python" and (begins or asks_for_name(file))


def join_code(workspace: Workspace) -> Join:
    """The code of a workspace, joined."""
    extraction = get_facts(workspace)
    packages = list_code(workspace)
    extraction.preload(packages)
    facts = {path: extraction.get_facts(path).facts for path in packages}
    files: dict[str, FlowFile] = {path: file for path, file in facts.items() if file is not None}
    from .started import InWorkspace  # needs all that follows launch files

    defined = DefinedInterfaces(workspace.interface_names, workspace.ros, workspace.interface_texts)
    sources = InWorkspace(workspace)
    find_file = sources.find_workspace_path
    built = list_built(workspace, files)
    uncompiled = find_uncompiled(workspace, files)
    return Join(
        {path: file for path, file in files.items() if path not in uncompiled}, packages.__getitem__, built,
        workspace.ros, defined=defined, find_file=find_file, uncompiled=uncompiled,
        constants=BuildConstants(_list_macros(workspace)), documents=Documents(find_file, sources.read_values),
    )  # fmt: skip


def _list_macros(workspace: Workspace) -> Iterator[GivenMacros]:
    """What the build of each package gives to its compiler."""
    for package in workspace:
        if package.build.macros:
            compiled = {target.name: target.sources for target in package.build.targets}
            yield GivenMacros(package.name, package.build.macros, compiled)


def make_graph(
    workspace: Workspace, store: Store | None, root: str = "", rev: str = "",
    chosen: Sequence[ChosenLaunch] | None = None, code_alone: bool = False, jobs: int = 1,
) -> Graph:  # fmt: skip
    """The message-flow graph of a workspace: of what its launch files start, and of the programs that none of them
    does. store: remembers it by the content it was joined from.

    chosen: launch files: then the graph of what these start together. code_alone: of all programs, as if no launch file
    started them.
    """
    if chosen is not None:
        from .bridges import add_bridges
        from .started import InWorkspace, follow_workspace_launch

        start = join_launched([follow_workspace_launch(workspace, one.path, one.arguments) for one in chosen])
        code = get_flow(workspace).code
        found = add_bridges(code.build(root, rev, _list_unread(code), start), start, InWorkspace(workspace))
        return _name_copies(found, workspace)

    def make() -> Graph:
        code = get_flow(workspace).code
        return add_text_coverage(code.build(unread=_list_unread(code)), code, workspace.read)

    flow = get_flow(workspace)
    flow.jobs = jobs
    # What the system has of its code names copies already.
    graph = _name_copies(recall(store, "graph", flow.key, Graph, make), workspace) if code_alone else flow.system
    return msgspec.structs.replace(graph, root=root, rev=rev)


def _name_copies(graph: Graph, workspace: Workspace) -> Graph:
    """A graph that says which packages it has nothing of, since another one has their name."""
    folders = {package.name: package.path for package in workspace}
    copies = tuple(
        Unresolved(COPIED, f"another package of this name is read, in `{folders.get(one.name) or '.'}`",
                   one.manifest_path, 1, one.name)
        for one in workspace.hidden
    )  # fmt: skip
    if not copies:
        return graph
    coverage = msgspec.structs.replace(graph.coverage, unresolved=(*graph.coverage.unresolved, *copies))
    return msgspec.structs.replace(graph, coverage=coverage)


def _list_unread(join: Join) -> list[str]:
    return [source.path for source in join.code.sources if source.facts.unread]
