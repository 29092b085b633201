"""Uses of Python names of other packages that fail on a target, for the rules that tell of them."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.package import PythonApiUse
from ...model.python.api import packages_of
from ...model.view import View
from ...model.workspace import Package
from ...targets.availability import Horizon
from ...targets.evidence import Evidence
from ...targets.surface.offers_python import Lost
from ..severity import Doubt, doubts_of_place


def uses_lost(view: View, package: Package) -> list[tuple[PythonApiUse, Lost]]:
    """What is used and is otherwise on the target than the use needs it, in the order of the digest; what the workspace
    provides and what reviewed tables tell is left out."""
    return [(use, lost) for use, lost, ahead in _worked_out(view, package) if ahead is None]


def uses_coming(view: View, package: Package) -> list[tuple[PythonApiUse, Lost, Horizon]]:
    """The same of what the target takes and an update of its distro does not, each with the nearest horizon."""
    return [(use, lost, ahead) for use, lost, ahead in _worked_out(view, package) if ahead is not None]


def _worked_out(view: View, package: Package) -> list[tuple[PythonApiUse, Lost, Horizon | None]]:
    key = "Python uses", package.name
    if key not in view.worked_out:
        view.worked_out[key] = list(_lost(view, package)) if package.digest.python_api else []
    return view.worked_out[key]


_BREAKS = frozenset(("removed", "refused", "override"))


def _lost(view: View, package: Package) -> Iterator[tuple[PythonApiUse, Lost, Horizon | None]]:
    reviewed = {change.old for change in view.changes("python-removed", "python-api") if change.old}
    patterns = {(use.at.path, use.at.line) for use in package.digest.uses if use.language == "python"}
    for found in package.digest.python_api:
        use = found.use
        head = use.name.partition(".")[0]
        if head in view.own_modules or not use.alone or not view.certain(use.conditions):
            continue
        if (found.at.path, found.at.line) in patterns or not reviewed.isdisjoint(_heads(use.name)):
            continue
        lost = view.python_offers.lost(use, packages_of(head))
        if lost is not None:
            yield found, lost, None
        if lost is not None and lost.state != "deprecated":
            continue
        owners = packages_of(head)
        for ahead in view.updates:
            if all(ahead.target.version(one) == view.target.version(one) for one in owners):
                continue
            lost = view.offers_on(ahead)[1].lost(use, owners)
            if lost is not None and lost.state in _BREAKS:
                yield found, lost, ahead
                break


def doubts_of(view: View, found: PythonApiUse, lost: Lost) -> tuple[Doubt, ...]:
    """What speaks against an error where a use fails when it is reached."""
    doubts = doubts_of_place(view, found.role)
    if found.role == "test":
        doubts = (*doubts, Doubt.TEST)  # nobody waits for it, whatever the build makes of it
    if found.use.lazy:
        doubts = (*doubts, Doubt.LATE)
    if not lost.sure:
        doubts = (*doubts, Doubt.INCOMPLETE)
    return (*doubts, Doubt.DISTURBS) if lost.state == "override" else doubts


def evidence_of(lost: Lost) -> Evidence:
    """What the stored versions tell of it."""
    change = {"removed": "removed", "absent": "added", "deprecated": "deprecated"}.get(lost.state, "changed")
    old, new = ((lost.new,), (lost.old,)) if lost.state == "early" else ((lost.old,), (lost.new,))
    return Evidence(
        lost.package, change, lost.name, lost.instead, "python", tuple(filter(None, old)), tuple(filter(None, new)),
        lost.last, lost.first, stored=True,
    )  # fmt: skip


def _heads(name: str) -> Iterator[str]:
    """`a.b.c`, `a.b`, `a`."""
    while name:
        yield name
        name = name.rpartition(".")[0]
