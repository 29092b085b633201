"""nonexistent-executable: a manifest exports `replace_me`.

What it does
    Reports what is wrong, in a sentence.

Why it breaks
    What happens to whom, and when: configuring, compiling, linking, installing, starting.

Severity
    warning. Say what makes a finding more or less severe.

Example
    <export><replace_me/></export>

Use instead
    <export/>

Not reported
    What looks like it and works.
"""

from ...model.cmake.build import At
from ...model.view import TargetView
from ...model.workspace import Package
from ..rule import Diagnostic, Text, rule


@rule(
    severity="warning",
    preview=True,
    texts=Text("`{package}` exports `{subject}`", help="remove it"),
)
def nonexistent_executable(view: TargetView, package: Package):
    for export in package.manifest.exports:
        if export.tag == "replace_me":
            yield Diagnostic(At(package.digest.manifest_path, export.line), export.tag, package.name)
