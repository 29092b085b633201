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

from ...model.view import TargetView
from ...model.workspace import Package
from ..rule import Diagnostic, Text, rule

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
    if package.manifest.metapackage or (package.build_type == "ament_python" and not package.digest.imports):
        return
    if not package.digest.includes and not package.digest.imports and not package.digest.references:
        return
    used = {p.name for need in view.needs(package) for p in need.providers}
    debian = {p.package for need in view.needs(package) for p in need.providers}
    used.update(dep for g in package.build.generated for dep, _ in g.dependencies)
    used.update(e.item for e in package.build.exports)
    used.update(
        f.type.split("/")[0] for i in package.digest.interfaces for s in i.definition.sections for f in s.fields
    )
    found = {f.name for f in package.build.found}
    included = {i.path.split("/", 1)[0] for i in package.digest.includes} | {
        i.module.split(".")[0] for i in package.digest.imports
    }
    for name, kinds in view.declared(package).items():
        if (
            name in used
            or name in included
            or name in package.digest.named
            or not kinds & {"build", "exec"}
            or name.startswith(_SILENT)
            or name.endswith(_SILENT)
        ):
            continue
        if (
            name in found
            and kinds & {"build"}
            and any(name in link.item for t in package.build.targets for link in t.links)
        ):
            continue
        if view.debian(name) & debian or (view.target.version(name) is None and name not in view.workspace.packages):
            continue
        place = next(d for d in package.manifest.dependencies if d.name == name)
        yield Diagnostic(view.manifest_place(package, place), name, package.name)
