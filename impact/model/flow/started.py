"""Launch files in the message-flow graph: where a workspace has them, and nodes as a launch starts them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any, NamedTuple

from ....edges.memory import cache_in_derived
from ...facts.kinds import find_size_limit
from ...facts.launch.actions import LaunchFile
from ...facts.launch.parameter_files import ParameterFile
from ...facts.launch.python import extract as extract_python
from ..launch.follow import follow
from ..launch.result import EMPTY, Launched, LaunchParameter, Remap, SettingFile, Started
from ..launch.text import LaunchText
from ..workspace import Workspace
from .names import RemappingRule, join_name, make_open_part, remap_ros1_name, remap_ros2_name


class InWorkspace:
    """Launch and parameter files of a workspace, by package and path as they are installed.

    A path in a package's share folder is looked for in the package's own folder, which is where nearly all install
    from; CMake's install rules are asked for the others.
    """

    def __init__(self, workspace: Workspace):
        self.workspace = workspace

    def find_workspace_path(self, package: str, path: str) -> str:
        """The workspace path of an installed file, or of one outside of all packages; empty for what is not there."""
        owner = self.workspace.packages.get(package)
        if not package:
            return path if self.workspace.extraction.tree.exists(path) else ""
        if owner is None:
            return ""
        base = f"{owner.path}/" if owner.path else ""
        if f"{base}{path}" in owner.files:
            return f"{base}{path}"
        name = path.rpartition("/")[2]
        for install in owner.build.installs:
            where = install.destination.rstrip("/").rpartition("/")[2]
            for item in install.items:
                source = f"{item.rstrip('/')}/{path.removeprefix(where + '/')}" if install.kind == "directory" else item
                if source in owner.files and source.rpartition("/")[2] == name:
                    return source
        found = [file for file in owner.files if file.endswith(f"/{path}")]
        return found[0] if len(found) == 1 else ""

    def find_launch_file(self, package: str, path: str) -> LaunchFile | None:
        """The facts of a launch file; None for what is not there or is no launch file by its name."""
        place = self.find_workspace_path(package, path)
        kind = classify_launch_file(place)
        found = self._get_facts(place, f"flow_{kind}") if place and kind else None
        if found is not None and found.imports:
            helped, _ = _read_with_helpers(self.workspace, place, found.imports)
            return helped or found
        return found

    def list_helpers(self, path: str) -> tuple[str, ...]:
        """The modules of the workspace that a launch file imports, themselves or by one another; all by their paths."""
        found = self._get_facts(path, "flow_launch_python") if classify_launch_file(path) == "launch_python" else None
        return _read_with_helpers(self.workspace, path, found.imports)[1] if found is not None else ()

    def find_parameter_file(self, package: str, path: str) -> ParameterFile | None:
        """The facts of a parameter file; None for what is not there."""
        place = self.find_workspace_path(package, path)
        return self.read_values(place) if place else None

    def read_values(self, place: str) -> ParameterFile | None:
        """The values of a YAML file of the workspace; None for what is not there."""
        return self._get_facts(place, "flow_parameters")

    def _get_facts(self, place: str, kind: str) -> Any:
        return self.workspace.extraction.look((place,), kind).get(place)


_MOST_HELPERS = 50


@cache_in_derived
def _read_with_helpers(
    workspace: Workspace, path: str, imports: tuple[str, ...]
) -> tuple[LaunchFile | None, tuple[str, ...]]:  # fmt: skip
    """The facts of a launch file in Python with what modules of the workspace give it, and the paths of these; None
    where it imports none. imports: as its facts have them."""
    helped, size = None, 0
    helpers = _find_helpers(workspace, path, imports)
    while size < len(helpers) <= _MOST_HELPERS:
        size = len(helpers)
        sources = {name: (workspace.read(place), package) for name, (place, package) in helpers.items()}
        most = find_size_limit("flow_launch_python")
        helped = extract_python(
            workspace.read(path), {name: row for name, row in sources.items() if len(row[0]) <= most}
        )
        helpers = _find_helpers(workspace, path, helped.imports)
    return helped, tuple(sorted({place for place, _ in helpers.values()}))


def _find_helpers(workspace: Workspace, path: str, imports: Iterable[str]) -> dict[str, tuple[str, str]]:
    """The modules of the workspace among what a file imports, by their dotted names: the path, and the package that
    relative imports in it are of."""
    modules = _list_modules(workspace)
    owner = workspace.find_owning_package(path)
    found: dict[str, tuple[str, str]] = {}
    for written in imports:
        for name in (written, written.rpartition(".")[0]):
            places = modules.get(name, ())
            own = [place for place, package in places if package == owner]
            # What is in no package of Python is found by programs beside it alone.
            chosen = own or ([place for place, _ in places] if "." in name else [])
            if len(chosen) == 1:
                inside = chosen[0].endswith("/__init__.py")
                found[name] = chosen[0], name if inside else name.rpartition(".")[0]
    return found


@cache_in_derived
def _list_modules(workspace: Workspace) -> dict[str, list[tuple[str, str]]]:
    """Path and package of the Python files of a workspace, by the names that they can be imported by."""
    files = {path: package.name for package in workspace for path in package.files if path.endswith(".py")}
    found: dict[str, list[tuple[str, str]]] = {}
    for path, package in sorted(files.items()):
        folder, _, name = path.rpartition("/")
        parts = [] if name == "__init__.py" else [name.removesuffix(".py")]
        while f"{folder}/__init__.py" in files:
            folder, _, name = folder.rpartition("/")
            parts.insert(0, name)
        if parts:
            found.setdefault(".".join(parts), []).append((path, package))
    return found


def classify_launch_file(path: str) -> str:
    """The kind of launch file by a path's name, empty for none."""
    name = path.rpartition("/")[2].lower()
    if name.endswith(".py"):
        return "launch_python"
    if name.endswith((".yaml", ".yml")):
        return "launch_yaml"
    return "launch_xml" if name.endswith((".launch", ".xml", ".test")) else ""


