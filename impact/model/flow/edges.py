"""What of a workspace's message flow is sure enough to be judged: endpoints of one certain name, and their pairs."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Collection, Iterator, Mapping
from functools import cached_property
from typing import NamedTuple

from ....edges.groups import group_pairs
from ....edges.memory import cache_in_derived
from ..workspace import Workspace
from .defined import list_released
from .graph import Endpoint, Graph, Node
from .launches import Launch
from .names import is_open
from .select import get_kind
from .workspace import get_flow

# Of these the workspace says what runs; plugins and libraries get their names from whoever loads them, but for names
# that begin with a slash.
_RUNNING = frozenset(("executable", "script", "component", "nodelet"))
# A type of a package outside of the workspace may be a class that stands for a message.
_INTERFACES = ("_msgs", "_interfaces", "_srvs", "_actions", "turtlesim", "dynamic_reconfigure")
SURE = frozenset(("literal", "given", "launch"))
OTHER_SIDE = {
    "publisher": "subscriber", "subscriber": "publisher", "server": "client", "client": "server",
    "action server": "action client", "action client": "action server",
}  # fmt: skip
# The written name begins with a text, to which more is added.
_ABSOLUTE = re.compile(r'"(/[\w/]+)" *\+')
# Pairs that are looked at under one name: publishers times subscribers, which hostile code has by the ten thousand.
_MOST_PAIRS = 10_000
_MOST_PAIRS_IN_ALL = 100_000
_SIDES = (("publisher", "subscriber"), ("server", "client"), ("action server", "action client"))


class Sure(NamedTuple):
    """An endpoint whose name is certain, with the node that runs it."""

    node: Node
    endpoint: Endpoint


class FlowPair(NamedTuple):
    """A publisher (or server) and a subscriber (or client) of one name, in a flow. launch: the launch file that surely
    starts both, empty where nothing tells that they run together."""

    flow: Flow
    giver: Sure
    taker: Sure
    launch: str = ""


class Flow:
    """A graph, asked for what is sure in it. surely: ids of nodes that surely run under their names, all when None.
    around: the flow of the whole workspace, this one when None."""

    def __init__(
        self,
        graph: Graph,
        interfaces: Mapping[str, set[str]],
        surely: set[str] | None = None,
        around: Flow | None = None,
    ):
        self.graph, self.interfaces, self.surely, self.around = graph, interfaces, surely, around
        self.nodes = {node.id: node for node in graph.nodes}
        places = ((one, (one.node, one.role, one.path, one.line, one.written)) for one in graph.endpoints)
        names = group_pairs((place, one.topic) for one, place in places)
        self._alone = {place for place, topics in names.items() if len(set(topics)) == 1}
        named = [one for one in graph.endpoints if one.topic]
        self.known = group_pairs(((get_kind(one), one.topic), one) for one in named)
        self._of_role: dict[tuple[str, str], list[Endpoint]] = group_pairs(
            ((one.role, one.topic), one) for one in named
        )
        self._of_node = group_pairs(((one.node, one.role, one.topic), one) for one in named)

    def list_sure(self, *roles: str) -> Iterator[Sure]:
        """Endpoints whose name is certain, of some roles or of all: in the order of the graph."""
        for one in self.graph.endpoints:
            node = self.nodes.get(one.node)
            if node is None or (roles and one.role not in roles) or not self.is_sure(one):
                continue
            if self.surely is None or node.id in self.surely:
                yield Sure(node, one)

    def is_sure(self, one: Endpoint) -> bool:
        """Whether an endpoint has one certain name, and belongs to something that surely runs by itself."""
        node = self.nodes.get(one.node)
        runs = node is not None and node.kind in _RUNNING and (node.line or node.kind != "executable")
        if node is not None and node.kind == "plugin":
            runs = begins(one, "/") and one.how == "literal"
        alone = (one.node, one.role, one.path, one.line, one.written) in self._alone
        return bool(runs and one.topic and one.how in SURE and alone)

    def find_type(self, endpoint: Endpoint) -> str:
        """The type of an endpoint, empty where it is not known to be a message's (or a service's, or an action's)."""
        package, _, name = endpoint.type.partition("/")
        own = self.interfaces.get(package)
        if own is None:
            own = list_released(package, self.graph.ros)
        known = name in own if own else package.endswith(_INTERFACES)
        return endpoint.type if name and known else ""

    def list_others(self, endpoint: Endpoint) -> list[Endpoint]:
        """The other side of an endpoint's topic, service or action, sure or not."""
        return self._of_role.get((OTHER_SIDE[endpoint.role], endpoint.topic), [])

    def count_unknown(self, role: str) -> int:
        """How many endpoints of a role have no name that is known, or in part only."""
        return sum(one.role == role and (not one.topic or one.how == "partly") for one in self.graph.endpoints)

    def may_have(self, role: str, type_: str, topic: str = "", *, typed: bool = False) -> bool:
        """Whether something in the workspace of this role and type has a name that is not known or not certain, or
        publishes what is not known. topic: only if the name may be this, as far as its beginning is known. typed: only
        if it is known to have the type."""
        unsure = self._unsure.get(role, {})
        types = (type_,) if typed else (type_, "", "*")
        return any(not topic or topic.startswith(head) for each in types for head in unsure.get(each, ()))

    @cached_property
    def _unsure(self) -> dict[str, dict[str, set[str]]]:
        """By role and type, how the names begin: empty where that is not known."""
        if self.around is not None:
            return self.around._unsure
        found: dict[str, dict[str, set[str]]] = {}
        for one in self.graph.endpoints:
            if not self.is_sure(one):
                head = _ABSOLUTE.match(one.written) if not one.topic else None
                begins_so = head[1] if head else one.topic.partition("<")[0] if is_open(one.topic) else ""
                found.setdefault(one.role, {}).setdefault(one.type, set()).add(begins_so)
        if self._unclear:
            found.setdefault("publisher", {}).setdefault("", set()).add("")
        return found

    @cached_property
    def _unclear(self) -> set[str]:
        """Files that publish through something that is not seen to be made anywhere, as a wrapper that is not
        followed."""
        unresolved = self.graph.coverage.unresolved
        return {one.path for one in unresolved if one.what == "publish" and "which publisher" in one.reason}

    def may_publish_more(self, path: str) -> bool:
        """Whether a file publishes what is not known, too."""
        return path in (self.around or self)._unclear

    def list_alternatives(self, one: Endpoint) -> list[Endpoint]:
        """Everything of the same node and role at the same name: code may choose among several."""
        return self._of_node.get((one.node, one.role, one.topic), [])

    def list_pairs(self, launch: str = "") -> Iterator[FlowPair]:
        """Every two sure endpoints that meet under a name, each two places of source once; of a name that very many
        meet under, the first."""
        seen = set()
        in_all = _MOST_PAIRS_IN_ALL
        for giving, taking in _SIDES:
            givers = group_pairs((one.endpoint.topic, one) for one in self.list_sure(giving))
            left = dict.fromkeys(givers, _MOST_PAIRS)
            for taker in self.list_sure(taking):
                topic = taker.endpoint.topic
                for giver in givers.get(topic, ())[: min(left.get(topic, 0), in_all)]:
                    left[topic] -= 1
                    in_all -= 1
                    key = (*_get_place(giver.endpoint), *_get_place(taker.endpoint))
                    if key not in seen:
                        seen.add(key)
                        yield FlowPair(self, giver, taker, launch)


