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
from ...targets.evidence import make_offer_evidence
from ...targets.symbol import Availability, Symbol
from ..vocabulary import Diagnostic, Doubt, Package, Replace, TargetView, rule
from .diagnosis import build_availability_texts, build_data


@rule(
    scope="target",
    doubts=(Doubt.DEPRECATED,),
    texts=build_availability_texts("include"),
    yields_to=("removed-header",),
)
def moved_header(view: TargetView):
    known: dict[str, Availability | None] = {}
    for package in view:
        for include in package.linked.includes:
            path = include.path
            if path not in known:
                rows = (row for row in view.find_reviewed("header", path) if row.state == "deprecated")
                known[path] = next(rows, None) or _find_deprecated(view, path)
            found = known[path]
            if found is None or not view.applies(include.conditions) or view.workspace.provides_header(path):
                continue
            fix = respell(view, package, include, found.replacement) if found.form == "renamed" else ()
            yield Diagnostic(
                include.at, path, package.name, build_data(found), "deprecated", fix=fix, evidence=found.evidence
            )


def _find_deprecated(view: TargetView, path: str) -> Availability | None:
    """A header that warns in the target's version of who provides it, by the stored surfaces."""
    owners = [p.name for p in view.find_header(path) if p.kind == "ros" and p.name not in view.workspace.packages]
    found = view.offers.find("header", path, owners)
    if found is None or found.state != "deprecated" or not found.sure:
        return None
    return Availability(Symbol("header", path), "deprecated", found.package, found.version,
                        replacement=found.instead, form="renamed", evidence=make_offer_evidence(found))  # fmt: skip


def respell(view: TargetView, package: Package, include: IncludeUse, path: str) -> tuple[Replace, ...]:
    """The fix that includes a header by its new path: where the target has it there, and the package has who provides
    it."""
    at = include.at
    if not path or not view.is_sure(include.conditions) or view.environment.headers(path) is not True:
        return ()
    if not view.is_met(view.find_header(path), view.build_environment(package)):
        return ()
    # The column is that of `<` or the quotation mark.
    return (Replace(at.path, at.line, at.column + 1, include.path, path),)
