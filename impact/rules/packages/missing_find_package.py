"""missing-find-package: built code uses a package that CMake never looks for.

What it does
    Reports packages whose headers compiled code includes, or whose CMake variables and targets are used, when no
    find_package (or catkin component, pkg_check_modules, ament_auto) of the package asks for them and none that is
    asked for brings them. What is found for the tests alone counts for the tests alone. Also components of catkin that
    are system libraries on the target, libraries that their vendor package no longer finds, and pkg_check_modules
    whose first argument, the prefix of its variables, is REQUIRED, and programs that include a client library and are
    linked to nothing, or that compile the headers of a library which no component they are linked to exports (ROS 1).

Why it breaks
    The compiler misses the include path, or the linker the library, unless another package happens to add them.

Severity
    error where a target is linked or an include path used under a name that only the missing find_package defines,
    where catkin is asked for a system library, for a variable that nothing sets where it stands for a library whose
    headers the target compiles, and, since Kinetic, where no target gets ROS's include folder; warning for includes,
    since an include path may come along by accident, for a program that includes a library of ROS and is not linked to
    it, since it may not use it, and for other variables that nothing sets.

Example
    ament_target_dependencies(node angles)      # and no find_package(angles REQUIRED)

Use instead
    find_package(angles REQUIRED)

Not reported
    Packages that come with another one that is found; headers of the C and C++ libraries.
"""

import re
from functools import lru_cache

from ...model.cmake.build import for_tests
from ...model.view import View, interface_of
from ...targets.version import at_least
from ..rule import Hit, rule
from .unlinked import unlinked

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
        yield from _only_placed(view, package)
        yield from _never_set(view, package)
        yield from _no_prefix(view, package)
        yield from _linked_to_nothing(view, package)
        yield from unlinked(view, package)
        found = found_names(view, package)
        if found is None:
            continue
        reachable = view.spread(found)
        tested = {f.name for f in package.build.found if for_tests(f.conditions) and f.name in found}
        outside = {f.name for f in package.build.found if not for_tests(f.conditions)}
        built = view.spread(n for n in found if n in outside or n not in tested) if tested - outside else reachable
        shipped = {t.name for t in package.build.targets if t.kind != "test" and not for_tests(t.conditions)}
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
        sought = {_folded(f.name) for f in package.build.found if f.name in outside}
        linked = {_folded(link.item) for t in package.build.targets for link in t.links if link.how == "link"}
        for need in view.weighed(package):
            if need.how != "include" or need.role != "build" or not need.certain:
                continue
            reached = built if shipped.intersection(need.targets) else reachable
            if view.answered(need.providers, reached) or need.subject.startswith(_SYSTEM_BY_DEFAULT):
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
        needed = found.required or (found.name == "Eigen" and _lacks_eigen(view, package))
        yield Hit(
            found.at,
            "cmake_modules",
            f"`Find{found.name}.cmake` comes with `cmake_modules`, which CMake never looks for",
            "add `cmake_modules` to find_package(catkin REQUIRED COMPONENTS ...) and to package.xml",
            package.name,
            severity="error" if sure else "warning" if needed else "note",
        )


def _lacks_eigen(view: View, package) -> bool:
    """True when code that is built here includes Eigen, whose headers lie in a folder of their own, and nothing that is
    found brings it."""
    found = {f.name for f in package.build.found} - {"Eigen"}
    if any("$" in name for name in found):
        return False
    reached = view.spread({*found, *(p.name for name in found for p in view.cmake(name)[:1])})
    return any(
        need.how == "include" and need.subject.startswith(("Eigen/", "unsupported/Eigen/"))
        and need.role == "build" and need.certain and not view.answered(need.providers, reached)
        for need in view.needs(package)
    )  # fmt: skip


def _weight_of(view: View, need, counts: bool) -> str:
    """How surely a missing find_package stops the compiler: from Jazzy on every package has its include folder."""
    if not counts or not (need.targets or need.public):
        return "note"
    apart = view.target.ros == 2 and view.target.distro not in (*_ONE_FOLDER, "humble", "iron")
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
    reach: dict[str, frozenset[str] | None] = {}
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
        if name not in found or name == package.name or name in told or name.endswith("_vendor"):
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
    if any(f"{f.name}_INCLUDE_DIRS" in given for f in build.found if f.how == "catkin"):
        return  # all of /opt/ros lies in one folder
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
                severity="warning" if view.target.distro in _WITH_CPATH else "error",
            )
            return


# Distros whose setup files put the include folder of ROS into CPATH. Source: catkin's change log, 0.7.0.
_WITH_CPATH = ("groovy", "hydro", "indigo", "jade")


def _no_components(view: View, package):
    """Components asked of catkin that are system libraries on the target, which catkin cannot find as components."""
    for found in package.build.found:
        name = found.name
        if found.how != "catkin" or name == "catkin" or not view.certain(found.conditions):
            continue
        if name in view.workspace.packages or view.target.version(name) is not None or view.private(name):
            continue
        key = view.target.resolve(name) is not None
        if not key and not any(p.kind == "system" and view.target.resolve(p.name) for p in view.cmake(name)):
            continue
        yield Hit(
            found.at,
            name,
            f"`{name}` is a system library in {view.target.distro} and no catkin component",
            f"find_package({name} REQUIRED), or pkg-config, on its own",
            package.name,
            severity="error" if found.required and not view.underlaid else "warning",
        )


