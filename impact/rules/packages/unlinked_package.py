"""unlinked-package: a target compiles headers of a package and links nothing that brings its library.

What it does
    Reports programs, and shared libraries that are installed or exported, which include a client library (roscpp,
    rclcpp) and are linked to nothing, and in ROS 1 programs whose own sources compile headers of a library which no
    component that they are linked to exports.

Why it breaks
    The linker reports undefined references; for a shared library it does where the library is used.

Severity
    error for programs that include a client library; warning otherwise, since a program may not use what it includes.

Example
    add_executable(node src/node.cpp)           # which includes ros/ros.h

Use instead
    add_executable(node src/node.cpp)
    target_link_libraries(node ${catkin_LIBRARIES})

Not reported
    Headers that are templates alone; targets that are linked to something of which it cannot be seen what it brings.
"""

from collections.abc import Iterator

from ...model.cmake.build import is_for_tests
from ...model.cmake.catkin_links import CatkinExports, find_linked_packages, list_linked
from ...model.package import IncludeUse
from ...targets.platform import strip_separators
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule


@rule(
    group="missing-find-package",
    texts={
        "client library": Text(
            "`{target}` includes `{header}` but links nothing", "target_link_libraries({target} {item})"
        ),
        "unlinked": Text(
            "`{target}` compiles `{header}` but does not link `{subject}`",
            "add `{subject}` to find_package(catkin REQUIRED COMPONENTS ...) and link ${{catkin_LIBRARIES}}",
        ),
    },
)
def unlinked_package(view: TargetView, package: Package):
    if package.build_type in ("catkin", "ament_cmake"):
        yield from _list_without_client(view, package)
    if package.build_type == "catkin" and view.target.ros == 1:
        yield from _list_unlinked(view, package)


# Headers of client libraries, whose compiled part every program needs that includes them.
_CLIENTS = {"ros/ros.h": ("roscpp", "${catkin_LIBRARIES}"), "rclcpp/rclcpp.hpp": ("rclcpp", "rclcpp::rclcpp")}


def _list_without_client(view: TargetView, package: Package):
    """Programs, and shared libraries for others, that include a client library and are given nothing to link."""
    build = package.build
    if build.unresolved or build.links:
        return
    linked = {t.name for t in build.targets if any(link.how in ("link", "ament", "objects") for link in t.links)}
    offered = {e.item for e in build.exports if e.how in ("libraries", "ament_export_libraries")}
    offered |= build.installed_targets
    programs = {
        t.name: t
        for t in build.targets
        if (t.kind == "executable" or (t.kind == "library" and not t.static and t.name in offered))
        and t.name not in linked and t.sources and view.is_sure(t.conditions)
    }  # fmt: skip
    for include in package.linked.includes if programs else ():
        client, item = _CLIENTS.get(include.path, ("", ""))
        if not client or client in view.workspace.packages or not view.is_sure(include.conditions):
            continue
        if include.role != "build":
            continue  # such as a test's program that `make all` leaves out
        for name in include.targets:
            target = programs.get(name)
            # A library may have got the header by one that it uses for a type alone.
            if target is None or (target.kind == "library" and include.at.path not in target.sources):
                continue
            del programs[name]
            data = {"target": name, "header": include.path, "item": item}
            doubts = () if target.kind == "executable" else (Doubt.DISTURBS,)
            yield Diagnostic(target.at, client, package.name, data, "client library", doubts)


def _list_unlinked(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """Programs whose own sources the linker most likely misses a library for: they include its headers, and what they
    use of those is not looked at. What libraries of the package miss may come with any library that one of theirs needs
    in turn, which the linker finds by itself."""
    build = package.build
    if build.unresolved or any("$" in f.name for f in build.found):
        return
    exported = CatkinExports(view)
    includes: dict[str, list[IncludeUse]] = {}
    for include in package.linked.includes:
        if include.role == "build" and view.is_sure(include.conditions):
            for name in include.targets:
                includes.setdefault(name, []).append(include)
    seen = set()
    for target in build.targets:
        if target.kind != "executable" or is_for_tests(target.conditions) or not view.is_sure(target.conditions):
            continue
        linked = list_linked(package, target.name)
        if linked is None:
            continue
        brought = exported.list_transitive(find_linked_packages(view, package, linked))
        if brought is None:
            continue
        words = [strip_separators(item) for item in linked]
        for include in includes.get(target.name, ()):
            if not include.path.startswith(_COMPILED) or include.at.path not in target.sources:
                continue  # a header may be included for what another source uses
            providers = view.find_header(include.path)
            if len(providers) != 1 or providers[0].kind != "ros" or not providers[0].sure:
                continue
            name = providers[0].name
            if name in brought or name in seen or name == package.name:
                continue
            libraries = exported.list_libraries(name)
            if not libraries or any(strip_separators(lib) in word for lib in (*libraries, name) for word in words):
                continue
            seen.add(name)
            data = {"target": target.name, "header": include.path}
            yield Diagnostic(include.at, name, package.name, data, "unlinked", (Doubt.INCOMPLETE,))


# Headers of classes and functions that stand in a library, so that a program that uses them is linked to it. Headers
# that are templates, or inline, are left out: who includes those may do without the library. Source: the packages'
# sources, in which the constructors and functions of these stand in a .cpp file. Stored surfaces tell which functions
# are inline, and not which ones of a header a program is sure to use: most of these headers have some that are inline.
_HEADERS = """
    camera_info_manager/camera_info_manager.h control_toolbox/pid.h controller_manager/controller_manager.h
    costmap_2d/costmap_2d_ros.h cv_bridge/cv_bridge.h eigen_conversions/eigen_kdl.h
    eigen_conversions/eigen_msg.h geometric_shapes/shape_operations.h image_geometry/
    image_transport/image_transport.h interactive_markers/interactive_marker_server.h
    interactive_markers/menu_handler.h kdl_conversions/kdl_msg.h kdl_parser/kdl_parser.hpp
    laser_geometry/laser_geometry.h map_server/image_loader.h moveit/move_group_interface/move_group_interface.h
    moveit/planning_scene/planning_scene.h moveit/planning_scene_monitor/planning_scene_monitor.h
    moveit/robot_model_loader/robot_model_loader.h moveit/robot_state/robot_state.h nodelet/loader.h
    resource_retriever/retriever.h robot_state_publisher/robot_state_publisher.h ros/package.h ros/ros.h
    rosbag/bag.h rosbag/view.h srdfdom/model.h tf/transform_broadcaster.h tf/transform_listener.h
    tf2_ros/buffer.h tf2_ros/static_transform_broadcaster.h tf2_ros/transform_broadcaster.h
    tf2_ros/transform_listener.h tf_conversions/tf_eigen.h tf_conversions/tf_kdl.h topic_tools/shape_shifter.h
    urdf/model.h
"""
_COMPILED = tuple(_HEADERS.split())
