"""Parameters that launch and parameter files set, and that the node's code neither declares nor reads."""

from collections.abc import Iterator

from ...model.flow.launches import LaunchedNode
from ...model.flow.misspelling import is_slip_of_name
from ...targets.parameters import find_last_part
from ..vocabulary import At, Diagnostic, Workspace
from .launch_settings import group_by_line

# What every node, or the framework around it, understands.
_COMMON = frozenset(
    ("use_sim_time", "tf_prefix", "robot_description", "start_type_description_service", "bond_heartbeat_period",
     "service_introspection_mode", "enable_statistics", "num_worker_threads")
)  # fmt: skip
_COMMON_HEADS = ("qos_overrides", "bond", "diagnostic_updater", "actionlib", "lifecycle")


def find_unasked(workspace: Workspace) -> Iterator[Diagnostic]:
    """A diagnostic for each parameter of the launch and parameter files of a workspace that no node it is set for asks
    for. Its data: that `program`, and as `replacement` the parameter of it whose name is misspelt; empty for none. Its
    kind is `namespace` where a node of ROS 1 reads one of the same name elsewhere, which is `read` then."""
    settings = group_by_line(workspace, lambda start: start.given, lambda parameter: parameter.name)
    for (path, line, name), rows in settings:
        if any(_asks(start, name, path, workspace.ros) for start, _ in rows):
            continue
        start, _ = rows[0]
        last = find_last_part(name)
        own = [known.removeprefix(f"{start.node}/") for known in start.parameters]
        similar = next((known for known in own if is_slip_of_name(find_last_part(known), last)), "")
        elsewhere = next((known for known in start.parameters if find_last_part(known) == last), "")
        data = {"program": start.program.partition("/")[2], "replacement": "" if elsewhere else similar}
        if elsewhere:
            data |= {"read": elsewhere, "full": f"{start.node}/{name}"}
        yield Diagnostic(At(path, line), name, start.package, data, "namespace" if elsewhere else "")


def _asks(start: LaunchedNode, name: str, path: str, ros: int) -> bool:
    """Whether a node may ask for a parameter. path: of the file that sets it."""
    if start.reads_files and path.endswith((".yaml", ".yml")):
        return True
    parts = name.replace("/", ".").split(".")
    if start.hidden_parameters or parts[-1] in _COMMON or parts[0] in _COMMON_HEADS:
        return True
    if ros == 1:
        return any(_is_read_by(known, f"{start.node}/{name}", parts) for known in start.parameters)
    known = {find_last_part(one) for one in start.parameters}
    return any(part in known for part in parts)


def _is_read_by(known: str, full: str, parts: list[str]) -> bool:
    """Whether a node of ROS 1 that reads a parameter gets another one with it: that itself, what is below the one it
    reads, or what may be either, where the namespace is not known."""
    if known.startswith("*/"):
        return find_last_part(known) in parts
    return full == known or full.startswith(f"{known.rstrip('/')}/")
