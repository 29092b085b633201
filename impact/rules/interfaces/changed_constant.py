"""changed-constant: a constant of a definition has another value, or is gone, against the base.

What it does
    Compares the constants of every definition.

Why it breaks
    A machine built before and one built after connect without complaint in ROS 2, whose type hash leaves constants out,
    and mean different things by the same number. In ROS 1 the md5 sum changes. A constant that is gone stops the
    compiler.

Severity
    error for a constant that is gone and whose definition the workspace uses; warning otherwise.

Example
    uint8 STOPPED=2                             # was 1

Use instead
    A new constant with a new number.
"""

from ...model.workspace import Workspace
from ..rule import Hit, rule
from .comparison import pairs, users


@rule(scope="change", severity="warning")
def changed_constant(workspace: Workspace, base: Workspace):
    for pair in pairs(workspace, base):
        after = {c.name: c for c in pair.new.constants}
        wire = "its md5 changes" if workspace.ros == 1 else "its type hash stays the same, so nobody is told"
        for constant in pair.old.constants:
            new = after.get(constant.name)
            who = users(workspace, pair)
            if new is None:
                yield Hit(
                    pair.at(1),
                    constant.name,
                    f"`{pair.name}` lost the constant `{constant.name}`; {who}",
                    "keep it for one release",
                    pair.package.name,
                    severity="error" if who.startswith("used") else "warning",
                )
            elif new.value != constant.value:
                yield Hit(
                    pair.at(new.line, new.column),
                    constant.name,
                    f"`{pair.name}.{constant.name}` is {new.value} and was {constant.value}: {wire}; {who}",
                    "add a new constant instead",
                    pair.package.name,
                )
