"""missing-export: dependants of the package will miss something that it promises or that its headers need.

What it does
    Compares what a package exports with what is there: include directories and libraries that do not exist, system
    libraries exported under a name whose variables nobody sets, packages that installed headers include and that are
    not exported, and include directories of its own headers or of system libraries off the compiler's path.

Why it breaks
    The package builds, and every package that depends on it fails: the header's own includes are not found, or the
    exported configuration names a library that was never built.

Severity
    error where the package's own configuration stops (an include directory that does not exist), or that of whoever
    looks for the package (a library that is never built); warning where a dependant of the workspace, or
    an exported target or library, needs what is missing; note otherwise, and for all but the first few of a package.

Example
    ament_export_dependencies(rclcpp)           # and include/p/p.hpp includes angles/angles.h

Use instead
    ament_export_dependencies(rclcpp angles)

Not reported
    What an exported package brings in turn; packages that ament_auto exports; until Galactic, where all headers lay in
    one folder, a missing ament_export_dependencies is a note.
"""

import posixpath
import re

from ...model.view import View
from ...targets.providers.library import variables
from ..rule import Hit, rule
from .missing_find_package import found_names
from .undeclared_package import LOUD, WITH_CLIENT, WITH_TESTS


@rule(severity="warning")
def missing_export(view: View):
    for package in view:
        if not package.build.files:
            continue
        yield from _directories(view, package)
        if package.build.catkin_package is not None:
            yield from _catkin(view, package)
        if package.build.ament_package is not None:
            yield from _ament(view, package)


def _directories(view: View, package):
    made = {posixpath.normpath(i.destination) for i in package.build.installs}
    for export in package.build.exports:
        if export.how != "include_dirs" or "$" in export.item or not view.certain(export.conditions):
            continue
        if package.build.catkin_package is None or export.item.startswith("/") or export.item in made:
            continue
        item = posixpath.normpath(export.item)
        inside = item[len(package.path) :].lstrip("/") if package.path and item.startswith(package.path + "/") else item
        if inside in (".", "") or package.has_files(inside) or inside.startswith(".."):
            continue
        yield Hit(
            export.at,
            "INCLUDE_DIRS",
            f"the exported include directory `{inside}` does not exist, so catkin stops",
            "create it, or drop INCLUDE_DIRS",
            package.name,
            severity="error",
        )


def _catkin(view: View, package):
    targets = {t.name for t in package.build.targets} | {t.output_name for t in package.build.targets}
    found = {f.name for f in package.build.found} | {f.prefix for f in package.build.found}
    for export in package.build.exports:
        if not view.active(export.conditions) or "$" in export.item:
            continue
        if export.how == "libraries" and export.item not in targets and not package.build.unresolved:
            if (
                "/" in export.item
                or export.item.startswith("-")
                or export.item.endswith((".so", ".a"))
                or view.cmake(export.item)
            ):
                continue
            yield Hit(
                export.at,
                export.item,
                f"the exported library `{export.item}` is no target of `{package.name}`",
                "export the library's target name",
                package.name,
                severity="error" if view.certain(export.conditions) and _own(view, package, export.item) else "warning",
            )
        elif export.how == "system_depends" and export.item not in found and not _sets(package, export.item):
            near = next((f for f in found if f and f.lower().rstrip("3") == export.item.lower().rstrip("3")), None)
            yield Hit(
                export.at,
                export.item,
                f"nothing sets `{export.item}_INCLUDE_DIRS` or `{export.item}_LIBRARIES`, so DEPENDS exports nothing",
                f"write `{near.upper() if near == 'Eigen3' else near}`" if near else f"find `{export.item}` first",
                package.name,
                severity="warning" if near else "note",
            )


def _own(view: View, package, library: str) -> bool:
    """True for the name of a library that can only be one of the package's own: CMake finds those of the system."""
    if library.startswith("boost_") or view.providers.pkgconfig(library) or view.providers.pkgconfig(f"lib{library}"):
        return False
    return all(link.item != library for target in package.build.targets for link in target.links)


