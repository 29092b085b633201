"""What all drawings show: edges between nodes and names, and how they differ from the base."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from typing import Literal, NamedTuple

from msgspec import structs

from ....edges.groups import group_pairs
from .graph import Endpoint, Graph, GuardAt, Node, Publish, Qos
from .select import get_kind

Mark = Literal["", "added", "removed", "changed"]
_CHOICE = re.compile(r"\|\||\?|\b(?:or|if|lambda)\b")
"""What binds less than `and`."""
_PLACE = re.compile(r"lambda@\d+:\d+")
_OUT = frozenset(("publisher", "client", "action client"))


class Edge(NamedTuple):
    """Endpoints of one role between a node and a name, and the publish statements there.

    kind: topic, service or action. mark: how it differs from the base; why: in which of type, QoS, guards or triggers a
    changed one does; before: what that was in the base.
    """

    node: str
    name: str
    kind: str
    role: str
    types: tuple[str, ...]
    endpoints: tuple[Endpoint, ...]
    publishes: tuple[Publish, ...]
    mark: Mark = ""
    why: str = ""
    before: Edge | None = None

    @property
    def outward(self) -> bool:
        """From the node to the name: it publishes or asks."""
        return self.role in _OUT


def list_edges(graph: Graph, base: Graph | None = None) -> list[Edge]:
    """The edges of a graph, sorted by name, role and node; those that only the base has come marked as removed."""
    now = {(edge.node, edge.name, edge.role): edge for edge in _make_edges(graph)}
    if base is not None:
        old = {(edge.node, edge.name, edge.role): edge for edge in _make_edges(base)}
        for key, edge in now.items():
            before = old.get(key)
            why = "" if before is None else _describe_difference(before, edge)
            mark: Mark = "added" if before is None else "changed" if why else ""
            now[key] = edge._replace(mark=mark, why=why, before=before if why else None)
        now.update({key: edge._replace(mark="removed") for key, edge in old.items() if key not in now})
    return sorted(now.values(), key=lambda edge: (edge.name, edge.kind, not edge.outward, edge.role, edge.node))


def _make_edges(graph: Graph) -> Iterator[Edge]:
    found = group_pairs(((one.node, one.topic, one.role), one) for one in graph.endpoints if one.topic)
    said = group_pairs(((one.node, one.topic), one) for one in graph.publishes if one.topic and not one.through)
    for (node, name, role), endpoints in found.items():
        types = tuple(sorted({endpoint.type for endpoint in endpoints if endpoint.type}))
        publishes = tuple(said.get((node, name), ())) if role == "publisher" else ()
        yield Edge(node, name, get_kind(endpoints[0]), role, types, tuple(endpoints), publishes)


def _describe_difference(before: Edge, now: Edge) -> str:
    found = []
    if before.types != now.types:
        found.append("type")
    if {_describe_qos(each) for each in before.endpoints} != {_describe_qos(each) for each in now.endpoints}:
        found.append("QoS")
    if _collect_guards(before.publishes) != _collect_guards(now.publishes):
        found.append("guards")
    if _collect_triggers(before.publishes) != _collect_triggers(now.publishes):
        found.append("trigger")
    return ", ".join(found)


def _describe_qos(endpoint: Endpoint) -> Qos | str:
    """What is told; how it is written counts where nothing else is known, and where it is written never."""
    if endpoint.qos is None:
        return Qos()
    reported = structs.replace(endpoint.qos, written="")
    return _PLACE.sub("lambda", endpoint.qos.written) if reported == Qos() and endpoint.qos.written else reported


def _collect_guards(publishes: Sequence[Publish]) -> frozenset:
    return frozenset(
        tuple((guard.kind, guard.text) for guard in way.guards) for publish in publishes for way in publish.by
    )


def _collect_triggers(publishes: Sequence[Publish]) -> frozenset:
    return frozenset((trigger.kind, trigger.detail) for publish in publishes for trigger in publish.triggers)


def name_nodes(nodes: Sequence[Node]) -> dict[str, str]:
    """What each node is called for people, by its id: its name in the system, where no other node has it."""
    count = Counter(node.name for node in nodes)
    return {node.id: node.name if node.name and count[node.name] == 1 else node.id for node in nodes}


def format_conditions(guards: Sequence[GuardAt]) -> str:
    """What must hold, in one line. Empty for nothing."""
    return " and ".join(list_conditions(guards))


def list_conditions(guards: Sequence[GuardAt]) -> list[str]:
    """What must hold, outermost first; what is a choice itself stands in parentheses among others."""
    asked = [guard for guard in guards if guard.kind in ("if", "unless")]
    return [
        f"not ({guard.text})"
        if guard.kind == "unless"
        else f"({guard.text})"
        if len(asked) > 1 and _CHOICE.search(guard.text)
        else guard.text
        for guard in asked
    ]


def format_loops(guards: Sequence[GuardAt]) -> str:
    """The loops, `catch` and the like among guards, outermost first; empty for none."""
    return " in ".join(f"{guard.kind} {guard.text}" for guard in guards if guard.kind not in ("if", "unless"))


def format_guards(guarded: Publish | Endpoint) -> str:
    """The guards of a publish statement, or of the call that makes an endpoint, in one line."""
    asked, around = format_conditions(guarded.guards), format_loops(guarded.guards)
    return ", ".join([*([asked] if asked else []), *([f"in {around}"] if around else [])])
