"""Programs of catkin packages that use a library, and are linked to nothing that brings it.

What `catkin_LIBRARIES` holds is told by what the components asked for export, themselves and through CATKIN_DEPENDS:
by the build of those in the workspace, and by the stored surfaces of those that are released.
"""

import re
from collections.abc import Iterable, Iterator

from ...model.cmake.build import BuildTarget, for_tests
from ...model.package import IncludeUse
from ...model.view import View
from ...targets.providers.library import OPENCV_FUNCTIONS
from ..rule import Hit


def unlinked(view: View, package) -> Iterator[Hit]:
    """Programs whose own sources the linker most likely misses a library for: they include its headers, and what they
    use of those is not looked at. What libraries of the package miss may come with any library that one of theirs needs
    in turn, which the linker finds by itself."""
    build = package.build
    if package.build_type != "catkin" or view.target.ros != 1 or build.unresolved:
        return
    found = {f.name for f in build.found}
    if any("$" in name for name in found):
        return
    exported = _Exported(view)
    targets = {t.name: t for t in build.targets}
    includes: dict[str, list[IncludeUse]] = {}
    for include in package.digest.includes:
        if include.role == "build" and view.certain(include.conditions):
            for name in include.targets:
                includes.setdefault(name, []).append(include)
    told = set()
    for target in build.targets:
        if target.kind != "executable" or for_tests(target.conditions) or not view.certain(target.conditions):
            continue
        linked = _linked(package, targets, target)
        if linked is None:
            continue
        brought = exported.closure(_packages(view, package, linked))
        if brought is None:
            continue
        words = [_plain(item) for item in linked]
        for include in includes.get(target.name, ()):
            if not include.path.startswith(_COMPILED) or include.at.path not in target.sources:
                continue  # a header may be included for what another source uses
            providers = view.header(include.path)
            if len(providers) != 1 or providers[0].kind != "ros" or not providers[0].sure:
                continue
            name = providers[0].name
            if name in brought or name in told or name == package.name:
                continue
            libraries = exported.libraries(name)
            if not libraries or any(_plain(lib) in word for lib in (*libraries, name) for word in words):
                continue
            told.add(name)
            yield Hit(
                include.at,
                name,
                f"`{target.name}` compiles `{include.path}` and is linked to nothing that brings `{name}`",
                f"add `{name}` to find_package(catkin REQUIRED COMPONENTS ...) and link ${{catkin_LIBRARIES}}",
                package.name,
                severity="warning",
            )


# Headers of classes and functions that stand in a library, so that a program that uses them is linked to it. Headers
# that are templates, or inline, are left out: who includes those may do without the library. Source: the packages'
# sources, in which the constructors and functions of these stand in a .cpp file.
_COMPILED = (
    "camera_info_manager/camera_info_manager.h",
    "control_toolbox/pid.h",
    "controller_manager/controller_manager.h",
    "costmap_2d/costmap_2d_ros.h",
    "cv_bridge/cv_bridge.h",
    "eigen_conversions/eigen_kdl.h",
    "eigen_conversions/eigen_msg.h",
    "geometric_shapes/shape_operations.h",
    "image_geometry/",
    "image_transport/image_transport.h",
    "interactive_markers/interactive_marker_server.h",
    "interactive_markers/menu_handler.h",
    "kdl_conversions/kdl_msg.h",
    "kdl_parser/kdl_parser.hpp",
    "laser_geometry/laser_geometry.h",
    "map_server/image_loader.h",
    "moveit/move_group_interface/move_group_interface.h",
    "moveit/planning_scene/planning_scene.h",
    "moveit/planning_scene_monitor/planning_scene_monitor.h",
    "moveit/robot_model_loader/robot_model_loader.h",
    "moveit/robot_state/robot_state.h",
    "nodelet/loader.h",
    "resource_retriever/retriever.h",
    "robot_state_publisher/robot_state_publisher.h",
    "ros/package.h",
    "ros/ros.h",
    "rosbag/bag.h",
    "rosbag/view.h",
    "srdfdom/model.h",
    "tf/transform_broadcaster.h",
    "tf/transform_listener.h",
    "tf2_ros/buffer.h",
    "tf2_ros/static_transform_broadcaster.h",
    "tf2_ros/transform_broadcaster.h",
    "tf2_ros/transform_listener.h",
    "tf_conversions/tf_eigen.h",
    "tf_conversions/tf_kdl.h",
    "topic_tools/shape_shifter.h",
    "urdf/model.h",
)


