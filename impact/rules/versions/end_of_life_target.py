"""end-of-life-target: the distro of a target is no longer maintained.

What it does
    Reports, once for every target, that its distro was past its end of life on the date of the shipped data.

Why it matters
    Faults of the distro are no longer fixed, and packages may be removed from its archives.
"""

from ..vocabulary import At, Diagnostic, TargetView, Text, rule


@rule(
    scope="target",
    severity="note",
    texts=Text("{subject} reached its end of life on {date}", help="plan the move to a maintained distro"),
)
def end_of_life_target(view: TargetView):
    ended = getattr(view.target, "end_of_life", "") or ""
    if ended and ended <= view.target.data_date:
        first = next(iter(view.workspace), None)
        if first is not None:
            yield Diagnostic(At(first.linked.manifest_path, 1), view.target.distro, first.name, {"date": ended})
