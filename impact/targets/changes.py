"""Known upstream changes: what a version of a ROS package or platform library removed, renamed, stopped bringing, takes
no longer in a call, or does differently.

The facts are in `data/changes*.json` (names), `uses*.json` (calls and members that only some versions take) and
`behaviour.json` (the name and the call stay, and another result comes out), reviewed, each with its source; those of
changes_debian.json.zst and changes_pypi.json.zst are read from packages (databuild/debian.py, pypi.py), and count where
no other file treats the name, or none says of which versions it is gone. A change is judged on a target by versions;
for headers of ROS packages whose source trees are in the provider table, by what the very release has.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator, Mapping
from functools import cache, lru_cache
from pathlib import Path
from typing import TYPE_CHECKING, Literal, NamedTuple

import msgspec

from ...edges.groups import group_pairs
from ..facts.usage import Pattern
from .distro.known import release_day
from .providers.libraries import load_libraries
from .providers.providers import Providers, load_providers
from .tables import find_data_folder, list_tables, suggest_repair
from .unpacked import SnapshotError, read_table
from .version import is_at_least

if TYPE_CHECKING:
    from .distro.distro import DistroTarget


class _Shared(msgspec.Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """What rows of one group have in common.

    kind: as in Change, `call-changed` of uses, `behaviour` of what behaves differently. package: a ROS package or,
    where library is set, a platform library. removed_in, deprecated_in, new_since: a version, or the first ROS distro;
    `ros2` is all of ROS 2; empty: not known or not yet. Of behaviour, removed_in is the version that changed it, and
    back_in the one that changed it back. new_in: where the distro's name does not tell, distro to the first version
    that has the new name (empty: never there). back_in: a version that has the old name again. ambiguous: the bare name
    is a common word. unless: endings of include paths that bring the old name back. ros: the generation of ROS whose
    versions are meant, for packages that both have and number apart; 0: either. last_in: where two packaged versions
    were compared, the one that has the old name; what versions between it and removed_in have is not known. Empty for
    reviewed rows. refused_from, needs: the year of the C++ standard from which on, or before which, the compiler does
    not take a use; 0: whatever the standard.
    """

    kind: str = "behaviour"
    package: str
    source: str
    library: bool = False
    removed_in: str = ""
    back_in: str = ""
    deprecated_in: str = ""
    new_since: str = ""
    new_in: dict[str, str] = {}
    ambiguous: bool = False
    unless: tuple[str, ...] = ()
    note: str = ""
    ros: int = 0
    last_in: str = ""
    refused_from: int = 0
    needs: int = 0


class _Use(Pattern, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """How a use looks in code, and what to write where it is not taken, or in all versions. clause: what it does now,
    where it compiles.
    imports: modules of which a Python file imports one."""

    help: str = ""
    clause: str = ""
    imports: tuple[str, ...] = ()


class _Group(_Shared, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """names: old to new (empty: nothing instead). uses: by label. help: of all uses that say nothing of their own.
    since, until: of behaviour, removed_in and back_in."""

    names: dict[str, str] = {}
    uses: dict[str, _Use] = {}
    help: str = ""
    since: str = ""
    until: str = ""


class ChangeRow(_Shared, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """One known change, on any target.

    old: an include path, a package, or an identifier as a scanner finds it (`cv::SURF`, `CV_BGR2GRAY`,
    `numpy.float`); new: what stands for it. Of a use, old is its label as a user reads it, which no other row has, new
    what to write instead, and pattern how it looks.
    """

    old: str
    new: str = ""
    pattern: _Use | None = None

    def format_arrival(self) -> str:
        """Since when the new name is there, as people read it: a version, a distro, or a version of each distro."""
        return format_versions(self.new_in) or self.new_since


def format_versions(new_in: Mapping[str, str]) -> str:
    """The first version of each distro that has a change; empty where none is known."""
    return ", ".join(f"{distro} {version}" for distro, version in new_in.items() if version)


class TransitiveInclude(NamedTuple):
    """A header that a compiler or library stopped bringing along.

    name: the identifier that needs it. headers: any of these offers it, best first. library, since: from which version
    of which platform library on it has to be included. sure: no other standard header is known to bring it since.
    """

    name: str
    headers: tuple[str, ...]
    library: str
    since: str
    sure: bool
    source: str


class _TransitiveGroup(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    headers: tuple[str, ...]
    library: str
    since: str
    names: tuple[str, ...]
    source: str
    sure: bool = False


class _File(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    changes: list[_Group] = []
    uses: list[_Group] = []
    behaviour: list[_Group] = []
    transitive: list[_TransitiveGroup] = []


def _read(pattern: str, *last: str) -> list[_File]:
    """The files of a pattern. last: those that come last."""
    paths = sorted(list_tables(pattern), key=lambda path: (path.name in last, path.name))
    return [read_table(path, _File) for path in paths]


@cache
def _load_files() -> list[_File]:
    """All data/changes*.json. A name that two files treat counts as in the more special one; what that does not say of
    it is taken from the other. What was read from packages comes last, since nobody reviewed it; before it the general
    table, since the others were compared with headers and tags."""
    return _read(
        "changes*.json*",
        "changes.json",
        "changes_debian.json.zst",
        "changes_library_tags.json.zst",
        "changes_pypi.json.zst",
    )


def _get_shared_fields(group: _Group) -> dict:
    return {name: getattr(group, name) for name in _Shared.__struct_fields__}


def _list_rows(file: _File) -> Iterator[ChangeRow]:
    for group in file.changes:
        shared = _get_shared_fields(group)
        yield from (ChangeRow(old=old, new=new, **shared) for old, new in group.names.items())


def read_rows(path: Path) -> tuple[ChangeRow, ...]:
    """The known changes of names in one file. Raises SnapshotError when it cannot be read."""
    return tuple(_list_rows(read_table(path, _File)))


@cache
def load_rows() -> tuple[ChangeRow, ...]:
    """Every known change of names. Raises SnapshotError when the data file cannot be read."""
    known: dict[tuple[str, str, str, int], ChangeRow] = {}
    for row in (row for file in _load_files() for row in _list_rows(file)):
        key = row.kind, row.package, row.old, row.ros
        known[key] = merge_rows(known[key], row) if key in known else row
    return tuple(known.values())


def merge_rows(first: ChangeRow, row: ChangeRow) -> ChangeRow:
    """A row with what a less special one on the same name adds."""
    both = tuple(dict.fromkeys(first.unless + row.unless))
    since = first.new_since or (row.new_since if row.new == first.new else "")
    bounds = {} if first.removed_in or first.deprecated_in else {bound: getattr(row, bound) for bound in _BOUNDS}
    return msgspec.structs.replace(first, **{"unless": both, "new_since": since, **bounds})


_BOUNDS = ("last_in", "removed_in", "deprecated_in")
"""What a row that only says what to write instead takes from a derived one."""


@cache
def load_uses(kind: str = "call-changed") -> dict[str, ChangeRow]:
    """Every known change of uses, or of behaviour, by label. Raises SnapshotError when a file cannot be read, or two
    rows have one label."""
    found: dict[str, ChangeRow] = {}
    for group in (g for file in _read(_USES[kind]) for g in (*file.uses, *file.behaviour)):
        shared = _get_shared_fields(group)
        if kind == "behaviour":
            shared |= {"removed_in": group.since, "back_in": group.until}
        for label, use in group.uses.items():
            if label in found:
                raise SnapshotError(f"{find_data_folder()}: two uses are called `{label}`; {suggest_repair()}")
            found[label] = ChangeRow(old=label, new=use.help or group.help, pattern=use, **shared)
    return found


_USES = {"call-changed": "uses*.json", "behaviour": "behaviour.json"}


@cache
def index_rows() -> tuple[dict[tuple[str, str], list[ChangeRow]], dict[tuple[str, str], list[ChangeRow]]]:
    """The rows by the kind of symbol and the name that some versions lack: the old one, then the new one. `cmake` is
    the kind of all of CMake, whose commands are in lower case."""
    rows = sorted((*load_rows(), *load_uses().values()), key=lambda row: row.kind in _LESS_TELLING)
    return (
        group_pairs((_make_subject(row.kind, row.old or row.package), row) for row in rows),
        group_pairs((_make_subject(row.kind, row.new), row) for row in rows if row.new and row.pattern is None),
    )


def _make_subject(kind: str, name: str) -> tuple[str, str]:
    head = kind.partition("-")[0]
    return _SUBJECTS.get(head, head), name.lower() if head == "cmake" and "::" not in name else name


_SUBJECTS = {"api": "c++", "call": "use", "msg": "field"}
"""What rows are about by how their kinds begin, where it is not called so."""
_LESS_TELLING = frozenset(("api-renamed", "api-changed"))
"""Kinds of rows that come after others on the same name."""


@cache
def compute_uses_stamp() -> str:
    """Differs whenever a table of uses does."""
    paths = (path for pattern in _USES.values() for path in list_tables(pattern))
    return hashlib.sha1(b"".join(path.read_bytes() for path in paths)).hexdigest()[:16]


@cache
def index_uses() -> dict[str, list[tuple[str, Pattern]]]:
    """The uses of C++, and what behaves otherwise, with their labels, by a word that stands in each."""
    found: dict[str, list[tuple[str, Pattern]]] = {}
    for row in (*load_uses().values(), *load_uses("behaviour").values()):
        if row.pattern is not None and row.pattern.language == "cpp":
            found.setdefault(row.pattern.word, []).append((row.old, row.pattern))
    return found


def find_standards(label: str) -> tuple[int, int]:
    """refused_from and needs of a use by its label."""
    row = load_uses().get(label)
    return (row.refused_from, row.needs) if row is not None else (0, 0)


def find_function(label: str, language: str, kind: str = "call-changed") -> str:
    """The function that a use in a language calls, by its label; empty for other uses. kind: as of load_uses()."""
    row = load_uses(kind).get(label)
    pattern = row.pattern if row is not None else None
    return pattern.word if pattern is not None and pattern.calls and pattern.language == language else ""


def shows_no_class(label: str) -> bool:
    """Whether a use calls a member of something whose class nothing shows, by its label."""
    row = load_uses().get(label)
    return row is not None and row.pattern is not None and row.pattern.shows_no_class


def shows_no_type(label: str) -> bool:
    """Whether a use is a member of something whose type nothing shows, by its label."""
    row = load_uses().get(label)
    return row is not None and row.pattern is not None and row.pattern.shows_no_type


@cache
def load_transitive() -> tuple[TransitiveInclude, ...]:
    """Every header that is known to have stopped coming along. Raises SnapshotError when the data cannot be read."""
    return tuple(
        TransitiveInclude(name, g.headers, g.library, g.since, g.sure, g.source)
        for file in _load_files()
        for g in file.transitive
        for name in g.names
    )


DISTROS: dict[str, int] = {
    name: place
    for place, name in enumerate(
        (
            *("groovy", "hydro", "indigo", "jade", "kinetic", "lunar", "melodic", "noetic"),
            *("ardent", "bouncy", "crystal", "dashing", "eloquent", "foxy", "galactic", "humble", "iron", "jazzy"),
            *("kilted", "lyrical", "rolling"),
        )
    )
}
"""ROS distros in the order of their release, ROS 1 before ROS 2; rolling stands after the newest."""

State = Literal["removed", "deprecated", "absent"]


def find_state(row: ChangeRow, target: DistroTarget, providers: Providers | None = None) -> State | None:
    """How a row is in force on a target: `removed`, gone there; `deprecated`, still there; `absent`, the new name is
    not there yet. None where it is not in force, or the version of the package or library is not known, except for
    packages that are themselves gone."""
    if row.ros and row.ros != target.ros:
        return None
    version = find_row_version(row, target)
    if not version:
        gone = row.kind in ("package-removed", "package-renamed") and has_reached(row.removed_in, "", target)
        return "removed" if gone else None
    return _determine_state(row, version, target, providers or load_providers())


def iterate_in_force(target: DistroTarget, providers: Providers | None = None) -> Iterator[tuple[ChangeRow, State]]:
    """The rows on names and uses that are in force on a target, and how."""
    for row in (*load_rows(), *load_uses().values()):
        if state := find_state(row, target, providers):
            yield row, state


def find_row_version(row: ChangeRow, target: DistroTarget) -> str:
    """Version of what a row is about on a target; empty when it is not there or not known."""
    return find_version(row.package, row.library, target, bool(row.last_in)) or ""


def find_version(package: str, library: bool, target: DistroTarget, derived: bool = False) -> str | None:
    """Version of a released package, or of a platform library, on a target; None when it is not there or not known.

    derived: what is asked was read from packages of the library. ROS releases some of those itself (urdfdom, ompl),
    under upstream's numbers and ahead of the platform's own. Where no table has the platform's version, that is the
    oldest which Debian's releases allow.
    """
    if not library:
        return target.find_version(package)
    if derived and (released := target.find_version(package.replace("-", "_"))):
        return released
    if package == "python" and getattr(target, "python_major", 3) == 2:
        return "2.7"
    return target.find_library(package) or (
        load_libraries().find_range(package, target.platform)[0] or target.find_oldest_library(package)
        if derived
        else None
    )


def _determine_state(row: ChangeRow, version: str, target: DistroTarget, table: Providers) -> State | None:
    if row.pattern is not None:
        if has_reached(row.removed_in, version, target) and not has_reached(row.back_in, version, target):
            return "removed"
        return "absent" if row.new_since and not has_reached(row.new_since, version, target) else None
    if row.kind.startswith("package-"):
        # The package is there: at most on its way out.
        return "deprecated" if has_reached(row.deprecated_in, version, target) else None
    if has_reached(row.back_in, version, target):
        return None
    gone = has_reached(row.removed_in, version, target)
    new = None
    if row.kind.startswith("header-") and not row.library:
        release = target.distro, version
        old = table.has_header(row.package, row.old, *release)
        if old is None and target.distro != "rolling" and table.has_kept_header(row.package, row.old, *release):
            old = True
        if old is not None:
            gone = not old
            if gone and not has_had_header(row.package, row.old, target, table):
                return None
        if row.new:
            new = table.has_header(row.package, row.new, *release)
            if new is None and table.has_kept_header(row.package, row.new, *release):
                new = True
    if gone:
        return "removed"
    if new is None and row.new:
        new = _is_new_by_table(row, version, target)
    if new is False:
        return "absent"
    return "deprecated" if has_reached(row.deprecated_in, version, target) else None


def behaves_differently(row: ChangeRow, target: DistroTarget) -> bool | None:
    """Whether a target has the new behaviour that a row describes; None where it has not the package, or one of another
    generation."""
    version = find_version(row.package, row.library, target)
    if not version or (row.removed_in in DISTROS and not _is_same_generation(row.removed_in, target)):
        return None
    return has_reached(row.removed_in, version, target) and not has_reached(row.back_in, version, target)


def has_had_header(package: str, header: str, target: DistroTarget, table: Providers) -> bool | None:
    """Whether a release for a target's distro, or an earlier one of this ROS generation, had a header: then it is gone
    rather than not there yet. None where no release of the generation is known to have it."""
    here = DISTROS.get(target.distro, len(DISTROS))
    spans = (span for span in table.list_header_spans(package, header) if span.distro in DISTROS)
    places = [DISTROS[span.distro] for span in spans if _is_same_generation(span.distro, target)]
    return min(places) <= here if places else None


def _is_same_generation(distro: str, target: DistroTarget) -> bool:
    return (DISTROS[distro] >= DISTROS["ardent"]) == (target.ros == 2)


def _is_new_by_table(row: ChangeRow, version: str, target: DistroTarget) -> bool | None:
    if target.distro in row.new_in:
        first = row.new_in[target.distro]
        return bool(first) and is_at_least(version, first)
    return has_reached(row.new_since, version, target) if row.new_since else None


@lru_cache(maxsize=10_000)
def has_reached(bound: str, version: str, target: DistroTarget) -> bool:
    """Whether a target is at or past a bound: a version, a distro of its generation, or all of ROS 2."""
    if not bound:
        return False
    if bound == "ros2":
        return target.ros == 2
    if bound in DISTROS:
        place = DISTROS.get(target.distro)
        if place is None or not _is_same_generation(bound, target):
            return False
        # What came with a distro came to rolling at some day before: for sure only from the distro's release on.
        return (release_day(bound) or "9") <= target.date if target.distro == "rolling" else DISTROS[bound] <= place
    return bool(version) and is_at_least(version, bound)


def list_excuses(package: str, name: str) -> tuple[str, ...]:
    """Endings of include paths that bring a removed name back (`_c.h` for OpenCV's C constants); empty for most."""
    return _load_excuses().get((package, name), ())


@cache
def _load_excuses() -> dict[tuple[str, str], tuple[str, ...]]:
    return {(row.package, row.old): row.unless for row in load_rows() if row.unless}
