"""Which headers each header of a library or ROS package brings along on a machine, over any number of steps.

Headers of ROS packages are looked up in the stored surfaces; those of platform libraries, of generators, and of
versions older than all that are stored, in `data/includes.json.zst`, which build/includes.py makes from the
repositories' release tags. An include under a condition counts, unless the condition surely does not hold there.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from functools import cache, cached_property
from typing import NamedTuple

import msgspec

from ....edges.memory import cache_method
from ....edges.reach import Reach
from ...conditions import Environment
from ...facts.condition import Condition
from ..distro.distro import DistroTarget
from ..surface.includes import Include, Included
from ..surface.store import Surfaces
from ..tables import find_table
from ..unpacked import read_table
from ..version import is_at_least, parse
from . import message_headers
from .libraries import load_libraries
from .standard import DEFINED_IN, find_named, find_oldest_gcc, get_bit, list_brought, list_naming_headers

_PARTS = re.compile(r"[/.]")


def is_called_after(header: str, space: str) -> bool:
    """Whether a folder or file of a header's path is called as a namespace is."""
    return space in _PARTS.split(header)


class IncludesTable(msgspec.Struct, frozen=True):
    """The shipped table. paths: include paths, whose places stand for them. owners: owner to header to its states, as
    `VERSION PLACE PLACE ...;VERSION -;...`: from that version on, and `-` where there is no such header. libraries:
    owners that are platform libraries. sparse: owners of which not every version was read, to those that were. names:
    types and macros to the headers that define them, of types that some header stopped bringing along, and of much used
    packages. announced: types to headers that only announce them. versions: distro to owner to the version that it has
    in the end, the compiler's as `gcc`."""

    paths: tuple[str, ...]
    owners: dict[str, dict[str, str]]
    libraries: frozenset[str]
    sparse: dict[str, tuple[str, ...]]
    names: dict[str, tuple[str, ...]] = {}
    announced: dict[str, tuple[str, ...]] = {}
    versions: dict[str, dict[str, str]] = {}


_State = tuple[tuple[int, ...], tuple[str, ...] | None]


class Includes:
    """A table, asked by header and version."""

    def __init__(self, table: IncludesTable):
        self.table = table
        self.owners_of: dict[str, tuple[str, ...]] = {}
        for owner, headers in table.owners.items():
            for header in headers:
                self.owners_of[header] = (*self.owners_of.get(header, ()), owner)
        self._read: dict[str, frozenset[tuple[int, ...]]] = {}

    @cache_method
    def list_states(self, owner: str, header: str) -> tuple[_State, ...]:
        """(first version, what it includes; None: no such header), oldest first."""
        paths, found = self.table.paths, []
        for run in self.table.owners[owner][header].split(";"):
            version, _, text = run.partition(" ")
            found.append((parse(version), None if text == "-" else tuple(paths[int(n)] for n in text.split())))
        return tuple(found)

    def list_included(self, owner: str, header: str, version: str) -> tuple[str, ...] | None:
        """What a header includes in a version; None when there is no such header in it, or none is known to be."""
        wanted, states = parse(version), self.list_states(owner, header)
        place = sum(1 for first, _ in states if first[: len(wanted)] <= wanted) - 1
        if place < 0:
            return None
        now = states[place][1]
        if place + 1 == len(states) or self._was_read(owner, wanted):
            return now
        # Between two known versions, a header may include what it does in either.
        later = states[place + 1][1]
        return tuple(dict.fromkeys((*(now or ()), *(later or ())))) if now or later else None

    def _was_read(self, owner: str, wanted: tuple[int, ...]) -> bool:
        """Whether a version, or another of its minor line, was read."""
        if owner not in self.table.sparse:
            return True
        if owner not in self._read:
            self._read[owner] = frozenset(parse(version)[:2] for version in self.table.sparse[owner])
        return wanted[:2] in self._read[owner]


@cache
def load_includes() -> Includes:
    """The shipped table. Raises SnapshotError when it cannot be read."""
    return Includes(read_table(find_table("includes.json.zst"), IncludesTable))


_INCLUDE_FOLDERS = ("eigen3/Eigen/", "eigen3/unsupported/", "opencv4/opencv2/")
"""Heads of include paths that name a library's own folder below the system's, as some write them."""
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


_NUMBERS = re.compile(r"\w+/version\.hp?p?")
"""Headers of ROS 2 packages that define the macros of their version, and include nothing. Source: version.h.in of
ament_cmake_gen_version_h."""
_WRITTEN = {
    "rclcpp/logging.hpp": (
        *("sstream", "type_traits", "rclcpp/logger.hpp", "rcutils/logging_macros.h", "rclcpp/utilities.hpp"),
    ),
    "rcutils/logging_macros.h": ("rcutils/logging.h", "stdio.h", "stdlib.h"),
}
"""Headers that their package's build writes in some versions, and what they include. Source: their templates in the
packages' resource folders, Humble to Rolling."""


