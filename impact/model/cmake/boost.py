"""Which components of Boost a package asks for, and which its targets are linked to."""

from __future__ import annotations

from collections.abc import Set
from typing import NamedTuple

from ....edges.memory import cache_in_derived
from ...targets.providers.library import BOOST_BROUGHT, BOOST_COMPILED, BOOST_OF_ROSCPP
from ..view import TargetView
from ..workspace import Package
from .build import BuildTarget
from .catkin_links import list_bringing, list_linked
from .links import is_opaque, resolve_package


class LinkedBoost(NamedTuple):
    """What a target is linked to: Boost components, those that it names itself, and whether a dependency may bring
    more of them."""

    components: frozenset[str]
    linked: frozenset[str]
    more: bool


def list_asked_components(package: Package) -> Set[str] | None:
    """The components of Boost that find_package() is given; None where no find_package() asks for Boost."""
    found = [f for f in package.build.found if f.how == "find_package" and f.name == "Boost"]
    components = (name for f in found for name in (*(name for name, _ in f.components), *f.optional_components))
    return frozenset(components) if found else None


@cache_in_derived
def find_linked_boost(view: TargetView, package: Package, target: str, asked: Set[str]) -> LinkedBoost | None:
    """What a target is linked to, itself or through targets of its package; None when that cannot be seen."""
    items = package.build.list_linked_items(target)
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
    linked = set(components)
    if "catkin" in packages:
        packages |= package.build.catkin_components
    if any(found.name in _BRING_BOOST for found in package.build.found):
        return None
    brought = view.list_transitive(packages - {one.name for one in package.build.targets})
    if view.target.ros == 1 and "roscpp" in brought:
        components |= BOOST_OF_ROSCPP
    components |= {c for c in BOOST_COMPILED if f"libboost-{c.replace('_', '-')}-dev" in brought}
    # Boost as a whole as a run dependency: somebody's export may name its libraries.
    more = not brought.isdisjoint(("boost", "libboost-all-dev", "libpcl-all-dev", "libpcl-all", "libpcl-dev"))
    return LinkedBoost(_add_brought(components), _add_brought(linked), more)


def _add_brought(components: Set[str]) -> frozenset[str]:
    """Components of Boost, and those that their libraries are linked to."""
    return frozenset(components).union(*(BOOST_BROUGHT.get(one, ()) for one in components))


# CMake packages whose libraries come with several of Boost's.
_BRING_BOOST = frozenset({"PCL", "gazebo", "ompl", "Gazebo", "rosbag2_cpp"})


def lacks_boost(view: TargetView, package: Package, target: BuildTarget, component: str) -> bool:
    """True for a program of a catkin package to which nothing it is linked to can bring a component of Boost: of all
    packages that export some of Boost only those of ROS's core are among it, whose components are known."""
    catkin = package.build_type == "catkin" and view.target.ros == 1
    if not catkin or component not in _NOT_OF_THE_CORE or target.kind != "executable" or package.build.unresolved:
        return False
    linked = list_linked(package, target.name)
    if linked is None or any("$" in f.name for f in package.build.found):
        return False
    bringing = list_bringing(view, package, linked, "boost")
    return bringing is not None and bringing <= _WITH_BOOST_OF_THE_CORE


# Components of Boost that no package of ROS's core finds, and the packages of it that export what they find. Source:
# find_package(Boost) and catkin_package(DEPENDS) in their CMakeLists.txt, Groovy to Noetic.
_NOT_OF_THE_CORE = frozenset({"program_options", "serialization", "iostreams", "log", "timer", "locale"})
_WITH_BOOST_OF_THE_CORE = frozenset(
    [
        "Boost", "actionlib", "bondcpp", "class_loader", "cpp_common", "message_filters", "nodelet", "pluginlib",
        "rosconsole", "roscpp", "roscpp_serialization", "rostime", "tf", "tf2", "tf2_ros", "xmlrpcpp",
    ]
)  # fmt: skip
