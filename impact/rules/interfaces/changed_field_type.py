"""changed-field-type: a field has another type, or another array form, than at the base.

What it does
    Compares the types, array lengths and bounds of fields that both revisions have.

Why it breaks
    Conversions that happened to work may stop to compile or lose values. The md5 sum or type hash changes, so nodes
    built before do not connect and recorded bags no longer match.

Severity
    error when a package of the workspace uses the definition; warning otherwise.

Example
    float32 range                               # was float64

Use instead
    A new field beside the old one, for one release.
"""

from ...model.workspace import Workspace
from ..rule import Hit, rule
from .comparison import pairs, type_of, users, wire


@rule(scope="change", severity="error")
def changed_field_type(workspace: Workspace, base: Workspace):
    for pair in pairs(workspace, base):
        before = {f.name: f for f in pair.old.fields}
        for field in pair.new.fields:
            old = before.get(field.name)
            if old is not None and type_of(old) != type_of(field):
                who = users(workspace, pair)
                yield Hit(
                    pair.at(field.line, field.column),
                    field.name,
                    f"`{pair.name}.{field.name}` is `{type_of(field)}` and was `{type_of(old)}`: "
                    f"{wire(workspace)}; {who}",
                    "add a new field instead, or change every user with it",
                    pair.package.name,
                    severity="error" if who.startswith("used") else "warning",
                )
