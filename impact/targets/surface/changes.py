"""What changed of a package from version to version, in the form that is shipped: names with the versions at which they
came, went or got another form.

Surfaces tell what each version offers; most of that never changes. Here is only what does, so that a check reads
little. The line of versions is one for each ROS generation, since nothing is gone from ROS 2 that only ROS 1 ever had.
"""

import msgspec

from ...facts.surface import Entity
from ..version import find_newest_up_to

PARAMETER = "parameter of a node"
"""The side, and the sort of thing, of parameters that nodes declare."""


class Overload(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """One way to call a function or macro of C++. fewest, most: arguments; most is -1 for any number. types: of the
    parameters, normalised. traits: as in Entity."""

    fewest: int
    most: int
    types: tuple[str, ...] = ()
    traits: tuple[str, ...] = ()

    def accepts(self, arguments: int) -> bool:
        """Whether it takes so many arguments."""
        return self.fewest <= arguments and (self.most < 0 or arguments <= self.most)


def make_overload(one: Entity) -> Overload:
    """The way to call a function or macro that an entity is."""
    parameters = one.parameters or ()
    required = sum(p.default is None and not p.pack for p in parameters)
    most = -1 if "variadic" in one.traits or any(p.pack for p in parameters) else len(parameters)
    kept = tuple(t for t in one.traits if t in ("const", "virtual", "pure", "override", "final", "static", "deleted"))
    return Overload(required, most, tuple(p.type for p in parameters), kept)


class Form(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """How a thing looked in a run of versions. overloads: in C++, empty for what is not called. deprecated: the
    message, None where it is not; of C++ functions where no overload is left."""

    overloads: tuple[Overload, ...] = ()
    deprecated: str | None = None


class ComparedThing(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What the comparison told of a thing, as in VersionChange of databuild, without what the line of versions tells as
    well. now: the message of a deprecation, a value or a default; declarations are in the surfaces."""

    kind: str
    what: str
    aspects: tuple[str, ...] = ()
    now: str = ""
    instead: str = ""
    moved_to: str = ""
    breaks: bool = True
    sure: float = 1.0


class ChangeEvent(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A thing changed. place: of the first version that has it so, in the line of versions. had, has: its form before
    and since; None where it is not there, or where forms say nothing."""

    place: int
    reported: tuple[ComparedThing, ...]
    had: Form | None
    has: Form | None


class Line(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The versions of one ROS generation, oldest first, and what changed: side to name to events in their order. side:
    `c++`, `header`, `python`, or the sort of thing in a build (`target`, `command`, `variable`, `executable`,
    `plugin`, `launch file`, `launch argument` ...). bases: classes of C++ by their full names, with those of their
    bases, in the newest version. approximate: versions that a branch stands for."""

    versions: tuple[str, ...]
    events: dict[str, dict[str, tuple[ChangeEvent, ...]]]
    bases: dict[str, tuple[str, ...]] = {}
    approximate: tuple[str, ...] = ()

    def find_place(self, version: str) -> int | None:
        """The version that stands for one: itself, or the newest before it that was read at its tag; None for one older
        than all."""
        found = find_newest_up_to(version, [known for known in self.versions if known not in self.approximate])
        return None if found is None else self.versions.index(found)
