"""other-generation: no package of the workspace can be built on a target, because all are for the other ROS generation.

What it does
    Reports, once for a target, that every package of the workspace builds with the tools of the other ROS generation:
    catkin packages against a ROS 2 target, ament packages against a ROS 1 target.

Why it breaks
    There is no catkin in ROS 2 and no ament in ROS 1. Findings of the other rules on such a target mean nothing.

Example
    rosimpact check catkin_ws/ --target humble

Use instead
    A target of the workspace's own generation, or manifests for both:
    <buildtool_depend condition="$ROS_VERSION == 1">catkin</buildtool_depend>
"""

from ...model.package import build_type_of
from ..vocabulary import At, Diagnostic, Package, TargetView, Text, rule


@rule(
    scope="target",
    texts=Text(
        "no package of the workspace can be built on {distro}: {build_type} belongs to ROS {generation}",
        help="check against a ROS {generation} target",
    ),
)
def other_generation(view: TargetView):
    packages = [p for p in view.workspace if not p.manifest.metapackage]
    foreign = [p for p in packages if _is_other_generation(view, p)]
    if not packages or len(foreign) < len(packages):
        return
    first = packages[0]
    if not view.reports_on(first.name):
        return
    data = {"distro": view.target.distro, "build_type": first.build_type, "generation": 3 - view.target.ros}
    others = tuple(package.name for package in view.workspace if package.name != first.name)
    at = At(first.linked.manifest_path, first.manifest.line, first.manifest.column)
    yield Diagnostic(at, first.name, first.name, data, also=others)


def _is_other_generation(view: TargetView, package: Package) -> bool:
    """True for packages that say they build with the other generation's tools; plain CMake and Python build in both."""
    tool = "catkin" if view.target.ros == 2 else "ament"
    build_type = build_type_of(package.manifest, view.target.ros)
    if build_type == "ament_cmake" and view.target.ros == 1:
        return True  # which nobody writes but for it
    return build_type.startswith(tool) and any(
        d.name.startswith(tool) and view.is_declaration_active(d.condition)
        for d in package.manifest.dependencies
        if d.kind in ("buildtool", "build")
    )
