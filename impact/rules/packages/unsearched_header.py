"""unsearched-header: an include names a header of the package, in a folder that no target searches.

What it does
    Looks for the folders of headers of the package itself, as an include writes them, among those that its targets are
    given to search, and beside the file that includes them.

Why it breaks
    The compiler stops: "No such file or directory".

Severity
    error; warning in tests, and where it is not known which folders targets search, as where find_path() looks one up,
    or what a command that is called does, and for `<lift.h>`, which may be of a library of the system.

Example
    #include "lift.h"                           // which is include/winch/lift.h, and include_directories(include)

Use instead
    #include "winch/lift.h"

Not reported
    Headers of the same path that something else has, or may have since it is called as their folder, or that may be
    made; includes under conditions that may not hold; packages of which it is not known what their CMake code does, or
    that search folders which a find module of their own looks up, and those that may have folders which were not read.
"""

import re

from ...model.absent_headers import is_made
from ...model.cmake.interpreter import calls_unmodelled
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, list_place_doubts, rule

_OF_PACKAGE = re.compile(r"\$\{\w+_INCLUDE_?(?:DIRS?|PATH)\}")


@rule(
    group="removed-header",
    texts=Text(
        "`{subject}` is `{header}`, but no target of `{package}` searches its folder",
        "[[include `{replacement}`, or ]]add the folder to the include directories",
    ),
)
def unsearched_header(view: TargetView, package: Package):
    build, seen = package.build, set()
    if not package.linked.unsearched or build.unresolved or not build.project:
        return
    called = calls_unmodelled(build)
    if called and view.unknown_contents.list_unknown_found(package):
        return  # a command of which nothing is known may make headers, and search folders
    searched = [path.path for path in build.list_paths() if path.how == "include"]
    looked_up = [found for found in build.found if found.how == "find_path" and f"${{{found.prefix}}}" in searched]
    variables = [one for one in searched if "$" in one]
    if any(map(_OF_PACKAGE.fullmatch, variables)) and _has_own_find_module(package):
        return  # what its own find module looks up may be any folder, those of the package too
    known = not (called or looked_up) and all(map(_OF_PACKAGE.fullmatch, variables))
    for include, header in package.linked.unsearched:
        path, place = include.path, (include.at.path, include.path)
        if place in seen or not view.is_sure(include.conditions) or is_made(package, path.rpartition("/")[2]):
            continue
        if any(path in (found.name, *found.optional_components) for found in looked_up):
            continue  # CMake searches the folder in which it found this very header
        if view.workspace.provides_header(path) != [package.name] or _has_another(view, package, path):
            continue
        if view.workspace.generates_header(package, path):
            continue  # a copy of what the build makes
        if view.workspace.unread and _may_be_unread(view, package, path):
            continue
        seen.add(place)
        inside = f"/{header}".rpartition("/include/")
        data = {"header": package.strip_path(header), "replacement": inside[2] if inside[1] else ""}
        library = include.angled and "/" not in path  # such as the system has, where it has that library
        doubts = (*list_place_doubts(view, include.role), known or Doubt.INCOMPLETE, not library or Doubt.AMBIGUOUS)
        yield Diagnostic(include.at, path, package.name, data, doubts=doubts)


def _has_own_find_module(package: Package) -> bool:
    """Whether a find module or a configuration of the package itself answers what it finds."""
    files = {path.rpartition("/")[2].lower() for path in package.linked.files if path.endswith(".cmake")}
    names = {found.name.lower() for found in package.build.found if found.how == "find_package"}
    return any(not files.isdisjoint((f"find{n}.cmake", f"{n}config.cmake", f"{n}-config.cmake")) for n in names)


def _may_be_unread(view: TargetView, package: Package, path: str) -> bool:
    """Whether a header may lie in a folder that was not read: of the package, or of something that it is built with."""
    workspace = view.workspace
    if workspace.is_unread(package.path) or not package.path or view.unknown_contents.may_hold(package, path):
        return True
    searched = (one.path for one in package.build.list_paths() if one.how == "include")
    return any(map(workspace.is_unread, searched)) or not workspace.unread_names.isdisjoint(package.declared)


def _has_another(view: TargetView, package: Package, path: str) -> bool:
    """Whether something else that a package is built with may have a header of the same path."""
    head = path.partition("/")[0]
    if head not in (path, package.name) and _may_be_of(view, package, head, path):
        return True
    others = [one for one in view.providers.find_header(path) if one.name != package.name]
    around = view.build_environment(package)
    return any(one.kind != "ros" or one.name in around for one in others)


def _may_be_of(view: TargetView, package: Package, name: str, path: str) -> bool:
    """Whether a header whose folder is called as a package may be that package's: one of the workspace, or that comes
    along, or a release of the target that is not known to lack it."""
    if name in view.workspace.packages or name in view.build_environment(package):
        return True
    return view.target.find_version(name) is not None and view.has_released_header(name, path) is not False
