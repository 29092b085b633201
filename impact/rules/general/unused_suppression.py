"""unused-suppression: an allow comment does not suppress any finding.

What it does
    Reports names in `rosimpact: allow(...)` comments that do not match any finding.

Why it matters
    A comment that is no longer needed hides the next finding of that kind.

Example
    #include <vector>  // rosimpact: allow(removed-header)

Use instead
    #include <vector>
"""

from collections.abc import Iterable, Iterator

from ..vocabulary import At, Diagnostic, Text, Workspace, rule


@rule(
    scope="workspace",
    severity="note",
    texts=Text("`allow({subject})` does not suppress any finding", help="remove it"),
)
def unused_suppression(workspace: Workspace):
    """What is unused is known only after all other rules have run, so check.py calls find_unused()."""
    return iter(())


def find_unused(workspace: Workspace, comments: Iterable[tuple[str, int, str]]) -> Iterator[Diagnostic]:
    """Diagnostics for (path, line, rule name) of comments without effect."""
    last, owner = "", None
    for path, line, name in comments:
        if path != last:
            last = path
            owner = max((p for p in workspace if path.startswith(p.path)), key=lambda p: len(p.path), default=None)
        yield Diagnostic(At(path, line), name, owner.name if owner else "")
