"""unused-dependency: nothing in a package uses a declared dependency.

What it does
    Reports build and run dependencies for which no find_package, include, import, launch reference, message field,
    plugin or exported name was found, and that no launch file, YAML or robot description mentions.

Why it matters
    Each one is installed on every machine, and can be removed from a distro.

Severity
    note: a dependency may be needed for reasons that no file shows.

Example
    <depend>laser_geometry</depend>             <!-- and nothing includes, finds, links or starts it -->

Use instead
    A manifest without it.

Not reported
    Metapackages, build tools, message runtimes, `*_vendor` packages, dependencies of packages with unresolved CMake.
"""

from ..vocabulary import Diagnostic, Package, TargetView, Text, rule
from .used_names import list_used_names, shows_uses

# How names of packages begin or end that are used by what is not read: build tools, programs that people start, and
# what generated code needs.
_SILENT = (
    "_vendor",
    "_runtime",
    "_generators",
    "message_generation",
    "message_runtime",
    "ament_",
    "rosidl",
    "python",
    "ros2launch",
    "launch",
    "rmw",
    "roslaunch",
    "rviz",
    "robot_state_publisher",
    "joint_state_publisher",
    "xacro",
)


@rule(
    severity="note",
    texts=Text(
        "nothing in `{package}` uses `{subject}`",
        help="remove the dependency if it is not needed for another reason",
    ),
)
def unused_dependency(view: TargetView, package: Package):
    if not shows_uses(package):
        return
    used = list_used_names(view, package)
    debian = {p.package for need in view.list_needs(package) for p in need.providers}
    found = {f.name for f in package.build.found}
    for name, kinds in view.collect_declared(package).items():
        if name in used or not kinds & {"build", "exec"} or name.startswith(_SILENT) or name.endswith(_SILENT):
            continue
        if (
            name in found
            and kinds & {"build"}
            and any(name in link.item for link in package.build.target_links)
        ):
            continue
        if view.list_debs(name) & debian or (
            view.target.find_version(name) is None and name not in view.workspace.packages
        ):
            continue
        yield Diagnostic(view.find_place(package, name), name, package.name)