class Brought(NamedTuple):
    """What a header brings along, itself included, and of which headers among them nothing is known here: they are of
    packages that no version is known of, are made while building, or are not there. standard: those of the standard
    libraries, as far as others than these include them."""

    headers: frozenset[str]
    outside: frozenset[str]
    standard: frozenset[str] = frozenset()


class _Found(NamedTuple):
    """A header of a package or library of some version, and what it includes. library: it is a system library's."""

    owner: str
    version: str
    includes: tuple[str, ...]
    library: bool = False


class HeadersOfMachine:
    """The headers of one machine, each answer kept. ros: 1 or 2. version: owner and whether it is a platform library to
    its version. surfaces: what its ROS packages offer, by default the shipped file. platform: whose libraries it has,
    besides those of the table; empty for no others."""

    def __init__(
        self,
        ros: int,
        version: Callable[[str, bool], str | None],
        data: Includes | None = None,
        surfaces: Surfaces | None = None,
        platform: str = "",
    ):
        self.ros, self._version, self._data, self._given = ros, version, data or load_includes(), surfaces
        self._platform = platform
        self._reach = Reach(self._look)
        # Of what was reached: headers of the standard libraries, and those of which nothing is known here.
        self._plain = self._unknown = 0
        # The headers that tells() was asked of, and those that it denies.
        self._asked = self._silent = 0

    @cache_method
    def find_version(self, owner: str) -> str | None:
        """The version of an owner here."""
        library = owner == "gcc" or owner in self._data.table.libraries
        return self._version(owner, library) or (self._version(owner, False) if library else None)

    @cached_property
    def gcc(self) -> int:
        """The major version of the compiler."""
        return parse(self.find_version("gcc") or "5")[0]

    @cached_property
    def surfaces(self) -> Surfaces:
        """The stored surfaces."""
        from ..surface.store import load_shipped

        return self._given or load_shipped()

    def includes(self, header: str) -> tuple[str, ...] | None:
        """What one header includes here, as dependants would write it; None when that is not known."""
        found = self._find(header)
        return None if found is None else found.includes

    @cache_method
    def list_always_included(self, header: str) -> tuple[str, ...]:
        """What a header of a ROS package includes under no condition; nothing where that is not known."""
        for package in self.surfaces.list_holders(header):
            stored = self._find_stored(package)
            written = stored[0].list_includes(header, stored[1]) if stored is not None else None
            if stored is not None and written is not None:
                plain = (one for one in written if not one.conditions)
                return tuple(dict.fromkeys(stored[0].resolve_include(one, header, stored[1]) for one in plain))
        return ()

    def find_owner(self, header: str) -> tuple[str, str] | None:
        """The package or library that has a header here, and its version."""
        found = self._find(header)
        return None if found is None else (found.owner, found.version)

    def is_from_library(self, header: str) -> bool:
        """True when a platform library, and no ROS package, has a header here."""
        found = self._find(header)
        return found is not None and (found.library or found.owner in self._data.table.libraries)

    def knows(self, header: str) -> bool:
        """True when some version of a header was read, be it here or not."""
        if header in self._data.owners_of:
            return True
        return any(
            header in included.headers
            for package in self.surfaces.list_holders(header)
            for ros in self.surfaces.list_ros(package)
            if (included := self.surfaces.find_included(package, ros)) is not None
        )

    @cache_method
    def _find(self, header: str) -> _Found | None:
        if header.startswith(_INCLUDE_FOLDERS):
            header = header.partition("/")[2]
        libraries = self._data.table.libraries
        owners = self._data.owners_of.get(header, ())
        return (
            self._find_in_table(header, (owner for owner in owners if owner in libraries))
            or self._find_in_surfaces(header)
            or self._find_in_table(header, (owner for owner in owners if not self._is_gone(owner, header)))
            or self._find_made(header)
            or self._find_in_libraries(header)
        )

    def _find_in_table(self, header: str, owners: Iterable[str]) -> _Found | None:
        for owner in owners:
            version = self.find_version(owner)
            found = self._data.list_included(owner, header, version) if version else None
            if version and found is not None:
                return _Found(owner, version, found)
        return None

    def _find_in_surfaces(self, header: str) -> _Found | None:
        for package in self.surfaces.list_holders(header):
            stored = self._find_stored(package)
            if stored is None:
                continue
            included, standing, version = stored
            written = included.list_includes(header, standing)
            if written is not None:
                active = (one for one in written if self._may_hold(one.conditions))
                paths = dict.fromkeys(self._resolve_include(included, one, header, standing) for one in active)
                return _Found(package, version, tuple(paths))
        return None

    def _resolve_include(self, included: Included, include: Include, header: str, version: str) -> str:
        """The path that dependants would write for what a header includes. What nobody has under a bare name in quotes
        is made from a template, and lies beside the header where it is installed."""
        path = included.resolve_include(include, header, version)
        folder = header.rpartition("/")[0]
        if include.angled or "/" in path or not folder or self._find(path) is not None:
            return path
        return path if len(list_brought(path, self.gcc)) > 1 else f"{folder}/{path}"

    def _find_in_libraries(self, header: str) -> _Found | None:
        if not self._platform or header in self._data.owners_of:
            return None
        found = load_libraries().find_included(header, self._platform)
        return _Found(*found, library=True) if found is not None else None

    def _is_gone(self, package: str, header: str) -> bool:
        """Whether the surface that stands for a package here lacks a header that others of its surfaces have."""
        stored = self._find_stored(package)
        return stored is not None and header in stored[0].headers

    @cache_method
    def _find_stored(self, package: str) -> tuple[Included, str, str] | None:
        """What a package's headers include, the stored version that stands for the one here, and that one."""
        version, included = self._version(package, False), self.surfaces.find_included(package, self.ros)
        standing = included.stands_for(version) if version and included is not None else None
        return (included, standing, version) if included and standing and version else None

    @cache_method
    def _may_hold(self, conditions: tuple[Condition, ...]) -> bool:
        if not conditions:
            return True
        from ...conditions import evaluate_all

        return evaluate_all(conditions, self._environment) is not False

    @cached_property
    def _environment(self) -> Environment:
        from ...conditions import Environment

        def find_version(name: str) -> str | None:
            return self._version(name, False) or self._version(name.lower(), True)

        return Environment(ros_version=str(self.ros), versions=find_version, headers=self._has)

    def _has(self, header: str) -> bool | None:
        """Whether a package has a header here, None when that is not known."""
        there: bool | None = None
        for package in self.surfaces.list_holders(header):
            stored = self._find_stored(package)
            if stored is None or header not in stored[0].headers:
                continue
            included, standing, version = stored
            if included.list_includes(header, standing) is not None:
                return True
            there = False if standing == version else there
        return there

    def _find_made(self, header: str) -> _Found | None:
        """A header that is made while its package is built."""
        written = () if _NUMBERS.fullmatch(header) else _WRITTEN.get(header)
        if written is not None and self.ros == 2:
            owner = header.partition("/")[0]
            version = self._version(owner, False)
            return _Found(owner, version, written) if version else None
        if self.ros == 1 and _CONFIG.match(header):
            owner = "dynamic_reconfigure"
            return _Found(owner, self.find_version(owner) or "", _RECONFIGURE)
        package = message_headers.find_package(header, self.ros)
        if package is None:
            package = message_headers.find_package_for_c(header) if self.ros == 2 else None
            version = self._version(package, False) if package else None
            return _Found("rosidl_generator_c", version, message_headers.OF_C) if version else None
        owner, pattern = _GENERATOR[self.ros]
        version = self.find_version(owner)
        always = self._data.list_included(owner, pattern, version) if version else None
        if version is None or always is None:
            return None
        apart = is_at_least(version, "0.9.0")
        others = message_headers.list_included(header, self.ros, self._load_interfaces(package), apart) or ()
        return _Found(owner, version, tuple(dict.fromkeys((*always, *others))))

    @cache_method
    def _load_interfaces(self, package: str) -> message_headers.Definitions:
        stored = self._find_stored(package)
        history = self.surfaces.find_history(package, self.ros) if stored is not None else None
        found = history.load_interfaces(stored[1]) if stored is not None and history is not None else {}
        return message_headers.Definitions(found)

    @cache_method
    def find_brought(self, header: str) -> Brought:
        """Everything that a header brings along here; of standard ones, by the machine's GCC."""
        reached, along = self._reach.collect_masks((header,))
        parts = (reached | along, reached & self._unknown, reached & self._plain)
        return Brought(*(frozenset(self._reach.list_names(mask)) for mask in parts))

    def _look(self, header: str) -> tuple[Iterable[str], Iterable[str]]:
        """The headers that one includes, or all that a standard one reads."""
        found = self.includes(header)
        if found is not None:
            return found, ()
        standard = list_brought(header, self.gcc)
        if _is_plain(header, self.gcc):
            self._plain |= self._reach.assign_bit(header)
        elif len(standard) == 1:
            self._unknown |= self._reach.assign_bit(header)
        return (), standard

    @cache_method
    def _compute_masks(self, headers: frozenset[str]) -> tuple[int, int]:
        """The headers that these lead to, and with them those that standard ones among them read."""
        reached, along = self._reach.collect_masks(headers)
        return reached, along | reached

    @cache_method
    def _follow_headers(self, headers: frozenset[str]) -> tuple[int, int]:
        """The same as far as it was known when it was first asked for: most files get what they need from headers that
        were followed for others, so that those that nobody else includes need not be."""
        reached, along = self._reach.collect_known_masks(headers)
        return reached, along | reached

    def compute_mask(self, headers: frozenset[str]) -> int:
        """Everything that these headers bring along here, as bits() has it."""
        return self._compute_masks(headers)[1]

    def brings_any(self, bits: int, headers: frozenset[str]) -> bool:
        """Whether these headers bring one of others along here, which are given as bits() has them."""
        return bool(bits & self._follow_headers(headers)[1] or bits & self.compute_mask(headers))

    @cache_method
    def _compute_naming_mask(self, name: str, standard: int) -> int:
        """The standard headers that a name of the standard libraries is in here, as bits() has them."""
        named = list_naming_headers(name, self.gcc, standard)
        return self.find_bits(one for one in named if _is_plain(one, self.gcc) and self.includes(one) is None)

    def brings(self, name: str, headers: frozenset[str], standard: int) -> bool:
        """Whether these headers bring a name of the standard libraries along here, as far as that can be excluded.

        standard: year of the C++ standard that they are compiled under."""
        naming = self._compute_naming_mask(name, standard)
        if naming & self._follow_headers(headers)[0] or naming & self._compute_masks(headers)[0]:
            return True
        if self.knows_name(name):
            return self.gcc < find_oldest_gcc() and bool(self.find_bits(DEFINED_IN[name]) & self.compute_mask(headers))
        return True

    def knows_name(self, name: str) -> bool:
        """Whether it is known here which headers bring a name of the standard libraries along: of older compilers the
        headers are, and of some names where they are defined."""
        return bool(get_bit(name)) and (self.gcc >= find_oldest_gcc() or name in DEFINED_IN)

    @cache_method
    def list_unknown_headers(self, headers: frozenset[str]) -> frozenset[str]:
        """The headers among all that these bring along of which nothing is known here."""
        reached, _ = self._compute_masks(headers)
        return frozenset(self._reach.list_names(reached & self._unknown))

    def tells(self, header: str) -> bool:
        """False for a header that is made from an interface of which no definition is known here, so that neither its
        being there nor what it brings along of others' is known."""
        package = message_headers.find_package(header, self.ros)
        if package is None or self.includes(header) is None:
            return True
        return message_headers.list_included(header, self.ros, self._load_interfaces(package), True) is not None

    def tells_all(self, headers: frozenset[str]) -> bool:
        """Whether it tells of all generated headers that these bring along."""
        mask = self.compute_mask(headers)
        fresh = mask & ~self._asked
        if fresh:
            self._asked |= fresh
            self._silent |= self.find_bits(header for header in self._reach.list_names(fresh) if not self.tells(header))
        return not mask & self._silent

    def find_bits(self, headers: Iterable[str]) -> int:
        """One bit for each of these headers, the same in all answers of this machine."""
        return self._reach.combine_bits(headers)