def follow_workspace_launch(
    workspace: Workspace, path: str, arguments: Mapping[str, str], undecided: bool = False
) -> Launched:  # fmt: skip
    """All that a launch file of the workspace starts. path: relative to the workspace's root. undecided: as for
    follow()."""
    package = workspace.find_owning_package(path)
    inner = path[len(workspace.packages[package].path) :].lstrip("/") if package else path
    sources = InWorkspace(workspace)
    return follow(package, inner, sources, arguments, generation=workspace.ros, undecided=undecided)


class Instance(NamedTuple):
    """A node as a launch starts it. name: full. settings: values of its parameters; in ROS 1 of all on the parameter
    server, by their global names. uncertain: why its name, or whether it is started at all, is not sure. What is not
    known of names and values stands in brackets (`/<$ROBOT>/camera`). chosen: the settings that rest on the default of
    a launch argument. is_unread: it is given a parameter file of which the content is not known. process: of a nodelet
    the node that it is loaded into."""

    started: Started
    name: str
    settings: Mapping[str, str]
    remaps: tuple[Remap, ...]
    uncertain: tuple[str, ...]
    chosen: frozenset[str] = frozenset()
    is_unread: bool = False
    process: Instance | None = None

    def remap_name(self, name: str, ros: int, kind: str = "topic") -> str:
        """A name as the code has it, after the remappings of this start; full. It is known in part where a remapping
        under an undecided condition gives it another name."""
        given = self.started.conditions
        sure = [r for r in self.remaps if r.is_sure(given)]
        names = [self._apply(name, sure, ros, kind)]
        if len(sure) < len(self.remaps):
            for one in self.remaps:
                if not one.is_sure(given):
                    names.append(self._apply(name, [r for r in self.remaps if r is one or r in sure], ros, kind))
        found = tuple(dict.fromkeys(names))
        shown = " or ".join(each[1:] for each in found)
        return found[0] if len(found) == 1 else f"/{make_open_part(f'<{shown}>')}"

    def _apply(self, name: str, remaps: Iterable[Remap], ros: int, kind: str) -> str:
        pairs = [(r.old.value, _fill(r.new)) for r in remaps if r.old.value is not None]
        if ros == 1:
            return remap_ros1_name(name, self.name, pairs)
        namespace, _, own = self.name.rpartition("/")
        rules = []
        for old, new in pairs:
            node, colon, match = old.partition(":")
            rules.append(RemappingRule(match if colon else old, new, node if colon else ""))
        return remap_ros2_name(name, own, namespace or "/", rules, kind)


def make_instance(all_started: Launched, own_name: str, started: Started, own_namespace: str = "") -> Instance:
    """A start of a node whose code calls itself own_name, in own_namespace."""
    # A process may hold several nodes, each with rules of its own.
    ruled = {one.old.value: one.new for one in reversed(started.remaps)}
    name = _fill(started.name) or _fill(ruled.get(f"{own_name}:__node", EMPTY)) or own_name
    namespace = _fill(started.namespace) or _fill(ruled.get(f"{own_name}:__ns", EMPTY)) or own_namespace
    full = join_name("/" + namespace.lstrip("/"), name)
    one = started.generation == 1
    given = all_started.server if one else all_started.collect_parameters(started, full)
    settings = {key: _fill_setting(one, started) for key, one in given.items()}
    uncertain = (*started.conditions, *(r for r in (*started.name.reasons, *started.namespace.reasons) if r))
    chosen = frozenset(key for key, one in given.items() if one.text.chosen)
    if one:
        is_unread = any(f"{full}/".startswith(f"{name.rstrip('/')}/") for name in all_started.unread)
    else:
        is_unread = any(isinstance(given, SettingFile) and given.entries is None for given in started.settings)
    return Instance(started, full, settings, started.remaps, uncertain, chosen, is_unread)


def _fill_setting(one: LaunchParameter, started: Started) -> str:
    if one.is_sure(started.conditions):
        return _fill(one.text)
    return make_open_part(f"<{one.text.shown} or not given>")


def _fill(text: LaunchText) -> str:
    return text.value if text.value is not None else make_open_part(text.shown)
