"""near-miss-name: a subscriber that nobody feeds listens to nearly the name that somebody publishes.

What it does
    Reports a subscriber without a publisher whose topic differs from one that is published, and that nobody reads, by a
    slip: a letter, a plural, an underscore, upper and lower case. Both have the same type and certain names. Where a
    launch file starts both, and nothing whose code is not in the workspace, a namespace that one of them lacks counts
    too.

Why it breaks
    The subscriber waits for ever; nothing says so.

Severity
    warning.

Example
    self.create_publisher(Odometry, "wheel_odom", 10)
    self.create_subscription(Odometry, "wheels_odom", self.on_odom, 10)

Use instead
    self.create_subscription(Odometry, "wheel_odom", self.on_odom, 10)

Not reported
    Names that differ in digits or sides (`camera1`, `left`); topics that something of an unknown name may feed.
"""

from ...model.cmake.build import At
from ...model.flow.edges import Flow, Sure, flows, said, unstarted
from ...model.flow.misspelling import NearNames
from ...model.workspace import Workspace
from ..rule import Hit, rule


@rule(severity="warning", preview=True, flow=True)
def near_miss_name(workspace: Workspace):
    closed = {launch.path for launch in workspace.launches if not launch.missing}
    told = set()
    for path, flow in flows(workspace):
        for taker, giver in _near(flow if path else unstarted(workspace), path in closed):
            one, other = taker.endpoint, giver.endpoint
            if (one.path, one.line) in told:
                continue
            told.add((one.path, one.line))
            where = f" in `{path}`" if path else " in the workspace"
            yield Hit(
                At(one.path, one.line),
                one.topic,
                f"nothing{where} publishes `{one.topic}`, but `{said(giver.node)}` publishes `{other.topic}` "
                f"({other.path}:{other.line}), which nobody reads",
                f"subscribe to `{other.topic}`, or publish `{one.topic}`",
                taker.node.package,
            )


def _near(flow: Flow, closed: bool):
    """Subscribers that nobody feeds, each with the only publisher of nearly its name that nobody reads. closed: whether
    all that runs is known, so that namespaces can be compared."""
    unread: dict[str, list[tuple[str, Sure]]] = {}
    for one in flow.sure("publisher"):
        if not one.endpoint.implied and not flow.others(one.endpoint):
            unread.setdefault(flow.type_of(one.endpoint), []).append((one.endpoint.topic, one))
    near = {type_: NearNames(givers, namespaces=closed) for type_, givers in unread.items()}
    for taker in flow.sure("subscriber"):
        one = taker.endpoint
        type_ = flow.type_of(one)
        if not type_ or one.implied or flow.others(one) or flow.may_have("publisher", type_):
            continue
        found: dict[str, Sure] = {}
        for giver in near[type_].near(one.topic) if type_ in near else ():
            if giver.node.id != taker.node.id:
                found.setdefault(giver.endpoint.topic, giver)
        if len(found) == 1:
            yield taker, next(iter(found.values()))
