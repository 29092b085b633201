"""The message-flow graph of a linked workspace: which files are read for it, what is built of them, and the join."""

from __future__ import annotations

import hashlib
from collections.abc import Callable, Iterator, Mapping

import msgspec

from ...facts.flow import FlowFile
from ...facts.kinds import FLOW
from ...gather import Gathered, gather
from ..package import role_of_folder
from ..workspace import Package, Workspace
from .graph import Graph
from .join import Join
from .nodes import Built
from .started import launched

# Raise with every change of what the join says of the same facts.
VERSION = "1"
_LIBRARIES = frozenset(("library", "module", "interface"))


def kinds_of(workspace: Workspace) -> dict[str, str]:
    """The kind of flow facts wanted of each C++ and Python file of the packages, tests left out."""
    gathered = workspace.gathered
    wanted: dict[str, str] = {}
    for package in workspace:
        start = len(package.path) + 1 if package.path else 0
        for path in package.digest.files:
            kind = gathered.kinds.get(path)
            if kind == "script":
                kind = gathered.facts(path).kind
            flow = FLOW.get(kind or "")
            if flow is not None and role_of_folder(path[start:]) != "test":
                wanted[path] = flow
    return wanted


def built_of(workspace: Workspace) -> Iterator[Built]:
    """What the build of each package makes."""
    libraries = {
        target.name: target.sources
        for package in workspace
        for target in package.build.targets
        if target.kind in _LIBRARIES
    }
    links = {
        target.name: tuple(link.item for link in target.links if link.how == "link" and link.item in libraries)
        for package in workspace
        for target in package.build.targets
    }
    for package in workspace:
        targets = package.build.targets
        executables = {target.name: target.sources for target in targets if target.kind == "executable"}
        yield Built(package.name, executables, libraries, _components(package), _scripts(package), links)


def _components(package: Package) -> dict[str, str]:
    return {exported.item: "" for exported in package.build.exports if exported.how == "component"}


def _scripts(package: Package) -> dict[str, str]:
    """Python programs of a package: entry points, installed programs, and files that say so in their first line."""
    files = set(package.digest.files)
    base = f"{package.path}/" if package.path else ""
    found: dict[str, str] = {}
    for path, setup in package.digest.setup:
        folder = path.rpartition("/")[0]
        for name, target, _ in setup.entry_points:
            module, _, function = target.partition(":")
            stem = module.strip().replace(".", "/")
            for candidate in (f"{folder}/{stem}.py", f"{folder}/src/{stem}.py", f"{folder}/{stem}/__init__.py"):
                candidate = candidate.lstrip("/")
                if candidate in files:
                    found[name] = f"{candidate}:{function.strip() or 'main'}"
                    break
    reached = {where.partition(":")[0] for where in found.values()}
    programs = {item for install in package.build.installs if install.kind == "programs" for item in install.items}
    for path in (*sorted(programs & files), *package.digest.scripts):
        name = path.rpartition("/")[2]
        if path not in reached and name not in ("setup.py", "conf.py") and path.startswith(base):
            found.setdefault(name, path)
            reached.add(path)
    return found


def joined(
    workspace: Workspace, jobs: int | None = None, progress: Callable[[int, int], None] | None = None
) -> tuple[Join, Gathered]:
    """The code of a workspace, joined; and its facts. progress: as gather() has it."""
    gathered = _flow(workspace, jobs, progress)
    return _join(workspace, gathered), gathered


def graph_of(
    workspace: Workspace,
    store,
    root: str = "",
    rev: str = "",
    jobs: int | None = None,
    progress: Callable[[int, int], None] | None = None,
    launch: str = "",
    arguments: Mapping[str, str] | None = None,
) -> Graph:
    """The message-flow graph of a workspace. store: remembers it by the content it was joined from. launch: the path of
    a launch file, relative to the workspace's root: then the graph of what it starts; arguments: its arguments."""
    gathered = _flow(workspace, jobs, progress)
    if launch:
        start = launched(workspace, launch, arguments or {})
        join = _join(workspace, gathered)
        return join.graph(root, rev, [s.path for s in join.code.sources if s.facts.unread], start)
    stamp = hashlib.sha1(workspace.identity + VERSION.encode())
    for path in sorted(gathered.kinds):
        stamp.update(f"{path} {gathered.ids.get(path, '')} {gathered.kinds[path]}\n".encode("utf-8", "surrogateescape"))
    key = stamp.digest()
    known = store.memo("graph", key) if store is not None else None
    if known is not None:
        try:
            return msgspec.structs.replace(msgspec.msgpack.decode(known, type=Graph), root=root, rev=rev)
        except msgspec.MsgspecError:
            pass
    join = _join(workspace, gathered)
    graph = join.graph(unread=[s.path for s in join.code.sources if s.facts.unread])
    if store is not None:
        store.remember("graph", [(key, msgspec.msgpack.encode(graph))])
    return msgspec.structs.replace(graph, root=root, rev=rev)


def _flow(workspace: Workspace, jobs: int | None, progress: Callable[[int, int], None] | None) -> Gathered:
    wanted = kinds_of(workspace)
    main = workspace.gathered
    return gather(main.tree, main.store, jobs=jobs, progress=progress, kind_of=wanted.get)


def _join(workspace: Workspace, gathered: Gathered) -> Join:
    paths = gathered.paths()
    gathered.preload(paths)
    files: dict[str, FlowFile] = {path: gathered.facts(path).facts for path in paths}
    owner = workspace.discovered.owner
    packages = {package.path: package.name for package in workspace}

    def package_of(path: str) -> str:
        place = owner(path)
        return packages.get(place.path, "") if place is not None else ""

    return Join(files, package_of, built_of(workspace), workspace.ros)
