"""unmatched-client: a client uses a service or action that nothing serves, while a similar name is served.

What it does
    Reports clients of services and actions whose name is known and that no node of the workspace serves, if a node
    serves the same type under a name with the same ending, or with a small difference in spelling.

Why it breaks
    The client waits forever for the server, or its calls fail.

Example
    self.create_service(SetCargo, "gripper/set_cargo", self.on_cargo)
    self.create_client(SetCargo, "set_cargo")

Use instead
    self.create_client(SetCargo, "gripper/set_cargo")

Not reported
    Clients of types that nothing in the workspace serves; services that every node of ROS has; servers whose name is
    not known, depends on a node that a launch file may rename, or may get the client's namespace when it is started.
"""

from ...model.flow.edges import Flow, Sure, begins, build_unstarted_flow, get_label, list_flows
from ...model.flow.misspelling import NearNames, is_in_namespace, is_slip_of_name
from ...model.flow.workspace import get_flow
from ..vocabulary import At, Diagnostic, Text, Workspace, rule

_SERVER = {"client": "server", "action client": "action server"}
# Packages of the services that nodes have by themselves, and types that tell nothing.
_EVERYWHERE = ("rcl_interfaces/", "lifecycle_msgs/", "composition_interfaces/", "type_description_interfaces/",
               "dynamic_reconfigure/", "roscpp/", "nodelet/", "std_srvs/", "sensor_msgs/SetCameraInfo")  # fmt: skip


@rule(
    scope="flow",
    severity="warning",
    preview=True,
    texts=Text(
        "nothing in {launch:the workspace} serves the {what} `{subject}`, but `{node}` serves `{replacement}` of the "
        "same type ({place})",
        help="call `{replacement}`, or serve `{subject}`",
    ),
)
def unmatched_client(workspace: Workspace):
    served = {
        one.topic
        for launch in get_flow(workspace).launches
        for one in launch.graph.endpoints
        if one.role in ("server", "action server")
    }
    reported = set()
    for path, flow in list_flows(workspace):
        for taker, giver in _find_unmatched(flow if path else build_unstarted_flow(workspace)):
            one, other = taker.endpoint, giver.endpoint
            if (one.path, one.line) in reported or one.topic in served:
                continue
            reported.add((one.path, one.line))
            data = {
                "launch": (path,) if path else (),
                "what": "service" if one.role == "client" else "action",
                "node": get_label(giver.node),
                "replacement": other.topic,
                "place": f"{other.path}:{other.line}",
            }
            yield Diagnostic(At(one.path, one.line), one.topic, taker.node.package, data)


def _find_unmatched(flow: Flow):
    """Clients without a server, each with the only sure server of its type and nearly its name."""
    serving: dict[tuple[str, str], list[tuple[str, Sure]]] = {}
    for giver in flow.list_sure(*_SERVER.values()):
        if not (begins(giver.endpoint, "~") and not giver.node.started):
            key = giver.endpoint.role, giver.endpoint.type
            serving.setdefault(key, []).append((giver.endpoint.topic, giver))
    near = {key: NearNames(givers, namespaces=True) for key, givers in serving.items()}
    for taker in flow.list_sure(*_SERVER):
        one = taker.endpoint
        role = _SERVER[one.role]
        if not flow.find_type(one) or one.type.startswith(_EVERYWHERE) or one.implied:
            continue
        if flow.list_others(one) or flow.may_have(role, one.type):
            continue
        found: dict[str, Sure] = {}
        for giver in near[role, one.type].find_near(one.topic) if (role, one.type) in near else ():
            other = giver.endpoint
            if is_slip_of_name(one.topic, other.topic) or _lacks_namespace(taker, giver):
                found.setdefault(other.topic, giver)
        if len(found) == 1:
            yield taker, next(iter(found.values()))


def _lacks_namespace(taker: Sure, giver: Sure) -> bool:
    """Whether one name is the other within a namespace that no one gives it who starts the server."""
    one, other = taker.endpoint, giver.endpoint
    if not is_in_namespace(one.topic, other.topic):
        return False
    return len(one.topic) < len(other.topic) or giver.node.started != "" or begins(other, "/")