def unlinked_opencv(view: View, package) -> Iterator[Hit]:
    """Programs that call functions of OpenCV which lie in libraries that nothing they are linked to hands on."""
    build = package.build
    if package.build_type != "catkin" or view.target.ros != 1 or build.unresolved:
        return
    calls = [
        use
        for use in package.digest.names
        if use.text in OPENCV_FUNCTIONS and use.role == "build" and view.certain(use.conditions)
    ]
    if not calls or any("$" in f.name for f in build.found):
        return
    exported = _Exported(view)
    targets = {t.name: t for t in build.targets}
    for target in build.targets:
        if target.kind != "executable" or for_tests(target.conditions) or not view.certain(target.conditions):
            continue
        linked = _linked(package, targets, target)
        if linked is None or any("opencv" in item.lower() for item in linked):
            continue
        if not all(_stem(item) in _OF_THEIR_OWN or view.is_package(_stem(item)) for item in linked if "$" in item):
            continue
        call = next((use for use in calls if use.at.path in target.sources), None)
        brought = exported.closure(_packages(view, package, linked)) if call is not None else None
        if call is None or brought is None:
            continue
        bringing = {name for name in brought if name != "OpenCV" and exported.may_bring(name, "opencv")}
        if not bringing <= {"cv_bridge"} or (bringing and view.target.distro in _WITH_ALL_OF_OPENCV):
            continue
        library = OPENCV_FUNCTIONS[call.text]
        yield Hit(
            call.at,
            "OpenCV",
            f"`{call.text}` is compiled into opencv_{library}, which nothing brings that `{target.name}` is linked to",
            f"find_package(OpenCV REQUIRED) and target_link_libraries({target.name} ${{OpenCV_LIBRARIES}})",
            package.name,
            severity="error",
        )
        return


def lacks_boost(view: View, package, target: BuildTarget, component: str) -> bool:
    """True for a program of a catkin package to which nothing it is linked to can bring a component of Boost: of all
    packages that export some of Boost only those of ROS's core are among it, whose components are known."""
    catkin = package.build_type == "catkin" and view.target.ros == 1
    if not catkin or component not in _NOT_OF_THE_CORE or target.kind != "executable" or package.build.unresolved:
        return False
    linked = _linked(package, {t.name: t for t in package.build.targets}, target)
    if linked is None or any("$" in f.name for f in package.build.found):
        return False
    if not all(_stem(item) in _OF_THEIR_OWN or view.is_package(_stem(item)) for item in linked if "$" in item):
        return False
    exported = _Exported(view)
    brought = exported.closure(_packages(view, package, linked))
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
# What is linked or exported beside packages of ROS, and brings no part of OpenCV or Boost along.
_OF_THEIR_OWN = frozenset(
    [
        "catkin", "Boost", "Eigen", "Eigen3", "EIGEN", "EIGEN3", "orocos_kdl", "console_bridge", "urdfdom",
        "urdfdom_headers", "TinyXML", "TinyXML2", "tinyxml", "tinyxml2", "Poco", "log4cxx", "LOG4CXX", "Bullet",
        "BULLET", "bullet", "YAML_CPP", "yaml-cpp", "BZip2", "lz4", "UUID", "CURL", "OpenSSL", "Threads", "PythonLibs",
    ]
)  # fmt: skip
# Distros whose cv_bridge hands on every library of OpenCV.
_WITH_ALL_OF_OPENCV = frozenset({"groovy", "hydro", "indigo", "jade"})


