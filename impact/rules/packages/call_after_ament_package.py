"""call-after-ament-package: a command that ament_package() has to come after is called after it.

What it does
    Reports ament_export_*() and generate_interfaces() behind ament_package() in the same file.

Why it breaks
    ament_package() has written the configuration already: CMake stops, "must be called before ament_package()".

Severity
    error; warning where CMake may not reach the call.

Example
    ament_package()
    ament_export_dependencies(rclcpp)

Use instead
    ament_export_dependencies(rclcpp)
    ament_package()

Not reported
    Calls in other files than ament_package().
"""

from ..vocabulary import Diagnostic, Package, TargetView, Text, list_place_doubts, rule


@rule(
    texts=Text("{subject}() is called after ament_package(), so CMake stops", "call it before ament_package()"),
)
def call_after_ament_package(view: TargetView, package: Package):
    last = package.build.ament_package
    if last is None:
        return
    calls = [(e.how, e.at, e.conditions) for e in package.build.exports if e.how.startswith("ament_export_")]
    calls += [("rosidl_generate_interfaces", g.at, g.conditions) for g in package.build.generated if g.how == "rosidl"]
    for name, at, conditions in calls:
        if at.path == last.path and at.line > last.line:
            yield Diagnostic(at, name, package.name, doubts=list_place_doubts(view, "build", conditions))
            break
