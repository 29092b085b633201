"""Which headers each header of a library or ROS package brings along, by version: include graphs of release tags.

`data/includes.json.zst` is made by build/includes.py from the repositories' release tags. An include that a library
writes under a condition counts as written, except for those of other operating systems.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from functools import cache
from typing import NamedTuple

import msgspec

from .snapshot import DATA, SnapshotError
from .standard import brought_by
from .version import parts


class Table(msgspec.Struct, frozen=True):
    """The shipped table. paths: include paths, whose places stand for them. owners: owner to header to its states, as
    `VERSION PLACE PLACE ...;VERSION -;...`: from that version on, and `-` where there is no such header. libraries:
    owners that are platform libraries. sparse: owners of which not every version was read. names: types to the headers
    that define them, of types that some header stopped bringing along. announced: types to headers that only announce
    them. versions: distro to owner to the version that it has in the end, the compiler's as `gcc`."""

    paths: tuple[str, ...]
    owners: dict[str, dict[str, str]]
    libraries: frozenset[str]
    sparse: frozenset[str]
    names: dict[str, tuple[str, ...]] = {}
    announced: dict[str, tuple[str, ...]] = {}
    versions: dict[str, dict[str, str]] = {}


_State = tuple[tuple[int, ...], tuple[str, ...] | None]


class Includes:
    """A table, asked by header and version."""

    def __init__(self, table: Table):
        self.table = table
        self.owners_of: dict[str, tuple[str, ...]] = {}
        for owner, headers in table.owners.items():
            for header in headers:
                self.owners_of[header] = (*self.owners_of.get(header, ()), owner)
        self._states: dict[tuple[str, str], tuple[_State, ...]] = {}

    def states(self, owner: str, header: str) -> tuple[_State, ...]:
        """(first version, what it includes; None: no such header), oldest first."""
        known = self._states.get((owner, header))
        if known is None:
            paths, found = self.table.paths, []
            for run in self.table.owners[owner][header].split(";"):
                version, _, text = run.partition(" ")
                found.append((parts(version), None if text == "-" else tuple(paths[int(n)] for n in text.split())))
            known = self._states[owner, header] = tuple(found)
        return known

    def included(self, owner: str, header: str, version: str) -> tuple[str, ...] | None:
        """What a header includes in a version; None when there is no such header in it, or none is known to be."""
        wanted, states = parts(version), self.states(owner, header)
        place = sum(1 for first, _ in states if first[: len(wanted)] <= wanted) - 1
        if place < 0:
            return None
        now = states[place][1]
        if owner not in self.table.sparse or place + 1 == len(states) or states[place][0][:2] == wanted[:2]:
            return now
        # Between two known versions, a header may include what it does in either.
        later = states[place + 1][1]
        return tuple(dict.fromkeys((*(now or ()), *(later or ())))) if now or later else None


@cache
def default() -> Includes:
    """The shipped table. Raises SnapshotError when it cannot be read."""
    import zstandard

    path = DATA / "includes.json.zst"
    try:
        raw = zstandard.ZstdDecompressor().decompress(path.read_bytes())
        return Includes(msgspec.json.decode(raw, type=Table))
    except (OSError, zstandard.ZstdError, msgspec.MsgspecError) as error:
        raise SnapshotError(f"{path}: {error}; install rosimpact again") from None


_MESSAGE = {
    1: re.compile(r"\w+/[A-Z]\w*\.h\Z"),
    2: re.compile(r"\w+/(?:msg|srv|action)/(?:detail/)?[a-z0-9_]+\.hpp\Z"),
}
_GENERATOR = {1: ("gencpp", "<gencpp>"), 2: ("rosidl_generator_cpp", "<rosidl_generator_cpp>")}
_CONFIG = re.compile(r"\w+/\w+Config\.h\Z")
_RECONFIGURE = (
    *("dynamic_reconfigure/config_tools.h", "limits", "ros/node_handle.h", "boost/any.hpp"),
    *(
        "dynamic_reconfigure/ConfigDescription.h",
        "dynamic_reconfigure/ParamDescription.h",
        "dynamic_reconfigure/Group.h",
    ),
    "dynamic_reconfigure/config_init_mutex.h",
)
"""What a header made from a .cfg file includes. Source: dynamic_reconfigure's ConfigType.h.template."""


class Brought(NamedTuple):
    """What a header brings along, itself included, and of which headers among them nothing is known here."""

    headers: frozenset[str]
    outside: frozenset[str]


