"""reordered-fields: the order of fields changed since the base.

What it does
    Reports definitions whose common fields changed their order.

Why it breaks
    All source still compiles. The bytes on the wire, the md5 sum and the type hash change, so nodes built before do not
    connect and recorded bags no longer match; positional initialisers silently swap values.

Severity
    error when a package of the workspace uses the definition; warning otherwise.

Example
    float64 y
    float64 x                                   # was x, y

Use instead
    The old order.
"""

from ..vocabulary import Text, Workspace, rule
from .comparison import UNMATCHED, diagnose, find_changed_sections


@rule(
    scope="change",
    texts=Text(
        f"the order of the fields of `{{definition}}` changed, from `{{subject}}` on: {UNMATCHED}",
        help="restore the old order",
    ),
)
def reordered_fields(workspace: Workspace, base: Workspace):
    for pair in find_changed_sections(workspace, base):
        common = {field.name for field in pair.old.fields} & {field.name for field in pair.new.fields}
        new = [field for field in pair.new.fields if field.name in common]
        old = [field.name for field in pair.old.fields if field.name in common]
        if len(new) != len(old):
            continue
        moved = next((field for field, name in zip(new, old, strict=True) if field.name != name), None)
        if moved is not None:
            yield diagnose(workspace, pair, pair.make_place(moved.line, moved.column), moved.name)
