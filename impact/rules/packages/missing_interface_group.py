"""missing-interface-group: a package generates interfaces and is not a member of their group.

What it does
    Reports packages of ROS 2 that call rosidl_generate_interfaces() and whose package.xml does not have
    `<member_of_group>rosidl_interface_packages</member_of_group>`.

Why it breaks
    Packages that depend on the group, such as ros1_bridge, are built before this one and lack its interfaces.

Example
    <depend>rosidl_default_runtime</depend>

Use instead
    <depend>rosidl_default_runtime</depend>
    <member_of_group>rosidl_interface_packages</member_of_group>

Not reported
    Interfaces that are generated for tests, or under a condition that is not known.
"""

from ...model.cmake.build import for_tests
from ...model.view import TargetView
from ...model.workspace import Package
from ..rule import Declare, Diagnostic, Doubt, Text, rule

_GROUP = "rosidl_interface_packages"


@rule(
    severity="warning",
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
        if generated.how == "rosidl" and view.certain(generated.conditions) and not for_tests(generated.conditions):
            fix = _join_group(package)
            yield Diagnostic(generated.at, _GROUP, package.name, doubts=(Doubt.DISTURBS,), fix=fix)
            break


def _join_group(package) -> tuple[Declare, ...]:
    """Groups came with format 3."""
    if package.manifest.format < 3:
        return ()
    return (Declare(package.digest.manifest_path, _GROUP, "member_of_group"),)
