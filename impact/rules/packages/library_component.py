"""library-component: a component of a library is asked for and gone on a platform.

What it does
    Compares the components given to find_package(Boost|Qt5|Qt6|VTK|OpenCV|PCL|gz-*|ignition-* ... COMPONENTS) with
    what the target's version of the library has, also in the CMake files that dependants run. Those of VTK 9 are what
    its configuration in Debian lists, those of Gazebo's libraries what some release of the major version adds.

Why it breaks
    CMake stops at a component that is gone (`signals` since Boost 1.69), or not there yet (`json` before 1.75).

Severity
    error when a component that is surely required is gone on the target; warning under a condition that is not known,
    when only the newest distro lacks it (the first place in the workspace; notes for the rest), and for what dependants
    look for.

Example
    find_package(Boost REQUIRED COMPONENTS signals)

Use instead
    find_package(Boost REQUIRED)                # and boost/signals2, which is header-only
"""

from collections.abc import Iterator

from ...model.cmake.build import FoundPackage
from ...targets.symbol import Symbol
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Upcoming, rate_upcoming, rule


@rule(
    texts={
        "gone": Text("{library}[[ {version}]] has no component `{subject}`", "{advice}"),
        "upcoming": Text("`{subject}` will be removed: not in {library} {version} ({horizon})", "{advice}"),
    },
)
def library_component(view: TargetView, package: Package):
    asked = [(found, ()) for found in package.build.found if found.how == "find_package"]
    asked += [(found, (Doubt.DISTURBS,)) for found in package.build.handed_on]
    yield from rate_upcoming(one for found, doubts in asked for one in _list_gone(view, package, found, doubts))


def _list_gone(
    view: TargetView, package: Package, found: FoundPackage, besides: tuple[Doubt, ...]
) -> Iterator[Diagnostic | Upcoming]:
    """Components that the target's version of the library, or that of the newest distro, does not have."""
    certain = view.is_sure(found.conditions)
    if found.name in view.workspace.packages or view.workspace.find_modules.get(found.name):
        return
    for name, at in found.components:
        known = view.find_availability(Symbol("component", name, (found.name,)))
        data = {"library": found.name, "version": known.version, "advice": known.detail}
        if known.state == "upcoming" and known.horizon is not None:
            data["horizon"] = known.horizon.name
            doubts = () if found.required and name != "system" and certain else (Doubt.FAR,)
            diagnostic = Diagnostic(at, name, package.name, data, "upcoming", (*doubts, *besides))
            yield Upcoming(diagnostic, found.name, known.horizon, diagnostic.place)
        if known.is_missing:
            if found.quiet and not found.required:
                doubts = (Doubt.DISPENSABLE,)
            else:
                doubts = (found.required or Doubt.OPTIONAL, certain or Doubt.CONDITIONAL)
            yield Diagnostic(at, name, package.name, data, "gone", (*doubts, *besides))
