"""unreadable-file: a file could not be read or parsed in full.

What it does
    Names every file whose facts are incomplete, and why.

Why it matters
    What stands in such a file was not checked; silence about it means nothing.

Severity
    note: what else is wrong with the file is for its own reader to say; the coverage line counts it too. warning for
    CMake whose blocks do not match, where CMake itself stops, and for a package that another of the same name stands
    for, since build tools refuse such a workspace.
"""

from ...model.cmake.build import At
from ...model.workspace import Workspace
from ..rule import Hit, rule


@rule(severity="note", per_target=False)
def unreadable_file(workspace: Workspace):
    hidden = {place.manifest_path for place in workspace.hidden}
    for problem in workspace.gathered.problems:
        owner = workspace.discovered.owner(problem.path)
        severity = "warning" if problem.path in hidden else ""
        yield Hit(At(problem.path, 1), problem.path, problem.message, "", owner.name if owner else "", severity)
    for package in workspace:
        told = set()
        for path, line, message in package.digest.problems:
            if path in told or (path == package.digest.manifest_path and line):
                continue
            told.add(path)
            yield Hit(At(path, max(1, line)), path.rsplit("/", 1)[-1], message, "", package.name)
        for at, reason in package.build.unresolved:
            if at.path not in told and reason.endswith(
                (
                    "is never closed",
                    "without if()",
                    "without foreach()",
                    "without while()",
                    "without function()",
                    "without macro()",
                    "without block()",
                )
            ):
                told.add(at.path)
                yield Hit(
                    at,
                    at.path.rsplit("/", 1)[-1],
                    f"{reason}, and CMake stops here",
                    "close the block",
                    package.name,
                    severity="warning",
                )
