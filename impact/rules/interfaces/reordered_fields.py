"""reordered-fields: fields stand in another order than at the base.

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

from ...model.workspace import Workspace
from ..rule import Hit, rule
from .comparison import pairs, users, wire


@rule(scope="change", severity="error")
def reordered_fields(workspace: Workspace, base: Workspace):
    for pair in pairs(workspace, base):
        new = [f for f in pair.new.fields if any(f.name == o.name for o in pair.old.fields)]
        old = [f.name for f in pair.old.fields if any(f.name == n.name for n in pair.new.fields)]
        moved = (
            next((f for f, name in zip(new, old, strict=True) if f.name != name), None)
            if len(new) == len(old)
            else None
        )
        if moved is not None:
            who = users(workspace, pair)
            yield Hit(
                pair.at(moved.line, moved.column),
                moved.name,
                f"the fields of `{pair.name}` stand in another order from `{moved.name}` on: {wire(workspace)}; {who}",
                "put them back in their old order",
                pair.package.name,
                severity="error" if who.startswith("used") else "warning",
            )
