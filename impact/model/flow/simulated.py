"""Plugins of Gazebo Classic in the message-flow graph: what worlds, models and robot descriptions tell of them.

Whether a description is loaded, and below which namespace, is not known: all of it stands under that condition.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping
from typing import cast

from msgspec import structs

from ...facts.gazebo import GazeboFile, GazeboPlugin
from ...facts.kinds import find_kind
from ...targets.gazebo_topics import GazeboTopic, load_gazebo_topics
from ..package import find_folder_role
from ..workspace import Workspace
from .graph import Endpoint, Graph, Node, Role
from .names import NameRefused, is_open, join_name, make_open_part, parse_ros2_rule, remap_ros2_name, resolve_ros2_name

_CONDITION = "Gazebo loads it, below no other namespace"
_SUBSTITUTION = re.compile(r"\$\{([^{}]*)\}|\$\((?:arg|var)? ?([^()]*)\)")


def add_simulated(graph: Graph, workspace: Workspace) -> Graph:
    """The graph of a system with the plugins that descriptions in the workspace have."""
    if workspace.ros != 2:
        return graph
    paths = {
        path: package.name
        for package in workspace
        for path in package.linked.files
        if find_kind(path) == "xacro" and find_folder_role(path[len(package.path) :].lstrip("/")) != "test"
    }
    files: Mapping[str, GazeboFile | None] = workspace.extraction.look(paths, "flow_gazebo") if paths else {}
    known = load_gazebo_topics().plugins if any(file is not None and file.plugins for file in files.values()) else {}
    nodes = {node.id: node for node in graph.nodes}
    endpoints = dict.fromkeys(graph.endpoints)
    for path, file in files.items():
        for plugin in file.plugins if file is not None else ():
            topics = known.get(plugin.library, ())
            if topics and plugin.name:
                node = _make_node(plugin, path, paths[path])
                nodes.setdefault(node.id, node)
                endpoints.update(dict.fromkeys(_list_endpoints(plugin, topics, node)))
    if len(endpoints) == len(graph.endpoints):
        return graph
    return structs.replace(graph, nodes=tuple(nodes[id_] for id_ in sorted(nodes)), endpoints=tuple(endpoints))


def _make_node(plugin: GazeboPlugin, path: str, package: str) -> Node:
    name = join_name("/" + _fill(plugin.namespace).strip("/"), _fill(plugin.name))
    return Node(
        name, name, package, "plugin", plugin=plugin.library, path=path, line=plugin.line, uncertain=(_CONDITION,)
    )


def _fill(text: str) -> str:
    """A text whose substitutions stand in brackets, which show what is asked for."""
    return make_open_part(_SUBSTITUTION.sub(lambda m: f"<{(m[1] or m[2] or '').strip()}>", text))


def _list_endpoints(plugin: GazeboPlugin, topics: tuple[GazeboTopic, ...], node: Node) -> Iterator[Endpoint]:
    namespace, _, own = node.name.rpartition("/")
    rules = [(rule, each) for each in plugin.remappings if (rule := parse_ros2_rule(_fill(each.text))) is not None]
    for topic in topics:
        kind = "topic" if topic.role in ("publisher", "subscriber") else "service"
        try:
            plain = resolve_ros2_name(topic.name, own, namespace or "/")
            name = remap_ros2_name(topic.name, own, namespace or "/", [rule for rule, _ in rules], kind)
        except NameRefused:
            continue
        by = next((each for rule, each in rules if rule.match in (topic.name, plain)), None)
        yield Endpoint(
            cast(Role, topic.role), node.id, name, topic.type, node.path, by.line if by is not None else plugin.line,
            by.text if by is not None else topic.name, "partly" if is_open(name) else "launch",
            framework="gazebo_ros", only_if=_CONDITION, code_name=topic.name,
        )  # fmt: skip
