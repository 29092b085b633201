"""Plugins that robot descriptions name and launch files have read in every run: through files that descriptions
include, and macros of xacro that they call."""

from __future__ import annotations

import posixpath
from collections.abc import Iterable
from typing import TYPE_CHECKING

from ...edges.groups import group_pairs
from ...edges.memory import cache_in_derived
from .package import ReferenceUse

if TYPE_CHECKING:
    from .view import TargetView

_DESCRIPTION = (".urdf", ".xacro")
_Place = tuple[str, int, int]


@cache_in_derived
def find_read_plugins(view: TargetView) -> dict[_Place, frozenset[str]]:
    """The places where descriptions name plugins that a launch file of the workspace has read whenever it is started,
    with the packages of the programs that it starts then, by itself and by launch files that it includes or that
    include it."""
    every = (use for package in view.list_built() for use in package.linked.references)
    uses = group_pairs((use.at.path, use) for use in every if not use.reference.conditional)
    included: dict[str, set[str]] = {}
    described: dict[str, list[str]] = {}
    for path, found in uses.items():
        for use in found if not path.endswith(_DESCRIPTION) else ():
            to = _find_path(view, use) if use.reference.kind == "file" and use.role == "run" else ""
            if to.endswith(_DESCRIPTION):
                described.setdefault(path, []).append(to)
            elif to in uses:
                included.setdefault(path, set()).add(to)
    found_at: dict[_Place, set[str]] = {}
    for path, descriptions in described.items():
        started = {
            use.reference.package
            for file in _list_connected(path, included)
            for use in uses[file]
            if use.reference.kind == "executable"
        }
        for place in _list_places(view, descriptions, uses):
            found_at.setdefault(place, set()).update(started)
    return {place: frozenset(started) for place, started in found_at.items()}


def _find_path(view: TargetView, use: ReferenceUse) -> str:
    """The file of the workspace that a use names; empty where it is of another package."""
    owner = view.workspace.packages.get(use.reference.package)
    return posixpath.join(owner.path, use.reference.name) if owner is not None else ""


def _list_connected(path: str, included: dict[str, set[str]]) -> set[str]:
    """A launch file, those that include it, and all that these include."""
    above = {path}
    while more := {one for one, to in included.items() if not to.isdisjoint(above)} - above:
        above |= more
    while more := {other for one in above for other in included.get(one, ())} - above:
        above |= more
    return above


def _list_places(view: TargetView, roots: Iterable[str], uses: dict[str, list[ReferenceUse]]) -> set[_Place]:
    """The plugins that descriptions name by themselves, in what they include and in the macros that are called."""
    files, called, places = set(roots), {""}, set[_Place]()
    known = 0
    while known != len(files) + len(called):
        known = len(files) + len(called)
        for use in [use for path in sorted(files) for use in uses.get(path, ()) if use.reference.macro in called]:
            if use.reference.kind == "file" and use.reference.name.endswith(_DESCRIPTION):
                files.add(_find_path(view, use))
            elif use.reference.kind == "macro":
                called.add(use.reference.name)
            elif use.reference.kind == "plugin":
                places.add((use.at.path, use.at.line, use.at.column))
    return places