def list_uncompared(workspace: Workspace) -> Iterator[tuple[Endpoint, int]]:
    """Subscribers and clients at names that too many meet under: the first at each, and how many pairs pairs() leaves
    out there."""
    seen = set()
    for _, flow in list_flows(workspace):
        in_all = _MOST_PAIRS_IN_ALL
        for giving, taking in _SIDES:
            givers = Counter(one.endpoint.topic for one in flow.list_sure(giving))
            takers = group_pairs((one.endpoint.topic, one.endpoint) for one in flow.list_sure(taking))
            for topic, listed in takers.items():
                number = givers[topic] * len(listed)
                compared = min(number, _MOST_PAIRS, in_all)
                in_all -= compared
                if compared < number and (giving, topic) not in seen:
                    seen.add((giving, topic))
                    yield listed[0], number - compared


@cache_in_derived
def list_flows(workspace: Workspace) -> list[tuple[str, Flow]]:
    """What each launch file surely starts, by its path; then the whole workspace, with an empty path."""
    whole = build_whole_flow(workspace)
    started = [(launch.path, build_launched_flow(whole, launch)) for launch in get_flow(workspace).launches]
    return [*started, ("", whole)]


@cache_in_derived
def build_whole_flow(workspace: Workspace) -> Flow:
    """The flow of a whole workspace, under the names that its source gives."""
    names = {each.name: workspace.interface_names.get(each.name, set()) for each in workspace}
    return Flow(get_flow(workspace).graph, names)


