"""The message flow of a workspace as it is started: one graph of what all its launch files start, and of the programs
that none of them does; or of what some launch files start together."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from typing import Any, NamedTuple, TypeVar

import msgspec

from ....edges.groups import group_pairs
from ..launch.result import Launched
from .graph import LOST_INCLUDE, Graph, Node
from .launches import Launch

_Row = TypeVar("_Row")


class ChosenLaunch(NamedTuple):
    """A launch file that a system is started with. path: relative to the workspace's root."""

    path: str
    arguments: Mapping[str, str] = {}


def join_launched(parts: Sequence[Launched]) -> Launched:
    """What several launch files start together: all their nodes, with one parameter server in ROS 1."""
    server = {name: setting for part in parts for name, setting in part.server.items()}
    files = dict.fromkeys(file for part in parts for file in part.files)
    return Launched(
        tuple(started for part in parts for started in part.started), server, tuple(files),
        frozenset(name for part in parts for name in part.arguments), sum(part.actions for part in parts),
        tuple(dict.fromkeys(file for part in parts for file in part.parameter_files)),
        tuple(started for part in parts for started in part.outside),
    )  # fmt: skip


def merge_launches(code: Graph, launches: Sequence[Launch]) -> Graph:
    """The graph of a system. code: the graph of its code, whose names hold for programs that no launch file starts.

    A node that several launch files start under one name is one node, with all names that it has in any of them. What
    launch files start and include of other packages is left out: that is most of what they start.
    """
    if not launches:
        return code
    programs = {start.program for launch in launches for start in launch.starts}
    possible = [(launch.path, launch.possible) for launch in launches if launch.possible is not None]
    programs |= {_get_program(node) for _, graph in possible for node in graph.nodes}
    started = {
        node.id
        for node in code.nodes
        if node.kind != "library" and _get_program(node) in programs
    }
    sure = [(launch.path, launch.graph) for launch in launches]
    graphs = [graph for _, graph in (*sure, *possible)]

    def merge(field: str) -> tuple[Any, ...]:
        own = (row for row in getattr(code, field) if row.node not in started)
        return _drop_repeats(chain(own, *(getattr(graph, field) for graph in graphs)))

    by_launch = group_pairs((node.id, path) for path, graph in (*sure, *possible) for node in graph.nodes)
    nodes = {
        node.id: msgspec.structs.replace(node, launches=tuple(dict.fromkeys(by_launch[node.id])))
        for graph in reversed(graphs)
        for node in graph.nodes
    }
    nodes |= {node.id: node for node in code.nodes if node.id not in started}
    lost = _drop_repeats(
        one for graph in graphs for one in graph.coverage.unresolved if one.what == LOST_INCLUDE
    )
    return msgspec.structs.replace(
        code,
        coverage=msgspec.structs.replace(code.coverage, unresolved=(*code.coverage.unresolved, *lost)),
        nodes=tuple(sorted(nodes.values(), key=lambda node: node.id)),
        endpoints=merge("endpoints"),
        publishes=merge("publishes"),
        timers=merge("timers"),
        parameters=merge("parameters"),
        outside=_drop_repeats(one for graph in graphs for one in graph.outside),
    )


def _get_program(node: Node) -> str:
    return f"{node.package}/{node.executable or node.plugin}"


def _drop_repeats(rows: Iterable[_Row]) -> tuple[_Row, ...]:
    return tuple(dict.fromkeys(rows))
