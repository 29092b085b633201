"""moved-header: an included header has a new name, and the old one will go.

What it does
    Reports includes of headers that the target still installs as a deprecated forwarder, as the reviewed tables or the
    stored surfaces of its packages say.

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
from ...targets.evidence import evidence_of, of_offered
from ...targets.surface.offers import Offered
from ...targets.target import Change
from ..fix_actions import Replace
from ..rule import Hit, rule
from ..severity import Doubt


@rule(doubts=(Doubt.DEPRECATED,))
def moved_header(view: View):
    moved = {
        c.old: c
        for c in view.changes("header-removed", "header-renamed", "header-moved")
        if c.state == "deprecated" and c.old
    }
    offered: dict[str, Offered | None] = {}
    for package in view:
        for include in package.digest.includes:
            path = include.path
            change = moved.get(path)
            if change is None and path not in offered:
                offered[path] = _deprecated(view, path)
            evidence = evidence_of(change) if change is not None else None
            if change is None and (found := offered[path]) is not None:
                change, evidence = _change(found), of_offered(found)
            if change is None or not view.active(include.conditions) or view.workspace.provides_header(path):
                continue
            yield Hit(
                include.at,
                path,
                f"`{path}` is deprecated in {change.package} {change.version}".strip(),
                f"include `{change.new}`" + (f", there since {change.since}" if change.since else "")
                if change.new
                else "",
                package.name,
                fix=respelt(view, package, include, change),
                evidence=evidence,
            )


def _deprecated(view: View, path: str) -> Offered | None:
    """A header that warns in the target's version of who provides it, by the stored surfaces."""
    owners = [p.name for p in view.header(path) if p.kind == "ros" and p.name not in view.workspace.packages]
    found = view.offers.find("header", path, owners)
    return found if found is not None and found.state == "deprecated" and found.sure else None


def _change(found: Offered) -> Change:
    return Change("header-renamed", found.package, found.name, found.instead, "deprecated", found.version, "", "")


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
