"""What a target answers with: providers, resolved keys, dependencies, and the changes that are in force on it."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

from ...edges.groups import group_pairs


class Provider(NamedTuple):
    """Who offers a header, CMake package, Python module or executable.

    kind: `ros` (a released package; `name` is the package) or `system` (`name` is a rosdep key, `package` the Debian
    one).
    sure: False when it was told by convention (first path part) rather than by a file list.
    """

    kind: str
    name: str
    package: str = ""
    sure: bool = True


class Resolution(NamedTuple):
    """A rosdep key on a platform: the manager (apt, pip, ...) and what it installs (empty tuple: nothing needed)."""

    manager: str
    packages: tuple[str, ...]


class ReleasedDependency(NamedTuple):
    """One dependency of a released package, as its package.xml of that day has it (conditions already evaluated)."""

    name: str
    kind: str
    bounds: tuple[tuple[str, str], ...]


class ChangeInForce(NamedTuple):
    """One known upstream change that is in force on a target.

    kind: header-removed, header-renamed, package-removed, package-renamed, api-removed, api-renamed, api-changed,
    cmake-removed, msg-field, msg-removed, python-removed, ... or, for uses (uses.py), call-changed,
    where old is the label of the use and new what to write instead.
    state: `removed` (gone on this target), `deprecated` (still there), `absent` (the new spelling is not there yet).
    version: version of the package on the target, empty when unknown. since: first distro or version with `new`.
    library: package is a platform library.
    """

    kind: str
    package: str
    old: str
    new: str
    state: str
    version: str
    since: str
    source: str
    library: bool = False


class ChangeTable(tuple[ChangeInForce, ...]):
    """The changes that are in force on a target, in order, and by what they are asked for."""

    @cached_property
    def by_name(self) -> dict[tuple[str, str], list[ChangeInForce]]:
        """The changes by kind and the name that the target does not have, or warns of; CMake commands in lower case."""
        found: dict[tuple[str, str], list[ChangeInForce]] = {}
        for change in self:
            name = change.new if change.state == "absent" else change.old
            name = name.lower() if change.kind.startswith("cmake") and "::" not in name else name
            found.setdefault((change.kind, name), []).append(change)
        return found

    @cached_property
    def removed(self) -> dict[tuple[str, str, str], list[ChangeInForce]]:
        """What is removed, by kind, package and old name."""
        return group_pairs(
            ((change.kind, change.package, change.old), change) for change in self if change.state == "removed"
        )