def build_launched_flow(whole: Flow, launch: Launch) -> Flow:
    """The flow of what a launch file surely starts."""
    surely = {start.node for start in launch.starts if not start.uncertain}
    return Flow(launch.graph, whole.interfaces, surely, whole)


@cache_in_derived
def build_system_flow(workspace: Workspace) -> Flow:
    """The flow of all that launch files start, and of the programs that none of them does."""
    whole = build_whole_flow(workspace)
    graph = get_flow(workspace).system
    return Flow(graph, whole.interfaces, {node.id for node in graph.nodes if not node.uncertain}, whole)


@cache_in_derived
def list_met_pairs(workspace: Workspace) -> list[FlowPair]:
    """Pairs that a launch file starts, then pairs that nothing starts together and that have nobody else to talk to:
    the workspace's programs need not be made to run together, but these have no other use. What launch files start of
    the latter has to go by the same name there."""
    seen = set()
    found: list[FlowPair] = []
    started = _Started(workspace)
    for launch, flow in list_flows(workspace):
        for pair in flow.list_pairs(launch):
            key = (*_get_place(pair.giver.endpoint), *_get_place(pair.taker.endpoint))
            if key in seen or (not launch and not (started.may_meet(pair) and _lacks_other_partner(flow, pair))):
                continue
            seen.add(key)
            found.append(pair)
    return found


class _Started:
    """The programs that launch files start, with the names that they have there."""

    def __init__(self, workspace: Workspace):
        self._names: dict[str, set[str]] = {}
        self._together: list[set[str]] = []
        for launch in get_flow(workspace).launches:
            programs = {start.node: start.program for start in launch.starts}
            self._together.append(set(programs.values()))
            for program in programs.values():
                self._names.setdefault(program, set())
            for one in launch.graph.endpoints:
                if one.node in programs:
                    self._names[programs[one.node]].add(one.topic)

    def may_meet(self, pair: FlowPair) -> bool:
        """Whether two programs that no launch file starts together have the names that the source gives."""
        sides = (pair.giver, pair.taker)
        if any({side.node.id for side in sides} <= together for together in self._together):
            return False
        return all(side.endpoint.topic in self._names.get(side.node.id, {side.endpoint.topic}) for side in sides)


def build_unstarted_flow(workspace: Workspace) -> Flow:
    """The workspace's flow as far as no launch file starts its nodes: these have the names that the source gives."""
    whole = build_whole_flow(workspace)
    started = {start.program for launch in get_flow(workspace).launches for start in launch.starts}
    return Flow(whole.graph, whole.interfaces, whole.nodes.keys() - started, whole)


def _lacks_other_partner(flow: Flow, pair: FlowPair) -> bool:
    """Whether neither side has a partner of its own type in the workspace."""
    giver, taker = pair.giver.endpoint, pair.taker.endpoint
    return not (
        any(_fits_type(giver, other) for other in flow.list_others(giver) if _get_place(other) != _get_place(taker))
        or any(_fits_type(taker, other) for other in flow.list_others(taker) if _get_place(other) != _get_place(giver))
    )


def _fits_type(one: Endpoint, other: Endpoint) -> bool:
    return one.type == other.type or not one.type or not other.type or "*" in (one.type, other.type)


def _get_place(endpoint: Endpoint) -> tuple[str, int]:
    return endpoint.path, endpoint.line


def begins(endpoint: Endpoint, with_: str) -> bool:
    """Whether the code writes an endpoint's name out, and begins it with this: `/` or `~`."""
    return endpoint.written.startswith(f'"{with_}')


def get_label(node: Node) -> str:
    """A node as a message names it: its name in a running system where a launch tells it, else what is started."""
    return node.name if node.started else node.executable or node.plugin or node.id


def list_successors(now: Flow, before: Flow, old: Endpoint, nodes: Collection[str]) -> Iterator[Endpoint]:
    """What the same node has now, of the same role and type, that it did not have at the base. nodes: its ids."""
    for one in now.graph.endpoints:
        if one.node in nodes and one.role == old.role and one.type == old.type and one.topic:
            known = before.known.get((get_kind(old), one.topic), ())
            if not any(each.node in nodes and each.role == one.role for each in known):
                yield one