def _sets(package, stem: str) -> bool:
    """True when a find_package of the package sets variables that begin with the stem."""
    for found in package.build.found:
        names = variables(found.name)
        if names is None and found.name.lower() == stem.lower():
            return True
        if names and any(
            name.startswith(stem + "_") and not name.endswith(("FOUND", "VERSION", "DIR")) for name in names
        ):
            return True
    return False


def _ament(view: View, package):
    exports = [e for e in package.build.exports if view.active(e.conditions)]
    hows = {e.how for e in exports}
    if not hows & {
        "ament_export_targets",
        "ament_export_libraries",
        "ament_export_include_directories",
        "ament_export_dependencies",
    }:
        if package.digest.public_headers and not any(f.how == "ament_auto" for f in package.build.found):
            libraries = [
                t for t in package.build.targets if t.kind in ("library", "interface") and t.name in _installed(package)
            ]
            if libraries and any("/include/" in f"/{h}" for h in package.digest.public_headers):
                first = package.build.ament_package
                # Plugins of a base class of its own: it is there for others to include.
                own_base = any(e.how == "plugin_description" and e.context == package.name for e in exports)
                if package.name not in view.workspace.includers and not own_base:
                    return
                yield Hit(
                    first,
                    "ament_export_include_directories",
                    f"`{package.name}` installs headers and exports neither them nor a target",
                    "call ament_export_targets or ament_export_include_directories",
                    package.name,
                )
        return
    if any(f.how == "ament_auto" for f in package.build.found) or any(
        "$" in e.item for e in exports if e.how == "ament_export_dependencies"
    ):
        return
    yield from _linked(view, package, exports)
    yield from _never_built(view, package, exports)
    yield from _components(view, package, exports)
    exported = set()
    for export in exports:
        if export.how == "ament_export_dependencies":
            exported.add(export.item)
            exported.update(p.name for p in view.cmake(export.item))
    reach = view.spread(exported)
    yield from _off_path(view, package, exports, reach)
    found = found_names(view, package) or set()
    told = set()
    # Until Galactic all headers lay in one folder, so a missing export went unnoticed.
    apart = view.target.distro not in ("ardent", "bouncy", "crystal", "dashing", "eloquent", "foxy", "galactic")
    includers = view.workspace.includers.get(package.name)
    spoken = 0
    for need in view.weighed(package):
        if need.how != "include" or not need.public or not need.certain or view.answered(need.providers, reach):
            continue
        if need.subject.startswith(WITH_TESTS):
            continue
        name = next((p.name for p in need.providers if p.name in found), None)
        if name is None or name in told or name == package.name or need.providers[0].kind != "ros":
            continue
        told.add(name)
        severity = (
            "warning"
            if apart
            and name not in WITH_CLIENT
            and (includers or "ament_export_libraries" in hows or "ament_export_targets" in hows)
            else "note"
        )
        # A package that exports little is told so by the first few; the rest follow as notes.
        spoken += severity == "warning"
        severity = severity if spoken <= LOUD else "note"
        yield Hit(
            need.at,
            name,
            f"an installed header includes `{need.subject}` and `{name}` is not exported",
            f"add `{name}` to ament_export_dependencies",
            package.name,
            severity=severity,
        )


# System libraries whose headers lie in a folder of their own that the compiler does not search by itself.
_OFF_PATH = frozenset({"eigen", "bullet", "libbullet-dev", "libpcl-all-dev", "libpcl-dev", "libogre-dev", "libxml2"})


