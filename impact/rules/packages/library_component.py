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

import re
from typing import NamedTuple

from ...model.package import IncludeUse
from ...model.view import View
from ...targets.providers.library import (
    BOOST_BROUGHT,
    BOOST_COMPILED,
    BOOST_OF_ROSCPP,
    compiled_component,
    gone_component,
)
from ...targets.version import at_least
from ..rule import Hit, rule
from .unlinked import lacks_boost, unlinked_opencv


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
                newest = view.newest
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
        yield from _linked_elsewhere(view, package)
        yield from unlinked_opencv(view, package)


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
    """Headers of compiled Boost libraries in targets that nothing given to them links the component to."""
    boost = view.target.library("boost") or ""
    targets = {t.name: t for t in package.build.targets}
    given: dict[str, _Given | None] = {}
    told = set()
    for include in package.digest.includes:
        component = compiled_component(include.path, boost)
        if component is None or component in told or include.role == "aside" or not view.certain(include.conditions):
            continue
        for name in include.targets:
            if name not in targets or not view.certain(targets[name].conditions):
                continue
            if name not in given:
                given[name] = _given(view, package, targets, name, asked)
            known = given[name]
            if known is None or component in known.linked:
                continue
            own = include.role == "build" and include.at.path in targets[name].sources
            lacking = own and lacks_boost(view, package, targets[name], component)
            if component in known.components and not lacking:
                continue
            told.add(component)
            asked_for = component in asked.get("Boost", ())
            yield Hit(
                targets[name].at if asked_for else include.at,
                f"Boost::{component}",
                f"`{name}` includes `{include.path}` and is not linked to the Boost component `{component}`",
                f"link `Boost::{component}` to `{name}`"
                if asked_for
                else f"find_package(Boost REQUIRED COMPONENTS {component}) and link it",
                package.name,
                severity="error" if lacking else _how_sure(view, include, targets[name], known),
            )
            break


class _Given(NamedTuple):
    """What a target is linked to: Boost components, those that it names itself, and whether a dependency may bring
    more of them."""

    components: frozenset[str]
    linked: frozenset[str]
    more: bool


def _how_sure(view: View, include, target, known: _Given) -> str:
    if include.role != "build":
        return "note"
    if view.target.ros == 1 and (known.more or target.kind != "executable"):
        return "note"  # who links a catkin library has Boost from roscpp
    return "warning" if known.more or target.kind != "executable" else "error"


def _given(view: View, package, targets, name: str, asked) -> _Given | None:
    """What a target is linked to, itself or through targets of its package; None when that cannot be told."""
    items = _links(package, targets, name)
    if items is None:
        return None
    components: set[str] = set()
    packages: set[str] = set()
    for item in items:
        low = item.lower()
        if low.startswith("boost::"):
            components.add(low[7:])
        elif low in ("boost", "${boost_libraries}", "${boost_library}"):
            components |= asked.get("Boost", set())
        elif "boost_" in low:
            components |= {c for c in BOOST_COMPILED if f"boost_{c}" in low}
        elif match := _VARIABLE.match(item):
            packages.add(match.group(1))
        elif "$" in item:
            return None
        else:
            packages.add(item.partition("::")[0])
    linked = components.union(*(BOOST_BROUGHT.get(c, ()) for c in components))
    if "catkin" in packages:
        packages |= {f.name for f in package.build.found if f.how == "catkin"}
    if any(found.name in _BRING_BOOST for found in package.build.found):
        return None
    brought = view.spread(packages - set(targets))
    if view.target.ros == 1 and "roscpp" in brought:
        components |= BOOST_OF_ROSCPP
    components |= {c for c in BOOST_COMPILED if f"libboost-{c.replace('_', '-')}-dev" in brought}
    # Boost as a whole as a run dependency: somebody's export may name its libraries.
    more = not brought.isdisjoint(("boost", "libboost-all-dev", "libpcl-all-dev", "libpcl-all", "libpcl-dev"))
    for extra in list(components):
        components |= BOOST_BROUGHT.get(extra, set())
    return _Given(frozenset(components), frozenset(linked), more)


def _links(package, targets, name: str) -> set[str] | None:
    """Everything a target is linked to, itself or through targets of its package; None when that cannot be told."""
    items = {link.item for link in package.build.links}
    stack, seen = [name], set()
    while stack:
        target = targets.get(stack.pop())
        if target is None or target.name in seen:
            continue
        seen.add(target.name)
        if target.kind in ("unknown", "external", "fetched", "imported"):
            return None
        if target.alias_of:
            stack.append(target.alias_of)
        for link in target.links:
            if link.how in ("link", "ament"):
                items.add(link.item)
                stack.append(link.item)
    return items


# Libraries that code with these includes has to be linked to: how the include paths begin, and a word of every name
# that the library is linked by, both folded.
_LINKED = (
    ("yaml-cpp/", "yamlcpp"),
    ("tinyxml2.h", "tinyxml2"),
    ("tinyxml.h", "tinyxml"),
    ("json/json.h", "jsoncpp"),
    ("jsoncpp/", "jsoncpp"),
    ("curl/curl.h", "curl"),
    ("GeographicLib/", "geographiclib"),
    ("assimp/", "assimp"),
    ("glog/", "glog"),
    ("ceres/", "ceres"),
    ("SDL2/", "sdl2"),
    ("libusb-1.0/", "usb"),
)


def _linked_elsewhere(view: View, package):
    """Programs that include a library's header and are not linked to it, beside a target that is."""
    targets = {t.name: t for t in package.build.targets}
    links: dict[str, set[str] | None] = {}
    told = set()
    for root, word in _LINKED:
        users: dict[str, IncludeUse] = {}
        for include in package.digest.includes:
            if include.path.startswith(root) and view.certain(include.conditions):
                for name in include.targets:
                    users.setdefault(name, include)
        if len(users) < 2:
            continue
        for name in users:
            if name not in links:
                links[name] = _links(package, targets, name) if name in targets else None
        own = {n for n in users if links[n] is not None and any(word in _plain(i) for i in links[n] or ())}
        for name, include in users.items():
            target, items = targets.get(name), links[name]
            if not own or name in own or target is None or items is None or word in told:
                continue
            if target.kind not in ("executable", "test") or not view.certain(
                c for c in target.conditions if "TESTING" not in c.text
            ):
                continue
            if any("$" in item and not _VARIABLE.match(item) for item in items):
                continue
            told.add(word)
            subject = root.partition("/")[0].removesuffix(".h")
            yield Hit(
                target.at,
                subject,
                f"`{name}` includes `{include.path}` and is not linked to `{subject}`, as `{min(own)}` is",
                f"link to `{name}` what `{min(own)}` is linked to",
                package.name,
                severity="warning",
            )


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", name.lower())


_VARIABLE = re.compile(r"\$\{(.+?)_(?:LIBRARIES|TARGETS|LIBRARY|LIBS|EXPORTED_TARGETS)\}\Z")
# CMake packages whose libraries come with several of Boost's.
_BRING_BOOST = frozenset({"PCL", "gazebo", "ompl", "Gazebo", "rosbag2_cpp"})
