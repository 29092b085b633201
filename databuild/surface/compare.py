"""What changed between two versions of a package, of every kind and in one form."""

import posixpath
from collections import Counter, defaultdict
from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import msgspec

from ...edges.memory import cache_method
from ...edges.reach import walk
from ...impact.facts.interface import PRIMITIVES, Field, Section, make_full_name
from ...impact.facts.surface import CLASSES, FUNCTIONS, Entity, HeaderSurface, format_declaration, list_offered
from ...impact.targets.surface.changes import PARAMETER
from ...impact.targets.surface.fields import ROS1_SUFFIXES, make_snake_case
from ...impact.targets.surface.python import UNKNOWN, SurfaceNames
from ...impact.targets.surface.surface import BuildSurface, PythonSurface, Surface
from ..extract.parameters import mentions
from . import compare_build, compare_cpp, compare_python
from .version_change import OPEN, VersionChange


class EntityPlace(NamedTuple):
    """Where an entity stands."""

    package: str
    header: str
    entity: Entity


class RepositorySurfaces:
    """The surfaces of all packages of one repository state, ready to be asked across packages."""

    def __init__(self, surfaces: Mapping[str, Surface]):
        self.surfaces = surfaces

    @cached_property
    def cpp(self) -> dict[str, list[EntityPlace]]:
        """Entities by name, as users write it."""
        found: dict[str, list[EntityPlace]] = defaultdict(list)
        for surface in self.surfaces.values():
            every = [header for _, header in surface.headers]
            inline = tuple(dict.fromkeys(name for header in every for name in header.inline))
            for path, header in surface.headers:
                for entity in list_offered([msgspec.structs.replace(header, inline=inline)]):
                    found[entity.name].append(EntityPlace(surface.package, path, entity))
        return found

    @cached_property
    def opened(self) -> dict[str, set[str]]:
        """Namespaces that `using namespace` opens, by the scope where it stands."""
        found: dict[str, set[str]] = defaultdict(set)
        for name, places in self.cpp.items():
            for place in places:
                if place.entity.kind == "using namespace":
                    found[name].add(place.entity.type)
        return found

    @cached_property
    def headers(self) -> dict[str, tuple[str, HeaderSurface | None]]:
        """Package and surface of each header by what dependants write; None for those that are generated."""
        found: dict[str, tuple[str, HeaderSurface | None]] = {}
        for surface in self.surfaces.values():
            for header in surface.build.headers:
                found.setdefault(header.include, (surface.package, None))
            for path, header in surface.headers:
                found[path] = (surface.package, header)
        return found

    @cache_method
    def collect_mentioned_names(self, package: str) -> frozenset[str] | None:
        """The names that the sources of a package mention, and those of the packages of this state that come along
        with it; None where they are not known."""
        known = self.surfaces
        along = walk([package], lambda name: known[name].runs_with if name in known else ())
        mentioned = [known[name].mentioned for name in along if name in known]
        return None if None in mentioned else frozenset().union(*filter(None, mentioned))

    @cache_method
    def get_python_names(self, package: str) -> SurfaceNames:
        """The Python names of a package."""
        return SurfaceNames(self.surfaces[package].python)

    def includes(self, header: str) -> set[str]:
        """Headers of this state that a header includes, itself among them, over any number of steps."""

        def list_includes(path: str) -> Iterator[str]:
            _, surface = self.headers.get(path, ("", None))
            for include in surface.includes if surface is not None else ():
                yield include.path
                yield posixpath.normpath(posixpath.join(posixpath.dirname(path), include.path))

        return self.headers.keys() & walk([header], list_includes)

    def resolve(self, type_: str, scope: str) -> str | None:
        """The class of this state that a type means in a scope; None for one that is not there."""
        bare = type_.partition("<")[0].strip().removeprefix("typename ").removeprefix("::").strip()
        parts = scope.split("::") if scope else []
        for length in range(len(parts), -1, -1):
            name = "::".join([*parts[:length], bare])
            for place in self.cpp.get(name, ()):
                if place.entity.kind in CLASSES:
                    return name
                if place.entity.kind == "alias" and place.entity.type != type_:
                    target = self.resolve(place.entity.type, "::".join(parts[:length]))
                    if target is not None:
                        return target
        return None

    def find_in_base(self, owner: str, last: str, depth: int = 0) -> tuple[list[Entity], frozenset[str]]:
        """Public members of that name that the bases of a class have, and bases that are not in this state."""
        found: list[Entity] = []
        strange: set[str] = set()
        for place in self.cpp.get(owner, ()):
            if place.entity.kind not in CLASSES:
                continue
            for base in place.entity.bases:
                name = self.resolve(base.type, owner.rpartition("::")[0])
                if name is None or depth > 8:
                    strange.add(base.type)
                    continue
                found += [p.entity for p in self.cpp.get(f"{name}::{last}", ()) if p.entity.access != "private"]
                more, others = self.find_in_base(name, last, depth + 1)
                found += more
                strange |= others
        return found, frozenset(strange)

    def is_reachable_by_using(self, name: str) -> bool:
        """Whether a name can be written because its scope has `using namespace`, or a `using` or alias of its own."""
        owner, _, last = name.rpartition("::")
        return any(f"{space}::{last}" in self.cpp for space in self._list_opened_namespaces(owner))

    def _list_opened_namespaces(self, owner: str) -> Iterator[str]:
        for space in self.opened.get(owner, ()):
            parts = owner.split("::") if owner else []
            for length in range(len(parts), -1, -1):
                yield "::".join([*parts[:length], space.removeprefix("::")])


