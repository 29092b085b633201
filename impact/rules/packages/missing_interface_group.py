"""missing-interface-group: a package generates interfaces and is not a member of their group.

What it does
    Reports packages of ROS 2 that call generate_interfaces() and whose package.xml does not have
    `<member_of_group>rosidl_interface_packages</member_of_group>`.

Why it breaks
    generate_interfaces() stops where it installs interfaces of a package that is not in the group. Packages that
    depend on the group, such as ros1_bridge, are built before this one and lack its interfaces.

Severity
    error; warning for interfaces that are not installed, and before Eloquent.

Example
    <depend>rosidl_default_runtime</depend>

Use instead
    <depend>rosidl_default_runtime</depend>
    <member_of_group>rosidl_interface_packages</member_of_group>

Not reported
    Interfaces that are generated for tests, or under a condition that is not known.
"""

from ...model.cmake.build import is_for_tests
from ...targets.version import is_at_least
from ..vocabulary import Declare, Diagnostic, Doubt, Package, TargetView, Text, rule

_GROUP = "rosidl_interface_packages"
# From here on, at the latest, generate_interfaces() asks. Source: its CMake code in rosidl_cmake, whose change
# log has nothing about it since.
_ASKS = "0.8.0"


@rule(
    group="missing-interface-wiring",
    texts=Text(
        "`{package}` generates interfaces but is not a member of their group",
        "add `<member_of_group>{subject}</member_of_group>` to package.xml",
    ),
)
def missing_interface_group(view: TargetView, package: Package):
    if not package.build_type.startswith("ament"):
        return
    if any(d.kind == "member_of_group" and d.name == _GROUP for d in package.manifest.dependencies):
        return
    for generated in package.build.generated:
        if generated.how == "rosidl" and view.is_sure(generated.conditions) and not is_for_tests(generated.conditions):
            stops = generated.installed and is_at_least(view.target.find_version("rosidl_cmake") or "0", _ASKS)
            doubts = (stops or Doubt.DISTURBS,)
            join = Declare(package.linked.manifest_path, _GROUP, "member_of_group")
            fix = (join,) if package.manifest.format >= 3 else ()  # groups came with it
            yield Diagnostic(generated.at, _GROUP, package.name, doubts=doubts, fix=fix)
            break