def _is_plain(header: str, gcc: int) -> bool:
    """Whether it is known of a header of the standard libraries which names it brings."""
    return find_named(header, gcc, 2017) is not None


def make_machine(target: DistroTarget) -> HeadersOfMachine:
    """The headers that a target has."""

    def find_version(name: str, library: bool) -> str | None:
        return target.find_library(name) if library else target.find_version(name)

    return HeadersOfMachine(target.ros, find_version, platform=target.platform)


@cache
def load_machine(distro: str, ros: int, data: Includes | None = None) -> HeadersOfMachine:
    """A distro as it was in the end."""
    known = data or load_includes()
    versions = known.table.versions.get(distro, {})

    def find_version(owner: str, library: bool) -> str | None:
        return versions.get(owner) or (None if library else _make_target(distro).find_version(owner))

    return HeadersOfMachine(ros, find_version, known, platform=_make_target(distro).platform)


@cache
def _make_target(distro: str) -> DistroTarget:
    from ..distro.distro import DistroTarget

    return DistroTarget(distro)


class _Offers(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """data/offers.json: names that tags do not tell, to the headers that offer them, best first."""

    source: str
    names: dict[str, tuple[str, ...]]


@cache
def load_offered() -> dict[str, tuple[str, ...]]:
    """Names to the headers that offer them: types that some header stopped bringing along, and much used ones."""
    reviewed = read_table(find_table("offers.json"), _Offers).names
    return {**load_includes().table.names, **reviewed}


def list_announcing_headers(name: str) -> tuple[str, ...]:
    """Headers that announce a type without defining it."""
    return load_includes().table.announced.get(name, ())
