"""What a Python does not accept: that of the target, or, where that is Python 2, that of the newest distro."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import NamedTuple

from ...facts.condition import Condition
from ...model.package import ImportUse, SyntaxUse
from ...model.view import View
from ...model.workspace import Package
from ...targets.availability import Horizon
from ...targets.target import Target
from ..api.upcoming import Upcoming, rated_all
from ..rule import Hit
from ..severity import Doubt, doubts_of_place, severity


class Refused(NamedTuple):
    """What is not accepted. doubts: beside those of its place. conditions: of the file, under which it stands."""

    use: SyntaxUse | ImportUse
    subject: str
    message: str
    help: str
    doubts: tuple[Doubt, ...] = ()
    conditions: tuple[Condition, ...] = ()


def report_refused(view: View, find: Callable[[Package, Target], Iterable[Refused]]) -> Iterator[Hit]:
    """Findings on what the Python of a view's target does not accept. find: gives it, for a package and a target with
    Python 3."""
    target, ahead = view.target, None
    if target.python_major < 3:
        ahead = next((one for one in view.horizons if one.target.python_major >= 3), None)
        if ahead is None:
            return
        target = ahead.target
    if not target.python:
        return
    for package in view:
        found = (_rated(view, package.name, refused, ahead) for refused in find(package, target))
        yield from rated_all(one for one in found if one is not None)


def _rated(view: View, package: str, refused: Refused, ahead: Horizon | None) -> Hit | Upcoming | None:
    use = refused.use
    hit = Hit(use.at, refused.subject, refused.message, refused.help, package)
    doubts = (*doubts_of_place(view, use.role), *refused.doubts, use.role != "test" or Doubt.TEST)
    if ahead is None:
        return hit._replace(severity=severity(*doubts))
    if not view.active_on(ahead, refused.conditions):
        return None
    hit = hit._replace(message=f"{refused.message} ({ahead.name})")
    return Upcoming(hit, "python", ahead, doubts, (use.at.path, use.at.line))
