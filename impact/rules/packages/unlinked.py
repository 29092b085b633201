"""Programs of catkin packages that use a library, and are linked to nothing that brings it."""

from collections.abc import Iterator

from ...model.cmake.build import for_tests
from ...model.package import IncludeUse
from ...model.view import View
from ..rule import Diagnostic
from ..severity import Doubt
from ..text import Text
from .catkin_links import Exported, linked_packages, list_linked, plain

TEXTS = {
    "unlinked": Text(
        "`{target}` compiles `{header}` but links nothing that brings `{subject}`",
        "add `{subject}` to find_package(catkin REQUIRED COMPONENTS ...) and link ${{catkin_LIBRARIES}}",
    ),
}


def list_unlinked(view: View, package) -> Iterator[Diagnostic]:
    """Programs whose own sources the linker most likely misses a library for: they include its headers, and what they
    use of those is not looked at. What libraries of the package miss may come with any library that one of theirs needs
    in turn, which the linker finds by itself."""
    build = package.build
    if package.build_type != "catkin" or view.target.ros != 1 or build.unresolved:
        return
    found = {f.name for f in build.found}
    if any("$" in name for name in found):
        return
    exported = Exported(view)
    includes: dict[str, list[IncludeUse]] = {}
    for include in package.digest.includes:
        if include.role == "build" and view.certain(include.conditions):
            for name in include.targets:
                includes.setdefault(name, []).append(include)
    seen = set()
    for target in build.targets:
        if target.kind != "executable" or for_tests(target.conditions) or not view.certain(target.conditions):
            continue
        linked = list_linked(package, target.name)
        if linked is None:
            continue
        brought = exported.closure(linked_packages(view, package, linked))
        if brought is None:
            continue
        words = [plain(item) for item in linked]
        for include in includes.get(target.name, ()):
            if not include.path.startswith(_COMPILED) or include.at.path not in target.sources:
                continue  # a header may be included for what another source uses
            providers = view.header(include.path)
            if len(providers) != 1 or providers[0].kind != "ros" or not providers[0].sure:
                continue
            name = providers[0].name
            if name in brought or name in seen or name == package.name:
                continue
            libraries = exported.libraries(name)
            if not libraries or any(plain(lib) in word for lib in (*libraries, name) for word in words):
                continue
            seen.add(name)
            data = {"target": target.name, "header": include.path}
            yield Diagnostic(include.at, name, package.name, data, "unlinked", (Doubt.INCOMPLETE,))


# Headers of classes and functions that stand in a library, so that a program that uses them is linked to it. Headers
# that are templates, or inline, are left out: who includes those may do without the library. Source: the packages'
# sources, in which the constructors and functions of these stand in a .cpp file.
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
