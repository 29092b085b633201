"""added-field: a field was added to a definition since the base.

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

from ..vocabulary import Text, Workspace, rule
from .comparison import UNMATCHED, diagnose, find_changed_sections


@rule(
    scope="change",
    severity="warning",
    texts=Text(
        f"the field `{{subject}}` was added to `{{definition}}`: {UNMATCHED}",
        help="update all machines together, or define a new message",
    ),
)
def added_field(workspace: Workspace, base: Workspace):
    for pair in find_changed_sections(workspace, base):
        before = {field.name for field in pair.old.fields}
        for field in pair.new.fields:
            if field.name not in before:
                yield diagnose(workspace, pair, pair.make_place(field.line, field.column), field.name)
