"""invalid-manifest: package.xml cannot be read as its format says.

What it does
    Reports manifests that are not XML, lack a required element, carry tags that no format knows (a misspelt
    `build-depend` is silently no dependency at all), or tags of another format than the one they declare, and
    dependencies inside of `<export>`.

Why it breaks
    catkin, colcon, rosdep and bloom refuse the package, or overlook the dependency.

Severity
    error: catkin_pkg refuses such a manifest, and with it catkin, colcon and bloom. warning for a dependency inside of
    `<export>`, which no tool reads.

Example
    <build-depend>rviz</build-depend>

Use instead
    <build_depend>rviz</build_depend>
"""

import re

from ...facts.manifest import ANY_FORMAT, TAGS
from ..vocabulary import At, Diagnostic, Doubt, Replace, Text, Workspace, rule

_HELP = "[[write `{replacement}`]]"


@rule(
    scope="workspace",
    texts={
        "tag": Text(
            "`<{subject}>{text}</{subject}>` is not a tag of format {format}, so `{text}` is not declared", _HELP
        ),
        "export": Text(
            "`<{tag}>{subject}</{tag}>` is inside `<export>`, so `{subject}` is not a dependency",
            "move the tag out of `<export>`",
        ),
        "problem": Text("{problem}", "correct the manifest"),
        "condition": Text(
            "the condition `{subject}` cannot be read", "write it as REP 149 says, such as `$ROS_VERSION == 2`"
        ),
    },
)
def invalid_manifest(workspace: Workspace):
    for package in workspace:
        manifest, path = package.manifest, package.linked.manifest_path
        misspelt = {}
        for tag, text, line, column in manifest.unknown_tags:
            misspelt[line] = tag
            words = tag.replace("-", "_").replace("depends", "depend")
            known = words in TAGS[min(manifest.format, 3)]
            data = {"text": text, "format": manifest.format, "replacement": f"<{words}>" if words != tag else ""}
            tags = ((f"<{tag}>", f"<{words}>"), (f"</{tag}>", f"</{words}>"))  # where they stand in one line
            fix = tuple(Replace(path, line, 0, old, new) for old, new in tags) if known else ()
            yield Diagnostic(At(path, line, column), tag, package.name, data, "tag", fix=fix)
        for export in manifest.exports:
            if export.tag in ANY_FORMAT and export.text and export.text not in package.declared:
                at, data = At(path, export.line, export.column), {"tag": export.tag}
                yield Diagnostic(at, export.text, package.name, data, "export", (Doubt.LATE,))
        for problem in manifest.problems:
            if problem.line not in misspelt:
                at, data = At(path, problem.line, problem.column), {"problem": problem.message}
                named = _NAMED.search(problem.message)  # what is at fault, such as a dependency
                yield Diagnostic(at, named[1] if named else package.name or path, package.name, data, "problem")
        for condition, line in {d.condition: d.line for d in manifest.dependencies if d.condition}.items():
            if not _PLAIN.match(condition) and not _is_readable(condition):
                yield Diagnostic(At(path, line), condition, package.name, kind="condition")


_NAMED = re.compile(r"`([^`\s]{1,60})`")

# One comparison, or several joined by and/or: nothing that catkin_pkg could refuse. Asking it costs 60 ms of import.
_TERM = r"""\s*(?:\$\w+|[\w.-]+|"[^"]*"|'[^']*')\s*(?:==|!=|<=|>=|<|>)\s*(?:\$\w+|[\w.-]+|"[^"]*"|'[^']*')\s*"""
_PLAIN = re.compile(rf"{_TERM}(?:\b(?:and|or)\b{_TERM})*\Z")


def _is_readable(condition: str) -> bool:
    from catkin_pkg.condition import evaluate_condition

    try:
        evaluate_condition(condition, {})
    except Exception:
        return False
    return True