class Machine:
    """The headers of one machine. ros: 1 or 2. version: owner and whether it is a platform library to its version."""

    def __init__(self, ros: int, version: Callable[[str, bool], str | None], data: Includes | None = None):
        self.ros, self._version, self._data = ros, version, data or default()
        self._known: dict[str, tuple[str, ...] | None] = {}
        self._closures: dict[str, Brought] = {}
        self._outside: dict[frozenset[str], frozenset[str]] = {}
        self._alone: dict[str, int] = {}
        self._masks: dict[frozenset[str], int] = {}
        self._bits: dict[str, int] = {}
        self._versions: dict[str, str | None] = {}

    def version(self, owner: str) -> str | None:
        """The version of an owner here."""
        if owner not in self._versions:
            library = owner == "gcc" or owner in self._data.table.libraries
            self._versions[owner] = self._version(owner, library) or (self._version(owner, False) if library else None)
        return self._versions[owner]

    def includes(self, header: str) -> tuple[str, ...] | None:
        """What one header includes here; None when that is not known."""
        if header not in self._known:
            self._known[header] = self._includes(header)
        return self._known[header]

    def _includes(self, header: str) -> tuple[str, ...] | None:
        for owner in self._data.owners_of.get(header, ()):
            version = self.version(owner)
            found = self._data.included(owner, header, version) if version else None
            if found is not None:
                return found
        if self.ros == 1 and _CONFIG.match(header):
            return _RECONFIGURE
        if _MESSAGE[self.ros].match(header):
            owner, pattern = _GENERATOR[self.ros]
            version = self.version(owner)
            return self._data.included(owner, pattern, version) if version else None
        return None

    def knows(self, header: str) -> bool:
        """True when some version of a header was read, be it here or not."""
        return header in self._data.owners_of

    def owner(self, header: str) -> tuple[str, str] | None:
        """The package or library that has a header here, and its version."""
        for owner in self._data.owners_of.get(header, ()):
            version = self.version(owner)
            if version and self._data.included(owner, header, version) is not None:
                return owner, version
        if self.includes(header) is not None:
            owner = "dynamic_reconfigure" if self.ros == 1 and _CONFIG.match(header) else _GENERATOR[self.ros][0]
            return owner, self.version(owner) or ""
        return None

    def brought(self, header: str) -> Brought:
        """Everything that a header brings along here; of standard ones, by the machine's GCC."""
        known = self._closures.get(header)
        if known is None:
            gcc = parts(self.version("gcc") or "5")[0]
            seen, outside, stack = {header}, set(), [header]
            while stack:
                at = stack.pop()
                found = self.includes(at)
                if found is None:
                    standard = brought_by(at, gcc)
                    seen |= standard
                    if len(standard) == 1:
                        outside.add(at)
                    continue
                for path in found:
                    if path not in seen:
                        seen.add(path)
                        stack.append(path)
            known = self._closures[header] = Brought(frozenset(seen), frozenset(outside))
        return known

    def mask(self, headers: frozenset[str]) -> int:
        """Everything that these headers bring along here, as bits() has it."""
        known = self._masks.get(headers)
        if known is None:
            known = 0
            for header in headers:
                alone = self._alone.get(header)
                if alone is None:
                    alone = self._alone[header] = self.bits(self.brought(header).headers)
                known |= alone
            self._masks[headers] = known
        return known

    def outside(self, headers: frozenset[str]) -> frozenset[str]:
        """The headers among all that these bring along of which nothing is known here."""
        known = self._outside.get(headers)
        if known is None:
            known = self._outside[headers] = frozenset().union(*(self.brought(header).outside for header in headers))
        return known

    def bits(self, headers: Iterable[str]) -> int:
        """One bit for each of these headers, the same in all answers of this machine."""
        found = 0
        for header in headers:
            known = self._bits.get(header)
            if known is None:
                known = self._bits[header] = 1 << len(self._bits)
            found |= known
        return found


@cache
def machine_of(distro: str, ros: int, data: Includes | None = None) -> Machine:
    """A distro as it was in the end."""
    known = data or default()
    versions = known.table.versions.get(distro, {})
    return Machine(ros, lambda owner, library: versions.get(owner), known)


class _Offers(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """data/offers.json: names that tags do not tell, to the headers that offer them, best first."""

    source: str
    names: dict[str, tuple[str, ...]]


@cache
def offered() -> dict[str, tuple[str, ...]]:
    """Names to the headers that offer them: types that some header stopped bringing along, and much used ones."""
    path = DATA / "offers.json"
    try:
        reviewed = msgspec.json.decode(path.read_bytes(), type=_Offers).names
    except (OSError, msgspec.MsgspecError) as error:
        raise SnapshotError(f"{path}: {error}; install rosimpact again") from None
    return {**default().table.names, **reviewed}


def announced(name: str) -> tuple[str, ...]:
    """Headers that announce a type without defining it."""
    return default().table.announced.get(name, ())
