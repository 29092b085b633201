"""Things of released packages' builds (CMake names, programs, launch files, plugins) that a target lacks, or will."""

from __future__ import annotations

from collections.abc import Collection, Iterable

from ...model.cmake.build import At
from ...model.view import View
from ...targets.availability import Availability, Symbol
from ...targets.changes import DISTROS
from ..rule import Hit
from ..severity import Doubt, severity
from .upcoming import Upcoming


def missing(view: View, kind: str, name: str, packages: Iterable[str]) -> Availability | None:
    """What is known of a thing that none of these packages has here, or will have; None for all else."""
    found = view.availability(Symbol(kind, name, tuple(packages)))
    return found if found.is_missing or found.state == "upcoming" else None


def hit_of(found: Availability, at: At, name: str, package: str, help: str = "") -> Hit:
    """The finding for what is missing or upcoming, without its severity. help: goes before what is known."""
    where = f"{found.package} {found.version}".strip()
    if found.state == "upcoming" and found.horizon is not None:
        message = f"`{name}` will be removed: not in {where} ({found.horizon.name})"
    else:
        word = "added" if found.state == "not yet" else "removed"
        message = f"`{name}` is not available in {where}" + (f" ({word} in {found.since})" if found.since else "")
    return Hit(at, name, message, help or advice(found), package, evidence=found.evidence)


def advice(found: Availability) -> str:
    """What to use instead, as far as it is known."""
    if found.state != "not yet" and found.moved_to:
        return f"`{found.moved_to}` has it now"
    if found.state != "not yet" and found.replacement:
        return f"use `{found.replacement}`"
    return f"{found.package} has `{found.alike}`" if found.alike else ""


def rate(found: Availability, hit: Hit, doubts: tuple[Doubt | bool | None, ...]) -> Hit | Upcoming:
    """A finding with its severity, or what rated() gives one. doubts: about the place."""
    doubts = (*doubts, found.sure or Doubt.INCOMPLETE)
    if found.state == "upcoming" and found.horizon is not None:
        place = getattr(hit.at, "path", ""), getattr(hit.at, "line", 0)
        return Upcoming(hit, found.package, found.horizon, doubts, place)
    return hit._replace(severity=severity(*doubts))


def of_another_distro(view: View, path: str, files: Collection[str]) -> bool:
    """Whether a file is for other distros than the target: it, or one that stands for it there, lies in a folder that
    is called after a distro (`param/humble/burger.yaml`). files: of its package."""
    folder, _, name = path.rpartition("/")
    distro = view.target.distro
    return any(part in DISTROS and part != distro for part in folder.split("/")) or f"{folder}/{distro}/{name}" in files
