"""Uses of C++ names of other packages that are otherwise on a target, for the rules that tell of them."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.package import CppApiUse
from ...model.view import View
from ...model.workspace import Package
from ...targets.availability import Horizon
from ...targets.surface.offers_cpp import Judged, judged
from ...targets.uses import function_of
from ..rule import Hit
from ..severity import Doubt, doubts_of_place

_REVIEWED = ("api-removed", "api-renamed", "api-changed")


def uses_judged(view: View, package: Package) -> list[tuple[CppApiUse, Judged]]:
    """What a package uses that is not on the target as the use needs it, in the order of the digest. What the target
    does not compile, and what reviewed tables speak of is left out."""
    return [(use, found) for use, found, ahead in _worked_out(view, package) if ahead is None]


def uses_coming(view: View, package: Package) -> list[tuple[CppApiUse, Judged, Horizon]]:
    """The same of what the target takes and an update of its distro does not, each with the nearest horizon."""
    return [(use, found, ahead) for use, found, ahead in _worked_out(view, package) if ahead is not None]


def _worked_out(view: View, package: Package) -> list[tuple[CppApiUse, Judged, Horizon | None]]:
    key = "C++ uses", package.name
    if key not in view.worked_out:
        view.worked_out[key] = list(_judged(view, package)) if package.digest.cpp_api else []
    return view.worked_out[key]


_BREAKS = frozenset(("removed", "arguments", "types", "override"))


def _judged(view: View, package: Package) -> Iterator[tuple[CppApiUse, Judged, Horizon | None]]:
    reviewed = {change.old for change in view.changes(*_REVIEWED)}
    reviewed.update(change.new for change in view.changes(*_REVIEWED) if change.state == "absent")
    calls = {
        function_of(change.old)
        for change in view.changes("call-changed")
        if view.offers.package(change.package) is None  # else its surfaces know more
    }
    near = view.closure(package)
    own = {name for one in view.workspace for name in one.digest.defined}
    for use in package.digest.cpp_api:
        if use.package not in near or use.name in own or not view.active(use.conditions):
            continue
        head = use.name.partition("::")[0]
        if head != use.package and head in near:
            continue  # a name of that package, which this one took over for a while
        if use.name.rpartition("::")[2] in calls or not reviewed.isdisjoint(_tails(use.name)):
            continue
        found = judged(view.offers, use.package, use.name, use.how, use.arguments, use.given, use.templated)
        if found is not None:
            yield use, found, None
        if found is not None and found.kind in _BREAKS:
            continue
        for ahead in view.updates:
            if ahead.target.version(use.package) == view.target.version(use.package):
                continue
            found = judged(view.offers_on(ahead)[0], use.package, use.name, use.how, use.arguments, use.given)
            if found is not None and found.kind in _BREAKS and found.earlier and view.active_on(ahead, use.conditions):
                yield use, found, ahead
                break


def _tails(name: str) -> Iterator[str]:
    """`a::b::c`, `b::c`, `c`."""
    yield name
    while "::" in name:
        name = name.partition("::")[2]
        yield name


def doubts_of(view: View, use: CppApiUse, found: Judged) -> tuple[Doubt, ...]:
    """What speaks against an error where a use is refused by the compiler."""
    doubts = doubts_of_place(view, use.role, use.conditions)
    if not (use.sure and found.sure) or any(package in view.workspace.packages for package in use.through):
        doubts = (*doubts, Doubt.INCOMPLETE)
    if found.kind == "override" and "override" not in use.given:
        doubts = (*doubts, Doubt.DISTURBS)  # it compiles, and nobody calls it
    return doubts


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