class _Exported:
    """What catkin packages hand on to whoever links them."""

    def __init__(self, view: View):
        self._view = view

    def libraries(self, name: str) -> tuple[str, ...]:
        """The libraries that a package exports; none where that is not known."""
        package = self._view.workspace.packages.get(name)
        if package is not None:
            return tuple(e.item for e in package.build.exports if e.how == "libraries" and "$" not in e.item)
        offer = self._view.offers.package(name)
        return tuple(lib for lib in offer.build.libraries if "$" not in lib) if offer is not None else ()

    def may_bring(self, name: str, library: str) -> bool:
        """Whether a part of a library, in lower case, may be among what a package itself hands on."""
        package = self._view.workspace.packages.get(name)
        if package is not None:
            given = [e.item for e in package.build.exports if e.how in ("system_depends", "libraries")]
            return any("$" in item or library in item.lower() for item in given)
        offer = self._view.offers.package(name)
        if offer is None:
            return name not in _OF_THEIR_OWN and not _INTERFACES.search(name) and name not in _BARE
        given = (*offer.build.system, *offer.build.libraries, *(why for _, why in offer.build.unknown))
        return any(library in item.lower() for item in given)

    def closure(self, names: Iterable[str]) -> frozenset[str] | None:
        """These packages and all that they bring; None where that of one is not known."""
        found: set[str] = set()
        waiting = list(names)
        while waiting:
            name = waiting.pop()
            if name in found:
                continue
            found.add(name)
            further = self._dependencies(name)
            if further is None:
                return None
            waiting.extend(further)
        return frozenset(found)

    def _dependencies(self, name: str) -> Iterable[str] | None:
        package = self._view.workspace.packages.get(name)
        if package is not None:
            given = [e.item for e in package.build.exports if e.how in ("catkin_depends", "system_depends")]
            return None if package.build.unresolved or any("$" in item for item in given) else given
        offer = self._view.offers.package(name)
        if offer is None:
            # What is no package of ROS, or one that only CMake builds, hands on no package of ROS.
            plain = not self._view.is_package(name) or self._view.target.known_build_types(name) - {""} == {"cmake"}
            return () if plain or _INTERFACES.search(name) else None
        return (*offer.build.dependencies, *offer.build.system)


_INTERFACES = re.compile(r"_(?:msgs?|srvs|actions)\Z")
# What packages of interfaces export.
_BARE = frozenset({"message_runtime", "message_generation"})


def _linked(package, targets: dict[str, BuildTarget], program: BuildTarget) -> set[str] | None:
    """All that a program is linked to, itself and through libraries of its package; None where that cannot be told."""
    items = {link.item for link in package.build.links}
    seen: set[str] = set()
    waiting = [program.name, *items]
    while waiting:
        target = targets.get(waiting.pop())
        if target is None or target.name in seen:
            continue
        if target.kind in ("unknown", "external", "fetched", "imported"):
            return None
        seen.add(target.name)
        if target.alias_of:
            waiting.append(target.alias_of)
        for link in target.links:
            if link.how == "link":
                items.add(link.item)
                waiting.append(link.item)
    if any("$" in item and not _VARIABLE.fullmatch(item) for item in items):
        return None
    return items


_VARIABLE = re.compile(r"\$\{(\w[\w.+-]*?)_(?:LIBRARIES|LIBRARY|LIBS|EXPORTED_TARGETS)\}")


def _packages(view: View, package, items: Iterable[str]) -> set[str]:
    """The packages that link items stand for."""
    names = {_stem(item) for item in items}
    if "catkin" in names:
        names.update(f.name for f in package.build.found if f.how == "catkin")
    return {name for name in names if view.is_package(name)} - {package.name, "catkin"}


def _stem(item: str) -> str:
    """`tf` of `${tf_LIBRARIES}`; any other item itself."""
    match = _VARIABLE.fullmatch(item)
    return match.group(1) if match else item


def _plain(name: str) -> str:
    return re.sub(r"[^a-z0-9]", "", name.lower())
