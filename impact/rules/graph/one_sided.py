"""Topics of the workspace that have publishers and no subscriber, or subscribers and no publisher."""

from collections.abc import Iterator

from ...model.flow.edges import begins, build_whole_flow, get_label
from ..vocabulary import At, Diagnostic, Workspace

_SIDES = {"publisher": "subscriber", "subscriber": "publisher"}
# Topics that tools, operators or all nodes use.
_TOOLS = frozenset(
    ("tf", "tf_static", "clock", "rosout", "parameter_events", "diagnostics", "robot_description", "joint_states",
     "cmd_vel", "odom", "initialpose", "goal", "goal_pose", "clicked_point", "map", "scan", "transition_event",
     "robot_description_semantic", "statistics", "diagnostics_agg", "rosout_agg", "speech", "chatter", "e_stop",
     "estop", "emergency_stop", "status", "feedback", "result", "cancel", "joy", "heartbeat", "debug")
)  # fmt: skip


def find_one_sided(workspace: Workspace, role: str) -> Iterator[Diagnostic]:
    """A diagnostic for each topic that has endpoints of a role (publisher or subscriber) and whose type nothing in the
    workspace has on the other side. Its data: that `type`, and the label of the `node`. Topics that tools and people
    outside of the workspace may use are left out: those of types that the workspace does not define, private ones, and
    known topics of tools."""
    flow = build_whole_flow(workspace)
    met = {one.type for one in flow.graph.endpoints if one.role == _SIDES[role]}
    reported: set[object] = set()
    for one in flow.list_sure(role):
        endpoint = one.endpoint
        type_ = flow.find_type(endpoint)
        if type_.partition("/")[0] not in workspace.interface_names or not met.isdisjoint((type_, "", "*")):
            continue
        private = begins(endpoint, "~") or endpoint.topic.startswith(f"{one.node.name}/")
        if role == "subscriber" and flow.may_have("publisher", type_):
            continue
        place = (endpoint.path, endpoint.line)
        if endpoint.implied or private or not reported.isdisjoint((endpoint.topic, place)):
            continue
        if endpoint.topic.rpartition("/")[2] not in _TOOLS and "debug" not in endpoint.topic:
            reported.update((endpoint.topic, place))
            data = {"type": endpoint.type, "node": get_label(one.node)}
            yield Diagnostic(At(*place), endpoint.topic, one.node.package, data)
