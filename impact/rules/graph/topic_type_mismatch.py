"""topic-type-mismatch: one side of a topic, service or action has another type than the other.

What it does
    Reports a publisher and a subscriber (a server and a client) of one name whose types differ. Both names have to be
    certain: written in the source, or told by the launch file that starts the nodes.

Why it breaks
    ROS 2 does not match them, and says nothing; ROS 1 prints an error and closes the connection. No message arrives.

Severity
    error when a launch file of the workspace starts both; warning when nothing tells that both run together, and
    neither has anybody else in the workspace to talk to.

Example
    self.create_publisher(Twist, "cmd_vel", 10)                  # teleop
    self.create_subscription(TwistStamped, "cmd_vel", ...)       # base

Use instead
    self.create_publisher(TwistStamped, "cmd_vel", 10)

Not reported
    Nodes that have several types for one name, of which one fits; types that are not messages by themselves (type
    adapters).
"""

from ...model.cmake.build import At
from ...model.flow.edges import met, said, uncompared
from ...model.workspace import Workspace
from ..rule import Hit, rule

_WHAT = {"subscriber": "topic", "client": "service", "action client": "action"}


@rule(severity="warning", preview=True, flow=True)
def topic_type_mismatch(workspace: Workspace):
    for taker, number in uncompared(workspace):
        yield Hit(
            At(taker.path, taker.line),
            taker.topic,
            f"too many meet at the {_WHAT[taker.role]} `{taker.topic}`: {number:,} pairs were not compared",
            severity="note",
        )
    for pair in met(workspace):
        giver, taker = pair.giver.endpoint, pair.taker.endpoint
        given, taken = pair.flow.type_of(giver), pair.flow.type_of(taker)
        if not given or not taken or given == taken:
            continue
        if {one.type for one in pair.flow.of_node(giver)} & {one.type for one in pair.flow.of_node(taker)}:
            continue
        if any("" in (one.type, pair.flow.type_of(one)) for one in pair.flow.of_node(giver) + pair.flow.of_node(taker)):
            continue
        verb = "publishes" if giver.role == "publisher" else "serves"
        what = _WHAT[taker.role]
        yield Hit(
            At(taker.path, taker.line),
            taker.topic,
            f"the {what} `{taker.topic}` is `{taken}` here, but `{said(pair.giver.node)}` {verb} it as `{given}` "
            f"({giver.path}:{giver.line}){pair.together}",
            f"use one type on both sides of `{taker.topic}`",
            pair.taker.node.package,
            severity="error" if pair.launch else "warning",
        )
