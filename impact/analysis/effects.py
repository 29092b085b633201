"""What an impact is made of: changes, the nodes that they reach, and what they leave without a partner."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Literal, NamedTuple

import msgspec

from ...edges.groups import group_pairs
from ...edges.memory import cache_method
from ..model.flow.edges import OTHER_SIDE
from ..model.flow.graph import Coverage, Endpoint, Graph, Node
from ..model.flow.reach import DownstreamSearch, Step

Kind = Literal["message", "topic", "condition", "trigger", "callback", "launch", "parameter"]
KINDS: tuple[Kind, ...] = ("message", "condition", "trigger", "topic", "callback", "launch", "parameter")
RECEIVING = frozenset(("subscriber", "server", "action server"))
ASKS = {"server": "client", "action server": "action client"}


class Hop(msgspec.Struct, frozen=True):
    """A node that is reached. came: the node before it on the shortest way, empty where it is reached at once. kind,
    name: the topic, service or action between; path, line: of the subscriber or server."""

    node: str
    package: str
    came: str
    kind: str
    name: str
    path: str
    line: int


class LeftEndpoint(msgspec.Struct, frozen=True):
    """An endpoint that a change leaves without any of the other side: a publisher that nothing subscribes to any more,
    a subscriber that nothing feeds, a client without a server."""

    node: str
    role: str
    name: str
    path: str
    line: int


class Effect(msgspec.Struct, frozen=True):
    """A change and what it reaches.

    kind: what is changed: `launch` what a launch file starts, under which names, and `parameter` what it, or a file of
    parameters, sets; change: how (`added`, `removed`, `renamed`, `changed`, or as `rosimpact logic` has it). subject:
    the message, topic, function, node, remapping, parameter or file. path, line: its place now, at the base where it is
    gone. nodes: that have it. topics: that it goes out by, full names. why: what differs, in a clause. reaches: all
    nodes downstream, nearest first. alone: endpoints of other nodes that had a partner by the old name and have none
    now.
    """

    kind: Kind
    change: str
    subject: str
    package: str
    path: str
    line: int
    nodes: tuple[str, ...]
    topics: tuple[str, ...]
    why: str
    reaches: tuple[Hop, ...] = ()
    alone: tuple[LeftEndpoint, ...] = ()


class Impact(msgspec.Struct, frozen=True):
    """All of it. nodes: that are changed or reached; of: how many the workspace has. silent: changed functions of
    which nothing is known to be published because of them. coverage: of the workspace's graph."""

    effects: tuple[Effect, ...]
    nodes: tuple[Node, ...]
    of: int
    silent: int
    coverage: Coverage

    @property
    def reached(self) -> set[str]:
        """Ids of all nodes downstream of a change."""
        return {hop.node for effect in self.effects for hop in effect.reaches}


NOTHING = Impact((), (), 0, 0, Coverage(0, 0, 0, 0))


class Outgoing(NamedTuple):
    """What goes out of a node because of a change: (name, role of who sends)."""

    node: str
    sent: tuple[tuple[str, str], ...]


class DownstreamLister:
    """Lists what lies downstream as hops. packages: of nodes, by id."""

    def __init__(self, packages: Mapping[str, str]):
        self.packages = packages

    def list_downstream(
        self, nodes: Iterable[str], out: Iterable[Outgoing], reach: DownstreamSearch, first: Iterable[Hop] = ()
    ) -> tuple[Hop, ...]:
        """All nodes that what goes out reaches, nearest first, each once. nodes: that are changed themselves; first:
        nodes that are reached at once."""
        own = set(nodes)
        found: dict[str, tuple[int, Hop]] = {}
        for hop in first:
            if hop.node not in own:
                found.setdefault(hop.node, (1, hop))
        near = set(found)
        for one in out:
            for steps, hop in self.find_hops(one, reach):
                known = found.get(hop.node)
                steps += one.node in near
                if hop.node not in own and (known is None or steps < known[0]):
                    found[hop.node] = (steps, hop)
        reported = sorted(found.values(), key=lambda each: each[0])
        return tuple(msgspec.structs.replace(hop, came="") if hop.came in own else hop for _, hop in reported)

    @cache_method
    def find_hops(self, out: Outgoing, reach: DownstreamSearch) -> list[tuple[int, Hop]]:
        return [
            (len(one.steps), self.make_hop(one.steps[-1], one.steps[-2].node if len(one.steps) > 1 else out.node))
            for one in reach.find_downstream(out.sent, out.node)
        ]

    def make_hop(self, step: Step, came: str = "") -> Hop:
        return Hop(step.node, self.packages.get(step.node, ""), came, step.kind, step.name, step.path, step.line)


def group_by_name(graph: Graph) -> dict[str, list[Endpoint]]:
    """Endpoints by the name of their topic, service or action."""
    return group_pairs((one.topic, one) for one in graph.endpoints)


def list_left_alone(
    sides: Sequence[Mapping[str, Sequence[Endpoint]]], names: Iterable[str]
) -> Iterator[LeftEndpoint]:  # fmt: skip
    """Endpoints of some names that had the other side at the base, and have it no more. sides: endpoints of the base
    and now, by name."""
    before, now = sides
    for name in sorted(names):
        had = {(one.role, one.node) for one in before.get(name, ())}
        had_roles, has_roles = {role for role, _ in had}, {one.role for one in now.get(name, ())}
        for one in now.get(name, ()):
            other = OTHER_SIDE[one.role]
            if other in had_roles - has_roles and (one.role, one.node) in had and not one.implied:
                yield LeftEndpoint(one.node, one.role, name, one.path, one.line)


def merge_effects(effects: Iterable[Effect]) -> list[Effect]:
    """Effects of several launch files: those of one change as one, which reaches what it reaches in any of them."""
    found: dict[tuple, Effect] = {}
    for one in effects:
        key = (one.kind, one.change, one.subject, one.path, one.line, one.nodes, one.why)
        known = found.get(key)
        if known is not None:
            hops = {hop.node: hop for hop in (*one.reaches, *known.reaches)}
            one = msgspec.structs.replace(
                known, topics=tuple(sorted({*known.topics, *one.topics})), reaches=tuple(hops.values()),
                alone=tuple(dict.fromkeys((*known.alone, *one.alone))),
            )  # fmt: skip
        found[key] = one
    return list(found.values())
