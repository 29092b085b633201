"""added-field: a definition has a field that the base does not have.

What it does
    Reports new fields.

Why it breaks
    Source compiles. The md5 sum or type hash changes: a robot built before and a laptop built after do not connect, and
    recorded bags no longer match.

Severity
    warning: a deployment that updates all machines together does not notice.

Example
    uint8 quality                               # new

Use instead
    A new message beside the old one where machines are updated one by one.
"""

from ...model.workspace import Workspace
from ..rule import Hit, rule
from .comparison import pairs, users, wire


@rule(scope="change", severity="warning")
def added_field(workspace: Workspace, base: Workspace):
    for pair in pairs(workspace, base):
        before = {f.name for f in pair.old.fields}
        for field in pair.new.fields:
            if field.name not in before:
                yield Hit(
                    pair.at(field.line, field.column),
                    field.name,
                    f"`{pair.name}` has the new field `{field.name}`: {wire(workspace)}; {users(workspace, pair)}",
                    "update every machine together, or add a new message",
                    pair.package.name,
                )
