"""other-generation: nothing of the workspace can be built on a target, since it is written for the other ROS.

What it does
    Says so once for a target of one ROS generation when every package of the workspace builds with the other's tools:
    catkin packages against a ROS 2 target, ament packages against a ROS 1 target.

Why it breaks
    There is no catkin in ROS 2 and no ament in ROS 1. What the other rules would say of such a target means nothing.

Severity
    error.

Example
    rosimpact check catkin_ws/ --target humble

Use instead
    A target of the workspace's own generation, or manifests for both:
    <buildtool_depend condition="$ROS_VERSION == 1">catkin</buildtool_depend>
"""

from ...model.cmake.build import At
from ...model.package import build_type_of
from ...model.view import View
from ..rule import Hit, rule


@rule(severity="error")
def other_generation(view: View):
    packages = [p for p in view.workspace if not p.manifest.metapackage]
    foreign = [p for p in packages if _other(view, p)]
    if not packages or len(foreign) < len(packages):
        return
    first = packages[0]
    if not view.reports_on(first.name):
        return
    count = "the package" if len(packages) == 1 else f"none of the {len(packages)} packages"
    verb = "cannot be built" if len(packages) == 1 else "can be built"
    yield Hit(
        At(first.digest.manifest_path, first.manifest.line),
        first.name,
        f"{count} {verb} on {view.target.distro}: {first.build_type} is of ROS {3 - view.target.ros}",
        f"check against a ROS {3 - view.target.ros} target",
        first.name,
    )


def _other(view: View, package) -> bool:
    """True for packages that say they build with the other generation's tools; plain CMake and Python build in both."""
    tool = "catkin" if view.target.ros == 2 else "ament"
    build_type = build_type_of(package.manifest, view.target.ros)
    return build_type.startswith(tool) and any(
        d.name.startswith(tool) and (not d.condition or view.active_manifest(d.condition))
        for d in package.manifest.dependencies
        if d.kind in ("buildtool", "build")
    )
