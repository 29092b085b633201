"""topic-type-mismatch: the two sides of a topic, service or action have different types.

What it does
    Reports a publisher and a subscriber (a server and a client) of one name whose types differ. Both names have to be
    known: from the source, or from the launch file that starts the nodes. Reports a subscriber, too, that expects
    another type from a tool of RViz (`/initialpose`, `/clicked_point`, the goal), if nothing in the workspace publishes
    there.

Why it breaks
    ROS 2 does not connect them and prints nothing; ROS 1 prints an error and closes the connection. No message arrives.

Severity
    error when a launch file of the workspace starts both; warning when it is not known that both run together, and
    neither has another partner in the workspace.

Example
    self.create_publisher(Twist, "cmd_vel", 10)                  # teleop
    self.create_subscription(TwistStamped, "cmd_vel", ...)       # base

Use instead
    self.create_publisher(TwistStamped, "cmd_vel", 10)

Not reported
    Nodes that use several types for one name, if one of them fits; type adapters.
"""

from ...model.flow.edges import FlowPair, build_unstarted_flow, list_flows, list_met_pairs, list_uncompared
from ..qos.offers import make_diagnostic
from ..vocabulary import At, Diagnostic, Doubt, Text, Workspace, rule

_RVIZ = {
    "/initialpose": "geometry_msgs/PoseWithCovarianceStamped",
    "/clicked_point": "geometry_msgs/PointStamped",
    "/goal_pose": "geometry_msgs/PoseStamped",
    "/move_base_simple/goal": "geometry_msgs/PoseStamped",
}
_WHAT = {"subscriber": "topic", "client": "service", "action client": "action"}


@rule(
    scope="flow",
    preview=True,
    texts={
        "mismatch": Text(
            "the type of the {what} `{subject}` is `{type}` here, but `{other}` in `{node}` ({place})"
            "[[; `{launch}` starts both]]",
            help="use one type on both sides of `{subject}`",
        ),
        "tool": Text(
            "the type of the topic `{subject}` is `{type}` here, but RViz publishes `{other}` there",
            help="expect `{other}`, or subscribe to another topic",
        ),
        "uncompared": Text("too many nodes use the {what} `{subject}`: {count:,} pairs were not compared"),
    },
)
def topic_type_mismatch(workspace: Workspace):
    for taker, number in list_uncompared(workspace):
        data = {"what": _WHAT[taker.role], "count": number}
        yield Diagnostic(At(taker.path, taker.line), taker.topic, "", data, "uncompared", (Doubt.UNCHECKED,))
    for pair in list_met_pairs(workspace):
        giver, taker = pair.giver.endpoint, pair.taker.endpoint
        other, type = pair.flow.find_type(giver), pair.flow.find_type(taker)
        if other and type and other != type and not _may_have_another_type(pair):
            found = make_diagnostic(pair, "mismatch", what=_WHAT[taker.role], type=type, other=other)
            yield found._replace(doubts=() if pair.launch else (Doubt.CONDITIONAL,))
    yield from _find_wrong_for_tools(workspace)


def _find_wrong_for_tools(workspace: Workspace):
    """Subscribers of what the tools of RViz publish, that expect another type."""
    reported = set()
    for path, flow in list_flows(workspace):
        for one in (flow if path else build_unstarted_flow(workspace)).list_sure("subscriber"):
            taker, other = one.endpoint, _RVIZ.get(one.endpoint.topic, "")
            type = flow.find_type(taker) if other else ""
            if not type or type == other or (taker.path, taker.line) in reported or flow.list_others(taker):
                continue
            if any(each.type in ("", other) for each in flow.list_alternatives(taker)):
                continue
            reported.add((taker.path, taker.line))
            data = {"type": type, "other": other}
            at = At(taker.path, taker.line)
            yield Diagnostic(at, taker.topic, one.node.package, data, "tool", (Doubt.CONDITIONAL,))


def _may_have_another_type(pair: FlowPair) -> bool:
    """Whether a side has several types for the name, of which one may fit."""
    giver, taker = (pair.flow.list_alternatives(side.endpoint) for side in (pair.giver, pair.taker))
    if {one.type for one in giver} & {one.type for one in taker}:
        return True
    return any("" in (one.type, pair.flow.find_type(one)) for one in giver + taker)
