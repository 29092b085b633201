"""unregistered-component: a component is compiled into a library, and CMake does not register it.

What it does
    Reports libraries that compile rclcpp_components/register_node_macro.hpp where no rclcpp_components_register_node()
    or rclcpp_components_register_nodes() names the library.

Why it breaks
    A component container looks for the plugin in the ament index, which these calls write, and does not find it.

Severity
    warning where a launch file of the workspace loads a component of that name; note otherwise, since the library may
    be linked or loaded by its path.

Example
    add_library(camera SHARED src/camera.cpp)   # with RCLCPP_COMPONENTS_REGISTER_NODE(camera::Camera)

Use instead
    rclcpp_components_register_nodes(camera "camera::Camera")

Not reported
    Static libraries; libraries that are linked to one that is registered; packages that register a component whose name
    is not known, write the index themselves or describe plugins of pluginlib alone.
"""

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule

_MACRO = "rclcpp_components/register_node_macro.hpp"


@rule(
    severity="warning",
    preview=True,
    texts=Text(
        "`{subject}` has a component, but CMake does not register it, so containers do not find it",
        'call rclcpp_components_register_nodes({subject} "{component}")',
    ),
)
def unregistered_component(view: TargetView, package: Package):
    build = package.build
    if build.unresolved or package.build_type not in ("ament_cmake", "ament_cmake_auto"):
        return
    exports = [e for e in build.exports if e.how == "component"]
    described = {plugin.type for _, plugin in package.linked.plugins}
    lost = [name for name in package.linked.registered if name not in described | {e.item for e in exports}]
    if not lost or any("$" in e.item or "$" in e.context for e in exports):
        return
    if any(use.name == "ament_index_register_resource" for use in build.uses):
        return
    uses = (use.reference for other in view.workspace for use in other.linked.references)
    loaded = any(one.kind == "plugin" and one.name in lost for one in uses)
    registered = {name for e in exports for name in (e.context, *(build.list_linked_items(e.context) or ()))}
    including = {name for i in package.linked.includes if i.path == _MACRO and i.role == "build" for name in i.targets}
    for target in build.targets:
        if target.kind != "library" or target.static or target.name not in including - registered:
            continue
        if view.is_sure(target.conditions):
            data = {"component": lost[0] if len(lost) == 1 else "NAMESPACE::CLASS"}
            yield Diagnostic(target.at, target.name, package.name, data, doubts=(loaded or Doubt.UNCHECKED,))
