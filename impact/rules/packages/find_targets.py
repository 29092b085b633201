"""What targets are given, against what their sources include: packages, client libraries, the package itself."""

import re

from ...model.cmake.build import for_tests
from ...model.cmake.links import may_hide, package_of
from ...model.view import View
from ...targets.version import at_least
from ..rule import Diagnostic
from ..severity import Doubt
from ..text import Text

TEXTS = {
    "not given": Text("`{target}` includes `{header}` but is not given `{subject}`", "give `{subject}` to the target"),
    "client library": Text(
        "`{target}` includes `{header}` but links nothing", "target_link_libraries({target} {item})"
    ),
    "own name": Text(
        "`{target}` is given `{package}`, which is this package itself, so CMake stops",
        "target_link_libraries({target} {package})",
    ),
}

_INCLUDE_DIRS_OF = re.compile(r"\$\{(.+?)_INCLUDE_DIRS?\}")
# Distros in which headers of all packages lay in one folder, so that any found package served every target.
ONE_FOLDER = ("ardent", "bouncy", "crystal", "dashing", "eloquent", "foxy", "galactic")


def check_given_packages(view: View, package):
    """Packages that are found, whose headers a target includes, and that the target is not given."""
    if package.build_type != "ament_cmake" or view.target.distro in ONE_FOLDER or package.build.unresolved:
        return
    targets = {t.name: t for t in package.build.targets}
    everywhere = {n for item, _ in package.build.include_dirs for n in _INCLUDE_DIRS_OF.findall(item)}
    everywhere |= {package_of(link.item) for link in package.build.links}
    found = {f.name for f in package.build.found}
    if any("$" in name for name in found) or any(f.how == "ament_auto" for f in package.build.found):
        return
    seen = set()
    reach: dict[str, tuple[frozenset[str], set[str]] | None] = {}
    for include in package.digest.includes:
        providers = view.header(include.path)
        if (
            not include.targets
            or not view.certain(include.conditions)
            or len(providers) != 1
            or providers[0].kind != "ros"
        ):
            continue
        name = providers[0].name
        if name not in found or name == package.name or name in seen or name.endswith("_vendor"):
            continue
        for target in include.targets:
            if target not in reach:
                items = _given(targets, target)
                hiding = {item for item in items or () if "$" in item and not _VARIABLE_OF_PACKAGE.fullmatch(item)}
                # Packages name their variables in capitals too: ${OMPL_INCLUDE_DIRS} is ompl's.
                given = {package_of(item) for item in items or () if item not in hiding} | everywhere
                names = {s for n in given if n for s in (n, n.lower())}
                reach[target] = None if items is None else (view.spread(names), hiding)
            brought = reach[target]
            if brought is None or name in brought[0] or any(may_hide(item, name) for item in brought[1]):
                continue
            seen.add(name)
            certain = view.certain(targets[target].conditions)
            doubts = (include.role == "build" or Doubt.TEST, certain or Doubt.CONDITIONAL)
            data = {"target": target, "header": include.path}
            yield Diagnostic(targets[target].at, name, package.name, data, "not given", doubts)
            break


_VARIABLE_OF_PACKAGE = re.compile(r"\$\{[^${}]+_(?:LIBRARIES|TARGETS|INCLUDE_DIRS?|LIBRARY|LIBS)\}")


def _given(targets, name: str) -> set[str] | None:
    """All that a target is given, itself or through targets of its package; None when that cannot be seen."""
    items: set[str] = set()
    stack, seen = [name], set()
    while stack:
        target = targets.get(stack.pop())
        if target is None or target.name in seen:
            continue
        seen.add(target.name)
        if target.kind in ("unknown", "external", "fetched"):
            return None
        if target.alias_of:
            stack.append(target.alias_of)
        for link in target.links:
            items.add(link.item)
            stack.append(link.item)
    return items


# Headers of client libraries, whose compiled part every program needs that includes them.
_CLIENTS = {"ros/ros.h": ("roscpp", "${catkin_LIBRARIES}"), "rclcpp/rclcpp.hpp": ("rclcpp", "rclcpp::rclcpp")}


def check_client_links(view: View, package):
    """Programs that include a client library and are given nothing to link."""
    build = package.build
    if build.unresolved or build.links or package.build_type == "ament_cmake_auto":
        return
    linked = {t.name for t in build.targets if any(link.how in ("link", "ament") for link in t.links)}
    programs = {
        t.name: t
        for t in build.targets
        if t.kind == "executable" and t.name not in linked and t.sources and view.certain(t.conditions)
    }
    for include in package.digest.includes if programs else ():
        client, item = _CLIENTS.get(include.path, ("", ""))
        if not client or client in view.workspace.packages or not view.certain(include.conditions):
            continue
        if include.role != "build":
            continue  # such as a test's program that `make all` leaves out
        for name in include.targets:
            target = programs.pop(name, None)
            if target is not None:
                data = {"target": name, "header": include.path, "item": item}
                yield Diagnostic(target.at, client, package.name, data, "client library")


def check_own_name(view: View, package):
    """ament_target_dependencies() with the package itself, which nothing has found when it is built."""
    if not stops_at_names(view) or any(f.name == package.name or "$" in f.name for f in package.build.found):
        return
    for target in package.build.targets:
        for link in target.links:
            if link.how == "ament" and link.item == package.name and view.certain(target.conditions + link.conditions):
                data = {"target": target.name}
                yield Diagnostic(link.at, "ament_target_dependencies", package.name, data, "own name")
                return


def stops_at_names(view: View) -> bool:
    """Whether ament_target_dependencies() stops at a name that was not found. Before 0.8.0 it meant to, and its test
    was never true. Source: commit 99d316a of ament_cmake."""
    return at_least(view.target.version("ament_cmake_target_dependencies") or "0.8.0", "0.8.0")


def list_given_names(view: View, package):
    """Names in ament_target_dependencies and `pkg::target` links that only find_package(pkg) can define."""
    own = {t.name for t in package.build.targets}
    for target in package.build.targets:
        for link in target.links:
            conditions = (*target.conditions, *link.conditions)
            if not view.certain(conditions) or "$" in link.item or link.item in own or for_tests(conditions):
                continue
            if link.how == "ament" and view.is_package(link.item):
                yield link.at, link.item
