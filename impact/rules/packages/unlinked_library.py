"""unlinked-library: sources of a target include a compiled library, and nothing that the target is given links it.

What it does
    For libraries that are more than headers (yaml-cpp, tinyxml, gtest ...): finds targets whose own sources include
    them, and that are linked to the library neither themselves, nor through targets of the package, nor through what
    the packages that they are given export in the target's versions.

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
    Targets that are given anything of which it cannot be seen what it brings; includes in headers, unless the target is
    given the library's include folders in place of it; static libraries, and shared ones that are not installed: the
    programs of the package bring what they lack.
"""

from ...model.cmake.build import BuildTarget
from ...model.cmake.catkin_links import BRING_NOTHING, CatkinExports, find_linked_packages, list_linked
from ...model.cmake.links import resolve_package
from ...targets.platform import strip_separators
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule

COMPILED = (
    ("yaml-cpp/", "yamlcpp"),
    ("tinyxml2.h", "tinyxml2"),
    ("tinyxml.h", "tinyxml"),
    ("json/json.h", "jsoncpp"),
    ("jsoncpp/", "jsoncpp"),
    ("curl/curl.h", "curl"),
    ("glog/logging.h", "glog"),
    ("libusb-1.0/", "usb"),
)
"""How the include paths of compiled libraries begin, and a word of every name that each is linked by, without
separators. Source: the libraries' documentation. Kept by hand: no stored index tells whether a header can be used
without the library, which none of these can."""
_COMPILED = (*COMPILED, ("gtest/gtest.h", "gtest"), ("gmock/gmock.h", "gmock"))
_STARTS = tuple(start for start, _ in _COMPILED)


@rule(
    texts=Text(
        "`{target}` compiles `{header}` but does not link the library",
        "link the library to `{target}` with target_link_libraries()",
    ),
)
def unlinked_library(view: TargetView, package: Package):
    if package.build.unresolved or package.build_type not in ("catkin", "ament_cmake"):
        return
    includes = [
        (i, word)
        for i in package.linked.includes
        if i.targets and i.path.startswith(_STARTS)
        for start, word in _COMPILED
        if i.path.startswith(start) and view.is_sure(i.conditions)
    ]
    if not includes or any("$" in f.name for f in package.build.found):
        return
    targets = {t.name: t for t in package.build.targets}
    installed = package.build.installed_targets
    seen: set[tuple[str, str]] = set()
    for include, word in includes:
        for name in include.targets:
            target = targets.get(name)
            if target is None or (word, name) in seen:
                continue
            mistaken = any(_gives_folders(link.item, word) for link in target.links)
            if include.at.path not in target.sources and not mistaken:
                continue
            if target.kind != "executable" and (target.kind != "library" or target.static or name not in installed):
                continue
            if not view.is_sure(target.conditions):
                continue
            if is_brought(view, package, name, include.path, word, mistaken):
                continue
            seen.add((word, name))
            subject = include.path.partition("/")[0].removesuffix(".h")
            data = {"target": name, "header": include.path}
            testing = word in ("gtest", "gmock") and include.at.path in package.linked.testing
            yield Diagnostic(include.at, subject, package.name, data, doubts=_collect_doubts(target, testing))


def _collect_doubts(target: BuildTarget, testing: bool) -> tuple[Doubt, ...]:
    """A program that defines tests needs the library, which runs them; of headers it may use what needs none."""
    if target.kind != "executable" or not testing:
        return (Doubt.INCOMPLETE,)
    return (Doubt.TEST,) if target.excluded else ()


def _gives_folders(item: str, word: str) -> bool:
    """Whether an item is the variable of a library's include folders, which CMake drops with a warning."""
    return "_INCLUDE_DIR" in item and word in strip_separators(item)


def is_brought(view: TargetView, package: Package, target: str, header: str, word: str, mistaken: bool) -> bool:
    """Whether anything that a target is given links the library of a header, or may. word: of every name that the
    library is linked by. mistaken: the target is given the library's folders, so that it needs the library, and what is
    not known to bring that counts for nothing."""
    items = list_linked(package, target)
    if items is None:
        return True
    items = {item for item in items if not _gives_folders(item, word)}
    if any(word.removesuffix("2") in strip_separators(item) for item in items):
        return True
    if word == "gmock" and any("gtest" in strip_separators(item) for item in items):
        return False
    if any(_may_bring_anything(view, package, item) for item in items):
        return True
    packages = find_linked_packages(view, package, items)
    if view.target.ros == 2:
        coming = view.list_transitive(packages)
        own = (view.workspace.packages[name] for name in coming if name in view.workspace.packages)
        if any(word in strip_separators(found.name) for one in own for found in one.build.found):
            return True  # though its manifest does not say so
        return view.is_met(view.find_header(header), coming)
    bringing = CatkinExports(view).list_bringing(packages, word)
    return bool(bringing) or (bringing is None and not mistaken)


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
