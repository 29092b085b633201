"""A running system beside the sources: which endpoints of its nodes the graph has, lacks, and has in vain."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import lru_cache
from typing import Literal, NamedTuple

import msgspec

from ....edges.groups import group_pairs
from .connections import format_guards
from .contracts import is_of_framework
from .edges import SURE
from .graph import Endpoint, Graph, Node, Role

State = Literal["matches", "may match", "other type", "not in the sources", "not seen"]
"""`may match`: the sources have an endpoint of this role and type whose name is not known."""

_OPEN_PART = re.compile(r"<[^<>/]*>")


class SeenEndpoint(NamedTuple):
    """An endpoint of a running system. node: full name, empty where it is not known; type: `package/Name`, empty where
    it is not known."""

    node: str
    role: Role
    name: str
    type: str


class Observation(NamedTuple):
    """What was seen of a running system. roles: by the full name of each node that ran the roles of which all its
    endpoints were told; none of a recording, which has what was recorded."""

    roles: dict[str, frozenset[Role]]
    endpoints: tuple[SeenEndpoint, ...]


class ObservedRow(msgspec.Struct, frozen=True, omit_defaults=True):
    """An endpoint that was seen, is in the sources, or both. type: as seen, else as the sources have it; expected: that
    of the sources where it is another. uncertain: why an endpoint that was not seen need not be there. counts: it makes
    the system differ from the sources."""

    state: State
    node: str
    role: Role
    name: str
    type: str
    path: str = ""
    line: int = 0
    expected: str = ""
    uncertain: str = ""
    counts: bool = False


class ObservedDifference(msgspec.Struct, frozen=True):
    """rows: endpoints of nodes that ran and are in the sources, and of what no node is told of. not_started: nodes of
    the sources that were not seen; others: nodes that were seen and are not in the sources."""

    rows: tuple[ObservedRow, ...]
    not_started: tuple[str, ...]
    others: tuple[str, ...]

    @property
    def differs(self) -> bool:
        return any(row.counts for row in self.rows)


def compare_observed(graph: Graph, seen: Observation) -> ObservedDifference:
    """What was seen beside a graph. What ROS makes for every node is left out."""
    made = group_pairs((one.node, one) for one in graph.endpoints)
    runs = {name: [node for node in graph.nodes if node.name and _fits(node.name, name)] for name in seen.roles}
    rows: list[ObservedRow] = []
    for name, nodes in runs.items():
        if nodes:
            own = [one for node in nodes for one in made.get(node.id, ())]
            here = [one for one in seen.endpoints if one.node == name]
            rows += _compare_node(name, own, here, seen.roles[name], nodes)
    nameless = [one for one in seen.endpoints if not one.node]
    rows += _compare_node("", graph.endpoints, nameless)
    if nameless and not seen.roles:
        rows += _list_unrecorded(graph, nameless)
    found = {node.id for nodes in runs.values() for node in nodes}
    missing = sorted(node.name for node in graph.nodes if node.name and node.id not in found) if seen.roles else []
    others = sorted(name for name, nodes in runs.items() if not nodes)
    return ObservedDifference(tuple(rows), tuple(missing), tuple(others))


def _compare_node(
    name: str, made: Iterable[Endpoint], seen: Iterable[SeenEndpoint], roles: Iterable[Role] = (),
    nodes: Iterable[Node] = (),
) -> Iterator[ObservedRow]:  # fmt: skip
    """Endpoints of a node that ran beside those that the sources make for it. roles: of which all that it has were
    seen."""
    by_role = group_pairs((one.role, one) for one in made)
    met: set[tuple[Role, str]] = set()
    for one in dict.fromkeys(seen):
        same = [each for each in by_role.get(one.role, ()) if each.topic and _fits(each.topic, one.name)]
        # Parts that begin with `_` hide what actions and the introspection of services consist of.
        if is_of_framework(one.role, one.name, one.type) or ("/_" in one.name and not same):
            continue
        met.update((each.role, each.topic) for each in same)
        typed = [each for each in same if not one.type or each.type in ("", "*", one.type)]
        first = (typed or same or [None])[0]
        place = (first.path, first.line) if first is not None else ("", 0)
        row = ObservedRow("matches", one.node, one.role, one.name, one.type, *place)
        if typed:
            yield row
        elif same:
            yield msgspec.structs.replace(row, state="other type", expected=same[0].type, counts=True)
        elif any(not each.topic and _may_be(each.type, one.type) for each in by_role.get(one.role, ())):
            yield msgspec.structs.replace(row, state="may match")
        else:
            yield msgspec.structs.replace(row, state="not in the sources", counts=bool(one.node))
    uncertain = "; ".join(reason for node in nodes for reason in node.uncertain)
    lacking = {
        (one.role, one.topic): one
        for role in roles
        for one in by_role.get(role, ())
        if one.topic and (one.role, one.topic) not in met and not is_of_framework(one.role, one.topic, one.type)
    }
    for one in lacking.values():
        reason = "made by a library" if one.implied else one.only_if and f"only if {one.only_if}"
        reason = reason or (f"only if {format_guards(one)}" if one.guards else "")
        reason = reason or uncertain or ("" if one.how in SURE else f"its name is known by {_KNOWN_BY[one.how]}")
        yield _make_unseen(one, name, reason, not reason)


_KNOWN_BY = {"default": "the default of a parameter", "partly": "a part of it", "unresolved": "nothing"}


def _list_unrecorded(graph: Graph, seen: list[SeenEndpoint]) -> Iterator[ObservedRow]:
    """Publishers of the sources whose topics a recording lacks: it need not have all."""
    names = {one.name for one in seen}
    nodes = {node.id: node.name for node in graph.nodes}
    for one in {one.topic: one for one in graph.endpoints if one.role == "publisher" and one.topic}.values():
        if not any(_fits(one.topic, name) for name in names) and not is_of_framework(one.role, one.topic, one.type):
            yield _make_unseen(one, nodes.get(one.node, ""), "a recording need not have it", False)


def _make_unseen(one: Endpoint, node: str, reason: str, counts: bool) -> ObservedRow:
    return ObservedRow(
        "not seen", node, one.role, one.topic, one.type, one.path, one.line, uncertain=reason, counts=counts
    )


def _may_be(type_: str, seen: str) -> bool:
    return type_ in ("", "*") or not seen or type_ == seen


@lru_cache(maxsize=10_000)
def _make_pattern(name: str) -> re.Pattern[str] | None:
    """What names fit one that is known in part; None for one that is known: text of any levels for a whole part, within
    a level elsewhere."""
    if not _OPEN_PART.search(name):
        return None
    levels = (
        ".+" if _OPEN_PART.fullmatch(level) else "[^/]+".join(map(re.escape, _OPEN_PART.split(level)))
        for level in name.split("/")
    )
    return re.compile("/".join(levels))


def _fits(name: str, seen: str) -> bool:
    """Whether a name of the sources, which may be known in part, can be one that was seen."""
    pattern = _make_pattern(name)
    return name == seen if pattern is None else pattern.fullmatch(seen) is not None
