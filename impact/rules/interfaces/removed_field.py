"""removed-field: a field of a message, service or action is gone against the base.

What it does
    Compares every definition with the base revision and reports fields that are no longer there.

Why it breaks
    Source that reads or writes the field does not compile (C++) or stops when it gets there (Python). The md5 sum or
    type hash changes, so nodes built before do not connect and recorded bags no longer match.

Severity
    error when a package of the workspace uses the definition; warning otherwise.

Example
    float32 voltage                             # deleted

Use instead
    Keep the field for one release, and mark it in a comment.
"""

from ...model.workspace import Workspace
from ..rule import Hit, rule
from .comparison import pairs, users, wire


@rule(scope="change", severity="error")
def removed_field(workspace: Workspace, base: Workspace):
    for pair in pairs(workspace, base):
        there = {f.name for f in pair.new.fields}
        for field in pair.old.fields:
            if field.name not in there:
                who = users(workspace, pair)
                yield Hit(
                    pair.at(1),
                    field.name,
                    f"`{pair.name}` lost the field `{field.name}`: {wire(workspace)}; {who}",
                    "keep the field for one release, or change every user with it",
                    pair.package.name,
                    severity="error" if who.startswith("used") else "warning",
                )
