"""What a change reaches downstream: from a node or topic to subscribers, and on to what their callbacks publish."""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from typing import NamedTuple

from ....edges.groups import group_pairs
from .graph import Graph, Publish

# Topics through which everything would reach everything.
EVERYWHERE = frozenset(("/rosout", "/parameter_events", "/diagnostics", "/clock"))
_SENDS = {"publisher": "subscriber", "client": "server", "action client": "action server"}
_KINDS = {"subscriber": "topic", "server": "service", "action server": "action"}


class Step(NamedTuple):
    """From one node to the next. kind: topic, service or action; path, line: of the subscriber or server."""

    kind: str
    name: str
    node: str
    path: str
    line: int


class ReachedNode(NamedTuple):
    """A node that is reached, and the shortest way there."""

    node: str
    steps: tuple[Step, ...]


class DownstreamSearch:
    """Asks a graph what lies downstream."""

    def __init__(self, graph: Graph):
        self.graph = graph
        named = (one for one in graph.endpoints if one.topic and one.node)
        self._receivers = group_pairs(((one.role, one.topic), one) for one in named)
        self._publishes = group_pairs((publish.node, publish) for publish in graph.publishes)
        clients = (one for one in graph.endpoints if one.role in ("client", "action client"))
        self._calls = group_pairs((one.node, one) for one in clients)

    def find_downstream(self, sent: Iterable[tuple[str, str]], node: str = "") -> list[ReachedNode]:
        """Nodes downstream of some topics, services and actions (name, role of who sends), nearest first. node: who
        sends them, which is left out."""
        first = [step for topic, role in sent for step in self._list_next(topic, role)]
        return [reached for reached in self._walk(first) if reached.node != node]

    def list_sent_on(self, node: str, path: str, line: int, stored: bool) -> list[tuple[str, str]]:
        """What a node may send because of a subscriber, server or timer that is made at a place, given as to
        find_downstream(). It is what the callback publishes; where that is nothing, and with stored, what timers and
        loops publish."""
        own, others = [], []
        for publish in self._publishes.get(node, ()):
            if publish.topic:
                mine = any((one.path, one.line) == (path, line) for one in publish.triggers)
                if mine:
                    own.append((publish.topic, "publisher"))
                elif stored and self._may_follow(publish, Step("topic", "", node, path, line)):
                    others.append((publish.topic, "publisher"))
        return list(dict.fromkeys(own or others))

    def _walk(self, first: Iterable[Step]) -> list[ReachedNode]:
        found: dict[str, ReachedNode] = {}
        queue: deque[tuple[Step, ...]] = deque((step,) for step in first)
        while queue:
            steps = queue.popleft()
            last = steps[-1]
            if last.node in found:
                continue
            found[last.node] = ReachedNode(last.node, steps)
            for topic, role in self._list_sent(last.node, last):
                queue.extend((*steps, step) for step in self._list_next(topic, role) if step.node not in found)
        return list(found.values())

    def _list_next(self, topic: str, role: str) -> Iterator[Step]:
        if topic in EVERYWHERE:
            return
        receiver = _SENDS[role]
        for endpoint in self._receivers.get((receiver, topic), ()):
            yield Step(_KINDS[receiver], topic, endpoint.node, endpoint.path, endpoint.line)

    def _list_sent(self, node: str, came: Step) -> Iterator[tuple[str, str]]:
        """What a node sends on: what may be published because of what came in.

        A publish statement that a timer or loop triggers may send what a callback has stored, so it counts too; one
        that another subscriber's callback alone triggers does not.
        """
        seen = set()
        for publish in self._publishes.get(node, ()):
            if publish.topic and publish.topic not in seen and self._may_follow(publish, came):
                seen.add(publish.topic)
                yield publish.topic, "publisher"
        for endpoint in self._calls.get(node, ()):
            if endpoint.topic and (endpoint.role, endpoint.topic) not in seen:
                seen.add((endpoint.role, endpoint.topic))
                yield endpoint.topic, endpoint.role

    @staticmethod
    def _may_follow(publish: Publish, came: Step) -> bool:
        return not publish.triggers or any(
            trigger.kind not in ("subscriber", "service", "action")
            or (trigger.path, trigger.line) == (came.path, came.line)
            for trigger in publish.triggers
        )
