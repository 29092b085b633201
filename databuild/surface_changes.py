"""Finds what changed of packages from version to version, for the file of surfaces (see surface_changes.py)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import msgspec

from ..impact.facts.surface import CLASSES, FUNCTIONS
from ..impact.targets.surface.changes import ChangeEvent, ComparedThing, Form, Line, make_overload
from ..impact.targets.surface.python import UNKNOWN
from ..impact.targets.surface.surface import BuildSurface
from .surface.compare import RepositorySurfaces, compare
from .surface.version_change import VersionChange
from .surface_file import pack, shorten_message

# What other tables tell (messages), and what a package has for itself.
_UNTOLD = frozenset(("dependency", "system dependency", "package", "standard"))
_CALLED = FUNCTIONS | {"macro"}
_OF_HEADERS = ("c++", "header")


class Lines:
    """Compares the versions of the packages of one repository as they come, oldest first."""

    def __init__(self) -> None:
        self._before: dict[tuple[str, int], RepositorySurfaces] = {}
        # The last that was read whole, which names of C++ and headers are compared with.
        self._whole: dict[tuple[str, int], RepositorySurfaces] = {}
        self._versions: dict[tuple[str, int], list[str]] = {}
        self._approximate: dict[tuple[str, int], list[str]] = {}
        self._events: dict[tuple[str, int], dict[tuple[str, str], list[ChangeEvent]]] = {}

    def add(
        self,
        package: str,
        version: str,
        generations: Sequence[int],
        state: RepositorySurfaces,
        approximate: bool = False,
    ) -> None:
        """The next version of a package, and the state that it belongs to. generations: 1, 2 or both. approximate: a
        branch stands for it."""
        compared: dict[tuple[int, int], tuple[tuple[tuple[str, str], ChangeEvent], ...]] = {}
        for generation in generations:
            key = package, generation
            versions = self._versions.setdefault(key, [])
            if version in versions:
                continue
            before, whole = self._before.get(key), self._whole.get(key)
            if before is not None and whole is not None:
                both = id(before), id(whole)
                if both not in compared:
                    compared[both] = tuple(_list_events(package, before, whole, state))
                for thing, event in compared[both]:
                    if thing not in self._events.get(key, {}) and _may_have_been(thing, event):
                        continue
                    placed = msgspec.structs.replace(event, place=len(versions))
                    self._events.setdefault(key, {}).setdefault(thing, []).append(placed)
            versions.append(version)
            if approximate:
                self._approximate.setdefault(key, []).append(version)
            self._before[key] = state
            if whole is None or not is_read_in_part(*(one.surfaces[package].build for one in (whole, state))):
                self._whole[key] = state

    def pack_lines(self) -> dict[tuple[str, int], bytes]:
        """Package and ROS generation to its line as it is stored."""
        return {key: pack(line) for key, line in self.list_lines()}

    def list_lines(self) -> Iterator[tuple[tuple[str, int], Line]]:
        """Packages with their ROS generation, each with its versions and what changed."""
        for (package, generation), versions in self._versions.items():
            events: dict[str, dict[str, tuple[ChangeEvent, ...]]] = {}
            for (side, name), reported in sorted(self._events.get((package, generation), {}).items()):
                events.setdefault(side, {})[name] = tuple(reported)
            bases = _collect_bases(package, self._before[package, generation])
            approximate = tuple(self._approximate.get((package, generation), ()))
            yield (package, generation), Line(tuple(versions), events, bases, approximate)


def is_read_in_part(before: BuildSurface, after: BuildSurface) -> bool:
    """Whether a version has no header, although the one before has some, and still has what is built: its build
    installs them in a way that is not understood. One that has nothing at all any more was given up, or split."""
    return bool(before.headers and not after.headers and (after.targets or after.libraries or after.programs))


def is_out_of_sight(side: str, event: ChangeEvent) -> bool:
    """Whether a name of C++, or a header, was merely not read, if it goes at a version that was read in part. What is
    found elsewhere has moved."""
    return side in _OF_HEADERS and all(reported.kind == "removed" for reported in event.reported)


def _may_have_been(thing: tuple[str, str], event: ChangeEvent) -> bool:
    """Whether a name of C++ seems new because the header that has it was generated before, or is not known well."""
    return thing[0] == "c++" and all(reported.kind == "added" and reported.sure < 1 for reported in event.reported)


def _find_side(change: VersionChange) -> str:
    if change.what == "header":
        return "header"
    return change.side if change.side in ("c++", "python") else change.what


def _list_events(
    package: str, before: RepositorySurfaces, whole: RepositorySurfaces, after: RepositorySurfaces
) -> Iterator[tuple[tuple[str, str], ChangeEvent]]:
    """What changed of a package, by side and name. whole: the last version before that was read whole, mostly `before`
    itself. The places are filled in later."""
    for thing, event in _compare_versions(package, before, after):
        if whole is before or thing[0] not in _OF_HEADERS:
            yield thing, event
    if whole is not before:
        yield from (row for row in _compare_versions(package, whole, after) if row[0][0] in _OF_HEADERS)


def _compare_versions(
    package: str, before: RepositorySurfaces, after: RepositorySurfaces
) -> Iterator[tuple[tuple[str, str], ChangeEvent]]:
    found: dict[tuple[str, str], list[ComparedThing]] = {}
    in_part = is_read_in_part(before.surfaces[package].build, after.surfaces[package].build)
    for change in compare(before.surfaces[package], after.surfaces[package], before, after):
        if change.side == "message" or change.what in _UNTOLD:
            continue
        name = change.name.partition("(")[0] if change.what == "parameter" else change.name
        kept = change.kind in ("deprecated", "value") or (change.kind == "default" and change.side != "c++")
        reported = ComparedThing(change.kind, change.what, change.aspects, shorten_message(change.now) if kept else "",
                    change.instead,
                    change.moved_to, change.breaks, change.sure)  # fmt: skip
        each = found.setdefault((_find_side(change), name), [])
        if reported not in each:
            each.append(reported)
    for (side, name), each in found.items():
        had, has = _find_form(package, side, name, before), _find_form(package, side, name, after)
        if side == "c++" and had is not None and had == has and all(reported.kind == "added" for reported in each):
            continue  # another header declares it too
        event = ChangeEvent(0, tuple(each), had, has)
        if not (in_part and is_out_of_sight(side, event)):
            yield (side, name), event


def _find_form(package: str, side: str, name: str, state: RepositorySurfaces) -> Form | None:
    if side == "c++":
        entities = [place.entity for place in state.cpp.get(name, ()) if place.entity.access != "private"]
        if not entities:
            owner, _, last = name.rpartition("::")
            entities = state.find_in_base(owner, last)[0] if owner else []
        if not entities:
            return None
        called = [one for one in entities if one.kind in _CALLED and one.parameters is not None]
        overloads = dict.fromkeys(map(make_overload, called))
        messages = [one.deprecated for one in entities]
        return Form(tuple(overloads), None if None in messages else shorten_message(messages[0] or ""))
    if side == "python":
        entry = state.get_python_names(package).find(name)
        if entry is None or entry is UNKNOWN:
            return None
        deprecated = entry.bound.deprecated if entry.bound is not None else ""
        return Form((), shorten_message(deprecated) if deprecated else None)
    return None


def _collect_bases(package: str, state: RepositorySurfaces) -> dict[str, tuple[str, ...]]:
    found = {}
    for name, places in state.cpp.items():
        for place in places:
            one = place.entity
            if place.package == package and one.kind in CLASSES and one.bases and not one.arguments:
                scope = name.rpartition("::")[0]
                found[name] = tuple(
                    state.resolve(base.type, scope) or base.type.partition("<")[0].removeprefix("::")
                    for base in one.bases
                    if base.access != "private"
                )
    return found