CONDITIONAL = 0.7
"""How sure a change is of something that stands under a condition of the preprocessor."""


def compare(
    old: Surface, new: Surface, before: RepositorySurfaces | None = None, after: RepositorySurfaces | None = None
) -> tuple[VersionChange, ...]:
    """What changed in a package. before, after: the repository states that the versions belong to, so that what went
    to another package, or into a base class there, is not taken for gone."""
    before = before or RepositorySurfaces({old.package: old})
    after = after or RepositorySurfaces({new.package: new})
    changes = compare_cpp.compare(dict(old.headers), dict(new.headers)) if old.headers != new.headers else ()
    found = [*_list_header_changes(old, new, after, changes), *_list_cpp_changes(old, new, before, after, changes)]
    found += [*_list_python_changes(old, new, after), *_list_message_changes(old, new, after), *_build(old, new, after)]
    found += _list_parameter_changes(old, new, before, after)
    order = {"message": 0, "c++": 1, "python": 2, "build": 3}
    return tuple(dict.fromkeys(sorted(found, key=lambda c: (order[c.side], c.what != "header", c.name, c.kind, c.old))))


def compare_states(before: RepositorySurfaces, after: RepositorySurfaces) -> dict[str, tuple[VersionChange, ...]]:
    """What changed in each package of a repository. A package that is new is one change; of one
    that is gone it is told where what it had is now."""
    found: dict[str, tuple[VersionChange, ...]] = {}
    for name in sorted({*before.surfaces, *after.surfaces}):
        if name not in after.surfaces:
            old, empty = before.surfaces[name], Surface(name, "", BuildSurface(name), PythonSurface(name))
            gone = VersionChange(name, "build", "removed", "package", name, old=old.version)
            found[name] = (gone, *compare(old, empty, before, after))
        elif name not in before.surfaces:
            version = after.surfaces[name].version
            found[name] = (VersionChange(name, "build", "added", "package", name, now=version, breaks=False),)
        else:
            found[name] = compare(before.surfaces[name], after.surfaces[name], before, after)
    return found


def _reaches(new: Surface, package: str, after: RepositorySurfaces) -> bool:
    """Whether whoever uses a package also gets another one through it."""
    known = after.surfaces
    return package in walk([new.package], lambda name: known[name].build.dependencies if name in known else ())


def _collect_headers(surface: Surface) -> dict[str, bool]:
    """Every header, and whether it is sure to be there; those that are made of messages are told as messages."""
    generated = {make_snake_case(name.partition("/")[2]) for name, _ in surface.interfaces}
    found = {}
    for header in surface.build.headers:
        stem = posixpath.splitext(posixpath.basename(header.include))[0]
        if not header.source and (make_snake_case(stem) in generated or _is_interface_part(stem, surface)):
            continue
        found[header.include] = header.sure
    for path, _ in surface.headers:
        found.setdefault(path, not surface.guessed)
    return found


def _is_interface_part(stem: str, surface: Surface) -> bool:
    """Whether a header of ROS 1 is made of part of a service or action."""
    names = {name.partition("/")[2] for name, _ in surface.interfaces}
    return any(stem.removesuffix(end) in names for ends in ROS1_SUFFIXES.values() for end in ends)


