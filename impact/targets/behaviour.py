"""Known changes of what something does: the name and the call stay, and another result comes out.

The facts are in `data/behaviour.json`, reviewed, each with the address that says so. No compiler tells of them.
"""

from __future__ import annotations

import hashlib
from functools import cache
from typing import NamedTuple

import msgspec

from ..facts.usage import Pattern
from .changes import DISTROS, reached, version_of
from .snapshot import DATA, SnapshotError
from .target import Change, Target

_FILE = DATA / "behaviour.json"


class _Use(Pattern, frozen=True, forbid_unknown_fields=True, kw_only=True):
    clause: str
    help: str = ""
    imports: tuple[str, ...] = ()


class _Group(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Rows that share all but the use: label, as a user reads it, to how it looks, what it does now, and what to write.
    imports: modules of which a Python file imports one."""

    package: str
    since: str
    source: str
    uses: dict[str, _Use]
    library: bool = False
    until: str = ""


class _File(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    behaviour: list[_Group]


class Behaviour(NamedTuple):
    """A use that does something else from a version of a package or platform library on.

    label: as a user reads it, no other row has it. since: as the bounds of changes.Row. clause: what it does now, and
    what before. help: what is right in both, or empty. source: an address. imports: see above. until: the version from
    which on it is as it was before since, empty where none is known.
    """

    package: str
    library: bool
    label: str
    since: str
    clause: str
    help: str
    source: str
    pattern: Pattern
    imports: tuple[str, ...]
    until: str = ""

    @property
    def change(self) -> Change:
        """The row in the form that the view asks for."""
        return Change("behaviour", self.package, self.label, "", "changed", "", self.since, self.source, self.library)

    def holds(self, target: Target) -> bool | None:
        """Whether a target has the new behaviour; None where it has not the package, or of another generation."""
        version = version_of(self.package, self.library, target)
        if not version or (self.since in DISTROS and _ros(self.since) != target.ros):
            return None
        return reached(self.since, version, target) and not reached(self.until, version, target)


def _ros(distro: str) -> int:
    return 2 if DISTROS[distro] >= DISTROS["ardent"] else 1


@cache
def all_behaviour() -> dict[str, Behaviour]:
    """Every row by its label. Raises SnapshotError when the data file cannot be read, or two rows have one label."""
    try:
        groups = msgspec.json.decode(_FILE.read_bytes(), type=_File).behaviour
    except (OSError, msgspec.MsgspecError) as error:
        raise SnapshotError(f"{_FILE}: {error}; install rosimpact again") from None
    found: dict[str, Behaviour] = {}
    for g in groups:
        for label, use in g.uses.items():
            if label in found:
                raise SnapshotError(f"{_FILE}: two rows are called `{label}`; install rosimpact again")
            found[label] = Behaviour(
                *(g.package, g.library, label, g.since, use.clause, use.help, g.source, use, use.imports), until=g.until
            )
    return found


@cache
def stamp() -> str:
    """Differs whenever the table does."""
    return hashlib.sha1(_FILE.read_bytes()).hexdigest()[:16]
