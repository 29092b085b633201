"""end-of-life-target: a target's distro gets no more updates.

What it does
    Says so once for every target whose distro was past its end of life on the day of the shipped data.

Why it matters
    Nothing that breaks there will be mended in the distro, and packages may leave its archives.

Severity
    note.
"""

from ...model.cmake.build import At
from ...model.view import View
from ..rule import Hit, rule


@rule(severity="note")
def end_of_life_target(view: View):
    ended = getattr(view.target, "end_of_life", "") or ""
    if ended and ended <= view.target.data_date:
        first = next(iter(view.workspace), None)
        if first is not None:
            yield Hit(
                At(first.digest.manifest_path, 1),
                view.target.distro,
                f"{view.target.distro} reached its end of life on {ended}",
                "plan the move to a maintained distro",
                first.name,
            )
