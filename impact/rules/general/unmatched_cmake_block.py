"""unmatched-cmake-block: a block of CMake code is not closed, or closed without being opened.

What it does
    Reports the first `if()`, `foreach()`, `while()`, `function()`, `macro()` or `block()` of a file that is not closed,
    or the first `endif()` and the like without its beginning.

Why it breaks
    CMake stops with an error while it configures the package.

Severity
    warning.

Example
    if(BUILD_TESTING)
      find_package(ament_lint_auto REQUIRED)

Use instead
    if(BUILD_TESTING)
      find_package(ament_lint_auto REQUIRED)
    endif()

Not reported
    Files that could not be parsed at all, see unreadable-file.
"""

from ...model.workspace import Workspace
from ..rule import Diagnostic, Text, rule

_BLOCKS = ("if", "foreach", "while", "function", "macro", "block")
_ENDS = ("is never closed", *(f"without {block}()" for block in _BLOCKS))


@rule(
    scope="workspace",
    severity="warning",
    group="unreadable-file",
    texts=Text("{problem}, and CMake stops here", help="close the block"),
)
def unmatched_cmake_block(workspace: Workspace):
    for package in workspace:
        manifest = package.digest.manifest_path
        reported = {path for path, line, _ in package.digest.problems if path != manifest or not line}
        for at, reason in package.build.unresolved:
            if at.path not in reported and reason.endswith(_ENDS):
                reported.add(at.path)
                yield Diagnostic(at, at.path.rpartition("/")[2], package.name, {"problem": reason})