# Headers of client libraries, whose compiled part every program needs that includes them.
_CLIENTS = {"ros/ros.h": ("roscpp", "${catkin_LIBRARIES}"), "rclcpp/rclcpp.hpp": ("rclcpp", "rclcpp::rclcpp")}


def _linked_to_nothing(view: View, package):
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
                yield Hit(
                    target.at,
                    client,
                    f"`{name}` includes `{include.path}` and is linked to nothing",
                    f"target_link_libraries({name} {item})",
                    package.name,
                    severity="error",
                )


# Vendor packages that only tell CMake where the library's configuration is, from which version on: package, version,
# CMake package, how its include paths begin. Source: the vendor packages' `-extras.cmake.in`.
_PLACING = (("yaml_cpp_vendor", "9.0.0", "yaml-cpp", "yaml-cpp/"),)


def _only_placed(view: View, package):
    """Libraries whose vendor package is found and no longer finds them."""
    found = {f.name: f for f in package.build.found}
    for vendor, since, library, root in _PLACING:
        version = view.target.version(vendor)
        asked = found.get(vendor)
        if asked is None or library in found or not version or not at_least(version, since):
            continue
        linked = {_folded(link.item) for t in package.build.targets for link in t.links}
        if _folded(library) in linked:
            continue
        use = next((i for i in package.digest.includes if i.path.startswith(root) and i.targets), None)
        if use is None or not view.certain(use.conditions):
            continue
        others = view.spread(name for name in found if name != vendor)
        if vendor in others or library in others:
            continue  # it may come along with those
        yield Hit(
            asked.at,
            library,
            f"`{use.path}` is included, and {vendor} {version} no longer finds `{library}`",
            f"add find_package({library} REQUIRED) and link it",
            package.name,
            severity="error" if asked.required else "warning",
        )


_LIBRARIES = re.compile(r"(.+)_(?:LIBRARIES|LIBRARY|LIBS)\Z")
# Variables that other things than a find_package of their own name set: test macros, Python, Qt, catkin itself, what
# PCL, gazebo and rviz find along.
_SET_ALONG = re.compile(
    r"(?i)(gtest|gmock|python|pythonlibs|qt|qt\d?\w*|catkin|boost\w*|rviz.*|ogre\w*|eigen\d?|opengl|gl|x11|openmp\w*|"
    r"threads|sdformat|protobuf|vtk|openssl\w*|tinyxml\d?|console_bridge|urdfdom\w*|mpi|cuda\w*|.*_cuda|dl|m|rt)\Z"
)


def _never_set(view: View, package):
    """`${X_LIBRARIES}` that a target links and nothing sets: the linker then misses the library."""
    build = package.build
    if build.unresolved or any("$" in f.name for f in build.found):
        return
    sought = {_folded(n) for f in build.found for n in (f.name, f.prefix) if n}
    reachable = {_folded(name) for name in view.spread(f.name for f in build.found)}
    told = set()
    for use in build.uses:
        match = (
            _LIBRARIES.match(use.name) if use.kind == "variable" and use.context == "target_link_libraries" else None
        )
        if match is None or use.name in told or not view.certain(use.conditions):
            continue
        stem = match.group(1)
        folded = _folded(stem)
        if not folded or _SET_ALONG.match(stem) or view.is_package(stem):
            continue
        if any(folded in other or other in folded for other in (*sought, *reachable) if len(other) > 2):
            continue
        told.add(use.name)
        module = next((m for m in (stem, f"lib{stem}") if view.providers.pkgconfig(m)), "")
        known = module or (stem if view.cmake(stem) else "")
        if not known:
            continue
        yield Hit(
            use.at,
            known,
            f"`{use.name}` is linked, and nothing sets it",
            f"pkg_check_modules({stem} REQUIRED {module})" if module else f"find_package({stem} REQUIRED)",
            package.name,
            severity="error" if _compiled_with(view, package, use.name, module, stem) else "warning",
        )


def _compiled_with(view: View, package, variable: str, module: str, stem: str) -> bool:
    """True when a target that links the empty variable, and nothing that could stand for it, compiles the library's
    headers."""
    providers = view.providers.pkgconfig(module) if module else view.cmake(stem)
    owners = {p.package or p.name for p in providers}
    for target in package.build.targets:
        items = [link.item for link in target.links if link.how == "link"]
        if f"${{{variable}}}" not in items or not view.certain(target.conditions):
            continue
        if any("$" not in item and _folded(stem) in _folded(item) for item in items):
            continue
        includes = (i for i in package.digest.includes if target.name in i.targets and view.certain(i.conditions))
        if any((p.package or p.name) in owners for i in includes for p in view.header(i.path)[:1]):
            return True
    return False


def _no_prefix(view: View, package):
    """pkg_check_modules(REQUIRED x): its first argument names the variables, so that x is not required."""
    for found in package.build.found:
        if found.how == "pkg_check_modules" and found.prefix in ("REQUIRED", "QUIET"):
            yield Hit(
                found.at,
                found.name,
                f"`{found.prefix}` is taken as the prefix of the variables, so `{found.name}` is not {found.prefix}",
                f"pkg_check_modules({found.name.upper().replace('-', '_')} {found.prefix} {found.name})",
                package.name,
            )


@lru_cache(maxsize=10000)
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
            if not view.certain(conditions) or "$" in link.item or link.item in own or for_tests(conditions):
                continue
            if link.how == "ament" and view.is_package(link.item):
                yield link.at, link.item
