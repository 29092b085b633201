"""unlinked-boost: a component of Boost is used and not linked, or linked and not asked for.

What it does
    Reports targets that include a header of Boost whose use needs a compiled component, and that nothing they are given
    links the component to, and targets that link `Boost::x` where find_package(Boost) is not given the component.

Why it breaks
    The linker reports undefined references, or CMake stops at a target that is not defined.

Severity
    For a header of a compiled component: error in an executable, warning in a library and where a dependency may bring
    the component, note in tests and, in ROS 1, in libraries; error for a component that no exported Boost of ROS 1 has.
    warning when `Boost::x` is linked and not asked for.

Example
    find_package(Boost REQUIRED)
    add_executable(logger src/logger.cpp)       # which includes boost/filesystem.hpp

Use instead
    find_package(Boost REQUIRED COMPONENTS filesystem)
    target_link_libraries(logger Boost::filesystem)

Not reported
    Headers that need no library in the target's version, or of which the package uses nothing; targets that are given
    something that cannot be seen; components that are not asked for where a part of the package's CMake cannot be read.
"""

from collections.abc import Iterator, Mapping, Set
from typing import NamedTuple

from ...model.cmake.build import BuildTarget
from ...model.cmake.links import is_opaque, list_linked_items, resolve_package
from ...targets.providers.library import BOOST_BROUGHT, BOOST_COMPILED, BOOST_OF_ROSCPP, find_compiled_component
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .catkin_links import CatkinExports, find_brought, list_linked

_MESSAGE = "`{target}` includes `{header}` but does not link the Boost component `{component}`"


class _BoostComponents(NamedTuple):
    """What a target is linked to: Boost components, those that it names itself, and whether a dependency may bring
    more of them."""

    components: frozenset[str]
    linked: frozenset[str]
    more: bool


@rule(
    group="library-component",
    texts={
        "boost": Text(_MESSAGE, "find_package(Boost REQUIRED COMPONENTS {component}) and link it"),
        "boost, asked for": Text(_MESSAGE, "link `{subject}` to `{target}`"),
        "not asked for": Text(
            "`{subject}` is linked, but the component `{component}` is not asked for",
            "add `{component}` to find_package(Boost COMPONENTS ...)",
        ),
    },
)
def unlinked_boost(view: TargetView, package: Package):
    asked = _list_asked_components(package)
    if asked is not None and not package.build.unresolved:  # what cannot be read may ask for more
        yield from _list_not_asked_for(view, package, asked)
    yield from _list_unlinked(view, package, asked or frozenset())


def _list_not_asked_for(view: TargetView, package: Package, asked: Set[str]) -> Iterator[Diagnostic]:
    """Imported targets of Boost whose component find_package() is not given."""
    seen = set(asked)
    for link in package.build.target_links:
        head, _, component = link.item.partition("::")
        if head != "Boost" or component in seen or component not in BOOST_COMPILED or not view.applies(link.conditions):
            continue
        seen.add(component)
        doubts = (Doubt.INCOMPLETE,)
        yield Diagnostic(link.at, link.item, package.name, {"component": component}, "not asked for", doubts)


def _list_unlinked(view: TargetView, package: Package, asked: Set[str]) -> Iterator[Diagnostic]:
    """Headers of compiled Boost libraries in targets that nothing given to them links the component to."""
    boost = view.target.find_library("boost") or ""
    targets = {t.name: t for t in package.build.targets}
    given: dict[str, _BoostComponents | None] = {}
    seen = set()
    for include in package.linked.includes:
        component = find_compiled_component(include.path, boost)
        if component is None or component in seen or include.role == "aside" or not view.is_sure(include.conditions):
            continue
        if include.idle:
            continue
        for name in include.targets:
            if name not in targets or not view.is_sure(targets[name].conditions):
                continue
            if name not in given:
                given[name] = _find_linked_components(view, package, targets, name, asked)
            known = given[name]
            if known is None or component in known.linked:
                continue
            own = include.role == "build" and include.at.path in targets[name].sources
            lacking = own and _lacks_boost(view, package, targets[name], component)
            if component in known.components and not lacking:
                continue
            seen.add(component)
            asked_for = component in asked
            data = {"target": name, "header": include.path, "component": component}
            kind = "boost, asked for" if asked_for else "boost"
            doubts = () if lacking else _list_doubts(view, include, targets[name], known)
            at = targets[name].at if asked_for else include.at
            yield Diagnostic(at, f"Boost::{component}", package.name, data, kind, doubts)
            break


