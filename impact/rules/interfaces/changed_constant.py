"""changed-constant: the value of a constant changed since the base.

What it does
    Compares the values of the constants that both revisions of a definition have.

Why it breaks
    In ROS 2 the type hash does not contain constants: a machine built before the change and one built after it still
    connect, and mean different things by the same number. In ROS 1 the md5 sum changes, and they do not connect.

Example
    uint8 STOPPED=2                             # was 1

Use instead
    A new constant with a new number.
"""

from ..vocabulary import Text, Workspace, rule
from .comparison import UNMATCHED, diagnose, find_changed_sections

_CHANGED = "the constant `{definition}.{subject}` changed from {old} to {new}"
_HELP = "add a new constant instead"


@rule(
    scope="change",
    severity="warning",
    texts={
        "ros1": Text(f"{_CHANGED}: {UNMATCHED}", _HELP),
        "ros2": Text(
            f"{_CHANGED}: the type hash stays the same, so nodes with the old value still connect; "
            "used by {users:nothing in the workspace}",
            _HELP,
        ),
    },
)
def changed_constant(workspace: Workspace, base: Workspace):
    kind = "ros1" if workspace.ros == 1 else "ros2"
    for pair in find_changed_sections(workspace, base):
        before = {constant.name: constant.value for constant in pair.old.constants}
        for constant in pair.new.constants:
            old = before.get(constant.name)
            if old is not None and old != constant.value:
                at = pair.make_place(constant.line, constant.column)
                yield diagnose(workspace, pair, at, constant.name, kind, old=old, new=constant.value)
