"""unexported-include-directory: dependants do not get the folder of installed headers, or of what these include.

What it does
    Reports ament packages that install headers but export neither include directories nor a target, where they install
    a library too and another package of the workspace includes the headers, or where headers are all that they build
    and install; that export a target without the folder of its headers; and packages of headers alone, or of catkin
    with a library, whose exported headers include a system library outside the compiler's default path that they do not
    export.

Why it breaks
    The package builds, and every package that includes its headers stops: "No such file or directory".

Example
    install(DIRECTORY include/ DESTINATION include)

Use instead
    install(DIRECTORY include/ DESTINATION include)
    ament_export_include_directories(include)

Not reported
    Packages that ament_auto exports, that find the library in a file of CONFIG_EXTRAS, or that install an export and a
    configuration of their own in `lib/cmake`, beside what ament_package() makes.
"""

import re
from collections.abc import Iterator

from ...model.cmake.links import list_exported_targets
from ..vocabulary import Diagnostic, Need, Package, TargetView, Text, rule
from .ament_exports import AmentExports, exports_something, read_ament_exports
from .include_folders import OFF_PATH


@rule(
    severity="warning",
    group="missing-export",
    texts={
        "nothing": Text(
            "`{package}` installs headers but exports neither include directories nor a target",
            "call ament_export_targets or ament_export_include_directories",
        ),
        "folder": Text(
            "`{subject}` is exported without the folder of its installed headers",
            "target_include_directories({subject} ... $<INSTALL_INTERFACE:include/${{PROJECT_NAME}}>)",
        ),
        "include directory": Text(
            "an installed header includes `{header}`, but the include directory of `{subject}` is not exported",
            "export its package, or its include directories",
        ),
    },
)
def unexported_include_directory(view: TargetView, package: Package):
    yield from _list_nothing(view, package)
    yield from _list_of_catkin(view, package)
    ament = read_ament_exports(view, package)
    if ament is not None:
        yield from _list_off_path(view, package, ament)
        yield from _list_without_folder(view, package, ament)


def _list_nothing(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """Headers that are installed, with a library or alone, and nothing that tells dependants where."""
    first = package.build.ament_package
    exports = package.build.exports
    if first is None or package.build.finds_declared or exports_something(exports):
        return
    if _has_own_configuration(package):
        return
    installed = package.build.installed_targets
    alone = _has_headers_alone(package)
    if not alone and not any(t.kind in ("library", "interface") and t.name in installed for t in package.build.targets):
        return
    if not any("/include/" in f"/{h}" for h in package.linked.public_headers):
        return
    # Plugins of a base class of its own: it is there for others to include.
    own_base = any(e.how == "plugin_description" and e.context == package.name for e in exports)
    if package.name not in view.workspace.includers and not own_base and not alone:
        return
    yield Diagnostic(first, "ament_export_include_directories", package.name, kind="nothing")


def _has_own_configuration(package: Package) -> bool:
    """Whether a package installs its targets for others with a configuration of its own in `lib/cmake` or
    `share/cmake`, where CMake looks before it comes to the one that ament_package() makes."""
    rules = [rule for rule in package.build.installs if _OF_CMAKE.match(rule.destination)]
    names = (name.lower() for rule in rules for name in (*rule.items, rule.rename))
    return any(rule.kind == "export" for rule in rules) and any(map(_CONFIGURATION.search, names))


_OF_CMAKE = re.compile(r"(?:lib|share)/cmake/")
_CONFIGURATION = re.compile(r"config\.cmake\Z")


def _list_without_folder(view: TargetView, package: Package, ament: AmentExports) -> Iterator[Diagnostic]:
    """Exported targets of a package with installed headers, none of which tells those who link it where these lie."""
    build = package.build
    if "ament_export_include_directories" in ament.hows or "cfg_extras" in ament.hows or build.unresolved:
        return
    targets = list(list_exported_targets(package))
    headers = [path for path in package.linked.public_headers if "/include/" in f"/{path}"]
    if not targets or not headers or any("$" in link.item for t in targets for link in t.links if link.how != "ament"):
        return
    given = {place for rule_ in build.installs if rule_.kind == "targets" for place in rule_.includes}
    if given or any(target.installed_includes for target in build.targets):
        return
    compiled = {name for path, names in package.linked.source_targets if path in headers for name in names}
    for target in targets:
        if (target.name in compiled or target.kind == "interface") and view.is_sure(target.conditions):
            yield Diagnostic(target.at, target.name, package.name, kind="folder")
            return


def _has_headers_alone(package: Package) -> bool:
    """Whether headers are all that a package builds and installs."""
    build = package.build
    if build.unresolved or build.generated or any(t.kind != "test" for t in build.targets):
        return False
    places = [i.destination.lstrip("/").partition("/")[0] for i in build.installs]
    return bool(places) and all(place == "include" for place in places)


def _list_off_path(view: TargetView, package: Package, ament: AmentExports) -> Iterator[Diagnostic]:
    """Header-only packages that leave the include folder of a system library out."""
    if any(e.how == "cfg_extras" for e in ament.exports) or package.build.installed_targets:
        return
    if not any("$" in e.item for e in ament.exports if "include" in e.how):
        public = [need for need in view.sort_needs(package) if need.public]
        yield from _list_missed(view, package, public, ament.found)


def _list_of_catkin(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """System libraries off the compiler's path that exported headers of a catkin package with a library include."""
    exports = package.build.exports
    if not package.build.catkin_package or package.build.finds_declared or any("$" in e.item for e in exports):
        return
    if not {"include_dirs", "libraries"} <= {e.how for e in exports}:
        return
    reach = view.roles.list_found_with({e.item for e in exports if e.how in ("catkin_depends", "system_depends")})
    handed = {e.item.lower() for e in exports if e.how == "system_depends"}
    folders = tuple(f"{e.item.rstrip('/')}/" for e in exports if e.how == "include_dirs")
    public = [need for need in view.sort_needs(package) if need.at.path.startswith(folders)]
    for missed in _list_missed(view, package, public, reach):
        if not any(item.startswith(missed.subject[:5]) for item in handed):  # EIGEN3 is what CMake calls eigen
            yield missed


def _list_missed(view: TargetView, package: Package, needs: list[Need], reach: frozenset[str]) -> Iterator[Diagnostic]:
    """Includes of system libraries off the compiler's path that nothing which dependants find brings."""
    seen = set()
    for need in needs:
        name = need.providers[0].name
        if need.how != "include" or not need.certain or name not in OFF_PATH or name in seen:
            continue
        if not view.is_met(need.providers, reach):
            seen.add(name)
            yield Diagnostic(need.at, name, package.name, {"header": need.subject}, "include directory")
