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
    compiler's default is below what they ask for: CMake then writes the higher one behind it. Headers of the standard
    library since C++17 of which no name is used: below their standard they are empty.
"""

from ...model.standards import find_standards, may_be_raised, may_be_set_elsewhere
from ...targets.providers.library import NeededStandard, find_default_standard, find_needed_standard, get_year
from ...targets.providers.standard import HEADER_SINCE, is_empty
from ...targets.version import is_at_least
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rate_newest, rule

_HELP = "set(CMAKE_CXX_STANDARD {needed})"
_NEEDS = "`{header}`[[ of {upstream}]][[ {version}]][[ ({horizon})]] needs C++{needed}"


@rule(
    scope="target",
    texts={
        "set": Text(f"C++{{standard}} is set, but {_NEEDS}", _HELP),
        "flag": Text(f"C++{{standard}} is set by a flag, but {_NEEDS}", _HELP),
        "default": Text(
            f"no C++ standard is set and the compiler of {{platform}} defaults to C++{{standard}}, but {_NEEDS}", _HELP
        ),
    },
)
def language_standard(view: TargetView):
    default = find_default_standard(view.target)
    for package in view:
        if not package.is_ros_cmake or not package.linked.includes:
            continue
        if view.target.ros == 1:
            yield from _check_ros1(view, package, default)
        else:
            yield from _check_ros2(view, package, default)


def _check_ros1(view: TargetView, package: Package, default: int | None):
    """What the package sets, else the compiler's default, against what is included."""
    fixed = view.find_standard(package)
    year = get_year(fixed[0]) if fixed else default
    if year is None:
        return
    if not fixed and may_be_set_elsewhere(view, package):
        return
    reported = set()
    # Qt's targets ask for C++11 themselves, as Qt does since 5.7 (its release notes).
    raised = is_at_least(view.target.find_library("qt") or "5.7", "5.7")
    sure = bool(fixed) or not (raised and any(f.name.startswith(("Qt5", "Qt6")) for f in package.build.found))
    standards = find_standards(view, package)
    for include in package.linked.includes:
        have = max([year, *(standards[t] for t in include.targets if t in standards)])
        if have >= 2020 or include.role != "build" or not include.targets or not view.is_sure(include.conditions):
            continue
        need = find_needed_standard(view.target, include.path) or _find_library_need(include.path)
        if need is None or need.package in reported or get_year(need.standard) <= have:
            continue
        if not need.package and (need.standard == 17 and not fixed):
            continue  # often beside std::experimental, under a test of the compiler
        if not need.package and include.idle and is_empty(include.path, view.machine.gcc):
            continue
        reported.add(need.package)
        own = need.package in view.workspace.packages
        known = need.sure and sure and not own and not may_be_raised(view, package, include.targets)
        doubts = (known or Doubt.INCOMPLETE,)
        data = _build_data(include.path, need, fixed[0] if fixed else have)
        if fixed:
            yield Diagnostic(fixed[1], _format_flag(fixed[0]), package.name, data, "set", doubts)
        else:
            data["platform"] = view.target.platform
            yield Diagnostic(include.at, _format_flag(need.standard), package.name, data, "default", doubts)


def _check_ros2(view: TargetView, package: Package, default: int | None):
    """A -std= flag stands where the compiler's default is all that linked targets ask for."""
    fixed = view.find_standard(package)
    if not fixed or not package.build.standard_by_flag or default is None:
        return
    have = get_year(fixed[0])
    own = {t.name: get_year(t.standard) for t in package.build.targets if t.standard}
    standards = find_standards(view, package)
    newest = view.newest
    for include in package.linked.includes:
        if include.role != "build" or not include.targets or not view.is_sure(include.conditions):
            continue
        if any(own.get(t, 0) > have or standards.get(t, 0) > max(have, default) for t in include.targets):
            continue  # CMake writes a flag of its own behind
        need = find_needed_standard(view.target, include.path)
        if need is None or need.package in view.workspace.packages:
            continue
        if get_year(need.standard) > have and default >= get_year(need.standard):
            doubts = (need.sure or Doubt.INCOMPLETE,)
            horizon = ""
        elif (
            newest is not None
            and (later := find_needed_standard(newest, include.path))
            and (get_year(later.standard) > have and (find_default_standard(newest) or 0) >= get_year(later.standard))
        ):
            need, doubts, horizon = later, (rate_newest(view),), view.horizon
        else:
            continue
        data = _build_data(include.path, need, fixed[0], horizon)
        yield Diagnostic(fixed[1], _format_flag(fixed[0]), package.name, data, "flag", doubts)
        return


def _build_data(path: str, need: NeededStandard, standard: int, horizon: str = "") -> dict[str, str | int]:
    """What the texts name. standard: as CMake writes it (98, 11), or its year."""
    return {
        "header": path if need.package else f"<{path}>",
        "upstream": need.package,
        "version": need.version,
        "horizon": horizon,
        "needed": need.standard,
        "standard": f"{standard % 100:02d}",
    }


def _format_flag(standard: int) -> str:
    return f"-std=c++{standard % 100:02d}"


def _find_library_need(path: str) -> NeededStandard | None:
    """What a header of the standard library needs; empty as a package."""
    standard = HEADER_SINCE.get(path)
    return NeededStandard(standard, "", "", True) if standard else None
