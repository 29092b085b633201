"""unexported-header: a package includes a header that another package of the workspace does not offer.

What it does
    Compares the headers of other packages of the workspace that a package compiles with what those install (ament), or
    with the INCLUDE_DIRS of their catkin_package() (catkin). Also reports packages of catkin that export no LIBRARIES,
    where a program includes a header of a library of theirs.

Why it breaks
    The compiler stops: "No such file or directory", or the linker at undefined references. In catkin's devel space a
    package gives only its INCLUDE_DIRS to those that find it, and packages of ament are found where they are installed.

Severity
    error for a header of a package of ament that no rule installs; warning under a condition, in tests of ROS 1, and
    for INCLUDE_DIRS that are missing, which whoever finds the installed package does without, or LIBRARIES, of which a
    program may need nothing.

Example
    catkin_package()                            # and another package includes arm/arm.h of include/

Use instead
    catkin_package(INCLUDE_DIRS include)

Not reported
    Packages of which not everything that they install can be known; headers that another package has too, or that the
    includer reaches through an include folder of its own.
"""

import posixpath
from collections.abc import Iterator

from ...model.cmake.installed import collect_installed_headers
from ...model.package import IncludeUse
from ..vocabulary import At, Diagnostic, Doubt, Package, TargetView, Text, list_place_doubts, rule


@rule(
    group="missing-export",
    texts={
        "not installed": Text(
            "`{by}` includes `{subject}`, which `{owner}` does not install",
            "install(DIRECTORY include/ DESTINATION include), and export the folder",
        ),
        "include dirs": Text(
            "`{by}` includes `{subject}`, but catkin_package() of `{owner}` exports no INCLUDE_DIRS",
            "catkin_package(INCLUDE_DIRS {folder} ...)",
        ),
        "library": Text(
            "`{by}` includes `{subject}` of `{library}`, but catkin_package() of `{owner}` exports no LIBRARIES",
            "catkin_package(LIBRARIES {library} ...)",
        ),
    },
)
def unexported_header(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """package: the one whose headers others include."""
    if package.name not in view.workspace.includers or not _is_known(package):
        return
    headers = _list_written(package)
    kind = _find_kind(view, package)
    installed = collect_installed_headers(package.build, package.linked.files)
    libraries = _list_libraries(package) if kind == "library" else {}
    if not headers or not kind or (kind == "not installed" and not installed.known):
        return
    for name in sorted(view.workspace.includers[package.name]):
        other = view.workspace.packages[name]
        found = {one.name for one in other.build.found if view.is_sure(one.conditions)}
        if package.name not in found:
            continue  # missing-find-package reports it
        for include in other.linked.includes:
            path = headers.get(include.path)
            if path is None or not include.targets or not view.is_sure(include.conditions):
                continue
            if kind == "not installed" and path in installed.headers:
                continue
            if kind == "library" and not (path in libraries and _is_unlinked(other, include, libraries[path])):
                continue
            if view.workspace.provides_header(include.path) != [package.name] or _reaches(other, path):
                continue
            folder = package.strip_path(path).removesuffix(f"/{include.path}")
            data = {"by": name, "owner": package.name, "folder": folder, "library": libraries.get(path, "")}
            build = package.build
            at = build.packaged or At(build.files[0], 1)
            doubts = list_place_doubts(view, include.role, include.conditions)
            lasting = {"include dirs": Doubt.DISTURBS, "library": Doubt.INCOMPLETE}.get(kind)
            yield Diagnostic(at, include.path, package.name, data, kind, (*doubts, lasting))
            return


def _list_written(package: Package) -> dict[str, str]:
    """Headers of the package, by what dependants may write where a folder called include is searched."""
    found: dict[str, str] = {}
    for path in package.linked.headers:
        inside = f"/{path}"
        while "/include/" in inside:
            inside = inside.partition("/include/")[2]
            found.setdefault(inside, path)
            inside = f"/{inside}"
    return found


def _is_known(package: Package) -> bool:
    """Whether all that the package gives to those who find it can be seen."""
    build = package.build
    if build.unresolved or build.handed_on or any(e.how == "cfg_extras" or "$" in e.item for e in build.exports):
        return False
    return not build.finds_declared


def _find_kind(view: TargetView, package: Package) -> str:
    """The kind of text that tells how dependants may miss a header; empty where they do not."""
    build = package.build
    if build.ament_package is not None and view.target.ros == 2:
        return "not installed"
    if build.catkin_package is None or view.target.ros == 2:
        return ""
    offered = {e.how for e in build.exports}
    return "include dirs" if "include_dirs" not in offered else "library" if "libraries" not in offered else ""


def _list_libraries(package: Package) -> dict[str, str]:
    """Headers of the package, each with the installed library alone that compiles it."""
    made = {t.name for t in package.build.targets if t.kind == "library"} & package.build.installed_targets
    return {path: names[0] for path, names in package.linked.source_targets if len(names) == 1 and names[0] in made}


def _is_unlinked(package: Package, include: IncludeUse, library: str) -> bool:
    """Whether a program whose own source includes a header links nothing that is called like its library."""
    for target in package.build.targets:
        if target.kind == "executable" and target.name in include.targets and include.at.path in target.sources:
            items = package.build.list_linked_items(target.name)
            if items is not None and not any(library in item for item in items):
                return True
    return False


def _reaches(package: Package, header: str) -> bool:
    """Whether a package has an include folder of its own that a header of another one lies in, or may."""
    folders = [item for item, _ in package.build.include_dirs]
    folders += [link.item for link in package.build.target_links if link.how == "include"]
    return any(header.startswith(f"{posixpath.normpath(folder)}/") for folder in folders)
