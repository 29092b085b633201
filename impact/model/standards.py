"""C++ standards that targets are compiled under on a view's target: what packages set, and what is asked of them."""

from __future__ import annotations

from collections.abc import Iterable

from ..targets.providers.library import find_default_standard, get_year
from ..targets.version import is_at_least
from .cmake.links import resolve_package
from .package import NameUse
from .view import TargetView
from .workspace import Package

_PASSING_ON = ("link", "ament", "interfaces")


def find_standards(view: TargetView, package: Package) -> dict[str, int]:
    """The years of the C++ standards that targets are compiled under at least: each one's own, and those that what it
    links asks of its users, in the package, the workspace and the released packages of the target."""
    targets = {target.name: target for target in package.build.targets}
    found: dict[str, int] = {}
    for target in targets.values():
        year = get_year(target.standard) if target.standard else 0
        others: set[str] = set()
        for own in package.build.list_reached_targets([target.name], _PASSING_ON):
            if own.public_standard:
                year = max(year, get_year(own.public_standard))
            others.update(resolve_package(link.item) for link in own.links if link.how in _PASSING_ON)
        if "catkin" in others:
            others |= package.build.catkin_components
        for name in view.roles.list_found_with(others - targets.keys()) if others else ():
            other = view.workspace.packages.get(name)
            asked = (
                max((t.public_standard for t in other.build.targets), default=0)
                if other is not None
                else (view.offers.find_standard(name))
            )
            year = max(year, get_year(asked) if asked else 0)
        if year:
            found[target.name] = year
    return found


def may_be_raised(view: TargetView, package: Package, names: Iterable[str]) -> bool:
    """Whether one of these targets links, through others of the workspace as well, an imported target of which it is
    not known what standard it asks for: CMake then compiles under that one."""
    targets = {target.name: target for target in package.build.targets}
    waiting, seen = list(names), set()
    while waiting:
        item = waiting.pop()
        if item in seen:
            continue
        seen.add(item)
        owner = resolve_package(item)
        other = view.workspace.packages.get(owner) if item not in targets and owner != package.name else None
        if item in targets:
            waiting.extend([targets[item].alias_of, *(link.item for link in targets[item].links if link.how == "link")])
        elif other is not None or owner == "catkin":
            # Its libraries are handed on with what they link.
            found = [other] if other is not None else _list_found(view, package)
            waiting.extend(link.item for one in found for made in one.build.targets for link in made.links)
        elif "::" in item and owner not in _ASKS_FOR_LITTLE and not view.offers.find_standard(owner):
            return True
    return False


# Their imported targets ask for C++11 at most.
_ASKS_FOR_LITTLE = frozenset({"Boost", "Eigen3", "Threads", "Qt5", "OpenMP", "yaml-cpp"})


def _list_found(view: TargetView, package: Package) -> list[Package]:
    packages = view.workspace.packages
    return [packages[name] for name in package.build.catkin_components if name in packages]


def _find_raised(view: TargetView) -> int:
    """The standard that CMake raises a package's to, since the exported targets of rclcpp and others ask for it. Rclcpp
    does since 9.0 (its CMakeLists.txt); of others before, none is known to ask for more than C++14."""
    if view.target.ros == 1:
        return 0
    if not is_at_least(view.target.find_version("rclcpp") or "9.0", "9.0"):
        return 2014
    return 2020 if is_at_least(view.target.find_library("gcc") or "", "15") else 2017


def find_failing_standard(
    view: TargetView, package: Package, use: NameUse, refused_from: int, needs: int
) -> str | None:
    """The C++ standard that a use fails under (empty: under any); None where it does not fail. refused_from, needs: the
    years of the standard that first refuses it and of the one that it needs, 0 for none."""
    if not refused_from and not needs:
        return ""
    build = package.build
    default = find_default_standard(view.target)
    own = [t.standard for t in build.targets if t.name in use.targets and t.standard]
    fixed = view.find_standard(package)
    set_for = ([fixed[0]] if fixed else []) + own
    have = max((get_year(number) for number in set_for), default=default)
    if have is None:
        return None
    if not set_for and may_be_set_elsewhere(view, package):
        return None
    if refused_from:
        return f"C++{have % 100:02d}" if have >= refused_from else None
    if max(have, _find_raised(view)) >= needs or not use.targets or use.role != "build":
        return None
    if not view.is_sure(use.conditions) or may_be_raised(view, package, use.targets):
        return None
    return f"C++{have % 100:02d}"


# Macros that come with the build tools, and set no standard.
_HARMLESS = ("catkin_", "ament_", "add_rostest", "add_ros", "generate_messages",
             "generate_dynamic_reconfigure", "generate_parameter_", "add_message", "add_service", "add_action",
             "ros", "rosidl_", "pkg_", "qt", "gtest_", "class_loader_", "pluginlib_", "rclcpp_components_",
             "protobuf_", "install_", "check_", "find_", "nodelet_", "orocos_", "configure_")  # fmt: skip


def may_be_set_elsewhere(view: TargetView, package: Package) -> bool:
    """True where a macro of another package, or a variable that it sets, may set the standard."""
    if package.build.open_flags:
        return True
    if any(u.kind == "command" and not u.name.startswith(_HARMLESS) for u in package.build.uses):
        return True
    if any("include(" in reason for _, reason in package.build.unresolved):
        return True
    found = view.list_transitive(f.name for f in package.build.found)
    own = [view.workspace.packages[name] for name in found if name in view.workspace.packages]
    return any(path.endswith((".cmake", ".cmake.in", ".cmake.em")) for other in own for path in other.files)
