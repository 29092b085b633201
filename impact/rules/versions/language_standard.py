"""language-standard: the C++ standard is too low for a dependency's headers.

What it does
    Compares the standard the package compiles with (-std= flags, CMAKE_CXX_STANDARD, else the target compiler's
    default) with what the headers it includes need in the target's version.

Why it breaks
    The compiler stops inside somebody else's header with errors about missing features.

Severity
    error for a -std= flag below what is needed and, in ROS 1, for a lower CMAKE_CXX_STANDARD or compiler default;
    warning where it is not certain that every use of the header needs it.

Example
    add_compile_options(-std=c++11)             # and pcl 1.12 needs C++14

Use instead
    set(CMAKE_CXX_STANDARD 17)

Not reported
    CMAKE_CXX_STANDARD in ROS 2: CMake raises it to what linked targets ask for.
"""

from ...model.view import View
from ...targets.library import default_standard, needed_standard, standard_year
from ..rule import Hit, rule


@rule(severity="error")
def language_standard(view: View):
    default = default_standard(view.target)
    for package in view:
        if package.build_type not in ("catkin", "ament_cmake", "ament_cmake_auto") or not package.digest.includes:
            continue
        fixed = package.build.standard
        have = standard_year(fixed[0]) if fixed else default
        if not fixed and (
            any(u.kind == "command" for u in package.build.uses)
            or any(f.name in view.workspace.packages for f in package.build.found)
        ):
            continue  # a macro of another package may set it
        if have is None:
            continue
        if view.target.ros == 2 and not (fixed and package.build.standard_by_flag):
            # CMake raises CMAKE_CXX_STANDARD to what the exported targets of rclcpp and others ask for.
            continue
        for include in package.digest.includes:
            if include.role != "build" or not view.certain(include.conditions):
                continue
            need = needed_standard(view.target, include.path)
            if need is None or need.package in view.workspace.packages or standard_year(need.standard) <= have:
                continue
            at = fixed[1] if fixed else include.at
            written = (
                f"C++{fixed[0] % 100:02d} is set"
                if fixed
                else f"no C++ standard is set and {view.target.platform}'s compiler takes C++{have % 100:02d}"
            )
            yield Hit(
                at,
                f"-std=c++{fixed[0] % 100:02d}" if fixed else include.path,
                f"{written}, and `{include.path}` of {need.package} {need.version} needs C++{need.standard}",
                f"set(CMAKE_CXX_STANDARD {need.standard})",
                package.name,
                severity="error" if need.sure and fixed else "warning",
            )
            break
