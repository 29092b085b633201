"""unlinked-library: sources of a target include a compiled library, and nothing that the target is given links it.

What it does
    Finds targets whose own sources call a function, or make an object of a class, that is compiled into a platform
    library (yaml-cpp, tinyxml ...), or make tests of gtest, and that are linked to the library neither themselves, nor
    through targets of the package, nor through what the packages that they are given export in the target's versions.

Why it breaks
    The linker reports undefined references, at once for a program, and for a shared library wherever it is used. Often
    it worked as long as another package happened to export the library.

Severity
    error for programs that define tests of gtest or run them; warning.

Example
    add_executable(loader test/loader.cpp)        # includes gtest/gtest.h
    target_link_libraries(loader arm)

Use instead
    target_link_libraries(loader arm gtest)

Not reported
    What is inline or a template in a header; targets that are given anything of which it cannot be seen what it brings;
    includes in headers, unless the target is
    given the library's include folders in place of it; static libraries, and shared ones that are not installed: the
    programs of the package bring what they lack.
"""

from collections.abc import Collection, Iterator, Mapping

from ...model.cmake.build import BuildTarget
from ...model.cmake.catkin_links import BRING_NOTHING, CatkinExports, find_linked_packages, list_linked
from ...model.cmake.links import resolve_package
from ...model.package import IncludeUse
from ...targets.platform import strip_separators
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .clean_machine import TEST_HEADERS
from .compiled_uses import LibraryUse, find_library_include, list_library_uses

_OF_TESTS = ("gtest/gtest.h", "gmock/gmock.h")


@rule(
    texts={
        "library": Text(
            "`{target}` uses `{name}` of `{header}` but does not link the library",
            "link the library to `{target}` with target_link_libraries()",
        ),
        "tests": Text(
            "`{target}` compiles `{header}` but does not link the library",
            "link the library to `{target}` with target_link_libraries()",
        ),
    },
)
def unlinked_library(view: TargetView, package: Package):
    if package.build.unresolved or package.build_type not in ("catkin", "ament_cmake"):
        return
    if any("$" in f.name for f in package.build.found):
        return
    targets = {t.name: t for t in package.build.targets}
    for include, target, use in _list_missing(view, package, targets):
        data = {"target": target, "header": include.path, "name": use.name}
        testing = not use.name and use.path in package.linked.testing
        yield Diagnostic(
            include.at, use.library, package.name, data, "library" if use.name else "tests",
            _collect_doubts(targets[target], testing),
        )  # fmt: skip


def _list_missing(
    view: TargetView, package: Package, targets: Mapping[str, BuildTarget]
) -> Iterator[tuple[IncludeUse, str, LibraryUse]]:
    """(an include of a library, the target that is not linked to it, its use), once for each library and target."""
    seen: set[tuple[str, str]] = set()
    installed = package.build.installed_targets
    for use, names, given in _list_uses(view, package):
        for name in names:
            target = targets.get(name)
            if target is None or (use.library, name) in seen:
                continue
            mistaken = any(_gives_folders(link.item, use.words) for link in target.links)
            if use.path not in target.sources and not mistaken:
                continue
            if target.kind != "executable" and (target.kind != "library" or target.static or name not in installed):
                continue
            include = given or find_library_include(view, package, use, name)
            if include is None or not view.is_sure(target.conditions):
                continue
            if given is None and include.path.startswith(TEST_HEADERS):
                continue
            if is_brought(view, package, name, include.path, use.words, mistaken):
                continue
            seen.add((use.library, name))
            yield include, name, use


def _list_uses(
    view: TargetView, package: Package
) -> Iterator[tuple[LibraryUse, tuple[str, ...], IncludeUse | None]]:
    """Uses with the targets of their files, and the include where it is all that is known: what tests are made with is
    macros, and what these use is not seen."""
    compiling = dict(package.linked.source_targets)
    yield from ((use, compiling.get(use.path, ()), None) for use in list_library_uses(package))
    for include in package.linked.includes:
        if include.targets and include.path in _OF_TESTS and view.is_sure(include.conditions):
            word = include.path.partition("/")[0]
            yield LibraryUse(include.at.path, "", word, (word,)), include.targets, include


def _collect_doubts(target: BuildTarget, testing: bool) -> tuple[Doubt, ...]:
    """A program that defines tests needs the library, which runs them; of headers it may use what needs none."""
    if target.kind != "executable" or not testing:
        return (Doubt.INCOMPLETE,)
    return (Doubt.TEST,) if target.excluded else ()


def _gives_folders(item: str, words: Collection[str]) -> bool:
    """Whether an item is the variable of a library's include folders, which CMake drops with a warning."""
    return "_INCLUDE_DIR" in item and any(word in strip_separators(item) for word in words)


def is_brought(
    view: TargetView, package: Package, target: str, header: str, words: Collection[str], mistaken: bool
) -> bool:
    """Whether anything that a target is given links the library of a header, or may. words: one stands in every name
    that the library is linked by. mistaken: the target is given the library's folders, so that it needs the library,
    and what is not known to bring that counts for nothing."""
    items = list_linked(package, target)
    if items is None:
        return True
    items = {item for item in items if not _gives_folders(item, words)}
    if any(word in strip_separators(item) for item in items for word in words):
        return True
    if "gmock" in words and any("gtest" in strip_separators(item) for item in items):
        return False
    if any(_may_bring_anything(view, package, item) for item in items):
        return True
    packages = find_linked_packages(view, package, items)
    if view.target.ros == 2:
        coming = view.list_transitive(packages)
        own = (view.workspace.packages[name] for name in coming if name in view.workspace.packages)
        if any(word in strip_separators(found.name) for one in own for found in one.build.found for word in words):
            return True  # though its manifest does not say so
        return view.is_met(view.find_header(header), coming)
    exported = CatkinExports(view)
    bringing = [exported.list_bringing(packages, word) for word in words]
    return any(bringing) or (None in bringing and not mistaken)


def _may_bring_anything(view: TargetView, package: Package, item: str) -> bool:
    """Whether it cannot be seen what an item brings: it is of no package of ROS and of no library that is known to come
    alone. A variable that no package found can set is empty."""
    name = resolve_package(item)
    if name in BRING_NOTHING or view.is_package(name) or name.startswith(("Qt5", "Qt6")):
        return False
    if "$" not in item:
        return "::" in item or any(found.name == name for found in package.build.found)
    start = name.lower()[:3]
    return any(start in (f.name.lower()[:3], f.prefix.lower()[:3]) for f in package.build.found)
