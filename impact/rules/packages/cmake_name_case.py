"""cmake-name-case: find_package is given the name of a package in another case than its configuration has.

What it does
    Reports names in find_package that are known in another case alone: in general, or with the target's version of a
    library.

Why it breaks
    CMake looks for files of this very name, such as `FindEigen3.cmake` or `assimpConfig.cmake`, and stops.

Severity
    error for a package that is required, where all that the platform has is known; warning otherwise.

Example
    find_package(ASSIMP REQUIRED)               # assimp has `assimpConfig.cmake` since 5.1

Use instead
    find_package(assimp REQUIRED)

Not reported
    Names in lower case, to which an `x-config.cmake` may answer; names with several spellings; find modules of the
    workspace; packages whose build fetches sources before, which may bring a find module.
"""

from ...targets.providers.library import find_misspelled_version
from ..vocabulary import Diagnostic, Doubt, Package, Replace, TargetView, Text, rule


@rule(
    group="misspelt-cmake-name",
    texts={
        "case": Text("CMake package `{subject}` not found: names are case-sensitive", "did you mean `{replacement}`?"),
        "case since": Text(
            "CMake package `{subject}` not found: {replacement} {version} has `{replacement}Config.cmake`, and names "
            "are case-sensitive",
            "write `{replacement}`",
        ),
    },
)
def cmake_name_case(view: TargetView, package: Package):
    yield from _list_unknown_spellings(view, package)
    yield from _list_lost_spellings(view, package)


def _list_unknown_spellings(view: TargetView, package: Package):
    """find_package names that are known in another case alone: CMake looks for files of this very name."""
    own = view.workspace.cmake_files
    if any(target.kind == "fetched" for target in package.build.targets):
        return
    for f in package.build.found:
        if f.how != "find_package" or not f.required or not view.is_sure(f.conditions) or view.is_package(f.name):
            continue
        if f.name.islower():
            continue  # `x-config.cmake` answers to it, which no list of files need show
        if {f"Find{f.name}.cmake", f"{f.name}Config.cmake"} & own or any(p.sure for p in view.find_cmake(f.name)):
            continue
        meant = [n for n in view.providers.list_spellings(f.name) if n != f.name]
        if len(meant) != 1 or not view.find_cmake(f.name) or meant[0] == f.name.lower():
            continue
        # Whoever brings the module along under the other name means that one, whatever the platform has.
        sure = f"Find{meant[0]}.cmake" in own or view.target.platform in view.providers.platforms
        fix = (Replace(f.at.path, f.at.line, f.at.column, f.name, meant[0]),)
        doubts = (sure or Doubt.INCOMPLETE,)
        yield Diagnostic(f.at, f.name, package.name, {"replacement": meant[0]}, "case", doubts, fix=fix)


def _list_lost_spellings(view: TargetView, package: Package):
    """find_package names to which the target's version of a library answers no longer, where the build needs them."""
    linked = {link.item for link in package.build.target_links if link.how == "ament"}
    for f in package.build.found:
        if f.how != "find_package" or f.via or not (f.required or f.name in linked):
            continue
        version = find_misspelled_version(view.target, f.name)
        if not version or f"Find{f.name}.cmake" in view.workspace.cmake_files:
            continue
        data = {"replacement": f.name.lower(), "version": version}
        doubts = (f.required or Doubt.OPTIONAL, view.is_sure(f.conditions) or Doubt.CONDITIONAL)
        yield Diagnostic(f.at, f.name, package.name, data, "case since", doubts)
