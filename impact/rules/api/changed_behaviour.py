"""changed-behaviour: a call compiles everywhere and behaves differently on a target.

What it does
    Reports the first use in each package, in C++, Python or a file of parameters, of what, as the reviewed table of
    behaviour says, does, returns or expects something else since a version of a package or library: where the
    targets asked for lie on both sides of that version, or, when one target is asked for, where the long-term
    distro before it was on the other side.

Why it matters
    Everything compiles and starts, and one developer's robot does other than another's.

Example
    float angle = cv::minAreaRect(points).angle;      // between -90 and 0 until OpenCV 4.5.1, then between 0 and 90

Use instead
    float angle = std::fmod(box.angle + 90.0F, 90.0F); // the same on every version, beside a like step for the size

Not reported
    Code that a version test excludes on the target; tests and examples; files of parameters in a folder that is called
    after another distro; uses that show that they know, such as a default that is given.
"""

from collections.abc import Iterator, Sequence

from ...model.package import NameUse
from ...targets.availability import Availabilities
from ...targets.changes import find_function
from ...targets.symbol import Availability, Symbol
from ..vocabulary import Diagnostic, Package, TargetView, Text, rule
from .changed_default import find_previous_lts
from .diagnosis import is_of_another_distro


@rule(
    scope="targets",
    severity="note",
    texts=Text("`{subject}` behaves differently since {since}: {clause}", "[[{advice}]]"),
)
def changed_behaviour(views: Sequence[TargetView]) -> Iterator[tuple[TargetView, Diagnostic]]:
    if not views:
        return
    workspace = views[0].workspace
    own = {function for package in workspace for function in package.linked.functions if function}
    previous = find_previous_lts(views[0].target.distro) if len(views) == 1 else None
    before = Availabilities(previous, ahead=()) if previous is not None else None
    for package in workspace:
        seen: set[tuple[str, str]] = set()
        for use in package.linked.uses:
            if use.role not in ("build", "run"):
                continue
            symbol = Symbol("behaviour", use.text)
            answers = [(view, view.availabilities.find_availability(symbol)) for view in views]
            changed = next((found for _, found in answers if found.state == "changed"), None)
            if changed is None or (changed.detail, changed.package) in seen or changed.package in workspace.packages:
                continue
            if find_function(use.text, use.language, "behaviour") in own:
                continue
            fresh = before is not None and before.find_availability(symbol).state == "present"
            if not fresh and all(found.state == "changed" for _, found in answers):
                continue  # known before it is asked what the use is of, which is dear
            asked = [(view, found) for view, found in answers if _is_relevant(view, package, use, found)]
            with_it = [(view, found) for view, found in asked if found.state == "changed"]
            if not with_it or (len(with_it) == len(asked) and not fresh):
                continue
            seen.add((changed.detail, changed.package))
            data = {"since": f"{changed.package} {changed.since}" if changed.since[0].isdigit() else changed.since}
            data |= {"clause": changed.detail, "advice": changed.replacement}
            for view, found in with_it:
                yield view, Diagnostic(use.at, use.shown or use.text, package.name, data, evidence=found.evidence)


def _is_relevant(view: TargetView, package: Package, use: NameUse, found: Availability) -> bool:
    """Whether a use is compiled or run on a target that has the package in some version."""
    if not view.builds(package) or found.state == "unknown" or not view.applies(use.conditions):
        return False
    if use.language == "yaml" and is_of_another_distro(view, use.at.path, package.linked.files):
        return False
    return view.may_concern(package, found.package, use.at.path)
