"""near-miss-name: a subscriber without a publisher uses nearly the name of a topic that is published.

What it does
    Reports a subscriber without a publisher if a publisher without a subscriber uses nearly the same name: it differs
    by a letter, a plural, an underscore, or upper and lower case. Both have the same type, and both names are known. If
    a launch file starts both, and only nodes whose code is in the workspace, a namespace that one of them lacks counts
    too.

Why it breaks
    The subscriber never receives a message. ROS prints no warning.

Example
    self.create_publisher(Odometry, "wheel_odom", 10)
    self.create_subscription(Odometry, "wheels_odom", self.on_odom, 10)

Use instead
    self.create_subscription(Odometry, "wheel_odom", self.on_odom, 10)

Not reported
    Names that differ in digits or sides (`camera1`, `left`); topics of a type that a publisher whose name is not known
    has; files that publish more, of which nothing is known.
"""

from ...model.flow.edges import Flow, Sure, build_system_flow, get_label, list_flows
from ...model.flow.misspelling import NearNames, is_slip_of_name
from ...model.flow.workspace import get_flow
from ..vocabulary import At, Diagnostic, Text, Workspace, rule


@rule(
    scope="flow",
    severity="warning",
    preview=True,
    texts=Text(
        "nothing in {launch:the workspace} publishes `{subject}`, but `{node}` publishes `{replacement}` ({place}), "
        "which has no subscriber",
        help="subscribe to `{replacement}`, or publish `{subject}`",
    ),
)
def near_miss_name(workspace: Workspace):
    closed = {launch.path for launch in get_flow(workspace).launches if not launch.missing}
    reported = set()
    for path, flow in list_flows(workspace):
        for taker, giver in _find_near_pairs(flow if path else build_system_flow(workspace), path in closed):
            one, other = taker.endpoint, giver.endpoint
            if (one.path, one.line) in reported:
                continue
            reported.add((one.path, one.line))
            data = {
                "launch": (path,) if path else (),
                "node": get_label(giver.node),
                "replacement": other.topic,
                "place": f"{other.path}:{other.line}",
            }
            yield Diagnostic(At(one.path, one.line), one.topic, taker.node.package, data)


def _find_near_pairs(flow: Flow, closed: bool):
    """Subscribers that nobody feeds, each with the only publisher of nearly its name that nobody reads. closed: whether
    all that runs is known, so that namespaces can be compared."""
    unread: dict[str, list[tuple[str, Sure]]] = {}
    for one in flow.list_sure("publisher"):
        if not one.endpoint.implied and not flow.list_others(one.endpoint):
            unread.setdefault(flow.find_type(one.endpoint), []).append((one.endpoint.topic, one))
    near = {type_: NearNames(givers, namespaces=closed) for type_, givers in unread.items()}
    for taker in flow.list_sure("subscriber"):
        one = taker.endpoint
        type_ = flow.find_type(one)
        if not type_ or one.implied or flow.list_others(one):
            continue
        if flow.may_have("publisher", type_, one.topic, typed=True):
            continue
        open_ = flow.may_have("publisher", type_)
        found: dict[str, Sure] = {}
        for giver in near[type_].find_near(one.topic) if type_ in near else ():
            other = giver.endpoint
            likely = is_slip_of_name(one.topic, other.topic) and not flow.may_publish_more(other.path)
            if giver.node.id != taker.node.id and (likely or not open_):
                found.setdefault(other.topic, giver)
        if len(found) == 1:
            yield taker, next(iter(found.values()))
