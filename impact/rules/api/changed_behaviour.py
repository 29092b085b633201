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
from ...targets.changes import ChangeRow, behaves_differently, load_uses
from ...targets.evidence_record import Evidence
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
    table = load_uses("behaviour")
    workspace = views[0].workspace
    own = {function for package in workspace for function in package.linked.functions}
    before = find_previous_lts(views[0].target.distro) if len(views) == 1 else None
    fresh: dict[str, bool] = {}
    for package in workspace:
        seen: set[tuple[str, str]] = set()
        for use in package.linked.uses:
            row = table.get(use.text)
            if row is None or row.pattern is None or use.role not in ("build", "run"):
                continue
            if (row.pattern.clause, row.package) in seen:
                continue
            if row.package in workspace.packages or (row.pattern.calls and row.pattern.word in own):
                continue
            if row.old not in fresh:
                fresh[row.old] = before is not None and behaves_differently(row, before) is False
            holding = [view for view in views if behaves_differently(row, view.target)]
            if not holding or (len(holding) == len(views) and not fresh[row.old]):
                continue  # known before it is asked what the use is of, which is dear
            asked = [view for view in views if _is_relevant(view, package, use, row)]
            with_it = [view for view in asked if view in holding]
            if not with_it or (len(with_it) == len(asked) and not fresh[row.old]):
                continue
            seen.add((row.pattern.clause, row.package))
            shown = use.shown or use.text
            data = {"since": f"{row.package} {row.removed_in}" if row.removed_in[0].isdigit() else row.removed_in}
            data |= {"clause": row.pattern.clause, "advice": row.new}
            evidence = Evidence(
                row.package, "changed", row.old, first=row.removed_in, library=row.library, source=row.source
            )
            for view in with_it:
                yield view, Diagnostic(use.at, shown, package.name, data, evidence=evidence)


def _is_relevant(view: TargetView, package: Package, use: NameUse, row: ChangeRow) -> bool:
    """Whether a use is compiled or run on a target that has the package in some version."""
    if not view.builds(package) or behaves_differently(row, view.target) is None or not view.applies(use.conditions):
        return False
    if use.language == "yaml" and is_of_another_distro(view, use.at.path, package.linked.files):
        return False
    return view.may_concern(package, row.package, use.at.path)
