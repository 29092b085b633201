"""Target: what another developer has. Answers which version, does a key resolve, what library, who provides."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple, Protocol, runtime_checkable

if TYPE_CHECKING:
    from .availability import Availability, Symbol


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
    def by_kind(self) -> dict[str, list[ChangeInForce]]:
        """The changes of each kind."""
        found: dict[str, list[ChangeInForce]] = {}
        for change in self:
            found.setdefault(change.kind, []).append(change)
        return found

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
        found: dict[tuple[str, str, str], list[ChangeInForce]] = {}
        for change in self:
            if change.state == "removed":
                found.setdefault((change.kind, change.package, change.old), []).append(change)
        return found


class Target(Protocol):
    """One machine, real or described. Interface only; see distro.py, capture.py for how one is made.

    Attributes: name, distro (`humble`), ros (1 or 2), date (ISO day), platform (`ubuntu jammy`), python (minor
    version), python_major (2 or 3), data_date (newest day of the data), notes (what was adjusted, such as a date moved
    to the first release), approximate (True before the first sync tag), knows_manifests (released manifests of this
    distro at this date are known).
    """

    name: str
    distro: str
    ros: int
    date: str
    platform: str
    python: int
    python_major: int
    data_date: str
    notes: tuple[str, ...]
    approximate: bool
    knows_manifests: bool

    def identity(self) -> str:
        """Differs whenever the target, or the data that answers for it, does."""
        ...

    def version(self, package: str) -> str | None:
        """Version of a released ROS package on this target (`2.0.1`), None when it is not there."""
        ...

    def ever_released(self, package: str) -> bool:
        """True when any distro at any date has released a package of this name."""
        ...

    def dependencies(self, package: str) -> tuple[ReleasedDependency, ...] | None:
        """What the released package declares, None when its manifest is not known."""
        ...

    def similar_dependencies(self, package: str) -> tuple[ReleasedDependency, ...] | None:
        """The same in the nearest distro of this generation that knows it; likely, not sure."""
        ...

    def later_dependencies(self, package: str) -> frozenset[str]:
        """Names that come along with the next later version, where this one's manifest is not known: what
        dependencies() may lack."""
        ...

    def possible_dependencies(self, package: str) -> frozenset[str]:
        """Names that come along with a package in some version of some distro of this generation: what it may bring
        where its own manifest is not known. Empty when none of it is."""
        ...

    def known_build_types(self, package: str) -> frozenset[str]:
        """Every build type that a package is known to have had in a distro of this generation."""
        ...

    def other_generation(self, package: str) -> bool:
        """True when distros have released a package of this name, and all of them are of the other ROS."""
        ...

    def build_type(self, package: str) -> str:
        """`catkin`, `ament_cmake`, `cmake` ... of a released package; empty when not known or not said."""
        ...

    def similar_build_type(self, package: str) -> str:
        """The same in the nearest distro of this generation that knows it; likely, not sure."""
        ...

    def resolve(self, key: str) -> Resolution | None:
        """The rosdep rule for a key on this platform, None when there is none."""
        ...

    def known_key(self, key: str) -> bool:
        """True when rosdep has, or had, a key of this name for any platform."""
        ...

    def keys_instead(self, key: str) -> tuple[str, ...]:
        """rosdep keys that install here what a key installs on other releases, best first."""
        ...

    def has_rosdep_rules(self) -> bool:
        """True when rosdep knows the platform's operating system, so that a key without a rule cannot be installed."""
        ...

    def library(self, name: str) -> str | None:
        """Version of a platform library by the name of platform_versions.yaml (opencv, boost, gcc, python3 ...)."""
        ...

    def released_names(self) -> frozenset[str]:
        """Every ROS package that is there."""
        ...

    def key_names(self) -> frozenset[str]:
        """Every rosdep key that any platform has, or had."""
        ...

    def repository(self, package: str) -> tuple[str, str, str] | None:
        """(name, source URL, branch) of the repository that releases a package; empty texts where not known."""
        ...

    def last_distro(self, package: str) -> str:
        """The newest distro of the same generation that has released a package, empty when none has."""
        ...

    def newest(self) -> Target | None:
        """The newest long-term distro of this generation as of the data's day, None when this is it or a newer one."""
        ...

    def in_testing(self) -> Target | None:
        """The same distro with what has been released on its day and waits for the next sync, which its build farm
        builds against already; None when nothing waits, or syncs are not known."""
        ...

    def updated(self) -> Target | None:
        """The same distro as of the data's newest day, None when this is it."""
        ...

    def library_names(self) -> frozenset[str]:
        """Platform libraries whose version is known here."""
        ...

    def has_changes(self) -> bool:
        """True when changes() answers without working them out."""
        ...

    def set_changes(self, changes: tuple[ChangeInForce, ...]) -> None:
        """What changes() is to answer, worked out by an earlier run on the same data."""
        ...

    def availability(self, symbol: Symbol) -> Availability:
        """How the target stands to a package, header, name, CMake name, program, plugin, field or parameter."""
        ...

    def changes(self) -> ChangeTable:
        """Known upstream changes that are in force here, deprecations included."""
        ...


@runtime_checkable
class DatedTarget(Target, Protocol):
    """A target that knows since when its machine has what it has."""

    def arrivals(self, package: str) -> tuple[tuple[str, str | None], ...]:
        """(ISO day, version) of every version of a ROS package that could be had until now; None: there was none."""
        ...

    def came_with_release(self, name: str) -> bool:
        """Whether everybody has a platform library in this version since the distro's release."""
        ...

    def overridden(self, package: str) -> bool:
        """Whether the version of a ROS package was given for this machine, and is not the distro's."""
        ...
