"""changed-field-type: the type of a field changed since the base.

What it does
    Compares the types, array lengths and bounds of fields that both revisions have.

Why it breaks
    Conversions may no longer compile, or lose values. The md5 sum or type hash changes, so nodes built before do not
    connect and recorded bags no longer match.

Severity
    error when a package of the workspace uses the definition; warning otherwise.

Example
    float32 range                               # was float64

Use instead
    A new field beside the old one, for one release.
"""

from ..vocabulary import Text, Workspace, rule
from .comparison import UNMATCHED, diagnose, find_changed_sections, format_type


@rule(
    scope="change",
    texts=Text(
        f"the type of the field `{{definition}}.{{subject}}` changed from `{{old}}` to `{{new}}`: {UNMATCHED}",
        help="add a new field instead, or change everything that uses it in the same change",
    ),
)
def changed_field_type(workspace: Workspace, base: Workspace):
    for pair in find_changed_sections(workspace, base):
        before = {field.name: format_type(field) for field in pair.old.fields}
        for field in pair.new.fields:
            old, new = before.get(field.name), format_type(field)
            if old is not None and old != new:
                yield diagnose(workspace, pair, pair.make_place(field.line, field.column), field.name, old=old, new=new)
