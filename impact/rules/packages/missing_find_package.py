"""missing-find-package: built code uses a package that CMake never looks for.

What it does
    Reports packages whose headers compiled code includes, or whose CMake variables and targets are used, when no
    find_package (or catkin component, pkg_check_modules, ament_auto) of the package asks for them and none that is
    asked for brings them.

Why it breaks
    The compiler misses the include path, or the linker the library, unless another package happens to add them.

Severity
    error where a target is linked or an include path used under a name that only the missing find_package defines;
    warning for includes, since an include path may come along by accident.

Example
    ament_target_dependencies(node angles)      # and no find_package(angles REQUIRED)

Use instead
    find_package(angles REQUIRED)

Not reported
    Packages that come with another one that is found; headers of the C and C++ libraries.
"""

import re
from functools import lru_cache

from ...model.view import View, interface_of
from ..evidence import weight
from ..rule import Hit, rule

_SYSTEM_BY_DEFAULT = (
    "boost/",
    "yaml-cpp/",
    "tinyxml",
    "SDL/",
    "libusb",
    "GL/",
    "zlib",
    "curl/",
    "gtest/",
    "gmock/",
    "openssl/",
)


@rule(severity="warning")
def missing_find_package(view: View):
    for package in view:
        build = package.build
        if not build.files or package.build_type not in ("catkin", "ament_cmake", "ament_cmake_auto"):
            continue
        yield from _find_modules(view, package)
        yield from _no_components(view, package)
        yield from _directories_not_given(view, package)
        yield from _not_given(view, package)
        found = found_names(view, package)
        if found is None:
            continue
        reachable = view.spread(found)
        closure = view.closure(package)
        told = set()
        for at, name in _given_to_targets(view, package):
            if name in reachable or name in told or name in package.digest.modules or name == package.name:
                continue
            told.add(name)
            yield Hit(
                at,
                name,
                f"`{name}` is given to a target and find_package(`{name}`) is never called",
                f"add find_package({name} REQUIRED)",
                package.name,
                severity="error",
            )
        sought = {_folded(f.name) for f in package.build.found}
        linked = {_folded(link.item) for t in package.build.targets for link in t.links if link.how == "link"}
        for need in sorted(view.needs(package), key=weight):
            if need.how != "include" or need.role != "build" or not need.certain:
                continue
            if view.answered(need.providers, reachable) or need.subject.startswith(_SYSTEM_BY_DEFAULT):
                continue
            name = next((p.name for p in need.providers if p.name in closure), None)
            if name is None or name in told or name == package.name:
                continue
            ros = need.providers[0].kind == "ros"
            stems = {_folded(p.name) for p in need.providers} | {_folded(need.subject.split("/")[0])}
            if any(a in b or b in a for a in stems for b in sought if len(a) > 2 and len(b) > 2):
                continue
            if not ros and any(a in b or b in a for a in stems for b in linked if len(a) > 2 and len(b) > 2):
                continue
            header_only = ros and view.target.ros == 1 and interface_of(view, need.subject) is not None
            if not ros and any(_cmake_of(view, f) & {p.name for p in need.providers} for f in found):
                continue
            told.add(name)
            direct = name in view.declared(package)
            yield Hit(
                need.at,
                name,
                f"`{need.subject}` is included and CMake never looks for `{name}`",
                f"add find_package({name} REQUIRED) and give it to the target",
                package.name,
                severity=_weight_of(view, need, direct and ros and not header_only),
            )


# Find modules that cmake_modules puts on CMake's path, once it is found itself. Catkin did so until Hydro.
_FIND_MODULES = frozenset({"Eigen", "NUMPY", "TBB", "TinyXML", "TinyXML2", "UUID", "Xenomai", "GSL"})


def _find_modules(view: View, package):
    """find_package calls whose find module comes with a package that is not found before."""
    if package.build_type != "catkin" or view.target.ros != 1 or view.target.distro in ("groovy", "hydro"):
        return
    names = {f.name for f in package.build.found}
    own = {p.rsplit("/", 1)[-1] for p in package.files if p.endswith(".cmake")}
    for found in package.build.found:
        if found.name not in _FIND_MODULES or found.how != "find_package" or f"Find{found.name}.cmake" in own:
            continue
        if "cmake_modules" in names or view.providers.cmake_platforms(found.name) or not view.active(found.conditions):
            continue
        sure = found.required and view.certain(found.conditions)
        yield Hit(
            found.at,
            "cmake_modules",
            f"`Find{found.name}.cmake` comes with `cmake_modules`, which CMake never looks for",
            "add `cmake_modules` to find_package(catkin REQUIRED COMPONENTS ...) and to package.xml",
            package.name,
            severity="error" if sure else "warning" if found.required else "note",
        )


def _weight_of(view: View, need, counts: bool) -> str:
    """How surely a missing find_package stops the compiler: since Humble every package has its own include folder."""
    if not counts or not (need.targets or need.public):
        return "note"
    apart = view.target.ros == 2 and view.target.distro not in _ONE_FOLDER
    return "error" if apart and need.targets and len(need.providers) == 1 else "warning"


_OF_PACKAGE = re.compile(r"\$\{(.+?)_(?:LIBRARIES|TARGETS|INCLUDE_DIRS|INCLUDE_DIR|LIBRARY|LIBS)\}")
# Distros in which headers of all packages lay in one folder, so that any found package served every target.
_ONE_FOLDER = ("ardent", "bouncy", "crystal", "dashing", "eloquent", "foxy", "galactic")


