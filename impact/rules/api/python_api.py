"""Uses of Python names of other packages that fail on a target, for the rules that tell of them."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.package import PythonApiUse
from ...model.python.api import packages_of
from ...model.view import View
from ...model.workspace import Package
from ...targets.evidence import Evidence
from ...targets.surface.offers_python import Lost


def uses_lost(view: View, package: Package) -> list[tuple[PythonApiUse, Lost]]:
    """What is used and is otherwise on the target than the use needs it, in the order of the digest; what the workspace
    provides and what reviewed tables tell is left out."""
    key = "Python uses", package.name
    if key not in view.worked_out:
        view.worked_out[key] = list(_lost(view, package)) if package.digest.python_api else []
    return view.worked_out[key]


def _lost(view: View, package: Package) -> Iterator[tuple[PythonApiUse, Lost]]:
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
            yield found, lost


def severity_of(found: PythonApiUse, lost: Lost) -> str:
    """How bad a use is that fails when it is reached."""
    if found.role == "aside":
        return "note"
    surely = not found.use.lazy and lost.sure and found.role in ("run", "build")
    return "error" if surely else "warning"


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
