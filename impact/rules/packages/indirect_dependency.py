"""indirect-dependency: packages are used directly, and come with what is declared.

What it does
    Names in one finding the ROS packages whose headers are included, whose modules are imported or which CMake finds,
    and which the manifest does not declare, but which declared ones hand on.

Why it matters
    Nothing breaks today. A declared package that no longer needs what it handed on breaks this one, without a word in
    the manifest that it was needed.

Example
    #include <geometry_msgs/msg/twist.hpp>      // and package.xml declares nav_msgs alone

Use instead
    <depend>geometry_msgs</depend>

Not reported
    What only happens to be installed (dependency-by-chance reports it), what whoever starts launch files has, tests,
    examples and conditional code.
"""

from ..vocabulary import Diagnostic, Need, Package, TargetView, make_sort_key, rule
from .clean_machine import is_chance
from .undeclared_needs import declare_need, describe_need, find_kind, find_undeclared, list_sources, make_texts

_USED = frozenset(("include", "import", "find_package", "component"))
_TOOLS = frozenset(("catkin", "ament_cmake", "ament_cmake_auto", "cmake_modules"))


@rule(
    group="undeclared-package",
    severity="note",
    texts=make_texts("`{subject}` is not declared and comes with {sources}[[ (nor are {others})]]"),
)
def indirect_dependency(view: TargetView, package: Package):
    used = {name: found for name, needs in find_undeclared(view, package).borrowed.items()
            if (found := _find_first(view, package, name, needs)) is not None}  # fmt: skip
    if not used:
        return
    name, first = min(used.items(), key=lambda item: make_sort_key(item[1]))
    sources, others = list_sources(view, package, first)[:1], tuple(sorted(used.keys() - {name}))
    data = {**describe_need(package, first), "sources": sources, "others": others}
    fix = tuple(step for other, need in used.items() for step in declare_need(view, package, need, other))
    yield Diagnostic(first.at, name, package.name, data, find_kind(first), fix=fix)


def _find_first(view: TargetView, package: Package, name: str, needs: list[Need]) -> Need | None:
    """The first direct use of a ROS package that is sure to be met."""
    used = [need for need in needs if need.how in _USED and need.role in ("build", "run") and need.certain]
    direct = (need for need in used if need.required and need.subject not in _TOOLS and _is_named(view, need))
    first = min(direct, key=make_sort_key, default=None)
    if first is None or is_chance(view, package, first, name) or view.is_circular(package, name):
        return None
    if first.role == "run" and view.roles.comes_with_launch(name, first.at.path):
        return None
    return first


def _is_named(view: TargetView, need: Need) -> bool:
    """Whether what is used is sure to be of a package of ROS: its own, an interface that it generates, or a module
    called like it."""
    first = need.providers[0]
    if first.kind != "ros":
        return False
    module = need.how == "import" and need.subject.partition(".")[0] == first.name
    return first.sure or module or view.generates_header(first.name, need.subject)