def _list_header_changes(
    old: Surface, new: Surface, after: RepositorySurfaces, changes: Sequence[compare_cpp.CppChange]
) -> Iterator[VersionChange]:
    had, has = _collect_headers(old), _collect_headers(new)
    open_ended = _open_ended(old, new)
    surfaces, news = dict(old.headers), dict(new.headers)
    moves: dict[str, Counter[str]] = defaultdict(Counter)
    for change in changes:
        if change.kind == "moved":
            moves[change.old_header][change.new_header] += 1
    for path in sorted(had.keys() - has.keys()):
        sure = 1.0 if had[path] and not open_ended else OPEN
        elsewhere = after.headers.get(path)
        if elsewhere is not None:
            if not _reaches(new, elsewhere[0], after):
                yield VersionChange(
                    old.package, "c++", "moved", "header", path, moved_to=elsewhere[0], where=path, sure=sure
                )
            continue
        surface = surfaces.get(path)
        instead = surface.instead if surface is not None and surface.instead in after.headers else ""
        instead = instead or next((there for there, _ in moves[path].most_common(1)), "") or _find_next(path, had, has)
        yield VersionChange(old.package, "c++", "removed", "header", path, instead=instead, where=path, sure=sure)
    for path in sorted(has.keys() - had.keys()):
        yield VersionChange(
            old.package, "c++", "added", "header", path, where=path, breaks=False, sure=1.0 if has[path] else OPEN
        )
    for path in sorted(surfaces.keys() & news.keys()):
        message = news[path].deprecated
        if surfaces[path].deprecated is None and message is not None:
            instead = news[path].instead
            yield VersionChange(
                old.package, "c++", "deprecated", "header", path, now=message, instead=instead, where=path, breaks=False
            )


def _open_ended(old: Surface, new: Surface) -> bool:
    """Whether the new version may install headers that are not known, other than those that the old one did."""
    if new.guessed and not old.guessed:
        return True
    return any(part == "headers" and (part, why) not in old.build.unknown for part, why in new.build.unknown)


def _find_next(path: str, had: Mapping[str, bool], has: Mapping[str, bool]) -> str:
    """The one header of the same name without its ending: a new one, else one in the same folder."""
    stem = posixpath.splitext(path)[0]
    beside = [other for other in has if posixpath.splitext(other)[0] == stem]
    name = posixpath.basename(stem)
    same = [other for other in has if other not in had and posixpath.splitext(posixpath.basename(other))[0] == name]
    return beside[0] if len(beside) == 1 else same[0] if len(same) == 1 else ""


def _list_cpp_changes(
    old: Surface,
    new: Surface,
    before: RepositorySurfaces,
    after: RepositorySurfaces,
    changes: Sequence[compare_cpp.CppChange],
) -> Iterator[VersionChange]:
    hints = {change.name: change for change in changes if change.kind == "renamed"}
    broken = {(c.old, c.new) for c in changes if c.kind == "signature" and not c.compatible}
    lost = {path for path, header in new.headers if header.lost or header.problems}
    open_ended = _open_ended(old, new)
    has = _collect_headers(new)
    for change in changes:
        if change.kind == "renamed":
            continue
        if change.kind == "default" and (change.old, change.new) in broken:
            continue  # both declarations are shown with what breaks
        one = change.old or change.new
        assert one is not None
        sure = 1.0
        conditions = (*(change.old.conditions if change.old else ()), *(change.new.conditions if change.new else ()))
        if conditions or one.macro:
            sure = CONDITIONAL
        if (open_ended and change.old_header not in has) or change.old_header in lost:
            sure = min(sure, OPEN)
        reported = VersionChange(
            old.package,
            "c++",
            change.kind,
            one.kind,
            change.name,
            format_declaration(change.old) if change.old else "",
            format_declaration(change.new) if change.new else "",
            change.what,
            where=change.old_header or change.new_header,
            breaks=not change.compatible and not one.internal,
            sure=sure,
        )
        if change.kind == "removed":
            gone = _adjust_removal(reported, change, old, new, before, after)
            if gone is not None and change.name in hints and gone.kind == "removed":
                gone = msgspec.structs.replace(gone, instead=hints[change.name].new.name)  # type: ignore[union-attr]
            if gone is not None:
                yield gone
        elif change.kind == "moved":
            # Where the header is gone, that says all.
            if change.old_header in has and change.new_header not in after.includes(change.old_header):
                yield msgspec.structs.replace(reported, instead=change.new_header, old="", now="")
        elif change.kind == "deprecated":
            message = change.new.deprecated if change.new is not None else ""
            yield msgspec.structs.replace(reported, old="", now=message or "")
        else:
            yield reported


