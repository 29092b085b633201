"""nothing-analysed: no package was found.

What it does
    Says so when a tree holds no package.xml outside ignored folders, and the run exits with status 2.

Why it matters
    A check that looked at nothing must not pass for one that found nothing.

Severity
    error, and the exit status is 2 whatever --fail-on says.
"""

from ...model.cmake.build import At
from ...model.workspace import Workspace
from ..rule import Hit, rule


@rule(severity="error", per_target=False)
def nothing_analysed(workspace: Workspace):
    if not workspace.packages:
        yield Hit(
            At("", 0),
            "package.xml",
            "no package was found",
            "give the folder that holds the packages, or remove its COLCON_IGNORE",
        )
