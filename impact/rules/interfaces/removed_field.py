"""removed-field: a field of a message, service or action was removed since the base.

What it does
    Compares every definition with the base revision and reports fields that were removed.

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

from ..vocabulary import Text, Workspace, rule
from .comparison import UNMATCHED, diagnose, find_changed_sections


@rule(
    scope="change",
    texts=Text(
        f"the field `{{subject}}` was removed from `{{definition}}`: {UNMATCHED}",
        help="keep the field for one release, or change everything that uses it in the same change",
    ),
)
def removed_field(workspace: Workspace, base: Workspace):
    for pair in find_changed_sections(workspace, base):
        after = {field.name for field in pair.new.fields}
        for field in pair.old.fields:
            if field.name not in after:
                yield diagnose(workspace, pair, pair.make_place(1), field.name)
