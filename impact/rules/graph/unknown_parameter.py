"""unknown-parameter: a launch or parameter file sets a parameter that the node never asks for.

What it does
    Reports parameters that a launch file, or a parameter file it loads, sets for one node, and that the node's code
    neither declares nor reads. All parameters of the node have to be known.

Why it breaks
    The value goes nowhere, and the node runs with its default: mostly a misspelt or outdated name.

Severity
    warning when a parameter of the node differs by a slip; note otherwise.

Example
    base_node:
      ros__parameters:
        max_sped: 0.5            # the node declares max_speed

Use instead
    max_speed: 0.5

Not reported
    Nodes that ask for parameters by prefix or by names that are not known, load plugins, or hand themselves to code
    outside of the workspace; values in a file's `/**`, which is for every node.
"""

from ...model.cmake.build import At
from ...model.flow.launches import Start
from ...model.flow.misspelling import is_slip
from ...model.workspace import Workspace
from ..rule import Hit, rule
from .given import given

# What every node, or the framework around it, understands.
_COMMON = frozenset(
    ("use_sim_time", "tf_prefix", "robot_description", "start_type_description_service", "bond_heartbeat_period",
     "service_introspection_mode", "enable_statistics", "num_worker_threads")
)  # fmt: skip
_COMMON_HEADS = ("qos_overrides", "bond", "diagnostic_updater", "actionlib", "lifecycle")


@rule(severity="note", preview=True, flow=True)
def unknown_parameter(workspace: Workspace):
    useless: dict[tuple[str, int], list[tuple[str, Start]]] = {}
    for (path, line, name), rows in given(workspace, lambda start: start.given, lambda each: each.name):
        if any(_asks(start, name) for start, _ in rows):
            continue
        start, _ = rows[0]
        near = [known for known in start.parameters if is_slip(_last(known), _last(name))]
        if near:
            cure = f"write `{near[0]}`"
            yield Hit(At(path, line), name, _said(start, name), cure, start.package, severity="warning")
        else:
            useless.setdefault((path, line), []).append((name, start))
    for (path, line), found in useless.items():
        (name, start), others = found[0], len(found) - 1
        more = f" and {others} more that this line loads" if others else ""
        cure = "remove them, or read them in the node" if others else "remove it, or read it in the node"
        yield Hit(At(path, line), name, _said(start, name) + more, cure, start.package)


def _said(start: Start, name: str) -> str:
    return f"`{start.program.partition('/')[2]}` neither declares nor reads the parameter `{name}`"


def _asks(start: Start, name: str) -> bool:
    """Whether a node may ask for a parameter."""
    parts = name.replace("/", ".").split(".")
    if start.hidden_parameters or parts[-1] in _COMMON or parts[0] in _COMMON_HEADS:
        return True
    known = {_last(one) for one in start.parameters}
    return any(part in known for part in parts)


def _last(name: str) -> str:
    return name.replace("/", ".").rpartition(".")[2].lstrip("~")