def _list_doubts(view: TargetView, include, target, known: _BoostComponents) -> tuple[Doubt, ...]:
    sure = not known.more and target.kind == "executable"
    # Who links a catkin library has Boost from roscpp.
    if include.role != "build" or (view.target.ros == 1 and not sure):
        return (Doubt.DISPENSABLE,)
    return () if sure else (Doubt.INCOMPLETE,)


def _list_asked_components(package: Package) -> Set[str] | None:
    """The components of Boost that find_package() is given; None where no find_package() asks for Boost."""
    found = [f for f in package.build.found if f.how == "find_package" and f.name == "Boost"]
    components = (name for f in found for name in (*(name for name, _ in f.components), *f.optional_components))
    return frozenset(components) if found else None


def _find_linked_components(
    view: TargetView, package: Package, targets: Mapping[str, BuildTarget], name: str, asked: Set[str]
) -> _BoostComponents | None:
    """What a target is linked to, itself or through targets of its package; None when that cannot be seen."""
    items = list_linked_items(package, name)
    if items is None:
        return None
    components: set[str] = set()
    packages: set[str] = set()
    for item in items:
        low = item.lower()
        if low.startswith("boost::"):
            components.add(low[7:])
        elif low in ("boost", "${boost_libraries}", "${boost_library}"):
            components |= asked
        elif "boost_" in low:
            components |= {c for c in BOOST_COMPILED if f"boost_{c}" in low}
        elif is_opaque(item):
            return None
        else:
            packages.add(resolve_package(item))
    linked = components.union(*(BOOST_BROUGHT.get(c, ()) for c in components))
    if "catkin" in packages:
        packages |= {f.name for f in package.build.found if f.how == "catkin"}
    if any(found.name in _BRING_BOOST for found in package.build.found):
        return None
    brought = view.list_transitive(packages - set(targets))
    if view.target.ros == 1 and "roscpp" in brought:
        components |= BOOST_OF_ROSCPP
    components |= {c for c in BOOST_COMPILED if f"libboost-{c.replace('_', '-')}-dev" in brought}
    # Boost as a whole as a run dependency: somebody's export may name its libraries.
    more = not brought.isdisjoint(("boost", "libboost-all-dev", "libpcl-all-dev", "libpcl-all", "libpcl-dev"))
    for extra in list(components):
        components |= BOOST_BROUGHT.get(extra, set())
    return _BoostComponents(frozenset(components), frozenset(linked), more)


# CMake packages whose libraries come with several of Boost's.
_BRING_BOOST = frozenset({"PCL", "gazebo", "ompl", "Gazebo", "rosbag2_cpp"})


def _lacks_boost(view: TargetView, package: Package, target: BuildTarget, component: str) -> bool:
    """True for a program of a catkin package to which nothing it is linked to can bring a component of Boost: of all
    packages that export some of Boost only those of ROS's core are among it, whose components are known."""
    catkin = package.build_type == "catkin" and view.target.ros == 1
    if not catkin or component not in _NOT_OF_THE_CORE or target.kind != "executable" or package.build.unresolved:
        return False
    linked = list_linked(package, target.name)
    if linked is None or any("$" in f.name for f in package.build.found):
        return False
    exported, brought = CatkinExports(view), find_brought(view, package, linked)
    return brought is not None and all(
        name in _WITH_BOOST_OF_THE_CORE or not exported.may_bring(name, "boost") for name in brought
    )


# Components of Boost that no package of ROS's core finds, and the packages of it that export what they find. Source:
# find_package(Boost) and catkin_package(DEPENDS) in their CMakeLists.txt, Groovy to Noetic.
_NOT_OF_THE_CORE = frozenset({"program_options", "serialization", "iostreams", "log", "timer", "locale"})
_WITH_BOOST_OF_THE_CORE = frozenset(
    [
        "Boost", "actionlib", "bondcpp", "class_loader", "cpp_common", "message_filters", "nodelet", "pluginlib",
        "rosconsole", "roscpp", "roscpp_serialization", "rostime", "tf", "tf2", "tf2_ros", "xmlrpcpp",
    ]
)  # fmt: skip
