"""language-standard: the C++ standard is too low for a dependency's headers.

What it does
    Compares the standard the package compiles with (-std= flags, CMAKE_CXX_STANDARD, compile features, else the target
    compiler's default) with what the headers it includes need: those of dependencies in the target's version, and
    those of the standard library.

Why it breaks
    The compiler stops inside somebody else's header with errors about missing features.

Severity
    error for a -std= flag below what is needed and, in ROS 1, for a lower CMAKE_CXX_STANDARD or compiler default;
    warning where it is not certain that every use of the header needs it, where a macro of another package may set the
    standard, and where only the newest distro's compiler lets a -std= flag stand.

Example
    add_compile_options(-std=c++11)             # and pcl 1.12 needs C++14

Use instead
    set(CMAKE_CXX_STANDARD 17)

Not reported
    CMAKE_CXX_STANDARD in ROS 2: CMake raises it to what linked targets ask for. A -std= flag in ROS 2 where the
    compiler's default is below what they ask for: CMake then writes the higher one behind it.
"""

from ...model.cmake.links import standards_asked
from ...model.view import View
from ...targets.providers.library import NeededStandard, default_standard, needed_standard, standard_year
from ...targets.providers.standard import HEADER_SINCE
from ...targets.version import at_least
from ..rule import Hit, rule

# Macros that come with the build tools, and set no standard.
_HARMLESS = ("catkin_", "ament_", "add_rostest", "add_ros", "generate_", "add_message", "add_service", "add_action",
             "ros", "rosidl_", "pkg_", "qt", "gtest_", "class_loader_", "pluginlib_", "rclcpp_components_",
             "protobuf_", "install_", "check_", "find_", "nodelet_", "orocos_", "configure_")  # fmt: skip


@rule(severity="error")
def language_standard(view: View):
    default = default_standard(view.target)
    for package in view:
        if package.build_type not in ("catkin", "ament_cmake", "ament_cmake_auto") or not package.digest.includes:
            continue
        if view.target.ros == 1:
            yield from _ros1(view, package, default)
        else:
            yield from _ros2(view, package, default)


def _ros1(view: View, package, default: int | None):
    """What the package sets, else the compiler's default, against what is included."""
    fixed = view.standard(package)
    year = standard_year(fixed[0]) if fixed else default
    if year is None:
        return
    if not fixed and _may_be_set(view, package):
        return
    told = set()
    # Qt's targets ask for C++11 themselves, as Qt does since 5.7 (its release notes).
    raised = at_least(view.target.library("qt") or "5.7", "5.7")
    sure = bool(fixed) or not (raised and any(f.name.startswith(("Qt5", "Qt6")) for f in package.build.found))
    standards = standards_asked(view, package)
    for include in package.digest.includes:
        have = max([year, *(standards[t] for t in include.targets if t in standards)])
        if have >= 2020 or include.role != "build" or not include.targets or not view.certain(include.conditions):
            continue
        need = needed_standard(view.target, include.path) or _of_library(include.path)
        if need is None or need.package in told or standard_year(need.standard) <= have:
            continue
        if not need.package and (need.standard == 17 and not fixed):
            continue  # often beside std::experimental, under a test of the compiler
        told.add(need.package)
        own = need.package in view.workspace.packages
        written = (
            f"C++{fixed[0] % 100:02d} is set"
            if fixed
            else f"no C++ standard is set and {view.target.platform}'s compiler takes C++{have % 100:02d}"
        )
        yield Hit(
            fixed[1] if fixed else include.at,
            f"-std=c++{fixed[0] % 100:02d}" if fixed else f"-std=c++{need.standard}",
            f"{written}, and {_what(include.path, need)} needs C++{need.standard}",
            f"set(CMAKE_CXX_STANDARD {need.standard})",
            package.name,
            severity="error" if need.sure and sure and not own else "warning",
        )


def _ros2(view: View, package, default: int | None):
    """A -std= flag stands where the compiler's default is all that linked targets ask for."""
    fixed = view.standard(package)
    if not fixed or not package.build.standard_by_flag or default is None:
        return
    have = standard_year(fixed[0])
    own = {t.name: standard_year(t.standard) for t in package.build.targets if t.standard}
    standards = standards_asked(view, package)
    newest = view.newest
    for include in package.digest.includes:
        if include.role != "build" or not include.targets or not view.certain(include.conditions):
            continue
        if any(own.get(t, 0) > have or standards.get(t, 0) > max(have, default) for t in include.targets):
            continue  # CMake writes a flag of its own behind
        need = needed_standard(view.target, include.path)
        if need is None or need.package in view.workspace.packages:
            continue
        if standard_year(need.standard) > have and default >= standard_year(need.standard):
            severity = "error" if need.sure else "warning"
            where = ""
        elif (
            newest is not None
            and (later := needed_standard(newest, include.path))
            and (
                standard_year(later.standard) > have
                and (default_standard(newest) or 0) >= standard_year(later.standard)
            )
        ):
            need, severity, where = later, "warning", f" in {view.horizon}"
        else:
            continue
        yield Hit(
            fixed[1],
            f"-std=c++{fixed[0] % 100:02d}",
            f"C++{fixed[0] % 100:02d} is set by a flag, and {_what(include.path, need)}{where} needs "
            f"C++{need.standard}",
            f"set(CMAKE_CXX_STANDARD {need.standard})",
            package.name,
            severity=severity,
        )
        return


def _what(path: str, need: NeededStandard) -> str:
    owner = " ".join(n for n in (need.package, need.version) if n)
    return f"`{path}` of {owner}" if owner else f"`<{path}>`"


def _of_library(path: str) -> NeededStandard | None:
    """What a header of the standard library needs; empty as a package."""
    standard = HEADER_SINCE.get(path)
    return NeededStandard(standard, "", "", True) if standard else None


def _may_be_set(view: View, package) -> bool:
    """True where a macro of another package may set the standard."""
    if any(u.kind == "command" and not u.name.startswith(_HARMLESS) for u in package.build.uses):
        return True
    if any("include(" in reason for _, reason in package.build.unresolved):
        return True
    found = view.spread(f.name for f in package.build.found)
    own = [view.workspace.packages[name] for name in found if name in view.workspace.packages]
    return any(path.endswith((".cmake", ".cmake.in", ".cmake.em")) for other in own for path in other.files)
