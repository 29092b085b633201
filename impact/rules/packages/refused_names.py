"""Names at which CMake commands stop, as the rules on them ask for them."""

from collections.abc import Iterator

from ...model.cmake.build import RefusedName
from ...model.cmake.conditions import make_version_key
from ..vocabulary import Diagnostic, Package, TargetView, Together, list_place_doubts

# What only code that is not read can mend.
_HIDDEN = frozenset(("branch", "branch sources", "no sources", "no target", "no value"))


def list_refused(view: TargetView, package: Package, *kinds: str) -> Iterator[RefusedName]:
    """The first place of each name that is refused for a reason of these kinds; none that what is not read may make or
    set."""
    seen = set()
    for refused in package.build.refused:
        if refused.kind not in kinds or (refused.kind in _HIDDEN and package.build.may_add_targets):
            continue
        if "$" in refused.name and refused.kind != "no value":
            continue  # what a variable stands for that nothing which was read sets is not known
        # In other branches a target is made on other machines alone.
        distro = any("ROS_DISTRO" in condition.text for way in refused.ways for condition in way)
        if refused.kind == "branch" and (any(map(view.applies, refused.ways)) or not distro):
            continue
        if refused.kind == "branch sources" and not (distro and any(map(view.is_sure, refused.ways))):
            continue
        if refused.name not in seen:
            seen.add(refused.name)
            yield refused


def find_policy_version(package: Package) -> tuple[int, ...]:
    """The version whose policies CMake follows. From 2.8 on it refuses a folder without CMakeLists.txt (CMP0014), from
    3.0 on a slash in any name (CMP0037), and what waits for a target that does not exist (CMP0046)."""
    lower, _, upper = (package.build.minimum or ("", None))[0].partition("...")
    return make_version_key(upper or lower)


def diagnose_refused(
    view: TargetView, package: Package, kind: str, together: tuple[Together, ...] = ()
) -> Iterator[Diagnostic]:
    """What a rule reports that all refused names of one kind are faults for. together: what they share."""
    for refused in list_refused(view, package, kind):
        doubts = list_place_doubts(view, "build", refused.conditions)
        yield Diagnostic(refused.at, refused.name, package.name, doubts=doubts, together=together)
