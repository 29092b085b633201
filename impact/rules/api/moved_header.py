"""moved-header: an included header has a new name, and the old one will go.

What it does
    Reports includes of headers that the target still installs as a deprecated forwarder.

Why it matters
    The next version, which another developer may have already, is without the old name.

Severity
    note. A target that no longer has the old name gets an error from removed-header.

Example
    #include <cv_bridge/cv_bridge.h>            // deprecated since cv_bridge 3.3

Use instead
    #include <cv_bridge/cv_bridge.hpp>

Not reported
    Headers that the workspace itself provides, and includes under a condition that does not hold on the target.
"""

from ...model.package import IncludeUse
from ...model.view import View
from ...model.workspace import Package
from ...targets.evidence import evidence_of
from ...targets.target import Change
from ..cure import Replace
from ..rule import Hit, rule


@rule(severity="note", deprecation=True)
def moved_header(view: View):
    moved = {
        c.old: c
        for c in view.changes("header-removed", "header-renamed", "header-moved")
        if c.state == "deprecated" and c.old
    }
    for package in view:
        for include in package.digest.includes:
            change = moved.get(include.path)
            if change is None or not view.active(include.conditions) or view.workspace.provides_header(include.path):
                continue
            yield Hit(
                include.at,
                include.path,
                f"`{include.path}` is deprecated in {change.package} {change.version}".strip(),
                f"include `{change.new}`" + (f", there since {change.since}" if change.since else "")
                if change.new
                else "",
                package.name,
                fix=respelt(view, package, include, change),
                evidence=evidence_of(change),
            )


def respelt(view: View, package: Package, include: IncludeUse, change: Change) -> tuple[Replace, ...]:
    """The cure that includes a header by its new name: where the header moved as it is, the target has it there, and
    the package has who provides it."""
    at = include.at
    if change.kind == "header-removed" or not change.new or not view.certain(include.conditions):
        return ()
    if view.environment.headers(change.new) is not True:
        return ()
    if not view.answered(view.header(change.new), view.closure(package)):
        return ()
    # The column is that of `<` or the quotation mark.
    return (Replace(at.path, at.line, at.column + 1, include.path, change.new),)
