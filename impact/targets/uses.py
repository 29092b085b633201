"""Known changes of how something is used: calls and members that only some versions of a package or library take.

The facts are in `data/uses*.json`, reviewed, each with its source. Names that are gone altogether are in changes.py.
"""

from __future__ import annotations

import hashlib
from functools import cache
from typing import NamedTuple

import msgspec

from ..facts.usage import Pattern
from . import behaviour
from .changes import reached, version_of
from .snapshot import DATA, SnapshotError
from .target import Change, Target


class _Use(Pattern, frozen=True, forbid_unknown_fields=True):
    help: str = ""


class _Group(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Rows of data/uses*.json that share all but the use: label, as a user reads it, to how it looks and what to write
    where it is not taken. help: the same for all uses that say nothing of their own."""

    kind: str
    package: str
    source: str
    uses: dict[str, _Use]
    library: bool = False
    removed_in: str = ""
    back_in: str = ""
    new_since: str = ""
    refused_from: int = 0
    needs: int = 0
    help: str = ""
    last_in: str = ""


class _File(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    uses: list[_Group]


class Use(NamedTuple):
    """A use that a package or platform library takes from new_since (empty: always) until before removed_in.

    kind: `call-changed`, for calls, overloads, types and members. label: as a user reads it, no other row has it. help:
    what to write instead. Bounds are as in changes.Row. refused_from, needs: the year of the C++ standard from which
    on, or before which, the compiler does not take it; 0: whatever the standard. last_in: as in changes.Row.
    """

    kind: str
    package: str
    label: str
    pattern: Pattern
    help: str
    library: bool
    removed_in: str
    back_in: str
    new_since: str
    source: str
    refused_from: int
    needs: int
    last_in: str


@cache
def all_uses() -> tuple[Use, ...]:
    """Every row. Raises SnapshotError when a data file cannot be read, or two rows have one label."""
    found: dict[str, Use] = {}
    for path in sorted(DATA.glob("uses*.json")):
        try:
            groups = msgspec.json.decode(path.read_bytes(), type=_File).uses
        except (OSError, msgspec.MsgspecError) as error:
            raise SnapshotError(f"{path}: {error}; install rosimpact again") from None
        for g in groups:
            for label, use in g.uses.items():
                row = Use(g.kind, g.package, label, use, use.help or g.help, g.library,
                          g.removed_in, g.back_in, g.new_since, g.source, g.refused_from, g.needs,
                          g.last_in)  # fmt: skip
                if found.setdefault(label, row) is not row:
                    raise SnapshotError(f"{path}: two rows are called `{label}`; install rosimpact again")
    return tuple(found.values())


@cache
def stamp() -> str:
    """Differs whenever the table, or that of behaviour.py, does."""
    files = [path.read_bytes() for path in sorted(DATA.glob("uses*.json"))]
    return hashlib.sha1(b"".join((*files, behaviour.stamp().encode()))).hexdigest()[:16]


@cache
def looked_for() -> dict[str, list[tuple[str, Pattern]]]:
    """The uses of C++, and what behaves otherwise, with their labels, by a word that stands in each."""
    found: dict[str, list[tuple[str, Pattern]]] = {}
    for row in (*all_uses(), *behaviour.all_behaviour().values()):
        if row.pattern.language == "cpp":
            found.setdefault(row.pattern.word, []).append((row.label, row.pattern))
    return found


def standards_of(label: str) -> tuple[int, int]:
    """refused_from and needs of a use by its label."""
    return _standards().get(label, (0, 0))


@cache
def _standards() -> dict[str, tuple[int, int]]:
    return {row.label: (row.refused_from, row.needs) for row in all_uses() if row.refused_from or row.needs}


def function_of(label: str) -> str:
    """The function that a use calls, by its label; empty for other uses."""
    return _functions().get(label, "")


@cache
def _functions() -> dict[str, str]:
    return {row.label: row.pattern.word for row in all_uses() if row.pattern.calls}


def uses_in_force(target: Target) -> tuple[Change, ...]:
    """Uses that a target does not take: state `removed` for no longer, `absent` for not yet."""
    found = []
    for row in all_uses():
        version = version_of(row.package, row.library, target, bool(row.last_in))
        if not version:
            continue
        if row.removed_in and reached(row.removed_in, version, target) and not reached(row.back_in, version, target):
            state = "removed"
        elif row.new_since and not reached(row.new_since, version, target):
            state = "absent"
        else:
            continue
        found.append(
            Change(row.kind, row.package, row.label, row.help, state, version, row.new_since, row.source, row.library)
        )
    return tuple(found)
