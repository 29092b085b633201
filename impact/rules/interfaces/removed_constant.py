"""removed-constant: a constant of a definition was removed since the base.

What it does
    Reports constants that the base's revision of a definition has and this one does not.

Why it breaks
    Source that uses the constant does not compile (C++), or stops when it gets there (Python).

Severity
    error when a package of the workspace uses the definition; warning otherwise.

Example
    uint8 STOPPED=1                             # deleted

Use instead
    Keep the constant for one release.
"""

from ..vocabulary import Text, Workspace, rule
from .comparison import diagnose, find_changed_sections


@rule(
    scope="change",
    group="changed-constant",
    texts=Text(
        "the constant `{subject}` was removed from `{definition}`; used by {users:nothing in the workspace}",
        help="keep the constant for one release",
    ),
)
def removed_constant(workspace: Workspace, base: Workspace):
    for pair in find_changed_sections(workspace, base):
        after = {constant.name for constant in pair.new.constants}
        for constant in pair.old.constants:
            if constant.name not in after:
                yield diagnose(workspace, pair, pair.make_place(1), constant.name)
