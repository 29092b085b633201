"""moved-endpoint: a node publishes or reads another topic than at the base, and nobody is at the other side of it.

What it does
    Compares the message flow with the base. Reports a publisher or subscriber whose name was replaced by one that has
    no other side in the workspace, while something else still publishes the old name and something still reads it.

Why it breaks
    The callback no longer runs, or nothing receives the messages. ROS prints no warning.

Severity
    warning for a subscriber; note for a publisher, which may be read from outside.

Example
    self.create_subscription(LaserScan, "scan_rear", self.on_scan, 10)      # was: scan, which is still published

Use instead
    self.create_subscription(LaserScan, "scan", self.on_scan, 10)

Not reported
    Topics that lost a side altogether, see lost-edge; names that are not certain, then or now; workspaces where more
    endpoints than at the base have a name that is not known.
"""

from ...model.flow.edges import OTHER_SIDE, Flow, list_successors
from ...model.flow.workspace import get_flow
from ..vocabulary import At, Diagnostic, Doubt, Text, Workspace, rule

_TOPICS = frozenset(("publisher", "subscriber"))


@rule(
    scope="flow_change",
    severity="warning",
    preview=True,
    group="lost-edge",
    texts={
        "publisher": Text(
            "nothing in the workspace subscribes to `{subject}`, which `{node}` publishes; at the base it published "
            "`{replacement}`, which is still read",
            help="publish `{replacement}`, or subscribe to `{subject}`",
        ),
        "subscriber": Text(
            "nothing in the workspace publishes `{subject}`, which `{node}` reads; at the base it read "
            "`{replacement}`, which is still published",
            help="subscribe to `{replacement}`, or publish `{subject}`",
        ),
    },
)
def moved_endpoint(workspace: Workspace, base: Workspace):
    now, before = (Flow(get_flow(each).system, {}) for each in (workspace, base))
    reported = set()
    for old in before.graph.endpoints:
        if old.role not in _TOPICS or not old.topic or not before.list_others(old) or not now.list_others(old):
            continue
        if old.implied or now.list_alternatives(old) or not before.is_sure(old):
            continue
        has = now.known.get(("topic", old.topic), ())
        successors = {one.topic: one for one in list_successors(now, before, old, {old.node})}
        if len(successors) != 1 or not any(one.role == old.role for one in has):
            continue
        (one,) = successors.values()
        other = OTHER_SIDE[old.role]
        if now.list_others(one) or not now.is_sure(one) or now.count_unknown(other) > before.count_unknown(other):
            continue
        if (one.path, one.line, one.topic) not in reported:
            reported.add((one.path, one.line, one.topic))
            node = now.nodes[one.node]
            yield Diagnostic(
                At(one.path, one.line),
                one.topic,
                node.package,
                {"node": node.executable or node.id, "replacement": old.topic},
                kind=old.role,
                doubts=(Doubt.CHANGED,) if old.role == "publisher" else (),
            )