def _adjust_removal(
    reported: VersionChange,
    change: compare_cpp.CppChange,
    old: Surface,
    new: Surface,
    before: RepositorySurfaces,
    after: RepositorySurfaces,
) -> VersionChange | None:
    """A removal as it is for users: None where the name can still be written and means the same."""
    one = change.old
    assert one is not None
    if change.compatible:
        return reported
    name = one.name
    owner, _, last = name.rpartition("::")
    if "overload" not in change.what:
        others = [place for place in after.cpp.get(name, ()) if place.package != new.package]
        if others:
            reached = any(_reaches(new, place.package, after) for place in others)
            if reached and any(place.header in after.includes(change.old_header) for place in others):
                return None
            if change.old_header in (place.header for place in others):
                return None  # told of the header
            return msgspec.structs.replace(
                reported, kind="moved", moved_to=others[0].package, instead=others[0].header, breaks=True
            )
        if after.is_reachable_by_using(name):
            return None
    if owner and one.access:
        alias = next((place.entity for place in after.cpp.get(owner, ()) if place.entity.kind == "alias"), None)
        if alias is not None:
            target = after.resolve(alias.type, owner.rpartition("::")[0])
            if target is None or one.kind in ("constructor", "destructor"):
                return None  # the class is something else now, which is told of it
            if f"{target}::{last}" in after.cpp or after.find_in_base(target, last)[0]:
                return None
    if owner and one.access and one.kind not in ("constructor", "destructor"):
        found, strange = after.find_in_base(owner, last)
        if found:
            # A method may be there with other parameters; those of the base count then.
            if one.kind not in FUNCTIONS or "override" in one.traits or compare_cpp.is_still_callable(one, found):
                return None
            now = format_declaration(found[0])
            return msgspec.structs.replace(reported, kind="signature", now=now, aspects=("types",))
        if strange:
            if "override" in one.traits:
                return None
            had = before.find_in_base(owner, last)[1]
            if not strange <= had:
                return msgspec.structs.replace(reported, sure=min(reported.sure, OPEN))
    return reported


def _list_python_changes(old: Surface, new: Surface, after: RepositorySurfaces) -> Iterator[VersionChange]:
    for change in compare_python.compare(old.python, new.python):
        home = _find_python_home(change.name, new, after) if change.kind == "removed" else ""
        if home == "?":
            continue
        if home:
            breaks = home not in new.runs_with  # who installs the package gets that one too
            change = msgspec.structs.replace(change, kind="moved", moved_to=home, breaks=breaks)
        yield change


def _find_python_home(name: str, new: Surface, after: RepositorySurfaces) -> str:
    """Another package of the state that gives the name; `?` where that cannot be known."""
    top = name.partition(".")[0]
    for package, surface in after.surfaces.items():
        if package == new.package or not any(m.name.partition(".")[0] == top for m in surface.python.modules):
            continue
        found = after.get_python_names(package).find(name)
        if found is UNKNOWN:
            return "?"
        if found is not None:
            return package
    return ""


def _list_message_changes(old: Surface, new: Surface, after: RepositorySurfaces) -> Iterator[VersionChange]:
    had, has = dict(old.interfaces), dict(new.interfaces)

    def change(kind: str, what: str, name: str, **more: Any) -> VersionChange:
        return VersionChange(old.package, "message", kind, what, f"{old.package}/{name}", **more)

    for name in sorted(had.keys() - has.keys()):
        homes = [p for p, s in after.surfaces.items() if p != new.package and name in dict(s.interfaces)]
        if len(homes) == 1:
            yield change("moved", "interface", name, moved_to=homes[0], instead=f"{homes[0]}/{name}")
        else:
            yield change("removed", "interface", name)
    for name in sorted(has.keys() - had.keys()):
        yield change("added", "interface", name, breaks=False)
    for name in sorted(had.keys() & has.keys()):
        sections = {section.name: section for section in has[name].sections}
        wire = False
        for section in had[name].sections:
            now = sections.get(section.name)
            if now is None:
                continue
            mine = [(f.name, _resolve_type(f, old.package)) for f in section.fields]
            wire = wire or mine != [(f.name, _resolve_type(f, old.package)) for f in now.fields]
            prefix = name if section.name == "message" else f"{name} {section.name}"
            for kind, what, member, more in _list_member_changes(section, now, old.package):
                yield change(kind, what, f"{prefix}.{member}", **more)
        if wire:
            yield change("wire", "interface", name, breaks=False)


