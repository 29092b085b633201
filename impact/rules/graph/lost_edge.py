"""lost-edge: a publisher and a subscriber that were connected at the base are no longer connected.

What it does
    Compares the message flow with the base, as launch files start it. Reports topics that had a publisher and a
    subscriber, and have only one of them now: the other was removed, or uses another name. Reports a node, too, that
    publishes or reads another topic than at the base, if nobody is at the other side of that one.

Why it breaks
    The subscriber's callback no longer runs, or nothing receives the messages. ROS prints no warning.

Severity
    warning when the subscriber is left, or when the removed side now uses another name; note when the subscriber was
    removed and the publisher is left, or when a publisher has a new name that nobody reads.

Example
    self.create_publisher(LaserScan, "scan_front", 10)           # was: scan; the planner still reads scan

Use instead
    self.create_publisher(LaserScan, "scan", 10)

Not reported
    Topics of which both sides were removed, or got the same new name; topics that an endpoint whose name is not known
    may use; endpoints whose name was not known at the base.
"""

from collections.abc import Iterator

from ...model.flow.edges import Flow
from ...model.flow.graph import Endpoint
from ...model.flow.workspace import get_flow
from ..vocabulary import At, Diagnostic, Doubt, Text, Workspace, rule

_OTHER = {"publisher": "subscriber", "subscriber": "publisher"}


@rule(
    scope="flow_change",
    severity="warning",
    preview=True,
    texts={
        "no publisher": Text(
            "nothing publishes `{subject}` any more; `{node}` did at the base",
            help="publish `{subject}`, or remove the subscriber",
        ),
        "publisher renamed": Text(
            "nothing publishes `{subject}` any more; `{node}` did at the base, and now publishes `{replacement}`",
            help="subscribe to `{replacement}`",
        ),
        "no subscriber": Text(
            "nothing subscribes to `{subject}` any more; `{node}` did at the base",
            help="subscribe to `{subject}`, or remove the publisher",
        ),
        "subscriber renamed": Text(
            "nothing subscribes to `{subject}` any more; `{node}` did at the base, and now reads `{replacement}`",
            help="publish `{replacement}`",
        ),
        "publisher moved": Text(
            "nothing in the workspace subscribes to `{subject}`, which `{node}` publishes; at the base it published "
            "`{replacement}`, which is still read",
            help="publish `{replacement}`, or subscribe to `{subject}`",
        ),
        "subscriber moved": Text(
            "nothing in the workspace publishes `{subject}`, which `{node}` reads; at the base it read "
            "`{replacement}`, which is still published",
            help="subscribe to `{replacement}`, or publish `{subject}`",
        ),
    },
)
def lost_edge(workspace: Workspace, base: Workspace):
    now, before = (Flow(get_flow(each).system, {}) for each in (workspace, base))
    yield from _find_moved(now, before)
    reported = set()
    for topic in sorted({topic for kind, topic in before.known if kind == "topic"}):
        had, has = _list_sides(before, topic), _list_sides(now, topic)
        for role, gone in _OTHER.items():
            left = [one for one in has[role] if not one.implied]
            if not had[role] or not had[gone] or not left or has[gone]:
                continue
            if _count_unknown(now, gone) > _count_unknown(before, gone):
                continue
            at, old = left[0], had[gone][0]
            if (at.path, at.line) in reported:
                continue
            reported.add((at.path, at.line))
            successors = sorted({one.topic for one in _find_successors(now, before, old)})
            renamed = len(successors) == 1
            node = now.nodes[old.node].executable if renamed and old.node in now.nodes else old.node.rpartition("/")[2]
            yield Diagnostic(
                At(at.path, at.line),
                topic,
                now.nodes[at.node].package if at.node in now.nodes else "",
                {"node": node or old.node, "replacement": successors[0] if renamed else ""},
                kind=f"{gone} renamed" if renamed else f"no {gone}",
                doubts=(Doubt.CHANGED,) if role == "publisher" and not successors else (),
            )


def _find_moved(now: Flow, before: Flow) -> Iterator[Diagnostic]:
    """Endpoints that had another side at the base and have none under their new name, while the old name has both."""
    reported = set()
    for old in before.graph.endpoints:
        if old.role not in _OTHER or not old.topic or not before.list_others(old) or not now.list_others(old):
            continue
        if old.implied or now.list_alternatives(old) or not before.is_sure(old):
            continue
        has = now.known.get(("topic", old.topic), ())
        successors = {one.topic: one for one in _find_successors(now, before, old)}
        if len(successors) != 1 or not any(one.role == old.role for one in has):
            continue
        (one,) = successors.values()
        other = _OTHER[old.role]
        if now.list_others(one) or not now.is_sure(one) or _count_unknown(now, other) > _count_unknown(before, other):
            continue
        if (one.path, one.line, one.topic) not in reported:
            reported.add((one.path, one.line, one.topic))
            node = now.nodes[one.node]
            yield Diagnostic(
                At(one.path, one.line),
                one.topic,
                node.package,
                {"node": node.executable or node.id, "replacement": old.topic},
                kind=f"{old.role} moved",
                doubts=(Doubt.CHANGED,) if old.role == "publisher" else (),
            )


def _count_unknown(flow: Flow, role: str) -> int:
    """How many endpoints of a role have no known name."""
    return sum(one.role == role and not one.topic for one in flow.graph.endpoints)


def _list_sides(flow: Flow, topic: str) -> dict[str, list[Endpoint]]:
    """Publishers and subscribers of a topic."""
    every = flow.known.get(("topic", topic), ())
    return {role: [one for one in every if one.role == role] for role in _OTHER}


def _find_successors(now: Flow, before: Flow, old: Endpoint) -> Iterator[Endpoint]:
    """What the same node has now, of the same role and type, that it did not have at the base."""
    for one in now.graph.endpoints:
        if one.node == old.node and one.role == old.role and one.type == old.type and one.topic:
            known = before.known.get(("topic", one.topic), ())
            if not any(each.node == one.node and each.role == one.role for each in known):
                yield one
