"""unmatched-cmake-block: a block or a command of CMake code is not closed, or a block closed without being opened.

What it does
    Reports the first command of a CMakeLists.txt that no parenthesis closes, or the first text outside of commands that
    is no comment (marks of a merge that was not finished); else the first `if()`, `foreach()`,
    `while()`, `function()`, `macro()` or `block()` of a file that is not closed, or the first `endif()` and the like
    without its beginning.

Why it breaks
    CMake stops with an error while it configures the package.

Severity
    error for a command and for stray text; warning for a block.

Example
    if(BUILD_TESTING)
      find_package(ament_lint_auto REQUIRED)

Use instead
    if(BUILD_TESTING)
      find_package(ament_lint_auto REQUIRED)
    endif()

Not reported
    Other files that could not be parsed, see unreadable-file.
"""

import re

from ..vocabulary import At, Diagnostic, Doubt, Text, Workspace, rule

_BLOCKS = ("if", "foreach", "while", "function", "macro", "block")
_UNCLOSED = re.compile(r"(\w+)\(\) is never closed")
# What CMake's parser stops at elsewhere, such as the marks of a merge (cmListFileCache.cxx).
_STRAY = re.compile(r"`.+` (?:is no command(?:: no parenthesis.*)?|(?:where a command was|follows a command).*)")
_ENDS = ("is never closed", *(f"without {block}()" for block in _BLOCKS))


@rule(
    scope="workspace",
    group="unreadable-file",
    texts={
        "block": Text("{problem}, and CMake stops here", help="close the block"),
        "command": Text("`{subject}()` is never closed, and CMake stops here", help="close the parenthesis"),
        "stray": Text("{problem}, and CMake stops here", help="remove it"),
    },
)
def unmatched_cmake_block(workspace: Workspace):
    for package in workspace:
        manifest = package.linked.manifest_path
        reported = {path for path, line, _ in package.linked.problems if path != manifest or not line}
        for at, reason in package.build.unresolved:
            if at.path not in reported and reason.endswith(_ENDS):
                reported.add(at.path)
                data = {"problem": reason}
                yield Diagnostic(at, at.path.rpartition("/")[2], package.name, data, "block", (Doubt.INCOMPLETE,))
        for path, line, message in package.linked.problems:
            if path in package.build.files and path.endswith("CMakeLists.txt"):
                if unclosed := _UNCLOSED.fullmatch(message):
                    yield Diagnostic(At(path, line), unclosed[1], package.name, {}, "command")
                    break
                if _STRAY.fullmatch(message):
                    subject = path.rpartition("/")[2]
                    yield Diagnostic(At(path, line), subject, package.name, {"problem": message}, "stray")
                    break
