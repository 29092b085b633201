"""nonexistent-target: a CMake command is given a target that does not exist, or not yet.

What it does
    Reports names that are given include directories, libraries or properties, and that no command adds as a target,
    that a later command adds, or that only branches for other distros add; and names in add_dependencies() that no
    command adds, among them the targets of the package's own messages where it generates none.

Why it breaks
    CMake stops: "Cannot specify link libraries for target which is not built by this project", "The dependency target
    of target does not exist".

Severity
    error; warning where CMake may not reach the place.

Example
    target_link_libraries(tracker Eigen3::Eigen)
    add_library(tracker src/tracker.cpp)

Use instead
    add_library(tracker src/tracker.cpp)
    target_link_libraries(tracker Eigen3::Eigen)

Not reported
    Names that cannot be resolved, and targets that a command which is not known may add; what a target has to wait for
    under the policies of a CMake before 3.0, which takes no notice, and where it is not called after the package or
    nearly like one of its targets, since it may be of another one.
"""

import re
from collections.abc import Iterator

from ...model.cmake.targets import MADE_ALONG
from ...model.misspelling import is_slip
from ..vocabulary import Diagnostic, Package, TargetView, Text, list_place_doubts, rule
from .refused_names import find_policy_version, list_refused


@rule(
    group="refused-cmake-name",
    texts={
        "no target": Text("`{subject}` is not a CMake target, so CMake stops", "name a target that the package adds"),
        "too early": Text("`{subject}` is used as a target before it is added, so CMake stops", "add the target first"),
        "branch": Text(
            "`{subject}` is no target on {distro}, since other distros alone add it, so CMake stops",
            "add the target on {distro} too",
        ),
        "no dependency": Text(
            "`{by}` is made to wait for `{subject}`, which is not a CMake target, so CMake stops",
            "name a target that the package adds, or remove it",
        ),
    },
)
def nonexistent_target(view: TargetView, package: Package):
    added = {target.name for target in package.build.targets if target.kind != "unknown"}
    for refused in list_refused(view, package, "no target", "branch"):
        kind = "too early" if refused.kind == "no target" and refused.name in added else refused.kind
        doubts = list_place_doubts(view, "build", refused.conditions)
        yield Diagnostic(refused.at, refused.name, package.name, {"distro": view.target.distro}, kind, doubts)
    if not package.build.may_add_targets:
        yield from _list_awaited(view, package)


_GENERATED = re.compile(r"(\w+?)_gen(?:erate_messages)?(?:_?(?:cpp|py|lisp|eus|nodejs|cfg))?\Z")


def _list_awaited(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    """What targets have to wait for and no command adds (CMP0046)."""
    if find_policy_version(package) < (3,):
        return
    added = {target.name for target in package.build.targets if target.kind != "unknown"}
    own, seen = {package.name, package.build.project} - {""}, set()
    prefixes = tuple(f"{one}_" for one in own)
    for target in package.build.targets:
        for link in target.links if target.kind in ("library", "module", "executable") else ():
            name, generated = link.item, _GENERATED.match(link.item)
            if link.how != "order" or name in added or name in seen or not re.fullmatch(r"[\w.+-]+", name):
                continue
            if not view.is_sure((*target.conditions, *link.conditions)):
                continue  # a branch of the other generation, whose generators are not there
            if generated is not None:
                meant = generated[1] in own
            else:  # what is found may have targets of any other name
                alike = name.startswith(prefixes) or any(is_slip(name, one) for one in added)
                meant = alike and not MADE_ALONG.fullmatch(name)
            seen.add(name)
            others = (target for one in view.workspace for target in one.build.targets if one.name != package.name)
            if meant and all(target.name != name for target in others):
                doubts = list_place_doubts(view, "build", link.conditions)
                yield Diagnostic(link.at, name, package.name, {"by": target.name}, "no dependency", doubts)