def _off_path(view: View, package, exports, reach):
    """Header-only packages that leave the include folder of a system library out."""
    if any(e.how == "cfg_extras" for e in exports) or _installed(package):
        return
    told = set()
    for need in view.weighed(package):
        name = need.providers[0].name
        if need.how != "include" or not need.public or not need.certain or name not in _OFF_PATH or name in told:
            continue
        if view.answered(need.providers, reach) or any("$" in e.item for e in exports if "include" in e.how):
            continue
        told.add(name)
        yield Hit(
            need.at,
            name,
            f"an installed header includes `{need.subject}` and the include folder of `{name}` is not exported",
            "export its package, or its include directories",
            package.name,
            severity="warning",
        )


def _components(view: View, package, exports):
    """Compiled parts of Boost that an exported target passes on: the find_package(Boost) of ament_export_dependencies
    defines no targets for them."""
    if not any(e.how == "ament_export_targets" for e in exports) or any(e.how == "cfg_extras" for e in exports):
        return
    if not any(e.how == "ament_export_dependencies" and e.item == "Boost" for e in exports):
        return
    asked = {name for f in package.build.found if f.name == "Boost" for name, _ in f.components} - _HEADERS_ALONE
    installed = _installed(package)
    for target in package.build.targets:
        if target.name not in installed or target.kind != "library" or not view.certain(target.conditions):
            continue
        for link in target.links:
            head, _, rest = link.item.partition("::")
            if head != "Boost" or link.visibility == "PRIVATE" or link.how not in ("link", "ament"):
                continue
            names = {rest} & asked if rest else asked if link.how == "ament" else set()
            if not names:
                continue
            yield Hit(
                link.at,
                "Boost",
                f"`{target.name}` passes `Boost::{min(names)}` on, and dependants find Boost without components",
                "find it with its components in a file given to ament_package(CONFIG_EXTRAS ...)",
                package.name,
            )
            return


_HEADERS_ALONE = frozenset({"boost", "headers"})


def _never_built(view: View, package, exports):
    """ament_export_libraries() of what no command makes: find_package(this package) stops when it looks for it."""
    names = {n for t in package.build.targets for n in (t.name, t.output_name) if t.kind != "unknown"}
    if package.build.unresolved or any("$" in name for name in names):
        return
    if any(t.kind in ("external", "fetched") for t in package.build.targets):
        return  # another build system makes libraries of its own
    for export in exports:
        item = export.item
        if export.how != "ament_export_libraries" or item in names or re.search(r"[$/.:]|^-", item):
            continue
        if not view.certain(export.conditions) or (view.cmake(item) and item != package.name):
            continue
        yield Hit(
            export.at,
            item,
            f"the exported library `{item}` is never built, so find_package({package.name}) stops",
            "export what the package builds, or drop it",
            package.name,
            severity="error",
        )


def _installed(package) -> set[str]:
    return {item for rule_ in package.build.installs if rule_.kind == "targets" for item in rule_.items}


def _linked(view: View, package, exports):
    """Imported targets that an exported library passes on, and whose package dependants are not told to find."""
    if not any(e.how == "ament_export_targets" for e in exports):
        return
    names = {e.item.lower() for e in exports if e.how == "ament_export_dependencies"}
    reach = {name.lower() for name in view.spread(e.item for e in exports if e.how == "ament_export_dependencies")}
    found = {f.name.lower(): f for f in package.build.found}
    installed = _installed(package)
    extras = any(e.how == "cfg_extras" for e in exports)
    told = set()
    for target in package.build.targets:
        if (
            target.name not in installed
            or target.kind not in ("library", "interface")
            or not view.certain(target.conditions)
        ):
            continue
        for link in target.links:
            head, _, rest = link.item.partition("::")
            known = found.get(head.lower())
            if link.how != "link" or not rest or "$" in link.item or link.visibility == "PRIVATE" or known is None:
                continue
            if (
                head.lower() in names
                or head.lower() in reach
                or head in told
                or extras
                or head in view.workspace.packages
            ):
                continue
            told.add(head)
            yield Hit(
                link.at,
                known.name,
                f"`{target.name}` passes `{link.item}` on and `{known.name}` is not exported",
                f"add `{known.name}` to ament_export_dependencies",
                package.name,
            )
