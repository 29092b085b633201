"""What targets are linked to, and what the catkin packages among it bring.

What `catkin_LIBRARIES` holds is told by what the components asked for export, themselves and through CATKIN_DEPENDS:
by the build of those in the workspace, and by the stored surfaces of those that are released.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from ....edges.memory import cache_method
from ....edges.reach import walk
from ...targets.platform import strip_separators
from ..view import TargetView
from ..workspace import Package
from .links import is_opaque, resolve_package

# What is linked or exported beside packages of ROS, and brings no part of OpenCV or Boost along. Kept by hand: of the
# Ubuntu releases of ROS 1 no index of dependencies is stored (apt.json.zst begins with Debian 11).
BRING_NOTHING = frozenset(
    [
        "catkin", "Boost", "Eigen", "Eigen3", "EIGEN", "EIGEN3", "orocos_kdl", "console_bridge", "urdfdom",
        "urdfdom_headers", "TinyXML", "TinyXML2", "tinyxml", "tinyxml2", "Poco", "log4cxx", "LOG4CXX", "Bullet",
        "BULLET", "bullet", "YAML_CPP", "yaml-cpp", "BZip2", "lz4", "UUID", "CURL", "OpenSSL", "Threads", "PythonLibs",
    ]
)  # fmt: skip


class CatkinExports:
    """What catkin packages hand on to whoever links them."""

    def __init__(self, view: TargetView):
        self._view = view

    def list_libraries(self, name: str) -> tuple[str, ...]:
        """The libraries that a package exports; none where that is not known."""
        package = self._view.workspace.packages.get(name)
        if package is not None:
            return tuple(e.item for e in package.build.exports if e.how == "libraries" and "$" not in e.item)
        offer = self._view.offers.find_package(name)
        return tuple(lib for lib in offer.build.libraries if "$" not in lib) if offer is not None else ()

    def may_bring(self, name: str, library: str) -> bool:
        """Whether a part of a library's name may be among what a package itself hands on, however it is written."""
        word = strip_separators(library)
        package = self._view.workspace.packages.get(name)
        if package is not None:
            given = [e.item for e in package.build.exports if e.how in ("system_depends", "libraries")]
            return any("$" in item or word in strip_separators(item) for item in given)
        offer = self._view.offers.find_package(name)
        if offer is None:
            return name not in BRING_NOTHING and not _INTERFACES.search(name)
        given = (*offer.build.system, *offer.build.libraries, *(why for _, why in offer.build.unknown))
        return any(word in strip_separators(item) for item in given)

    def list_transitive(self, names: Iterable[str]) -> frozenset[str] | None:
        """These packages and all that they bring; None where that of one is not known."""
        found = frozenset(walk(names, lambda name: self._list_dependencies(name) or ()))
        return None if any(self._list_dependencies(name) is None for name in found) else found

    def list_bringing(self, names: Iterable[str], library: str) -> set[str] | None:
        """Which of these packages, and of all that they bring, may hand on a part of a library; None where it is not
        known what one of them brings."""
        found = self.list_transitive(names)
        return None if found is None else {name for name in found if self.may_bring(name, library)}

    @cache_method
    def _list_dependencies(self, name: str) -> Iterable[str] | None:
        package = self._view.workspace.packages.get(name)
        if package is not None:
            given = [e.item for e in package.build.exports if e.how in ("catkin_depends", "system_depends")]
            return None if package.build.unresolved or any("$" in item for item in given) else given
        offer = self._view.offers.find_package(name)
        if offer is None:
            # What is no package of ROS, or one that only CMake builds, hands on no package of ROS.
            plain = not self._view.is_package(name) or self._view.target.list_build_types(name) - {""} == {"cmake"}
            return () if plain or _INTERFACES.search(name) else None
        return (*offer.build.dependencies, *offer.build.system)


_INTERFACES = re.compile(r"_(?:msgs?|srvs|actions)\Z")


def list_linked(package: Package, target: str) -> set[str] | None:
    """All that a target is linked to, itself and through targets of its package; None where that cannot be known, as of
    all that a manifest declares, of which some may be known nowhere."""
    items = package.build.list_linked_items(target)
    if items is None or ("${catkin_LIBRARIES}" in items and package.build.finds_declared):
        return None
    return None if any(map(is_opaque, items)) else items


def list_bringing(view: TargetView, package: Package, items: Iterable[str], library: str) -> set[str] | None:
    """Which packages of catkin that link items stand for, and of all that they bring, may hand on a part of a library;
    None where that cannot be known."""
    stems = (resolve_package(item) for item in items if "$" in item)
    if not all(stem in BRING_NOTHING or view.is_package(stem) for stem in stems):
        return None
    return CatkinExports(view).list_bringing(find_linked_packages(view, package, items), library)


def find_linked_packages(view: TargetView, package: Package, items: Iterable[str]) -> set[str]:
    """The packages that link items stand for."""
    names = {resolve_package(item) for item in items}
    if "catkin" in names:
        names |= package.build.catkin_components
    return {name for name in names if view.is_package(name)} - {package.name, "catkin"}
