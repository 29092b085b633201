"""missing-find-package: built code uses a package that CMake never looks for.

What it does
    Reports packages whose headers compiled code includes, or whose targets are used, when no find_package (or catkin
    component, pkg_check_modules, ament_auto) of the package asks for them and none that is asked for brings them. What
    is found for the tests alone counts for the tests alone.

Why it breaks
    The compiler misses the include path, or CMake stops at a target, unless another package happens to add them.

Severity
    error where a target is linked or given under a name that only the missing find_package defines, and for includes of
    compiled code where the package has an include folder of its own; warning for other includes, since an include path
    may come along by accident, or a function of another package may find it, and for those of tests; note for
    libraries, for headers of messages in ROS 1, and in files that the package itself does not compile.

Example
    ament_target_dependencies(node angles)      # and no find_package(angles REQUIRED)

Use instead
    find_package(angles REQUIRED)

Not reported
    Packages that come with another one that is found; headers of the C and C++ libraries; tests in ROS 1, and where
    ament_lint_auto or ament_auto finds what is declared for them.
"""

from ...model.cmake.build import is_for_tests
from ...model.cmake.interpreter import calls_unmodelled
from ...model.cmake.links import describe_finding, list_found_names, list_given_items, list_given_names, stops_at_names
from ...model.misspelling import SpellingIndex
from ...model.view import find_included_interface
from ...targets.platform import strip_to_letters
from ...targets.providers.libraries import load_libraries
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .include_folders import find_include_doubt

# Headers of platform libraries that the compiler finds without any find_package, by how their paths begin.
_SYSTEM_BY_DEFAULT = (
    *("boost/", "yaml-cpp/", "tinyxml", "SDL/", "libusb", "GL/", "zlib", "curl/", "gtest/", "gmock/", "openssl/"),
)


@rule(
    preview=True,
    texts={
        "given": Text(
            "`{subject}` is given to a target but find_package(`{subject}`) is not called",
            "add find_package({subject} REQUIRED)",
        ),
        "made": Text(
            "interfaces depend on `{subject}` but find_package(`{subject}`) is not called before",
            "add find_package({subject} REQUIRED)",
        ),
        "linked": Text(
            "`{item}` is linked but find_package(`{subject}`) is not called", "add find_package({subject} REQUIRED)"
        ),
        "included": Text(
            "`{header}` is included but CMakeLists.txt does not find `{subject}`",
            "add find_package({subject} REQUIRED) and give it to the target",
        ),
        "library": Text(
            "`{header}` is included but CMakeLists.txt does not find `{subject}`", "[[add {how} and ]]link the library"
        ),
    },
)
def missing_find_package(view: TargetView, package: Package):
    build = package.build
    if not build.files or not package.is_ros_cmake:
        return
    found = list_found_names(view, package)
    if found is None:
        return
    reachable = view.list_transitive(found) | view.roles.list_found_with(found)
    tested, outside = (_list_answered(view, package, testing) & found for testing in (True, False))
    built = view.list_transitive(n for n in found if n in outside or n not in tested) if tested - outside else reachable
    shipped = {t.name for t in package.build.targets if t.kind != "test" and not is_for_tests(t.conditions)}
    closure = view.build_environment(package)
    # ament_auto and ament_lint_auto find all that is declared for tests.
    finds_tested = any(f.how in ("declared", "ament_lint_auto") for f in build.found)
    near, prefixes = SpellingIndex({*view.collect_declared(package), *found}), {f.prefix for f in package.build.found}
    seen = set()
    brought = view.roles.list_brought(found)
    for at, name, item, how in list_given_names(view, package):
        by_chance = how == "made" and name in built and name not in brought
        if (name in built and not by_chance) or name in seen or name in package.linked.modules or name == package.name:
            continue
        seen.add(name)
        if how == "made" and name not in view.workspace.packages and view.target.find_version(name) is None:
            continue  # other rules report what the target does not have
        linked = how == "linked"
        if linked and view.unknown_contents.may_define_target(package, item, built):
            continue
        known = linked or view.is_package(name)
        if not known and (name in prefixes or view.find_cmake(name) or near.find_nearest(name)):
            continue  # a library, or a name that is misspelt
        # The configuration of a library whose contents are not known may find others.
        opaque = not view.is_package(name) or any(
            view.unknown_contents.may_hold(package, f.name) for f in package.build.found
        )
        if linked:
            opaque, lucky = opaque or calls_unmodelled(build), view.target.ros == 1
        elif how == "made":
            # catkin is content with the folder of a package that is configured along.
            lucky = by_chance or (view.target.ros == 1 and name in view.workspace.packages)
        else:
            lucky = not stops_at_names(view)
        doubts = (Doubt.LUCKY if lucky else None, Doubt.INCOMPLETE if opaque else None)
        yield Diagnostic(at, name, package.name, {"item": item}, how, doubts)
    sought = {strip_to_letters(f.name) for f in package.build.found if f.name in outside}
    linked = sought | {strip_to_letters(link.item) for link in package.build.target_links if link.how == "link"}
    for need in view.sort_needs(package):
        tested = need.role == "test" and bool(need.targets) and view.is_built("test") and not finds_tested
        if need.how != "include" or not (need.role == "build" or tested) or not need.certain:
            continue
        reached = built if shipped.intersection(need.targets) and not tested else reachable
        if view.is_met(need.providers, reached) or need.subject.startswith(_SYSTEM_BY_DEFAULT):
            continue
        name = next((p.name for p in need.providers if p.name in closure), None)
        if name is None or name in seen or name == package.name:
            continue
        ros = need.providers[0].kind == "ros"
        stems = {strip_to_letters(p.name) for p in need.providers} | {strip_to_letters(need.subject.split("/")[0])}
        near_by = sought if ros else linked
        # A library may be found by a part of its name, or a longer one; a package whose headers are called so has one.
        called = ros and name == need.subject.partition("/")[0]
        parts = () if called else ((a, b) for a in stems for b in near_by if len(a) > 2 and len(b) > 2)
        if not stems.isdisjoint(near_by) or any(a in b or b in a for a, b in parts):
            continue
        # Headers of messages that are installed lie beside those of all packages; others are yet to be made.
        installed = view.target.ros == 1 and name not in view.workspace.packages
        header_only = ros and installed and find_included_interface(view, need.subject) is not None
        named = {p.name for p in need.providers}
        if not ros and any(p.name in named for f in found for p in view.find_cmake(f)):
            continue
        seen.add(name)
        own_folder = view.target.ros == 2 or not installed
        counts = ros and not header_only and (own_folder or name in view.collect_declared(package))
        doubts = (find_include_doubt(view, need) if counts else Doubt.DISPENSABLE, not tested or Doubt.TEST)
        if calls_unmodelled(build, tested):
            doubts = (*doubts, Doubt.INCOMPLETE)  # a function of another package may find it
        folder = "" if ros or not shipped.intersection(need.targets) else load_libraries().find_folder(need.subject)
        if folder and not any(folder in item or "$" in item for item in list_given_items(package, need.targets)):
            doubts = (Doubt.INCOMPLETE,)
        data = {"header": need.subject, "how": "" if ros else describe_finding(view, name, need.subject)}
        yield Diagnostic(need.at, name, package.name, data, "included" if ros else "library", doubts)


def _list_answered(view: TargetView, package: Package, testing: bool) -> set[str]:
    """What CMake looks for, for tests alone or not, and who answers."""
    names = {f.name for f in package.build.found if is_for_tests(f.conditions) is testing}
    return names.union(p.name for name in names for p in view.find_cmake(name))
