"""unoffered-interface: a controller is given an interface of a joint that the robot description does not offer.

What it does
    Compares `command_interfaces` and `state_interfaces` beside `joints` in files of parameters with the interfaces that
    the `<ros2_control>` tags of the workspace give the joints of these names.

Why it breaks
    The controller manager refuses to activate the controller: a command or state interface "is not available".

Severity
    warning, since the plugin of the hardware may offer others than the description names.

Example
    command_interfaces: [effort]                # and <joint name="hip"> has <command_interface name="position"/> alone

Use instead
    command_interfaces: [position]

Not reported
    Joints that no description of the workspace has, or whose interfaces a macro or variable gives; controllers that
    command others (`command_joints`).
"""

import re

from ...facts.launch.references import ControlledJoint
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule

_VARIABLE = re.compile(r"\\?\$\{[^{}]*\}|\\?\$\([^()]*\)")


@rule(
    severity="warning",
    preview=True,
    texts=Text(
        "`{controller}` is given the {kind} interface `{subject}`, but the description of `{joint}` has {offered:none}",
        "name an interface that the joint has, or add it to the joint in `{description}`",
    ),
)
def unoffered_interface(view: TargetView, package: Package):
    if not package.linked.claims:
        return
    known = [found for each in view.list_built() for found in each.linked.controlled_joints]
    for claim in package.linked.claims:
        for joint in claim.joints:
            same = [(path, found) for path, found in known if _may_be(found, joint)]
            if not same or not all(found.whole for _, found in same):
                continue
            offered = {
                name for _, found in same for name in (found.commands if claim.kind == "command" else found.states)
            }
            if claim.interface in offered:
                continue
            data = {"controller": claim.controller, "kind": claim.kind, "joint": joint,
                    "offered": tuple(sorted(offered)), "description": same[0][0]}  # fmt: skip
            doubts = (Doubt.EXAMPLE,) if claim.role == "aside" else ()
            yield Diagnostic(claim.at, claim.interface, package.name, data, doubts=doubts)
            break


def _may_be(found: ControlledJoint, joint: str) -> bool:
    """Whether a joint of a description may be called so, whatever its variables stand for."""
    return re.fullmatch(".*".join(map(re.escape, _VARIABLE.split(found.name))), joint) is not None
