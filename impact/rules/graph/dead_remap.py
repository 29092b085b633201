"""dead-remap: a launch file remaps a name that the node does not use.

What it does
    Reports remappings of launch files whose old name is none that the node's code uses: no topic, service, action or,
    in ROS 1, parameter, no namespace of them, and nothing that goes by one of them (`image/compressed`, `move/goal`).
    All names of the node have to be known.

Why it breaks
    The remapping does nothing, and nothing says so: the node goes on under the name that was to be changed.

Severity
    warning.

Example
    <node pkg="porter_base" exec="base_node">
      <remap from="cmd_val" to="safe/cmd_vel"/>      <!-- the node subscribes to cmd_vel -->
    </node>

Use instead
    <remap from="cmd_vel" to="safe/cmd_vel"/>

Not reported
    Nodes that hand themselves to code outside of the workspace, load plugins, or make names from what is not known;
    remappings given to several nodes, one of which uses the name, or is not in the workspace; /tf, /clock and others
    that nearly every node has.
"""

from ...model.cmake.build import At
from ...model.flow.launches import Renamed, Start
from ...model.workspace import Workspace
from ..rule import Hit, rule
from .given import given

_COMMON = frozenset(("/tf", "/tf_static", "/clock", "/rosout", "/parameter_events", "/diagnostics"))

# What stands below a name and goes by it: transports, calibrations, the topics of an action, reconfiguration.
_BELOW = frozenset(
    ("compressed", "compressedDepth", "theora", "zstd", "ffmpeg", "raw", "draco", "zlib", "cloudini", "camera_info",
     "goal", "cancel", "status", "feedback", "result", "_action", "set_parameters", "parameter_updates",
     "parameter_descriptions")
)  # fmt: skip


@rule(severity="warning", preview=True, flow=True)
def dead_remap(workspace: Workspace):
    for (path, line, written), rows in given(workspace, lambda start: start.renamed, lambda each: each.written):
        if any(_lives(start, renamed, workspace.ros) for start, renamed in rows):
            continue
        start, _ = rows[0]
        programs = {each.program.partition("/")[2] for each, _ in rows}
        who = " and ".join(f"`{program}`" for program in sorted(programs))
        near = ", ".join(f"`{name}`" for name in start.names[:6]) or "none"
        yield Hit(
            At(path, line),
            written,
            f"the remapping of `{written}` does nothing: {who} {'has' if len(programs) == 1 else 'have'} no such name",
            f"remap a name that it has ({near}), or remove the remapping",
            _package(workspace, path),
        )


def _lives(start: Start, renamed: Renamed, ros: int) -> bool:
    """Whether a remapping may do something for a node."""
    if start.hidden or renamed.old in _COMMON:
        return True
    if ros == 1 and (start.hidden_parameters or renamed.old.rpartition("/")[2] in _last_parts(start.parameters)):
        return True
    old = renamed.old.rstrip("/")
    return any(name == old or name.startswith(f"{old}/") or _is_below(old, name) for name in start.names)


def _is_below(old: str, name: str) -> bool:
    """Whether a name is one that goes by another: `image/compressed`, `move/goal`."""
    return old.startswith(f"{name}/") and old[len(name) + 1 :].partition("/")[0] in _BELOW


def _last_parts(names: tuple[str, ...]) -> set[str]:
    return {name.rpartition("/")[2].lstrip("~") for name in names}


def _package(workspace: Workspace, path: str) -> str:
    owner = workspace.discovered.owner(path)
    return next((name for name, each in workspace.packages.items() if owner and each.path == owner.path), "")
