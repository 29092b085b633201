"""Uses of C++ names of other packages that are otherwise on a target, for the rules that tell of them."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.package import CppApiUse
from ...model.view import View
from ...model.workspace import Package
from ...targets.surface.offers_cpp import Judged, judged
from ...targets.uses import function_of
from ..rule import Hit

_REVIEWED = ("api-removed", "api-renamed", "api-changed")


def uses_judged(view: View, package: Package) -> list[tuple[CppApiUse, Judged]]:
    """What a package uses that is not on the target as the use needs it, in the order of the digest. What the target
    does not compile, and what reviewed tables speak of is left out."""
    key = "C++ uses", package.name
    if key not in view.worked_out:
        view.worked_out[key] = list(_judged(view, package)) if package.digest.cpp_api else []
    return view.worked_out[key]


def _judged(view: View, package: Package) -> Iterator[tuple[CppApiUse, Judged]]:
    reviewed = {change.old for change in view.changes(*_REVIEWED)}
    reviewed.update(change.new for change in view.changes(*_REVIEWED) if change.state == "absent")
    calls = {function_of(change.old) for change in view.changes("call-changed")}
    near = view.closure(package)
    for use in package.digest.cpp_api:
        if use.package not in near or not view.active(use.conditions):
            continue
        head = use.name.partition("::")[0]
        if head != use.package and head in near:
            continue  # a name of that package, which this one took over for a while
        if use.name.rpartition("::")[2] in calls or not reviewed.isdisjoint(_tails(use.name)):
            continue
        found = judged(view.offers, use.package, use.name, use.how, use.arguments, use.given)
        if found is not None:
            yield use, found


def _tails(name: str) -> Iterator[str]:
    """`a::b::c`, `b::c`, `c`."""
    yield name
    while "::" in name:
        name = name.partition("::")[2]
        yield name


def severity_of(view: View, use: CppApiUse, found: Judged) -> str:
    """How bad a use is that the compiler refuses."""
    if use.role == "aside":
        return "note"
    if not view.certain(c for c in use.conditions if c.language in ("cpp", "macro")):
        return "note"  # a test of the code itself most likely tells the versions apart
    sure = use.sure and found.sure and not any(p in view.workspace.packages for p in use.through)
    return "error" if sure and view.built(use.role) and view.certain(use.conditions) else "warning"


def when(found: Judged) -> str:
    """Since or from which version a use is taken, or what the header of the last version with it said, as a help line
    says it."""
    offered = found.offered
    if found.kind == "absent":
        return f"it is there since {offered.package} {offered.first}"
    if not found.earlier and offered.coming:
        return f"it is so since {offered.package} {offered.coming}"
    if found.kind == "removed" and offered.before is not None and offered.before.deprecated:
        return f"its header said: {offered.before.deprecated}"
    return ""


def line_of(hit: Hit) -> tuple[str, int]:
    """The file and line that a finding is about: one finding tells enough of it."""
    return getattr(hit.at, "path", ""), getattr(hit.at, "line", 0)
