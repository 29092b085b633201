"""lost-edge: a publisher and a subscriber of the base no longer meet.

What it does
    Compares the message flow with the base. Reports a topic that had a publisher and a subscriber, and of which only
    one side is left: the other was removed, or goes by another name.

Why it breaks
    The subscriber's callback no longer runs, or what is published reaches nobody; nothing says so.

Severity
    warning when the subscriber is left, or when the side that is gone goes on under another name; note when the
    subscriber was removed and the publisher is left.

Example
    self.create_publisher(LaserScan, "scan_front", 10)           # was: scan; the planner still reads scan

Use instead
    self.create_publisher(LaserScan, "scan", 10)

Not reported
    Topics of which both sides are gone, or got the same new name; topics that something of an unknown name may go on
    with; what an unknown name had at the base.
"""

from __future__ import annotations

from collections.abc import Iterator

from ...model.cmake.build import At
from ...model.flow.edges import Flow
from ...model.flow.graph import Endpoint
from ...model.workspace import Workspace
from ..rule import Hit, rule

_OTHER = {"publisher": "subscriber", "subscriber": "publisher"}
_DOES = {"publisher": "publishes", "subscriber": "reads"}


@rule(severity="warning", preview=True, compares=True, flow=True)
def lost_edge(workspace: Workspace, base: Workspace):
    now, before = (Flow(each.flow, {}) for each in (workspace, base))
    for topic in sorted({topic for kind, topic in before.known if kind == "topic"}):
        had, has = _sides(before, topic), _sides(now, topic)
        for role, gone in _OTHER.items():
            left = [one for one in has[role] if not one.implied]
            if not had[role] or not had[gone] or not left or has[gone]:
                continue
            if _unknown(now, gone) > _unknown(before, gone):
                continue
            at, old = left[0], had[gone][0]
            successors = sorted({one.topic for one in _successors(now, before, old)})
            severity = "note" if role == "publisher" and not successors else "warning"
            went = f", which {_DOES[gone]} `{successors[0]}` now" if len(successors) == 1 else ""
            who = now.nodes[old.node].executable if went and old.node in now.nodes else old.node.rpartition("/")[2]
            yield Hit(
                At(at.path, at.line),
                topic,
                f"nothing {_DOES[gone]} `{topic}` any more; at the base `{who or old.node}` did{went}",
                _cure(role, topic, successors),
                now.nodes[at.node].package if at.node in now.nodes else "",
                severity=severity,
            )


def _unknown(flow: Flow, role: str) -> int:
    """How many endpoints of a role have no known name."""
    return sum(one.role == role and not one.topic for one in flow.graph.endpoints)


def _sides(flow: Flow, topic: str) -> dict[str, list[Endpoint]]:
    """Publishers and subscribers of a topic."""
    every = flow.known.get(("topic", topic), ())
    return {role: [one for one in every if one.role == role] for role in _OTHER}


def _successors(now: Flow, before: Flow, old: Endpoint) -> Iterator[Endpoint]:
    """What the same node has now, of the same role and type, that it did not have at the base."""
    for one in now.graph.endpoints:
        if one.node == old.node and one.role == old.role and one.type == old.type and one.topic:
            known = before.known.get(("topic", one.topic), ())
            if not any(each.node == one.node and each.role == one.role for each in known):
                yield one


def _cure(role: str, topic: str, successors: list[str]) -> str:
    if role == "subscriber":
        return f"subscribe to `{successors[0]}`" if len(successors) == 1 else f"publish `{topic}`, or stop reading it"
    return f"publish `{successors[0]}`" if len(successors) == 1 else f"subscribe to `{topic}`, or stop publishing it"