def _not_given(view: View, package):
    """Packages that are found, whose headers a target includes, and that the target is not given."""
    if package.build_type != "ament_cmake" or view.target.distro in _ONE_FOLDER or package.build.unresolved:
        return
    targets = {t.name: t for t in package.build.targets}
    everywhere = {n for item, _ in package.build.include_dirs for n in _OF_PACKAGE.findall(item)}
    everywhere |= {_package_of(link.item) for link in package.build.links}
    found = {f.name for f in package.build.found}
    if any("$" in name for name in found) or any(f.how == "ament_auto" for f in package.build.found):
        return
    told = set()
    reach: dict[str, dict[str, str] | None] = {}
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
        if name not in found or name == package.name or name in told:
            continue
        for target in include.targets:
            if target not in reach:
                given = _given(view, targets, target)
                # Packages name their variables in capitals too: ${OMPL_INCLUDE_DIRS} is ompl's.
                names = {s for n in (*(given or ()), *everywhere) if n for s in (n, n.lower())}
                reach[target] = None if given is None else view.spread(names)
            brought = reach[target]
            if brought is None or name in brought:
                continue
            told.add(name)
            yield Hit(
                targets[target].at,
                name,
                f"`{target}` includes `{include.path}` and is not given `{name}`",
                f"give `{name}` to the target",
                package.name,
                severity="error" if include.role == "build" and view.certain(targets[target].conditions) else "warning",
            )
            break


@lru_cache(maxsize=10000)
def _package_of(item: str) -> str:
    """The package that a link item stands for: `pkg::target`, `${pkg_LIBRARIES}`, or the item itself."""
    match = _OF_PACKAGE.match(item)
    return match.group(1) if match else item.partition("::")[0]


def _given(view: View, targets, name: str) -> set[str] | None:
    """Packages that a target is given, itself or through targets of its package; None when that cannot be told."""
    names: set[str] = set()
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
            if "$" in link.item and not _OF_PACKAGE.match(link.item):
                return None
            names.add(_package_of(link.item))
            stack.append(link.item)
    return names


def _directories_not_given(view: View, package):
    """catkin packages that are found, and whose include directories no target gets."""
    build = package.build
    if package.build_type != "catkin" or not any(f.how == "catkin" for f in build.found) or build.unresolved:
        return
    given = " ".join(
        [item for item, _ in build.include_dirs]
        + [link.item for t in build.targets for link in t.links if link.how == "include"]
    )
    if "catkin_INCLUDE_DIRS" in given or "/opt/ros" in given:
        return
    for target in build.targets:
        if target.kind not in ("executable", "library") or not view.certain(target.conditions):
            continue
        include = next(
            (
                i
                for i in package.digest.includes
                if target.name in i.targets
                and view.certain(i.conditions)
                and any(p.kind == "ros" and p.name not in view.workspace.packages for p in view.header(i.path))
            ),
            None,
        )
        if include is not None:
            yield Hit(
                target.at,
                "catkin_INCLUDE_DIRS",
                f"`{include.path}` is included by `{target.name}`, which does not get catkin_INCLUDE_DIRS",
                "include_directories(${catkin_INCLUDE_DIRS})",
                package.name,
            )
            return


def _no_components(view: View, package):
    """Components asked of catkin that are system libraries on the target, which catkin cannot find as components."""
    for found in package.build.found:
        name = found.name
        if found.how != "catkin" or name == "catkin" or not view.certain(found.conditions):
            continue
        if (
            name in view.workspace.packages
            or view.target.version(name) is not None
            or view.target.resolve(name) is None
        ):
            continue
        if view.providers.cmake_platforms(name) or any(p.kind == "system" for p in view.cmake(name)):
            continue  # a plain CMake package of the system answers, and catkin takes it
        yield Hit(
            found.at,
            name,
            f"`{name}` is a system library in {view.target.distro} and no catkin component",
            f"find_package({name} REQUIRED), or pkg-config, on its own",
            package.name,
            severity="warning",
        )


def _folded(name: str) -> str:
    return re.sub(r"[^a-z]|^lib|dev$", "", name.lower())


def _cmake_of(view: View, name: str) -> set[str]:
    return {p.name for p in view.cmake(name)}


def found_names(view: View, package) -> set[str] | None:
    """Every package CMake looks for, under the names others know them by; None when CMake finds by names unknown."""
    names: set[str] = set()
    for found in package.build.found:
        if found.how == "ament_auto":
            names.update(n for n, kinds in view.declared(package).items() if kinds & {"build", "buildtool"})
        names.add(found.name)
        names.update(p.name for p in view.cmake(found.name))
    for export in package.build.exports:
        if export.how == "ament_export_dependencies":
            names.add(export.item)
    if any("${" in f.name for f in package.build.found):
        return None
    names.update(dependency for generated in package.build.generated for dependency, _ in generated.dependencies)
    return names


def _given_to_targets(view: View, package):
    """Names in ament_target_dependencies and `pkg::target` links that only find_package(pkg) can define."""
    own = {t.name for t in package.build.targets}
    for target in package.build.targets:
        for link in target.links:
            conditions = (*target.conditions, *link.conditions)
            if (
                not view.certain(conditions)
                or "$" in link.item
                or link.item in own
                or any("TESTING" in c.text for c in conditions)
            ):
                continue
            if link.how == "ament" and view._is_package(link.item):
                yield link.at, link.item
