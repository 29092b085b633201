"""Plugins in the nodes that load them, as parameter files and launch files say.

A parameter `<name>.plugin` (navigation2, MoveIt, costmaps), or `plugin`, makes the node that has it load a class into
itself; what programs of the workspace load follows from their code, see plugin_hosts.py. A parameter `<name>.type` of a
controller manager makes it load a controller, which is a node of its own of that name, in the manager's namespace. In
ROS 1 the controllers are those that a launch file names to a spawner, each with its parameter `<name>/type`; what one
has is in the namespace of its name, and is shown as if it were a node.
Source: nav2's "Configuration Guide", ros2_control's and ros_control's "Controller Manager".
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from msgspec import structs

from ....edges.groups import group_pairs
from ...facts.launch.parameter_files import ParameterFile
from ...facts.store import recall
from ..workspace import Workspace
from .code import get_tail
from .file_selection import compute_stamp
from .graph import Graph, Node
from .launches import follow_launch_files
from .names import get_namespace, is_open, join_name, normalise
from .started import InWorkspace, make_instance

_MANAGER = "controller_manager"
# Programs of controller_manager in ROS 1 that load controllers, with the words that may stand before their names.
_SPAWNERS = {"spawner": (), "controller_manager": ("load", "spawn")}
# Options of these with a value behind them.
_WITH_VALUE = frozenset(("--namespace", "--timeout", "--shutdown-timeout", "-t", "-n"))


class PluginLoad(NamedTuple):
    """A plugin in a node. node: the full name of the node that it is, or is in; place: `path:line` of the parameter."""

    node: str
    place: str


def list_plugin_loads(workspace: Workspace) -> dict[str, tuple[PluginLoad, ...]]:
    """Classes of the workspace's plugins, without a leading `::`, to the nodes that parameter files of ROS 2 in it load
    them into; in ROS 1 to the controllers that launch files spawn."""
    classes: dict[str, str] = {}
    for package in workspace:
        for _, plugin in package.linked.plugins:
            if plugin.type:
                classes[plugin.name or plugin.type] = classes[plugin.type] = plugin.type.removeprefix("::")
    if not classes:
        return {}
    store, key = workspace.extraction.store, compute_stamp(workspace)
    find = _list_launched if workspace.ros == 2 else _list_spawned
    # Following launch files again takes long, and what they start is remembered by the same key.
    every = recall(store, "launched plugins", key, list[tuple[str, PluginLoad]], lambda: list(find(workspace)))
    launched = [row for row in every if row[0] in classes]
    if workspace.ros != 2:
        spawned = group_pairs((classes[name], load) for name, load in dict.fromkeys(launched))
        return {name: tuple(loads) for name, loads in spawned.items()}
    paths = [path for package in workspace for path in package.linked.files if path.endswith((".yaml", ".yml"))]
    found: dict[str, dict[PluginLoad, None]] = {}
    given = {load.place for _, load in launched}
    for name, load in launched:
        found.setdefault(classes[name], {})[load] = None
    for path, file in workspace.extraction.look(paths, "flow_parameters").items():
        for name, load in _list_loads(path, file):
            # What a launch file gives a node is under the name that the node has there.
            if name in classes and load.place not in given:
                found.setdefault(classes[name], {})[load] = None
    return {name: tuple(loads) for name, loads in found.items()}


def _list_launched(workspace: Workspace) -> Iterator[tuple[str, PluginLoad]]:
    """What the nodes that launch files start load by their parameters, by the name that is given."""
    sources = InWorkspace(workspace)
    for _, launch in follow_launch_files(workspace):
        for started in launch.started:
            if started.generation != 2 or not started.settings:
                continue
            own = f"<{started.executable.shown or started.plugin.shown}>"
            node = make_instance(launch, own, started).name
            for name, setting in launch.collect_parameters(started, node).items():
                *inner, last = name.split(".")
                controller = last == "type" and bool(inner) and node.rpartition("/")[2] == _MANAGER
                if (last == "plugin" or controller) and setting.text.value is not None:
                    at = setting.source or setting.at
                    place = f"{sources.find_workspace_path(at.package, at.path)}:{at.line}"
                    full = join_name(get_namespace(node), inner[-1]) if controller else node
                    yield setting.text.value, PluginLoad(full, place)


def _list_spawned(workspace: Workspace) -> Iterator[tuple[str, PluginLoad]]:
    """The controllers that launch files of ROS 1 spawn, by the type that the parameter server has for them."""
    sources = InWorkspace(workspace)
    for _, launch in follow_launch_files(workspace):
        for started in launch.started:
            words = _SPAWNERS.get(started.executable.value or "")
            if started.generation != 1 or started.package.value != _MANAGER or words is None:
                continue
            arguments = [one.value for one in started.arguments]
            space, names = _read_spawner([one for one in arguments if one is not None], words)
            node = make_instance(launch, "spawner", started).name
            for name in names:
                full = normalise(join_name("/" + space.strip("/") if space else get_namespace(node), name))
                setting = launch.server.get(f"{full}/type")
                if setting is not None and setting.text.value is not None and not is_open(full):
                    place = f"{sources.find_workspace_path(started.at.package, started.at.path)}:{started.at.line}"
                    yield setting.text.value, PluginLoad(full, place)


def _read_spawner(arguments: list[str], words: tuple[str, ...]) -> tuple[str, list[str]]:
    """The namespace that a spawner is given, and the controllers. words: those of which one stands first, if any."""
    space, names = "", []
    option = ""
    for one in arguments:
        if option:
            space = one if option in ("--namespace", "-n") else space
            option = ""
        elif one.startswith("--namespace="):
            space = one.partition("=")[2]
        elif one in _WITH_VALUE:
            option = one
        elif not one.startswith(("-", "_")) and ":=" not in one:
            names.append(one)
    if words:
        names = names[1:] if names[:1] and names[0] in words else []
    return space, names


def _list_loads(path: str, file: ParameterFile | None) -> Iterator[tuple[str, PluginLoad]]:
    """What the parameters of a file load, by the name that is given."""
    for entry in file.entries if file is not None else ():
        if "ros__parameters" not in entry.path or not isinstance(entry.value, str):
            continue
        split = entry.path.index("ros__parameters")
        node, (*inner, last) = normalise("/" + "/".join(entry.path[:split])), entry.path[split + 1 :] or ("",)
        if not inner or last not in ("plugin", "type") or "*" in node:
            continue
        controller = last == "type" and get_tail(node.replace("/", "::")) == _MANAGER
        if controller or last == "plugin":
            full = join_name(get_namespace(node), inner[-1]) if controller else node
            yield entry.value, PluginLoad(full, f"{path}:{entry.line}")


def assign_plugins(graph: Graph, loads: Mapping[str, Iterable[PluginLoad]]) -> Graph:
    """A graph with each of its plugins in the nodes that load it, by class; those that nothing loads stay. Where its
    code shows already that a node loads it, it is there."""
    hosts = group_pairs((program, node.name) for node in graph.nodes for program in node.loads)
    placed: dict[str, tuple[Node, tuple[PluginLoad, ...]]] = {}
    for node in graph.nodes:
        if node.kind == "plugin" and not node.name:
            given = tuple(loads.get(node.plugin.removeprefix("::"), ()))
            there = hosts.get(f"{node.package}/{node.plugin}", [])
            if given or there:
                placed[node.id] = node, tuple(one for one in given if one.node not in there)
    if not placed:
        return graph

    def replace(rows: Iterable[Any]) -> tuple[Any, ...]:
        return tuple(dict.fromkeys(one for row in rows for one in _assign(row, placed)))

    known = {node.id: node for node in graph.nodes if node.id not in placed}
    for node, those in placed.values():
        for load in those:
            known.setdefault(load.node, structs.replace(node, id=load.node, name=load.node, started=load.place))
    return structs.replace(
        graph,
        nodes=tuple(known[id_] for id_ in sorted(known)),
        endpoints=replace(graph.endpoints),
        publishes=replace(graph.publishes),
        timers=replace(graph.timers),
        parameters=replace(graph.parameters),
    )


def _assign(row: Any, placed: Mapping[str, tuple[Node, tuple[PluginLoad, ...]]]) -> Iterator[Any]:
    """An entry of the graph as it is in each node that loads the plugin that it is of."""
    if row.node not in placed:
        yield row
        return
    node, loads = placed[row.node]
    own = f"/<{node.executable or get_tail(node.plugin)}>"
    for load in loads:
        changes: dict[str, Any] = {"node": load.node}
        topic = getattr(row, "topic", "")
        if topic:
            private = topic == own or topic.startswith(f"{own}/")
            absolute = getattr(row, "written", '"/').startswith('"/')
            inside = load.node + topic[len(own) :] if private else topic
            changes["topic"] = inside if private or absolute else join_name(get_namespace(load.node), topic[1:])
        if getattr(row, "how", "") == "partly" and not is_open(changes.get("topic", "")):
            changes["how"] = "launch"
        yield structs.replace(row, **changes)
