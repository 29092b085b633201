"""dead-remap: a launch file remaps a name that the node does not use.

What it does
    Reports remappings in launch files whose old name does not occur in the node's code: not as a topic, service, action
    or (in ROS 1) parameter, not as a namespace of them, and not as a name derived from them (`image/compressed`,
    `move/goal`). All names of the node have to be known.

Why it breaks
    The remapping has no effect and ROS prints no warning: the node keeps the old name.

Example
    <node pkg="porter_base" exec="base_node">
      <remap from="cmd_val" to="safe/cmd_vel"/>      <!-- the node subscribes to cmd_vel -->
    </node>

Use instead
    <remap from="cmd_vel" to="safe/cmd_vel"/>

Not reported
    Nodes that pass themselves to code outside of the workspace, load plugins, or compute names; remappings that apply
    to several nodes, if one of them uses the name or is not in the workspace; /tf, /clock and other names that nearly
    every node has.
"""

from ...model.flow.launches import GivenRemapping, LaunchedNode
from ..vocabulary import At, Diagnostic, Text, Workspace, rule
from .launch_settings import group_by_line

_COMMON = frozenset(("/tf", "/tf_static", "/clock", "/rosout", "/parameter_events", "/diagnostics"))

# What stands below a name and goes by it: transports, calibrations, the topics of an action, reconfiguration.
_BELOW = frozenset(
    ("compressed", "compressedDepth", "theora", "zstd", "ffmpeg", "raw", "draco", "zlib", "cloudini", "camera_info",
     "goal", "cancel", "status", "feedback", "result", "_action", "set_parameters", "parameter_updates",
     "parameter_descriptions")
)  # fmt: skip


@rule(
    scope="flow",
    severity="warning",
    preview=True,
    texts=Text(
        "the remapping of `{subject}` has no effect: it matches no topic, service or action of {programs}",
        help="remap a name that exists ({names:none is known}), or remove the remapping",
    ),
)
def dead_remap(workspace: Workspace):
    remappings = group_by_line(workspace, lambda start: start.renamed, lambda renamed: renamed.written)
    for (path, line, written), rows in remappings:
        if any(_may_apply(start, renamed, workspace.ros) for start, renamed in rows):
            continue
        programs = sorted({start.program.partition("/")[2] for start, _ in rows})
        data = {"programs": tuple(programs), "names": rows[0][0].names}
        yield Diagnostic(At(path, line), written, workspace.find_owning_package(path), data)


def _may_apply(start: LaunchedNode, renamed: GivenRemapping, ros: int) -> bool:
    """Whether a remapping may change a name of a node."""
    if start.hidden or renamed.old in _COMMON:
        return True
    parameters = {name.rpartition("/")[2].lstrip("~") for name in start.parameters}
    if ros == 1 and (start.hidden_parameters or renamed.old.rpartition("/")[2] in parameters):
        return True
    old = renamed.old.rstrip("/")
    if any(name == old or name.startswith(f"{old}/") for name in start.names):
        return True
    return any(old.startswith(f"{name}/") and old[len(name) + 1 :].partition("/")[0] in _BELOW for name in start.names)
