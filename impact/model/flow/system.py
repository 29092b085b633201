"""The message flow of a workspace as it is started: one graph of what all its launch files start, and of the programs
that none of them does; or of what some launch files start together."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from typing import Any, NamedTuple, TypeVar

import msgspec

from ....edges.groups import group_pairs
from ..launch.result import Launched
from .graph import LOST_INCLUDE, NOT_GIVEN, Endpoint, Graph, Node, Publish, Unresolved
from .launches import Launch
from .names import has_known_segment

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
        unread=frozenset(name for part in parts for name in part.unread),
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
    started = {node.id for node in code.nodes if node.kind != "library" and _get_program(node) in programs}
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
    lost = _drop_repeats(one for graph in graphs for one in graph.coverage.unresolved if one.what == LOST_INCLUDE)
    endpoints, publishes = _drop_not_given(merge("endpoints"), merge("publishes"))
    left = _select_unresolved(code.coverage.unresolved, endpoints, publishes)
    resolved = code.coverage.resolved + len(code.coverage.unresolved) - len(left)
    return msgspec.structs.replace(
        code,
        coverage=msgspec.structs.replace(
            code.coverage, resolved=resolved, unresolved=(*left, *lost),
            in_part=sum(has_known_segment(one.pattern) for one in left),
        ),
        nodes=tuple(sorted(nodes.values(), key=lambda node: node.id)),
        endpoints=endpoints,
        publishes=publishes,
        timers=merge("timers"),
        parameters=merge("parameters"),
        outside=_drop_repeats(one for graph in graphs for one in graph.outside),
    )


def _drop_not_given(
    endpoints: tuple[Endpoint, ...], publishes: tuple[Publish, ...]
) -> tuple[tuple[Endpoint, ...], tuple[Publish, ...]]:
    """Endpoints and publish statements without those of a node that have no name since one launch file gives it no
    parameter, where another does: there is none without the name."""
    given = {(one.node, one.role, one.path, one.line) for one in endpoints if one.how == "launch" and one.topic}
    left = tuple(
        one for one in endpoints
        if one.topic or not one.reason.endswith(NOT_GIVEN) or (one.node, one.role, one.path, one.line) not in given
    )  # fmt: skip
    if len(left) == len(endpoints):
        return endpoints, publishes
    said = {(one.node, one.path, one.line) for one in publishes if one.topic}
    return left, tuple(
        one for one in publishes
        if one.topic or not one.reason.endswith(NOT_GIVEN) or (one.node, one.path, one.line) not in said
    )  # fmt: skip


def _select_unresolved(
    unresolved: Sequence[Unresolved], endpoints: Iterable[Endpoint], publishes: Iterable[Publish]
) -> list[Unresolved]:
    """Of what is not resolved in the code that which is not resolved either where launch files start it. endpoints,
    publishes: of what they start."""
    known: dict[tuple[str, str, int], list[bool]] = {}
    named: set[tuple[str, str]] = set()
    for one in endpoints:
        is_named = bool(one.topic) and one.how not in ("partly", "unresolved")
        known.setdefault((f"{one.role} name", one.path, one.line), []).append(is_named)
        if is_named:
            named.add((one.node, one.topic))
    for one in publishes:
        known.setdefault(("publish", one.path, one.line), []).append((one.node, one.topic) in named)
    return [one for one in unresolved if not all(known.get((one.what, one.path, one.line), (False,)))]


def _get_program(node: Node) -> str:
    return f"{node.package}/{node.executable or node.plugin}"


def _drop_repeats(rows: Iterable[_Row]) -> tuple[_Row, ...]:
    return tuple(dict.fromkeys(rows))
