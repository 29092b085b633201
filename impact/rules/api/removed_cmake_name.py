"""removed-cmake-name: a CMake command, variable or target of another package is gone on a target.

What it does
    Reports calls of macros and functions, and uses of imported targets and variables, that the target's version of the
    providing package does not define: names that the known-changes table lists as removed, and names that other
    versions of the package export and this one does not. So are variables X_LIBRARIES that a target is linked to, and
    that lack the libraries of X since it exports targets alone.

Why it breaks
    CMake stops at an unknown command or target; an unknown variable is empty and the build fails later.

Severity
    error for commands and targets that CMake always reaches; warning for variables, under conditions that cannot be
    decided, where the exports of the target's version are not completely known, and, once, for a name that is
    deprecated on the target and removed on the newest distro.

Example
    ament_target_dependencies(node rclcpp)      # removed in ament_cmake 2.8.5

Use instead
    target_link_libraries(node rclcpp::rclcpp)

Not reported
    Calls under a condition that does not hold on the target; names that the package or the workspace defines; variables
    beside which something else may bring their package.
"""

from collections.abc import Iterable, Iterator

from ...model.cmake.build import CMakeUse
from ...model.cmake.links import is_linked_otherwise
from ...targets.symbol import Availability
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Upcoming, list_place_doubts, rate_upcoming, rule
from .diagnosis import build_availability_texts, build_data, diagnose, find_missing
from .link_fixes import make_link_fix, tell_replacement


@rule(
    scope="target",
    texts={
        **build_availability_texts(),
        "emptied": Text(
            "`{subject}` does not hold the libraries of {upstream} {version}, which exports targets alone",
            "link `{replacement}`",
        ),
    },
)
def removed_cmake_name(view: TargetView):
    for package in view:
        uses = package.build.list_uses()
        owners = {(use.kind, use.name): _find_reviewed_owner(view, use.kind, use.name) for use in uses}
        unknown = [use for use in uses if not owners[use.kind, use.name]]
        yield from rate_upcoming(_list_unexported(view, package, unknown))
        yield from rate_upcoming(_list_reviewed(view, package, uses, owners))
        yield from _list_emptied(view, package)


def _find_reviewed_owner(view: TargetView, kind: str, name: str) -> str:
    """The package that, as reviewed rows say, no longer defines a name, or will not; empty where none say so."""
    rows = view.find_reviewed(kind, name)
    return next((row.package for row in rows if row.state in ("removed", "deprecated")), "")


def _list_reviewed(
    view: TargetView, package: Package, uses: list[CMakeUse], owners: dict[tuple[str, str], str]
) -> Iterator[Diagnostic | Upcoming]:
    """What the tables of known changes tell, unless what is stored of the very release contradicts it."""
    seen = set()
    for use in uses:
        owner = owners[use.kind, use.name]
        if not owner or use.name in seen or not view.applies(use.conditions):
            continue
        found = find_missing(view, use.kind, use.name, (owner,), use.conditions)
        if found is not None:
            seen.add(use.name)
            doubts = (*list_place_doubts(view, "build", use.conditions), use.kind != "variable" or Doubt.INCOMPLETE)
            yield _diagnose(view, package, found._replace(sure=True), use, use.name, doubts)


def _list_unexported(view: TargetView, package: Package, uses: list[CMakeUse]) -> Iterator[Diagnostic | Upcoming]:
    """What the stored versions of the packages that are found, or come along with these, do not export alike."""
    found = dict.fromkeys(one.name for one in package.build.found if one.how != "pkg_check_modules")
    brought, owners = view.list_transitive(found), view.providers.commands.get(view.target.ros, {})
    own = {target.name for one in view.workspace for target in one.build.targets}
    places: dict[tuple[str, str], tuple[CMakeUse, bool]] = {}
    for use in uses:
        kind, name = use.kind, use.name
        # A variable may be set in more ways than its package shows.
        if kind == "variable" or (kind == "target" and ("::" not in name or "$" in name or name in own)):
            continue
        if not view.applies(use.conditions):
            continue
        certain = view.is_sure(use.conditions)
        key = kind, name.lower() if kind == "command" else name
        if key not in places or (certain and not places[key][1]):
            places[key] = use, certain
    for (kind, name), (use, certain) in places.items():
        if kind == "target":
            packages = [name.partition("::")[0]]
        else:
            packages = [*found, *brought.intersection(owners.get(name, "").split())]
        lost = find_missing(view, kind, name, packages, use.conditions)
        if lost is not None and not (lost.library and view.unknown_contents.may_make_target(package, name)):
            alone = not lost.library or not view.unknown_contents.may_build_library(package, name)
            doubts = (certain or Doubt.CONDITIONAL, alone or Doubt.INCOMPLETE)
            yield _diagnose(view, package, lost, use, name, doubts)


def _diagnose(
    view: TargetView, package: Package, found: Availability, use: CMakeUse, name: str, doubts: Iterable[Doubt | bool]
) -> Diagnostic | Upcoming:
    call = next((call for call in package.build.dependency_calls if call.at == use.at), None)
    if call is None:
        return diagnose(found, use.at, name, package.name, doubts)
    data = {**build_data(found), "replacement": tell_replacement(view, package, call)}
    fix = make_link_fix(view, package) if found.is_missing else ()
    return diagnose(found, use.at, name, package.name, doubts, data=data, fix=fix)


def _list_emptied(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """Variables that target_link_libraries() is given and that other versions of their packages fill, where a target
    gets the package in no other way."""
    seen: set[str] = set()
    for target in package.build.targets:
        for link in target.links:
            name = link.item.removeprefix("${").removesuffix("_LIBRARIES}")
            if link.how != "link" or link.item != f"${{{name}_LIBRARIES}}" or link.item in seen:
                continue
            offer = view.offers.find_package(name) if not view.may_have(name) else None
            if offer is None or not view.is_sure(link.conditions) or not offer.exports_targets_alone:
                continue
            items = package.build.list_linked_items(target.name)
            if items is None or is_linked_otherwise(view, name, items):
                continue
            seen.add(link.item)
            libraries = [one.name for one in offer.build.targets if one.kind == "library"]
            best = f"{name}::{name}" if f"{name}::{name}" in libraries else libraries[0]
            data = {"upstream": name, "version": offer.version, "replacement": best}
            # The target may use nothing but what stands in headers.
            yield Diagnostic(link.at, link.item, package.name, data, "emptied", (Doubt.INCOMPLETE,))
