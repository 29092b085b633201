"""Topics that live within the workspace, so that what one side lacks is worth a note: shared by the rules on topics
that have one side alone."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.flow.edges import Flow, Sure, launched_flow, unstarted, whole_flow
from ...model.workspace import Workspace

_SIDES = {"publisher": "subscriber", "subscriber": "publisher"}
# Read or written by tools, by operators, or by every node.
_TOOLS = frozenset(
    ("tf", "tf_static", "clock", "rosout", "parameter_events", "diagnostics", "robot_description", "joint_states",
     "cmd_vel", "odom", "initialpose", "goal", "goal_pose", "clicked_point", "map", "scan", "transition_event",
     "robot_description_semantic", "statistics", "diagnostics_agg", "rosout_agg", "speech", "chatter", "e_stop",
     "estop", "emergency_stop", "status", "feedback", "result", "cancel", "joy", "heartbeat", "debug")
)  # fmt: skip


def one_sided(workspace: Workspace, role: str) -> Iterator[tuple[Sure, str]]:
    """Endpoints of a role (publisher or subscriber) whose topic has no other side, one a topic, with where that is so:
    a launch file, or the workspace. Topics are left out that tools and people outside of the workspace may use: those
    of types that the workspace does not define, private ones, and what is known of tools."""
    own = workspace.interface_names
    told: set[object] = set()
    for where, flow in _flows(workspace):
        for one in flow.sure(role):
            endpoint = one.endpoint
            type_ = flow.type_of(endpoint)
            package = type_.partition("/")[0]
            private = endpoint.written.startswith("~") or endpoint.topic.startswith(f"{one.node.name}/")
            place = (endpoint.path, endpoint.line)
            if package not in own or endpoint.implied or private or not told.isdisjoint((endpoint.topic, place)):
                continue
            if endpoint.topic.rpartition("/")[2] in _TOOLS or "debug" in endpoint.topic or flow.others(endpoint):
                continue
            if not flow.may_have(_SIDES[role], type_):
                told.update((endpoint.topic, place))
                yield one, where


def _flows(workspace: Workspace) -> Iterator[tuple[str, Flow]]:
    """Launch files that start nothing from elsewhere, then what no launch file starts."""
    whole = whole_flow(workspace)
    for launch in workspace.launches:
        if not launch.missing:
            yield f"`{launch.path}`", launched_flow(whole, launch)
    yield "the workspace", unstarted(workspace)