def _list_member_changes(old: Section, new: Section, package: str) -> Iterator[tuple[str, str, str, dict[str, Any]]]:
    had, has = {f.name: f for f in old.fields}, {f.name: f for f in new.fields}
    gone, come = [n for n in had if n not in has], [n for n in has if n not in had]
    for name in gone:
        alike = [n for n in come if _resolve_type(has[n], package) == _resolve_type(had[name], package)]
        rivals = [n for n in gone if _resolve_type(had[n], package) == _resolve_type(had[name], package)]
        instead = alike[0] if len(alike) == len(rivals) == 1 else ""
        yield "removed", "field", name, {"old": _format_field(had[name]), "instead": instead}
    for name in come:
        yield "added", "field", name, {"now": _format_field(has[name]), "breaks": False}
    for name, field in had.items():
        now = has.get(name)
        if now is None:
            continue
        if _resolve_type(field, package) != _resolve_type(now, package):
            yield "type", "field", name, {"old": _format_field(field), "now": _format_field(now)}
        elif field.default != now.default:
            yield "default", "field", name, {"old": field.default, "now": now.default, "breaks": False}
    before, after = {c.name: c for c in old.constants}, {c.name: c for c in new.constants}
    for name, constant in before.items():
        now = after.get(name)
        if now is None:
            yield "removed", "constant", name, {"old": f"{constant.type} {name}={constant.value}"}
        elif constant.value.strip() != now.value.strip():
            yield "value", "constant", name, {"old": constant.value, "now": now.value, "breaks": False}
    for name in after.keys() - before.keys():
        yield "added", "constant", name, {"now": f"{after[name].type} {name}={after[name].value}", "breaks": False}


def _format_field(field: Field) -> str:
    return f"{field.type}{field.array} {field.name}"


def _resolve_type(field: Field, package: str) -> str:
    """The type, however it is written."""
    plain, bound, limit = field.type.partition("<=")
    return f"{plain if plain in PRIMITIVES else make_full_name(plain, package)}{bound}{limit}{field.array}"


def _build(old: Surface, new: Surface, after: RepositorySurfaces) -> Iterator[VersionChange]:
    for change in compare_build.compare(old.build, new.build):
        if change.what == "header":
            continue  # told with what is in them
        if change.kind == "removed" and change.what in _MOVABLE:
            things = compare_build.THINGS[change.what]
            homes = [p for p, s in after.surfaces.items() if p != new.package and change.name in things(s.build)]
            if len(homes) == 1:
                breaks = change.breaks and change.what != "plugin"
                change = msgspec.structs.replace(change, kind="moved", moved_to=homes[0], breaks=breaks)
        yield change


def _list_parameter_changes(
    old: Surface, new: Surface, before: RepositorySurfaces, after: RepositorySurfaces
) -> Iterator[VersionChange]:
    had, has = dict(old.parameters), dict(new.parameters)

    def change(kind: str, name: str, default: str | None, now: str | None, sure: float) -> VersionChange:
        return VersionChange(old.package, "build", kind, PARAMETER, name, default or "", now or "", (), "", "", "",
                      kind == "removed", sure)  # fmt: skip

    # A name that is still mentioned, or was before, may be declared in a way that is not read.
    later, earlier = after.collect_mentioned_names(old.package), before.collect_mentioned_names(old.package)
    for name, default in had.items():
        if name not in has:  # who still sets it is ignored
            yield change("removed", name, default, "", OPEN if later is None or mentions(later, name) else 1.0)
        elif has[name] != default and "?" not in (has[name], default):
            yield change("default", name, default, has[name], 1.0)
    for name, default in has.items():
        if name not in had:
            yield change("added", name, "", default, OPEN if earlier is not None and mentions(earlier, name) else 1.0)


_MOVABLE = frozenset(("executable", "plugin", "launch file", "target"))
