"""unreadable-file: a file could not be read or parsed in full.

What it does
    Names every file whose facts are incomplete, and why.

Why it matters
    The contents of such a file were not checked; that nothing is reported in it means nothing.

Severity
    note: other tools report what else is wrong with the file; the coverage line counts it too.
"""

from ..vocabulary import At, Diagnostic, Text, Workspace, rule


@rule(scope="workspace", severity="note", texts=Text("{problem}"))
def unreadable_file(workspace: Workspace):
    duplicates = {place.manifest_path for place in workspace.hidden}
    for problem in workspace.extraction.problems:
        if problem.path not in duplicates:
            owner = workspace.discovered.find_owner(problem.path)
            package = owner.name if owner else ""
            yield Diagnostic(At(problem.path, 1), problem.path, package, {"problem": problem.message})
    for package in workspace:
        reported = set()
        for path, line, message in package.linked.problems:
            if path not in reported and not (path == package.linked.manifest_path and line):
                reported.add(path)
                subject = path.rpartition("/")[2]
                yield Diagnostic(At(path, max(1, line)), subject, package.name, {"problem": message})
