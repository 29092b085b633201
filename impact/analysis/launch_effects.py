"""What launch files and files of parameters that differ from the base's reach, edge by edge."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from itertools import zip_longest
from typing import NamedTuple

import msgspec

from ...edges.console import format_count
from ...edges.groups import group_pairs
from ..model.flow.graph import Endpoint
from ..model.flow.launch_changes import LaunchChange, NodeChange, StartDifference, StartedNode
from ..model.flow.names import resolve_ros1_name
from ..model.flow.reach import EVERYWHERE, DownstreamSearch, Step
from ..model.flow.select import get_kind
from .effects import ASKS, RECEIVING, DownstreamLister, Effect, Hop, Outgoing, group_by_name, list_left_alone

SENDING = frozenset(("publisher", "client", "action client"))
# A value of a parameter that is longer is cut.
_LONGEST_VALUE = 60


class _NamedEdge(NamedTuple):
    """An endpoint by its name at the base and now, empty where it has none; with the endpoint of either side, None for
    one of a program that is not in the workspace."""

    role: str
    before: str
    now: str
    had: Endpoint | None = None
    has: Endpoint | None = None


class LaunchEffects:
    """What a launch file that starts something otherwise reaches, in the graphs of what it starts."""

    def __init__(self, launch: LaunchChange, downstream: DownstreamLister, find_package: Callable[[str], str]):
        self.launch, self.downstream, self.find_package = launch, downstream, find_package
        self.sides = [(graph, DownstreamSearch(graph)) for graph in (launch.before, launch.now)]
        self.endpoints = [group_pairs((one.node, one) for one in graph.endpoints) for graph, _ in self.sides]
        self.named = [group_by_name(graph) for graph, _ in self.sides]

    def describe(self) -> Iterator[Effect]:
        launch = self.launch
        if launch.added or launch.removed:
            nodes = [one.now or one.before for one in launch.nodes]
            ids = tuple(dict.fromkeys(one.name for one in nodes if one is not None and one.kind == "node"))
            edges = self.list_edges(ids, launch.added)
            why = "a new launch file starts" if launch.added else "the launch file is gone; it started"
            change = "added" if launch.added else "removed"
            at = (launch.path, 1)
            yield self.make_effect(change, launch.path, at, ids, edges, f"{why} {format_count(len(ids), 'node')}")
            return
        for pair in launch.nodes:
            yield from self.describe_pair(pair)

    def describe_pair(self, pair: NodeChange) -> Iterator[Effect]:
        before, now = pair.before, pair.now
        one = now or before
        if one is None:
            return
        ids = (one.name,) if one.name else ()
        if before is None or now is None:
            yield self.describe_new(one, now is None)
            return
        renamed = group_pairs((pair.find_cause(edge.before, edge.now), edge) for edge in self.list_renamed(before, now))
        settings: dict[tuple[str, str], list[StartDifference]] = {}
        for difference in pair.differences:
            edges = renamed.get(difference, [])
            at = (difference.path, difference.line)
            if not edges and not now.node:
                edges = list(self.list_named(difference, before, now))
            if difference.what in ("parameter", "file") and not edges:
                settings.setdefault((difference.path, difference.what), []).append(difference)
                continue
            names = dict.fromkeys(name for edge in edges for name in (edge.now or edge.before,))
            subject = now.name if difference.what not in ("remapping", "parameter") else _format_remap(difference)
            if names and difference.what in ("remapping", "parameter"):
                subject = ", ".join(names)
            change = "renamed" if difference.what == "name" or edges else "changed"
            clauses = [_describe_difference(difference), *map(_describe_edge, edges)]
            if now.condition and difference.what != "condition":
                clauses.append(f"started only if {now.condition}")
            why = "; ".join(dict.fromkeys(clauses))
            yield self.make_effect(change, subject, at, ids, edges, why)
        for (path, _), group in settings.items():
            yield self.describe_settings(now, path, group)

    def describe_new(self, node: StartedNode, gone: bool) -> Effect:
        """What is started only now, or, gone, only at the base."""
        change, at, ids = "removed" if gone else "added", (node.path, node.line), (node.name,) if node.name else ()
        if node.kind in ("node", "include"):
            edges = self.list_edges((node.node,), not gone)
            why = f"`{node.program}` is {'no longer started' if gone else 'started'}"
            why += f" only if {node.condition}" * bool(node.condition and not gone)
            return self.make_effect(change, node.name, at, ids, edges, why)
        count = format_count(len(node.parameters), "parameter")
        why = f"{count} {'no longer' if gone else 'now'} set for a node of this name"
        subject = node.name or "parameters of all nodes"
        return msgspec.structs.replace(self.make_effect(change, subject, at, ids, (), why), kind="parameter")

    def describe_settings(self, node: StartedNode, path: str, group: Sequence[StartDifference]) -> Effect:
        """Parameters that a file sets otherwise, which change no name."""
        ids = (node.name,)
        if not node.name:
            asked = {one.name for one in group}
            names = {one.id: one.name for one in self.launch.now.nodes}
            uses = self.launch.now.parameters
            ids = tuple(sorted({u.node for u in uses if resolve_ros1_name(u.name, names.get(u.node, "")) in asked}))
        edges = [edge for edge in self.list_edges(ids, True) if edge.role in SENDING]
        names = [one.name for one in group]
        subject = ", ".join(names[:3]) + f" and {len(names) - 3} more" * (len(names) > 3)
        why = "; ".join(map(_describe_difference, group[:3])) + f"; and {len(group) - 3} more" * (len(group) > 3)
        effect = self.make_effect("changed", subject, (path, group[0].line), ids, edges, why)
        return msgspec.structs.replace(effect, kind="parameter")

    def list_renamed(self, before: StartedNode, now: StartedNode) -> Iterator[_NamedEdge]:
        """Endpoints of a node that have another name, though the code is as it was."""
        rows: list[dict[tuple, dict[str, Endpoint]]] = []
        for side, one in zip(self.endpoints, (before, now), strict=True):
            found: dict[tuple, dict[str, Endpoint]] = {}
            for each in side.get(one.node, ()) if one.node else ():
                if each.topic and not each.implied and each.topic not in EVERYWHERE:
                    key = (each.role, each.path, each.function, each.written, each.variable)
                    found.setdefault(key, {})[each.topic] = each
            rows.append(found)
        for key in rows[0].keys() & rows[1].keys():
            gone = sorted(rows[0][key].keys() - rows[1][key].keys())
            come = sorted(rows[1][key].keys() - rows[0][key].keys())
            for old, new in zip_longest(gone, come, fillvalue=""):
                had, has = rows[0][key].get(old), rows[1][key].get(new)
                yield _NamedEdge(key[0], old, new, had, has)

    def list_named(self, difference: StartDifference, before: StartedNode, now: StartedNode) -> Iterator[_NamedEdge]:
        """The names that a remapping of a program of another package is about, or a parameter whose value is a name of
        the graph; what the program does with them is not known."""
        if difference.what not in ("remapping", "parameter"):
            return
        default = difference.name if difference.what == "remapping" else ""
        texts = [(text or default).partition(" if ")[0] for text in (difference.old, difference.new)]
        pairs = zip(texts, (before, now), strict=True)
        old, new = (resolve_ros1_name(text, one.name) if text else "" for text, one in pairs)
        if old == new:
            return
        if difference.what == "remapping" or any(name in side for name in (old, new) if name for side in self.named):
            yield _NamedEdge("publisher", old, new)

    def list_edges(self, ids: Iterable[str], now: bool) -> list[_NamedEdge]:
        """All that some nodes have, now or at the base."""
        found = (one for id in ids for one in self.endpoints[now].get(id, ()))
        return [
            _NamedEdge(one.role, "", one.topic, None, one) if now else _NamedEdge(one.role, one.topic, "", one, None)
            for one in found
            if one.topic and not one.implied and one.topic not in EVERYWHERE
        ]

    def make_effect(
        self, change: str, subject: str, at: tuple[str, int], ids: tuple[str, ...], edges: Sequence[_NamedEdge],
        why: str,
    ) -> Effect:  # fmt: skip
        hops: dict[str, Hop] = {}
        for side, (_, reach) in enumerate(self.sides):
            out: list[Outgoing] = []
            first: list[Hop] = []
            for edge in edges:
                name, endpoint = (edge.now, edge.has) if side else (edge.before, edge.had)
                if not name:
                    continue
                if edge.role in RECEIVING and endpoint is not None:
                    sent = reach.list_sent_on(endpoint.node, endpoint.path, endpoint.line, True)
                    out.append(Outgoing(endpoint.node, tuple(sent)))
                    first += [
                        self.downstream.make_hop(Step(get_kind(one), name, one.node, one.path, one.line))
                        for one in self.named[side].get(name, ())
                        if one.role == ASKS.get(edge.role) and one.node
                    ]
                elif edge.role in SENDING:
                    out.append(Outgoing(endpoint.node if endpoint is not None else "", ((name, edge.role),)))
            for hop in self.downstream.list_downstream(ids, list(dict.fromkeys(out)), reach, first):
                hops.setdefault(hop.node, hop)
        names = {name for edge in edges for name in (edge.before, edge.now) if name}
        alone = tuple(one for one in list_left_alone(self.named, names) if one.node not in ids)
        return Effect(
            "launch", change, subject, self.find_package(at[0]), *at, ids, tuple(sorted(names)), why,
            tuple(hops.values()), alone,
        )  # fmt: skip


def _format_remap(difference: StartDifference) -> str:
    return f"{difference.name}:={difference.new or difference.old}"


def _describe_difference(difference: StartDifference) -> str:
    what, old, new = difference.what, difference.old, difference.new
    if what == "file":
        named = ", ".join(f"`{path}`" for path in new.split(", "))
        return f"`{difference.name}` is made from {named}, which {'differ' if ',' in new else 'differs'}"
    what = "text of the arguments" if what == "arguments" else what
    named = f"{what} `{difference.name}`" if difference.name else what
    if what == "name":
        return f"the node was `{old}`"
    if not old:
        return f"{named} is new: `{_shorten(new)}`"
    if not new:
        return f"{named} is gone, was `{_shorten(old)}`"
    same = next((place for place, (a, b) in enumerate(zip(old, new, strict=False)) if a != b), 0) - _LONGEST_VALUE // 3
    if same > 0 and max(len(old), len(new)) > _LONGEST_VALUE:
        old, new = f"...{old[same:]}", f"...{new[same:]}"
    return f"{named} is `{_shorten(new)}`, was `{_shorten(old)}`"


def _describe_edge(edge: _NamedEdge) -> str:
    if not edge.before:
        return f"a new {edge.role} of `{edge.now}`"
    role = edge.role if edge.had or edge.has else "name"
    return f"the {role} `{edge.before}` is " + (f"now `{edge.now}`" if edge.now else "gone")


def _shorten(text: str) -> str:
    return text if len(text) <= _LONGEST_VALUE else f"{text[: _LONGEST_VALUE - 3]}..."
