"""changed-default: a call leaves out an argument whose default differs between versions.

What it does
    Reports calls of C++ functions of other packages that rely on a default argument which changed, after the long-term
    distro before the target's, up to the target's version.

Why it matters
    It compiles everywhere, and does something else for those who have the other version.

Example
    client.get_state();                         // nav2_util waits for 2 s since Humble, and waited for ever

Use instead
    The argument, written out.

Not reported
    Calls that give the argument; methods of objects whose type does not show; what the workspace provides itself;
    functions of which there are several.
"""

from functools import cache

from ...targets.distro.distro import DistroTarget
from ...targets.distro.known import list_known_distros
from ...targets.surface.offers_cpp import find_changed_default
from ...targets.symbol import Availability
from ...targets.version import is_at_least
from ..vocabulary import Diagnostic, Package, TargetView, Text, rule
from .uses import list_cpp_uses


@rule(
    severity="note",
    texts=Text(
        "the default argument of `{subject}` changed from `{old}` to `{new}` in {upstream} {since}",
        help="give the argument where it matters",
    ),
)
def changed_default(view: TargetView, package: Package):
    for use in list_cpp_uses(view, package):
        found = use.found
        if found.form != "default" or not use.sure or not _was_added_lately(view.target, found):
            continue
        values = find_changed_default(view.offers, found, use.arguments)
        if values is None:
            continue
        data = {"old": values[0], "new": values[1], "upstream": found.package, "since": found.since}
        yield Diagnostic(use.at, use.name, package.name, data, evidence=found.evidence)


def _was_added_lately(target: DistroTarget, found: Availability) -> bool:
    """Whether a change came after the long-term distro before the target's."""
    earlier = find_previous_lts(target.distro)
    version = earlier.find_version(found.package) if earlier is not None else None
    return version is None or not is_at_least(version, found.since)


@cache
def find_previous_lts(distro: str) -> DistroTarget | None:
    """The long-term distro of the same generation before one."""
    here = next((one for one in list_known_distros() if one.name == distro), None)
    if here is None:
        return None
    earlier = [one for one in list_known_distros() if one.lts and one.ros == here.ros and one.released < here.released]
    return DistroTarget(max(earlier, key=lambda one: one.released).name) if earlier else None
