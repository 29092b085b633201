"""deprecated-name: a name that is used will go.

What it does
    Reports classes, functions, constants and CMake names that the target still has and has marked as deprecated: by the
    known-changes table, and of Python names by what the sources of the target's version say.

Why it matters
    The version that drops the name may be on a colleague's machine already.

Severity
    note.

Example
    rclcpp::executor::FutureReturnCode          // deprecated since Foxy

Use instead
    rclcpp::FutureReturnCode

Not reported
    Code that a version test excludes on the target.
"""

from ...model.view import View
from ...targets.evidence import evidence_of
from ..rule import Hit, rule
from .python_api import evidence_of as told_by
from .python_api import uses_lost


@rule(severity="note", deprecation=True)
def deprecated_name(view: View):
    old = {
        c.old: c
        for c in view.changes("api-removed", "api-renamed", "python-removed", "cmake-removed", "cmake-renamed")
        if c.state == "deprecated" and c.old
    }
    for package in view:
        told = set()
        for found, lost in uses_lost(view, package):
            if lost.state == "deprecated" and (found.at.path, lost.name) not in told:
                told.add((found.at.path, lost.name))
                why = "" if lost.why == "deprecated" else lost.why
                message = f"`{lost.name}` is deprecated in {lost.package} {lost.version}"
                yield Hit(found.at, lost.name, message, why, package.name, evidence=told_by(lost))
        uses = [(u.text, u.at, u.conditions) for u in package.digest.names]
        uses += [(u.name, u.at, u.conditions) for u in package.build.uses]
        for text, at, conditions in uses:
            change = old.get(text)
            if change is None or not view.active(conditions) or not view.concerned(package, change, at.path):
                continue
            yield Hit(
                at,
                text,
                f"`{text}` is deprecated in {change.package} {change.version}".strip(),
                f"use `{change.new}`" if change.new else "",
                package.name,
                evidence=evidence_of(change),
            )
