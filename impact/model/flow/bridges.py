"""Bridges to Gazebo in the message-flow graph: the topics that launch files tell them to carry.

A bridge is a program whose topics stand in its arguments or in a YAML file that it is given. Sources:
parameter_bridge.cpp, bridge_config.cpp, ros_gz_bridge.cpp and ros_gz_bridge.launch.py of ros_gz_bridge,
image_bridge.cpp of ros_gz_image.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from msgspec import structs

from ...facts.launch.parameter_files import YamlNode, parse_yaml_tree
from ...facts.markup import decode
from ..launch.result import EMPTY, Launched, LaunchParameter, Started
from ..launch.text import LaunchText, wrap
from .graph import Endpoint, Graph, Node, Role
from .names import NameRefused, is_open, make_open_part, resolve_ros2_name
from .started import Instance, InWorkspace, make_instance

_PACKAGES = ("ros_gz_bridge", "ros_ign_bridge")
_PROGRAMS = frozenset(("parameter_bridge", "bridge_node"))
_IMAGES = (("ros_gz_image", "image_bridge"), ("ros_ign_image", "image_bridge"))
# What they call themselves; those of the older packages differ from distro to distro.
_OWN_NAMES = {"ros_gz_bridge": "ros_gz_bridge", "ros_gz_image": "ros_gz_image"}
_INCLUDED = re.compile(r"launch/ros_gz_(?:bridge|sim)\.launch(?:\.py|\.xml)?\Z")
_INCLUDING = frozenset(("ros_gz_bridge", "ros_gz_sim"))
# `/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan`
_ARGUMENT = re.compile(r"(?P<name>[^@]+)@(?P<type>\w+(?:/\w+){1,2})(?:(?P<direction>[@\[\]]).+)?\Z", re.DOTALL)
# Names of interfaces begin with a capital letter; of another type a bridge makes nothing.
_TYPE = re.compile(r"\w+/(?:\w+/)?[A-Z][A-Za-z0-9]*\Z")
_SHARED = re.compile(r"\$\(find ([\w.-]+)\)/(.+)\Z")
_BOTH: tuple[Role, ...] = ("publisher", "subscriber")
_ROLES: dict[str, tuple[Role, ...]] = {
    "@": _BOTH, "[": ("publisher",), "]": ("subscriber",),
    "BIDIRECTIONAL": _BOTH, "": _BOTH, "GZ_TO_ROS": ("publisher",), "ROS_TO_GZ": ("subscriber",),
}  # fmt: skip
# Of these the first that is given is the name on the side of ROS.
_NAMES = ("topic_name", "ros_topic_name", "gz_topic_name", "service_name")
_LARGEST = 1 << 20


class Carried(NamedTuple):
    """A name that a bridge carries. name: as the bridge gives it to ROS, what is not known in brackets. path, line:
    where it is told."""

    roles: tuple[Role, ...]
    name: str
    type: str
    written: str
    path: str
    line: int


def add_bridges(graph: Graph, launch: Launched, sources: InWorkspace) -> Graph:
    """The graph of a launch with the bridges that it starts, and what is known that they carry."""
    nodes = {node.id: node for node in graph.nodes}
    endpoints: dict[Endpoint, None] = dict.fromkeys(graph.endpoints)
    known: set[tuple[str, int]] = set()
    for started in (*launch.started, *launch.outside):
        bridge = _find_bridge(started) if started.generation != 1 else None
        if bridge is None:
            continue
        package, executable = bridge.package.value or "", bridge.executable.value or ""
        own = _OWN_NAMES.get(package) or f"<{executable or package}>"
        instance = make_instance(launch, own, bridge)
        carried = list(_list_carried(instance, sources))
        made = [one for each in carried for one in _make_endpoints(each, instance)]
        if not made:
            continue
        at = bridge.at
        path = sources.find_workspace_path(at.package, at.path) or f"{at.package}/{at.path}"
        plugin = bridge.plugin.value or ""
        nodes.setdefault(
            instance.name,
            Node(
                instance.name, instance.name, package, "component" if plugin else "executable", executable, plugin,
                "", path, at.line, f"{path}:{at.line}", instance.uncertain,
            ),
        )  # fmt: skip
        endpoints.update(dict.fromkeys(made))
        known.add((path, at.line))
    if not known:
        return graph
    unresolved = tuple(
        one for one in graph.coverage.unresolved if one.what != "started node" or (one.path, one.line) not in known
    )
    return structs.replace(
        graph,
        nodes=tuple(nodes[id_] for id_ in sorted(nodes)),
        endpoints=tuple(endpoints),
        coverage=structs.replace(graph.coverage, unresolved=unresolved),
    )


def _find_bridge(started: Started) -> Started | None:
    """The start of a bridge, with what it is given as a node would be; None for anything else."""
    package = started.package.value
    if started.kind == "include":
        return _find_included(started) if package in _INCLUDING else None
    program = started.executable.value
    if package in _PACKAGES and (program in _PROGRAMS or started.plugin.value == f"{package}::RosGzBridge"):
        return started
    return started if (package, program) in _IMAGES else None


def _find_included(started: Started) -> Started | None:
    """The bridge that a launch file of ros_gz starts, by the arguments that this is given."""
    given = {one.name: one.text for one in started.settings if isinstance(one, LaunchParameter)}
    if not _INCLUDED.match(started.executable.value or "") or "config_file" not in given:
        return None
    name = given.get("bridge_name", EMPTY)
    space, own = started.namespace, given.get("namespace", EMPTY)
    if own.value != "":
        joined = f"{space.value or ''}/{own.value or ''}" if own.value and own.value[0] != "/" else own.value
        known = joined if own.value is not None and space.value is not None else None
        space = LaunchText(known, known or f"{space.shown}/{own.shown}", (*space.reasons, *own.reasons))
    config = LaunchParameter("config_file", given["config_file"], started.at)
    return started._replace(
        kind="node", package=wrap("ros_gz_bridge"), executable=wrap("bridge_node"), name=name, namespace=space,
        settings=(config,),
    )  # fmt: skip


def _list_carried(instance: Instance, sources: InWorkspace) -> Iterator[Carried]:
    started = instance.started
    at = started.at
    place = sources.find_workspace_path(at.package, at.path) or f"{at.package}/{at.path}", at.line
    if not started.plugin.value:
        is_images = (started.package.value, started.executable.value) in _IMAGES
        for word in _list_own_words(started):
            if is_images:
                yield Carried(("publisher",), make_open_part(word), "sensor_msgs/Image", word, *place)
            elif (carried := _parse_argument(word, place)) is not None:
                yield carried
    file = _SHARED.match(instance.settings.get("config_file", ""))
    path = sources.find_workspace_path(*file.groups()) if file is not None else ""
    if path:
        yield from _read_configuration(sources.workspace.read(path), path)


def _list_own_words(started: Started) -> Iterator[str]:
    """The arguments that are no arguments of ROS, as far as they are known."""
    inside = False
    for word in started.arguments:
        if word.value in ("--ros-args", "--"):
            inside = word.value == "--ros-args"
        elif not inside and word.shown[:1] != "-":
            yield word.shown


def _parse_argument(word: str, place: tuple[str, int]) -> Carried | None:
    m = _ARGUMENT.match(word)
    if m is None or not _TYPE.match(m["type"]):
        return None
    name, type_, direction = make_open_part(m["name"]), _shorten_type(m["type"]), m["direction"]
    if "/srv/" in m["type"]:
        return Carried(("server",), name, type_, word, *place) if direction in (None, "@") else None
    return Carried(_ROLES[direction], name, type_, word, *place) if direction is not None else None


def _shorten_type(written: str) -> str:
    package, _, name = written.partition("/")
    return f"{package}/{name.rpartition('/')[2]}"


def _read_configuration(data: bytes, path: str) -> Iterator[Carried]:
    """What a configuration file of a bridge lists."""
    root, _ = parse_yaml_tree(decode(data)) if len(data) <= _LARGEST else (None, ())
    for item in root.value if root is not None and root.kind == "list" else ():
        rows: dict[str, YamlNode] = dict(item.value) if item.kind == "map" else {}
        given = {key: node.value for key, node in rows.items() if isinstance(node.value, str) and node.value}
        type_, direction = given.get("ros_type_name", ""), given.get("direction", "")
        key = next((key for key in _NAMES if key in given), "")
        if not key or not _TYPE.match(type_) or (key != "service_name" and direction not in _ROLES):
            continue
        roles: tuple[Role, ...] = ("server",) if key == "service_name" else _ROLES[direction]
        yield Carried(roles, given[key], _shorten_type(type_), given[key], path, rows[key].line)


def _make_endpoints(carried: Carried, instance: Instance) -> Iterable[Endpoint]:
    namespace, _, own = instance.name.rpartition("/")
    for role in carried.roles:
        try:
            resolve_ros2_name(carried.name, own, namespace or "/")
            name = instance.remap_name(carried.name, 2, "service" if role == "server" else "topic")
        except NameRefused:
            continue
        yield Endpoint(
            role, instance.name, name, carried.type, carried.path, carried.line, carried.written,
            "partly" if is_open(name) else "launch", framework="ros_gz_bridge", code_name=carried.name,
        )  # fmt: skip
