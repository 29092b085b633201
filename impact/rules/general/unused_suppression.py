"""unused-suppression: an allow comment silences nothing.

What it does
    Reports names in `rosimpact: allow(...)` comments that no finding answers to.

Why it matters
    A comment that outlives its reason hides the next finding of that kind.

Severity
    note.

Example
    #include <vector>  // rosimpact: allow(removed-header)

Use instead
    #include <vector>
"""

from collections.abc import Iterable, Iterator

from ...model.cmake.build import At
from ...model.workspace import Workspace
from ..rule import Hit, rule


@rule(severity="note", per_target=False)
def unused_suppression(workspace: Workspace):
    """What is unused is known only after all other rules have spoken, so check.py calls unused()."""
    return iter(())


def unused(workspace: Workspace, comments: Iterable[tuple[str, int, str]]) -> Iterator[Hit]:
    """Hits for (path, line, rule name) of comments without effect."""
    last, owner = "", None
    for path, line, name in comments:
        if path != last:
            last = path
            owner = max((p for p in workspace if path.startswith(p.path)), key=lambda p: len(p.path), default=None)
        yield Hit(At(path, line), name, f"`allow({name})` silences nothing", "remove it", owner.name if owner else "")
