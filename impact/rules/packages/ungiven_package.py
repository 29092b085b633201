"""ungiven-package: a target includes headers of a package that is found and not given to it.

What it does
    Reports packages of ament, and libraries of the system with an include folder of their own, that CMake finds, whose
    headers a source of a target includes, and that neither the target is given, itself or through what it links, nor
    the whole package.

Why it breaks
    The compiler does not get the include folder of the package. Until Galactic all packages had one folder in common,
    and some still use it.

Severity
    error for code that is built in any case; warning in tests, under a condition that is not known, where it is not
    known which folder the package uses, and where it gets one of its own with a later update.

Example
    find_package(angles REQUIRED)
    ament_target_dependencies(node rclcpp)      # and node.cpp includes angles/angles.h

Use instead
    ament_target_dependencies(node rclcpp angles)

Not reported
    Packages that come with one that the target is given; packages whose headers lie in the folder that packages have in
    common; targets that are given something that cannot be seen.
"""

import re
from collections.abc import Iterable, Iterator

from ...model.cmake.links import find_brought, is_opaque, may_hide, resolve_package
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .include_folders import OFF_PATH, collect_folder_doubts, shares_one_folder


@rule(
    group="missing-find-package",
    texts=Text("`{target}` includes `{header}` but is not given `{subject}`", "give `{subject}` to the target"),
    yields_to=("unlinked-package",),
)
def ungiven_package(view: TargetView, package: Package):
    if package.build_type != "ament_cmake" or package.build.unresolved:
        return
    targets = {t.name: t for t in package.build.targets}
    # Many files of a target include the same headers; other targets are made on other machines.
    includes = dict.fromkeys(
        (i.path, tuple(filter(targets.__contains__, i.targets)), i.role)
        for i in package.linked.includes
        if i.targets and view.is_sure(i.conditions)
    )
    yield from _list_off_path(view, package, includes)
    if shares_one_folder(view):
        return
    found = {f.name for f in package.build.found} - {package.name}
    if any("$" in name for name in found) or package.build.finds_declared:
        return
    seen = set()
    for path, including, role in includes:
        providers = view.find_header(path)
        owners = {p.name for p in providers}
        if not owners.isdisjoint(("", package.name)) or (
            (system := tuple(p for p in providers if p.kind != "ros"))
            and (view.unknown_contents.may_come_along(package) or view.is_met(system, view.build_environment(package)))
        ):
            continue  # the compiler finds it by itself
        names = owners & found  # of several possible owners, the one that CMake finds
        if len(names) != 1:
            continue
        (name,) = names
        if name in seen or name.endswith("_vendor"):
            continue
        of_folder = collect_folder_doubts(view, name, path)
        if of_folder is None or (len(providers) > 1 and Doubt.INCOMPLETE in of_folder):
            continue
        for target in including:
            brought = find_brought(view, package, target)
            if brought is None or not owners.isdisjoint(brought[0]) or any(may_hide(item, name) for item in brought[1]):
                continue
            seen.add(name)
            certain = view.is_sure(targets[target].conditions)
            doubts = (role == "build" or Doubt.TEST, certain or Doubt.CONDITIONAL, *of_folder)
            data = {"target": target, "header": path}
            yield Diagnostic(targets[target].at, name, package.name, data, doubts=doubts)
            break


def _list_off_path(
    view: TargetView, package: Package, includes: Iterable[tuple[str, tuple[str, ...], str]]
) -> Iterator[Diagnostic]:
    """Targets that include headers of a system library outside of the compiler's default path, which CMake finds, and
    that are given nothing that may bring its folder. includes: path, targets and role."""
    build = package.build
    targets = {t.name: t for t in build.targets}
    everywhere = [item for item, _ in build.include_dirs]
    seen = set()
    for path, including, role in includes:
        providers = view.find_header(path)[:1]
        if not providers or providers[0].name not in OFF_PATH or _NAMES_FOLDER.match(path):
            continue
        found = ((f.name, view.find_cmake(f.name)) for f in build.found if f.how == "find_package")
        name, bringing = next(((n, by) for n, by in found if by and by[0].name == providers[0].name), ("", ()))
        if not name or name in seen:
            continue
        for target in including:
            items = package.build.list_linked_items(target, None)
            if items is None or not view.is_sure(targets[target].conditions):
                continue
            items = {item for item in (*items, *everywhere) if item not in targets}
            if any(map(is_opaque, items)):
                continue
            given = {resolve_package(item) for item in items}
            known = {
                n: {p.name for p in view.find_cmake(n)[:1]} for n in given if "/" not in n and n not in package.folders
            }
            brought = view.list_transitive({key for n, keys in known.items() for key in (n, *keys)})
            alike = any(name.lower()[:3] in item.lower() for item in items)
            if alike or not all(known.values()) or view.is_met(bringing, brought):
                continue
            seen.add(name)
            data = {"target": target, "header": path}
            doubts = (role == "build" or Doubt.TEST, Doubt.INCOMPLETE)
            yield Diagnostic(targets[target].at, name, package.name, data, doubts=doubts)
            break


# Includes by the name of the folder itself, as in <eigen3/Eigen/Core>.
_NAMES_FOLDER = re.compile(r"(?:eigen3|pcl-[\d.]+|bullet|OGRE|libxml2)/")
