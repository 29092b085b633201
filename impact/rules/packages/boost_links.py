"""Headers of compiled Boost libraries in targets that are not linked to the component."""

from collections.abc import Iterator
from typing import NamedTuple

from ...model.cmake.build import BuildTarget
from ...model.cmake.links import linked_items
from ...model.view import View
from ...targets.providers.library import BOOST_BROUGHT, BOOST_COMPILED, BOOST_OF_ROSCPP, compiled_component
from ..rule import Diagnostic
from ..severity import Doubt
from ..text import Text
from .catkin_links import BRING_NOTHING, PACKAGE_VARIABLE, Exported, linked_packages, list_linked, stem_of

_MESSAGE = "`{target}` includes `{header}` but does not link the Boost component `{component}`"
TEXTS = {
    "boost": Text(_MESSAGE, "find_package(Boost REQUIRED COMPONENTS {component}) and link it"),
    "boost, asked for": Text(_MESSAGE, "link `{subject}` to `{target}`"),
}


def list_unlinked_boost(view: View, package, asked: dict[str, set[str]]) -> Iterator[Diagnostic]:
    """Headers of compiled Boost libraries in targets that nothing given to them links the component to."""
    boost = view.target.library("boost") or ""
    targets = {t.name: t for t in package.build.targets}
    given: dict[str, _Given | None] = {}
    seen = set()
    for include in package.digest.includes:
        component = compiled_component(include.path, boost)
        if component is None or component in seen or include.role == "aside" or not view.certain(include.conditions):
            continue
        for name in include.targets:
            if name not in targets or not view.certain(targets[name].conditions):
                continue
            if name not in given:
                given[name] = _find_given(view, package, targets, name, asked)
            known = given[name]
            if known is None or component in known.linked:
                continue
            own = include.role == "build" and include.at.path in targets[name].sources
            lacking = own and _lacks_boost(view, package, targets[name], component)
            if component in known.components and not lacking:
                continue
            seen.add(component)
            asked_for = component in asked.get("Boost", ())
            data = {"target": name, "header": include.path, "component": component}
            kind = "boost, asked for" if asked_for else "boost"
            doubts = () if lacking else _list_doubts(view, include, targets[name], known)
            at = targets[name].at if asked_for else include.at
            yield Diagnostic(at, f"Boost::{component}", package.name, data, kind, doubts)
            break


class _Given(NamedTuple):
    """What a target is linked to: Boost components, those that it names itself, and whether a dependency may bring
    more of them."""

    components: frozenset[str]
    linked: frozenset[str]
    more: bool


def _list_doubts(view: View, include, target, known: _Given) -> tuple[Doubt, ...]:
    sure = not known.more and target.kind == "executable"
    # Who links a catkin library has Boost from roscpp.
    if include.role != "build" or (view.target.ros == 1 and not sure):
        return (Doubt.DISPENSABLE,)
    return () if sure else (Doubt.INCOMPLETE,)


def _find_given(view: View, package, targets, name: str, asked) -> _Given | None:
    """What a target is linked to, itself or through targets of its package; None when that cannot be seen."""
    items = linked_items(package, name)
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
        elif match := PACKAGE_VARIABLE.match(item):
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


# CMake packages whose libraries come with several of Boost's.
_BRING_BOOST = frozenset({"PCL", "gazebo", "ompl", "Gazebo", "rosbag2_cpp"})


def _lacks_boost(view: View, package, target: BuildTarget, component: str) -> bool:
    """True for a program of a catkin package to which nothing it is linked to can bring a component of Boost: of all
    packages that export some of Boost only those of ROS's core are among it, whose components are known."""
    catkin = package.build_type == "catkin" and view.target.ros == 1
    if not catkin or component not in _NOT_OF_THE_CORE or target.kind != "executable" or package.build.unresolved:
        return False
    linked = list_linked(package, target.name)
    if linked is None or any("$" in f.name for f in package.build.found):
        return False
    if not all(stem_of(item) in BRING_NOTHING or view.is_package(stem_of(item)) for item in linked if "$" in item):
        return False
    exported = Exported(view)
    brought = exported.closure(linked_packages(view, package, linked))
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
