"""library-component: a component of a library is used and not asked for, or asked for and gone on a platform.

What it does
    Compares the components given to find_package(Boost|Qt5|Qt6|VTK|OpenCV|PCL ... COMPONENTS) with what the target's
    version of the library has, and with the imported targets (`Boost::thread`, `Qt5::Widgets`) and headers that need a
    compiled component.

Why it breaks
    CMake stops at a component that is gone (`signals` since Boost 1.69), or the linker at symbols of one never linked.

Severity
    error when a component that is surely required is gone on the target; warning when only the newest distro lacks it,
    when `Boost::x` is linked and not asked for, and when a header of a compiled component is included while other
    components are asked for; note where nothing tells how Boost is linked.

Example
    find_package(Boost REQUIRED COMPONENTS signals)

Use instead
    find_package(Boost REQUIRED)                # and boost/signals2, which is header-only
"""

from ...model.view import View
from ...targets.library import BOOST_COMPILED, gone_component
from ...targets.version import at_least
from ..rule import Hit, rule


@rule(severity="error")
def library_component(view: View):
    for package in view:
        asked: dict[str, set[str]] = {}
        for found in package.build.found:
            if found.how != "find_package" or not view.active(found.conditions):
                continue
            names = asked.setdefault(found.name, set())
            names.update(name for name, _ in found.components)
            names.update(found.optional_components)
            for name, at in found.components:
                gone = gone_component(view.target, found.name, name)
                newest = view.target.newest()
                later = gone_component(newest, found.name, name) if newest is not None and not gone else None
                if later:
                    yield Hit(
                        at,
                        name,
                        f"`{name}` is there, and gone in {found.name} {later.version} of {view.horizon}",
                        later.help,
                        package.name,
                        severity="warning"
                        if found.required and name != "system" and view.certain(found.conditions)
                        else "note",
                    )
                if gone:
                    sure = found.required and view.certain(found.conditions)
                    yield Hit(
                        at,
                        name,
                        f"{found.name} {gone.version} has no component `{name}`",
                        gone.help,
                        package.name,
                        severity="error" if sure else "warning",
                    )
        yield from _old_qt(view, package)
        yield from _linked(view, package, asked)
        yield from _included(view, package, asked)


def _old_qt(view: View, package):
    """Qt 4 beside rviz or rqt, which are built with Qt 5 since version 1.12 and Kinetic."""
    found = {f.name: f for f in package.build.found if f.how == "find_package" and view.active(f.conditions)}
    qt4 = found.get("Qt4")
    if (
        qt4 is None
        or "Qt5Widgets" in found
        or "Qt5" in found
        or not view.declared(package).keys() & {"rviz", "rqt_gui_cpp"}
    ):
        return
    rviz = view.target.version("rviz") or ""
    if rviz and at_least(rviz, "1.12"):
        sure = qt4.required and view.certain(qt4.conditions)
        yield Hit(
            qt4.at,
            "Qt4",
            f"`{package.name}` finds Qt 4, and rviz {rviz} is built with Qt 5",
            "find_package(Qt5 COMPONENTS Core Widgets)",
            package.name,
            severity="error" if sure else "warning",
        )


def _linked(view: View, package, asked):
    if "Boost" not in asked:
        return
    told = set()
    for target in package.build.targets:
        for link in target.links:
            head, _, component = link.item.partition("::")
            if head != "Boost" or not component or component in told or component in asked["Boost"]:
                continue
            if component not in BOOST_COMPILED or not view.active((*target.conditions, *link.conditions)):
                continue
            told.add(component)
            yield Hit(
                link.at,
                f"Boost::{component}",
                f"`Boost::{component}` is linked and the component `{component}` is not asked for",
                f"add `{component}` to find_package(Boost COMPONENTS ...)",
                package.name,
                severity="warning",
            )


def _included(view: View, package, asked):
    """Headers of compiled Boost libraries in built code, with no sign that the component is linked."""
    if any("boost" in n.lower() and n != "Boost" for n in asked):
        return
    linked = " ".join(link.item for t in package.build.targets for link in t.links).lower()
    told = set()
    for include in package.digest.includes:
        component = BOOST_COMPILED_HEADERS.get(include.path)
        if component is None or component in told or include.role != "build" or not view.certain(include.conditions):
            continue
        if component in asked.get("Boost", ()) or f"boost_{component}" in linked or f"boost::{component}" in linked:
            continue
        if "boost_libraries" not in linked and "Boost" in asked and asked["Boost"]:
            pass
        told.add(component)
        yield Hit(
            include.at,
            component,
            f"`{include.path}` needs the compiled Boost component `{component}`, which is not asked for",
            f"find_package(Boost REQUIRED COMPONENTS {component}) and link it",
            package.name,
            severity="warning" if asked.get("Boost") else "note",
        )


BOOST_COMPILED_HEADERS = {
    "boost/filesystem.hpp": "filesystem",
    "boost/filesystem/path.hpp": "filesystem",
    "boost/filesystem/operations.hpp": "filesystem",
    "boost/program_options.hpp": "program_options",
    "boost/regex.hpp": "regex",
    "boost/iostreams/device/mapped_file.hpp": "iostreams",
    "boost/iostreams/filter/gzip.hpp": "iostreams",
    "boost/iostreams/filter/zlib.hpp": "iostreams",
    "boost/serialization/serialization.hpp": "serialization",
    "boost/archive/text_oarchive.hpp": "serialization",
    "boost/archive/binary_oarchive.hpp": "serialization",
}
