"""Things of released packages' builds (CMake names, programs, launch files, plugins) that a target's version lacks."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Collection, Iterable
from typing import NamedTuple

from ...model.view import View
from ...targets.changes import DISTROS
from ...targets.surface.offers import Offer, Offered
from ...targets.surface.surface import BuildSurface

_THERE: dict[str, tuple[str, Callable[[BuildSurface], Iterable[str]]]] = {
    "target": ("targets", lambda build: (target.name for target in build.targets)),
    "command": ("commands", lambda build: build.commands),
    "variable": ("commands", lambda build: build.variables),
    "executable": ("programs", lambda build: (program.name for program in build.programs)),
    "launch file": ("launches", lambda build: (launch.path for launch in build.launches)),
    "launch argument": (
        "launches",
        lambda build: (f"{launch.path} {name}" for launch in build.launches for name, _ in launch.arguments),
    ),
    "plugin": ("plugins", lambda build: (name for plugin in build.plugins for name in (plugin.name, plugin.type))),
}


class Lacking(NamedTuple):
    """A thing that the target's version of a package lacks and another version has. message, help: of a finding.
    sure: nothing about it is guessed, and its place in the build could be read whole."""

    offered: Offered
    message: str
    help: str
    sure: bool


def lacking(view: View, side: str, name: str, packages: Iterable[str]) -> Lacking | None:
    """What is known of a thing that the first of these packages lacks; None where one of them has it, and for packages
    of the workspace, which are as they are there."""
    part, there = _THERE[side]
    found = None
    for package in packages:
        if package in view.workspace.packages:
            return None
        offer = view.offers.package(package)
        offered = offer.get(side, name) if offer is not None else None
        if offer is None or offered is None or guessed(offer, offered):
            continue
        if offered.state not in ("removed", "moved", "absent") or name in there(offer.build):
            return None
        open_ended = any(one == part for one, _ in offer.build.unknown)
        alike = _alike(offer, side, name)
        found = found or Lacking(offered, *_told(offered, name, alike), offered.sure and not open_ended)
    return found


_ALIKE = 0.75
"""How much of two names has to agree, as difflib measures it."""


def _alike(offer: Offer, side: str, name: str) -> str:
    """What the target's version has that is called most alike; empty where nothing is."""
    if side not in ("executable", "launch file", "plugin", "target"):
        return ""
    _, there = _THERE[side]
    close = difflib.get_close_matches(name, list(dict.fromkeys(there(offer.build))), 1, _ALIKE)
    return close[0] if close else ""


def guessed(offer: Offer, offered: Offered) -> bool:
    """Whether a branch, which may hold something else than the release, or one of two stored versions that differ in
    this is what it rests on."""
    if any(version in offer.line.approximate for version in (offer.stored, offered.last, offered.first)):
        return True
    events = offer.line.events[offered.side][offered.name]
    return not offer.exact and any(event.place == offer.place + 1 for event in events)


def _told(offered: Offered, name: str, alike: str) -> tuple[str, str]:
    where = f"{offered.package} {offered.version}"
    has = f"it has `{alike}`" if alike else ""
    if offered.state == "absent":
        return f"`{name}` is not yet in {where}", has
    if offered.state == "moved" and offered.moved_to:
        return f"`{name}` is gone in {where}", f"`{offered.moved_to}` has it now"
    return f"`{name}` is gone in {where}", f"use `{offered.instead}`" if offered.instead else has


def of_another_distro(view: View, path: str, files: Collection[str]) -> bool:
    """Whether a file is for other distros than the target: it, or one that stands for it there, lies in a folder that
    is called after a distro (`param/humble/burger.yaml`). files: of its package."""
    folder, _, name = path.rpartition("/")
    distro = view.target.distro
    return any(part in DISTROS and part != distro for part in folder.split("/")) or f"{folder}/{distro}/{name}" in files


def severity_of(role: str, *, certain: bool, sure: bool) -> str:
    """How bad it is that a thing is missing. certain: what asks for it surely runs."""
    if role == "aside":
        return "note"
    return "error" if role in ("run", "build") and certain and sure else "warning"
