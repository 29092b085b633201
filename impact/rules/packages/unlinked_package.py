"""unlinked-package: a target uses what is compiled into a package's library and links nothing that brings it.

What it does
    Reports programs, and shared libraries that are installed or exported, which call a function or make an object of a
    class that is compiled into the library of a package (`ros::init`, `rclcpp::spin`) and are linked to nothing; in
    ROS 1 also programs that are linked to other components, none of which exports that library.

Why it breaks
    The linker reports undefined references; for a shared library it does where the library is used.

Severity
    error for programs that are linked to nothing; warning otherwise.

Example
    add_executable(node src/node.cpp)           # which calls ros::init()

Use instead
    add_executable(node src/node.cpp)
    target_link_libraries(node ${catkin_LIBRARIES})

Not reported
    What is inline or a template in a header; targets that are linked to something of which it cannot be seen what it
    brings.
"""

from collections.abc import Iterator

from ...model.cmake.build import is_for_tests
from ...model.cmake.catkin_links import CatkinExports, find_linked_packages, list_linked
from ...targets.platform import strip_separators
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule
from .compiled_uses import find_package_include, list_package_uses


@rule(
    group="missing-find-package",
    texts={
        "client library": Text(
            "`{target}` uses `{name}` but links nothing", "target_link_libraries({target} {item})"
        ),
        "unlinked": Text(
            "`{target}` uses `{name}` of `{header}` but does not link `{subject}`",
            "add `{subject}` to find_package(catkin REQUIRED COMPONENTS ...) and link ${{catkin_LIBRARIES}}",
        ),
    },
)
def unlinked_package(view: TargetView, package: Package):
    if package.build_type in ("catkin", "ament_cmake"):
        yield from _list_without_client(view, package)
    if package.build_type == "catkin" and view.target.ros == 1:
        yield from _list_unlinked(view, package)


def _list_without_client(view: TargetView, package: Package):
    """Programs, and shared libraries for others, that use what is compiled into a library of a package, and are given
    nothing to link."""
    build = package.build
    if build.unresolved or build.links:
        return
    linked = {t.name for t in build.targets if any(link.how in ("link", "ament", "objects") for link in t.links)}
    offered = {e.item for e in build.exports if e.how in ("libraries", "ament_export_libraries")}
    offered |= build.installed_targets
    programs = {
        t.name: t
        for t in build.targets
        if (t.kind == "executable" or (t.kind == "library" and not t.static and t.name in offered))
        and t.name not in linked and t.sources and view.is_sure(t.conditions)
    }  # fmt: skip
    if not programs:
        return
    compiling = dict(package.linked.source_targets)
    for path, owner, name in list_package_uses(view, package):
        for place in compiling.get(path, ()):
            target = programs.get(place)
            if target is None or (target.kind == "library" and path not in target.sources):
                continue  # a library may have got the header by one that it uses for a type alone
            include = find_package_include(view, package, path, place, owner)
            if include is None or include.role != "build":
                continue  # such as a test's program that `make all` leaves out
            del programs[place]
            data = {"target": place, "name": name, "item": _find_item(view, owner)}
            doubts = () if target.kind == "executable" else (Doubt.DISTURBS,)
            yield Diagnostic(target.at, owner, package.name, data, "client library", doubts)


def _find_item(view: TargetView, owner: str) -> str:
    """What links a package: a target that it exports, or else its variable."""
    if view.target.ros == 1:
        return "${catkin_LIBRARIES}"
    offer = view.offers.find_package(owner)
    exported = [target.name for target in offer.build.targets if "::" in target.name] if offer is not None else []
    return exported[0] if exported else f"${{{owner}_TARGETS}}"


def _list_unlinked(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """Programs whose own sources the linker most likely misses a library for: they include its headers, and what they
    use of those is not looked at. What libraries of the package miss may come with any library that one of theirs needs
    in turn, which the linker finds by itself."""
    build = package.build
    if build.unresolved or any("$" in f.name for f in build.found):
        return
    exported = CatkinExports(view)
    used: dict[str, list[tuple[str, str, str]]] = {}
    for path, owner, name in list_package_uses(view, package):
        used.setdefault(path, []).append((path, owner, name))
    seen = set()
    for target in build.targets if used else ():
        if target.kind != "executable" or is_for_tests(target.conditions) or not view.is_sure(target.conditions):
            continue
        linked = list_linked(package, target.name)
        if linked is None:
            continue
        brought = exported.list_transitive(find_linked_packages(view, package, linked))
        if brought is None:
            continue
        words = [strip_separators(item) for item in linked]
        for path, owner, name in (use for source in target.sources for use in used.get(source, ())):
            if owner in brought or owner in seen:
                continue
            include = find_package_include(view, package, path, target.name, owner)
            if include is None or include.role != "build":
                continue
            libraries = exported.list_libraries(owner)
            if not libraries or any(strip_separators(lib) in word for lib in (*libraries, owner) for word in words):
                continue
            seen.add(owner)
            data = {"target": target.name, "name": name, "header": include.path}
            yield Diagnostic(include.at, owner, package.name, data, "unlinked", (Doubt.INCOMPLETE,))
