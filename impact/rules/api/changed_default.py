"""changed-default: a call leaves out an argument whose default another version has otherwise.

What it does
    Reports calls of C++ functions of other packages that rely on a default argument which changed with the target's
    version of the package, or with the last version before it at which anything of the function changed.

Why it matters
    It compiles everywhere, and does something else for those who have the other version.

Severity
    note.

Example
    node->create_client<Empty>("reset");        // the quality of service by default is another since rclcpp 28

Use instead
    The argument, written out.

Not reported
    Calls that give the argument; methods of objects whose type does not show; what the workspace provides itself.
"""

from ...model.view import View
from ..rule import Hit, rule
from .cpp_api import uses_judged


@rule(severity="note")
def changed_default(view: View):
    for package in view:
        for use, found in uses_judged(view, package):
            if found.kind != "default" or not use.sure:
                continue
            offered = found.offered
            yield Hit(
                use.at,
                use.name,
                f"a default of `{use.name}` that this call relies on is another since "
                f"{offered.package} {offered.first}",
                "give the argument where it matters",
                package.name,
            )
