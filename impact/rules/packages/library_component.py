"""library-component: a component of a library is used and not asked for, or asked for and gone on a platform.

What it does
    Compares the components given to find_package(Boost|Qt5|Qt6|VTK|OpenCV|PCL ... COMPONENTS) with what the target's
    version of the library has, and with the imported targets (`Boost::thread`, `Qt5::Widgets`) and headers that need a
    compiled component. Also programs that include a header of a compiled library, such as yaml-cpp, and are not linked
    to it, where another target of the package is; and programs that call functions of OpenCV which lie in other
    libraries than those that cv_bridge hands on, and get OpenCV from nobody else (ROS 1).

Why it breaks
    CMake stops at a component that is gone (`signals` since Boost 1.69), or the linker at symbols of one never linked.

Severity
    error when a component that is surely required is gone on the target; warning when only the newest distro lacks it,
    and when `Boost::x` is linked and not asked for. For a header of a compiled component in a target that is not linked
    to it: error in an executable, warning in a library and where a dependency may bring the component, note in tests
    and, in ROS 1, in libraries. error for functions of OpenCV, and for a component that no exported Boost of ROS 1 has.

Example
    find_package(Boost REQUIRED COMPONENTS signals)

Use instead
    find_package(Boost REQUIRED)                # and boost/signals2, which is header-only
"""

from ...model.view import View
from ...targets.providers.library import BOOST_COMPILED, gone_component
from ...targets.version import at_least
from ..rule import Diagnostic, rule
from ..severity import Doubt
from ..text import Text
from .boost_links import TEXTS as BOOST_TEXTS
from .boost_links import list_unlinked_boost
from .library_links import TEXTS as LINK_TEXTS
from .library_links import list_linked_elsewhere, list_unlinked_opencv


@rule(
    scope="target",
    severity="error",
    texts={
        **BOOST_TEXTS,
        **LINK_TEXTS,
        "gone": Text("{library} {version} has no component `{subject}`", "{advice}"),
        "upcoming": Text("`{subject}` will be removed: not in {library} {version} ({horizon})", "{advice}"),
        "qt": Text(
            "`{package}` finds Qt 4, but rviz {version} is built with Qt 5", "find_package(Qt5 COMPONENTS Core Widgets)"
        ),
        "not asked for": Text(
            "`{subject}` is linked, but the component `{component}` is not asked for",
            "add `{component}` to find_package(Boost COMPONENTS ...)",
        ),
    },
)
def library_component(view: View):
    for package in view:
        asked: dict[str, set[str]] = {}
        for found in package.build.found:
            if found.how == "find_package" and view.active(found.conditions):
                names = asked.setdefault(found.name, set())
                names.update(name for name, _ in found.components)
                names.update(found.optional_components)
                yield from _list_gone(view, package, found)
        yield from _list_old_qt(view, package)
        yield from _list_not_asked_for(view, package, asked)
        yield from list_unlinked_boost(view, package, asked)
        yield from list_linked_elsewhere(view, package)
        yield from list_unlinked_opencv(view, package)


def _list_gone(view: View, package, found):
    """Components that the target's version of the library, or that of the newest distro, does not have."""
    newest = view.newest
    certain = view.certain(found.conditions)
    for name, at in found.components:
        gone = gone_component(view.target, found.name, name)
        later = gone_component(newest, found.name, name) if newest is not None and not gone else None
        if later is not None:
            data = {"library": found.name, "version": later.version, "horizon": view.horizon, "advice": later.help}
            doubt = Doubt.UPCOMING if found.required and name != "system" and certain else Doubt.FAR
            yield Diagnostic(at, name, package.name, data, "upcoming", (doubt,))
        if gone:
            data = {"library": found.name, "version": gone.version, "advice": gone.help}
            if found.quiet and not found.required:
                doubts = (Doubt.DISPENSABLE,)
            else:
                doubts = (found.required or Doubt.OPTIONAL, certain or Doubt.CONDITIONAL)
            yield Diagnostic(at, name, package.name, data, "gone", doubts)


def _list_old_qt(view: View, package):
    """Qt 4 beside rviz or rqt, which are built with Qt 5 since version 1.12 and Kinetic."""
    found = {f.name: f for f in package.build.found if f.how == "find_package" and view.active(f.conditions)}
    qt4 = found.get("Qt4")
    if qt4 is None or found.keys() & {"Qt5Widgets", "Qt5"}:
        return
    rviz = view.target.version("rviz") or ""
    if rviz and at_least(rviz, "1.12") and view.declared(package).keys() & {"rviz", "rqt_gui_cpp"}:
        doubts = (qt4.required or Doubt.OPTIONAL, view.certain(qt4.conditions) or Doubt.CONDITIONAL)
        yield Diagnostic(qt4.at, "Qt4", package.name, {"version": rviz}, "qt", doubts)


def _list_not_asked_for(view: View, package, asked: dict[str, set[str]]):
    """Imported targets of Boost whose component find_package() is not given."""
    seen = set(asked.get("Boost", ()))
    for target in package.build.targets if "Boost" in asked else ():
        for link in target.links:
            head, _, component = link.item.partition("::")
            if head != "Boost" or component in seen or component not in BOOST_COMPILED:
                continue
            if view.active((*target.conditions, *link.conditions)):
                seen.add(component)
                subject, doubts = f"Boost::{component}", (Doubt.INCOMPLETE,)
                yield Diagnostic(link.at, subject, package.name, {"component": component}, "not asked for", doubts)
