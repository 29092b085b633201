"""deprecated-name: a name that is used will go.

What it does
    Reports classes, functions, constants and CMake names that the target still has and has marked as deprecated: by the
    known-changes table, and of C++ and Python names by what the sources of the target's version say; of C++ with the
    first stored version that has them no more.

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

from collections.abc import Iterator

from ...model.view import View
from ...targets.evidence import evidence_of, of_offered
from ..rule import Hit, rule
from ..severity import Doubt
from .cpp_api import line_of, uses_judged
from .python_api import evidence_of as told_by
from .python_api import uses_lost


@rule(doubts=(Doubt.DEPRECATED,))
def deprecated_name(view: View):
    told = set()
    for hit in _reviewed(view):
        told.add(line_of(hit))
        yield hit
    for package in view:
        for use, found in uses_judged(view, package):
            if found.kind != "deprecated" or not use.sure or (use.at.path, use.at.line) in told:
                continue
            offered = found.offered
            goes = f", and gone in {offered.gone_in}" if offered.gone_in else ""
            message = offered.here.deprecated if offered.here is not None else ""
            yield Hit(
                use.at,
                use.name,
                f"`{use.name}` is deprecated in {offered.package} {offered.version}{goes}",
                f"use `{offered.instead}`" if offered.instead else f"its header says: {message}" if message else "",
                package.name,
                evidence=of_offered(offered),
            )


def _reviewed(view: View) -> Iterator[Hit]:
    """What reviewed tables tell, and what Python files use."""
    old = {
        c.old: c
        for c in view.changes("api-removed", "api-renamed", "python-removed", "cmake-removed", "cmake-renamed")
        if c.state == "deprecated" and c.old
    }
    for package in view:
        told = set()
        gone = tuple(f"{lost.name}." for _, lost in uses_lost(view, package) if lost.state == "removed")
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
            if f"{text}.".startswith(gone):
                continue  # what it stands in has gone with it, and is told of
            yield Hit(
                at,
                text,
                f"`{text}` is deprecated in {change.package} {change.version}".strip(),
                f"use `{change.new}`" if change.new else "",
                package.name,
                evidence=evidence_of(change),
            )
