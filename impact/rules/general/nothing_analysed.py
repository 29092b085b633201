"""nothing-analysed: no package was found.

What it does
    Reports a folder that has no package.xml outside of ignored folders. The run exits with status 2.

Why it matters
    A check that analysed nothing must not look like a check that found nothing.

Severity
    error, and the exit status is 2 whatever --fail-on says.
"""

from ..vocabulary import At, Diagnostic, Text, Workspace, rule


@rule(
    scope="workspace",
    texts=Text(
        "no package was found",
        help="give the folder that contains the packages, or remove its COLCON_IGNORE",
    ),
)
def nothing_analysed(workspace: Workspace):
    if not workspace.packages:
        yield Diagnostic(At("", 0), "package.xml")
