"""Components of CMake packages that list them themselves: data/components.json.zst (databuild/components.py)."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

import msgspec

from ..platform import find_neighbours
from ..tables import find_table
from ..unpacked import read_table
from ..version import parse

if TYPE_CHECKING:
    from ..distro.distro import DistroTarget

FILE = "components.json.zst"


class ComponentTable(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What the table holds. by_platform: CMake package to platform to its version there and the components, space
    separated. always: the components of packages whose name has a version in it, which some release of that has."""

    by_platform: dict[str, dict[str, tuple[str, str]]] = {}
    always: dict[str, str] = {}


class MissingComponent(NamedTuple):
    """A component that a package lacks. version: of the package, empty where its name tells it. near: the one that may
    be meant, empty for none."""

    version: str
    near: str


@cache
def load_components() -> ComponentTable:
    """The shipped table. Raises SnapshotError."""
    return read_table(find_table(FILE), ComponentTable)


_EVERYWHERE = ("all", "core")
"""What each of Gazebo's libraries takes for a component."""


def find_missing_component(target: DistroTarget, package: str, component: str) -> MissingComponent | None:
    """A component that a target's version of a CMake package lacks; None where it is there, or that is not known.

    Of a package whose version is in its name no release of that version may have it, and on other packages both the
    platforms before and after the target's have to agree, or the one that has the target's version."""
    known = load_components()
    if package in known.always:
        names = known.always[package].split()
        gone = component not in names and component not in _EVERYWHERE
        return MissingComponent("", _find_near(component, names)) if gone else None
    platforms = known.by_platform.get(package, {})
    version = target.find_library(package.lower()) if platforms else None
    if version is None:
        return None
    before, after = find_neighbours(target.platform, platforms)
    same = [one for one in (before, after) if one and parse(platforms[one][0]) == parse(version)]
    told = same or [before, after]
    if not all(told) or not _lies_between(version, [platforms[one][0] for one in told]):
        return None
    plain = _strip_prefix(package, component)
    names = {name for one in told for name in platforms[one][1].split()}
    return None if names & {component, plain} else MissingComponent(version, _find_near(plain, names))


def _strip_prefix(package: str, component: str) -> str:
    """`vtkCommonCore` is `CommonCore` for the configuration of VTK 9."""
    start = package.lower()
    return component.removeprefix(start) if component[len(start) : len(start) + 1].isupper() else component


def _lies_between(version: str, ends: Iterable[str]) -> bool:
    keys = [parse(end) for end in ends]
    return min(keys) <= parse(version) <= max(keys)


def _find_near(component: str, names: Iterable[str]) -> str:
    """The name that is most like a component, whatever the case of its letters; empty where none is alike."""
    by_fold = {name.lower(): name for name in names}
    return next((by_fold[one] for one in get_close_matches(component.lower(), sorted(by_fold), 1, 0.88)), "")
