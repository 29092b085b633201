"""Takes rows out of data/changes*.json that the stored surfaces, or the table of interfaces, answer.

A row says that a name of a ROS package is gone from some version, or distro, on. Where surfaces of the package are
stored, each stored version tells whether the name is there. A row is

    answered        stored versions have the name and later ones lack it, as the row says; what a later version has
                    (again) is not gone
    contradicted    some stored version says otherwise, so that the row is wrong there or its bound is inexact
    wrong           contradicted, and the newest stored version has the name
    more            answered, but the row names a replacement, or a deprecation, that nothing stored names; or a target
                    that lacks the name is not known so without the row
    bare            it is a bare name of a function or method, which does not tell whose: it may be anybody's
    unknown         no version is stored, or none on one side of the bound, or the name is of no kind that is stored

Of rows that were derived from release tags, which are what surfaces are made from too, only the unknown ones and those
that say more stay, and of reviewed rows all but the answered, wrong and bare ones. A contradicted bound is first
replaced by the versions that the stored ones tell, of each generation of ROS (see derive_bounds).

Platform libraries have no stored surfaces. Of Python, rows go that changes_pypi.json answers for every version that a
platform has: where they name a replacement, that alone is kept. Of C++, rows on names that Debian's newest version
declares although they should be gone are wrong and go; where an older one does, the Debian versions between which the
name went become the bounds. A name that a header only takes over from another namespace (`using std::uint8_t`) is no
such declaration, and neither is one under a condition, but for `!defined(...)`. Rows that spell one name in several
ways (`asio::`, `boost::asio::`), with the same replacement, go together.

Of interfaces, their fields and constants, and of what is generated from them, the table of interfaces alone is asked,
so that a row only lends a replacement. Rows of uses stay too: a pattern that is only a qualified name is answered by
the surfaces, and still finds places that the resolver does not see, such as template arguments and braced initialisers.

Of the general table, changes.json, a row goes that adds nothing to one on its name in a more special one (`twice`).

    python -P -m rosimpact.databuild.superseded [--write]
"""

from __future__ import annotations

import json
import re
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from functools import cache, lru_cache
from itertools import accumulate
from pathlib import Path
from typing import Any

import msgspec

from ..edges.files import write_file
from ..impact.targets.availability import Availabilities
from ..impact.targets.changes import DISTROS, ChangeRow, merge_rows, read_rows
from ..impact.targets.distro.distro import DistroTarget
from ..impact.targets.distro.known import list_known_distros
from ..impact.targets.providers.libraries import load_libraries
from ..impact.targets.providers.library import DEBIAN_PACKAGES
from ..impact.targets.surface.changes import Line
from ..impact.targets.surface.fields import covers, load_fields
from ..impact.targets.surface.offers import find_standing
from ..impact.targets.surface.store import load_shipped
from ..impact.targets.symbol import Symbol
from ..impact.targets.tables import DATA
from ..impact.targets.unpacked import read_table
from ..impact.targets.version import is_at_least
from .includes import list_platform_versions
from .pypi import FILE as PYPI_FILE
from .table_file import write_table

_SIDES = {"api": ("c++",), "python": ("python",), "header": ("header",), "cmake": ("command", "target", "variable")}
_SEPARATOR = {"c++": "::", "python": ".", "header": "\0"}
_DERIVED = frozenset(("changes_ros_tags.json.zst",))
GENERAL = "changes.json"
_SPECIAL = ("changes_libraries.json", "changes_ros.json", "changes_ros_tags.json.zst")
"""Tables whose rows come before those of the general one."""
_GOES = {True: ("answered", "contradicted", "wrong", "bare"), False: ("answered", "wrong", "bare")}
"""Verdicts on rows that go: of derived files, and of reviewed ones."""


def judge_row(kind: str, package: str, old: str, new: str, removed_in: str, ros: int, deprecated: bool = False) -> str:
    """What the stored data makes of a row; see the module. ros: as in changes.Row. deprecated: the row says from when
    on the name is deprecated."""
    side = kind.partition("-")[0]
    if side == "msg" and not new:
        return "answered"
    if not removed_in or (side not in _SIDES and side != "msg"):
        return "unknown"
    if side == "api" and is_bare(package, old):
        return "bare"
    answers: list[str] = []
    for generation in (ros,) if ros else (1, 2):
        reported = list(_list_presence(side, package, old, generation))
        found = _compare(reported, _make_gone_test(removed_in, package, generation))
        if found == "unknown":
            continue
        instead, warns = _find_replacements(side, package, old, generation)
        if found == "answered" and ((new and new not in instead) or (deprecated and not warns)):
            found = "more"
        answers.append(found)
    for worst in ("contradicted", "more", "answered"):
        if worst in answers:
            return worst
    return "unknown"


def derive_bounds(kind: str, package: str, old: str, ros: int) -> dict[int, str]:
    """By generation of ROS, the first stored version without a name that earlier ones have, and none from then on
    has."""
    side = kind.partition("-")[0]
    found = {}
    for generation in (ros,) if ros else (1, 2):
        reported = list(_list_presence(side, package, old, generation))
        if without := reported[_find_loss(reported) :]:
            found[generation] = without[0][0]
    return found


def is_told(kind: str, package: str, old: str, gone: Callable[[str], bool | None], ros: int) -> bool:
    """Whether every distro of a generation whose version lacks a name is told so by what is stored alone."""
    side = kind.partition("-")[0]
    for known in list_known_distros():
        version = _get_target(known.name).find_version(package) if known.ros == ros else None
        if version is None or not gone(version):
            continue
        interface = _find_interface(side, package, old, ros)
        symbols = [interface] if interface else [Symbol(which, old, (package,)) for which in _SIDES[side]]
        found = [_get_availabilities(known.name).find_availability(symbol) for symbol in symbols]
        if not any(one.is_missing and one.sure and not (one.evidence and one.evidence.source) for one in found):
            return False
    return True


@cache
def _get_availabilities(distro: str) -> Availabilities:
    return Availabilities(_get_target(distro), ahead=())


def is_bare(package: str, name: str) -> bool:
    """Whether a name of C++ is a function or method without its scope. Macros, types and functions of C, which are
    called after their package, are global."""
    head = package.partition("_")[0]
    return "::" not in name and not name.startswith(f"{head}_") and not name[:1].isupper()


def _compare(reported: list[tuple[str, bool]], gone: Callable[[str], bool | None]) -> str:
    """What versions that have, or lack, a name make of the bound. gone: what the bound says of a version."""
    lost = _find_loss(reported)
    told = (one for place, one in enumerate(reported) if one[1] or place >= lost)
    sides = {(gone(version), has) for version, has in told if gone(version) is not None}
    if not any(has for _, has in sides):
        return "unknown"
    if (True, True) in sides or (False, False) in sides:
        return "contradicted"
    return "answered" if len(sides) == 2 else "unknown"


def _find_loss(reported: list[tuple[str, bool]]) -> int:
    """The place after the last version that has a name; that of the end, where none has."""
    return max((place + 1 for place, (_, has) in enumerate(reported) if has), default=len(reported))


def _make_gone_test(bound: str, package: str, ros: int) -> Callable[[str], bool | None]:
    """Whether a bound says of a version that the name is gone; None for one that distros on both sides had."""
    if bound == "ros2":
        return lambda version: ros == 2
    if bound not in DISTROS:
        return lambda version: is_at_least(version, bound)
    if not _may_hold(bound, ros):
        return lambda version: None

    def is_gone(version: str) -> bool | None:
        sides = {DISTROS[distro] >= DISTROS[bound] for distro in _find_distros(package, ros).get(version, ())}
        return sides.pop() if len(sides) == 1 else None

    return is_gone


def _may_hold(bound: str, ros: int) -> bool:
    """Whether a bound may hold in a generation of ROS: that of the distro, where it is one."""
    return bound not in DISTROS or (DISTROS[bound] >= DISTROS["ardent"]) == (ros == 2)


@lru_cache(maxsize=16)
def _find_distros(package: str, ros: int) -> dict[str, set[str]]:
    """The versions of a package with the distros of a generation that ever had them; rolling, which has no bound, left
    out."""
    found: dict[str, set[str]] = {}
    for known in list_known_distros():
        if known.ros == ros and known.name != "rolling":
            for _, version in _get_target(known.name).list_releases(package):
                if version is not None:
                    found.setdefault(version, set()).add(known.name)
    return found


@cache
def _get_target(distro: str) -> DistroTarget:
    return DistroTarget(distro)


def _list_presence(side: str, package: str, old: str, ros: int) -> Iterator[tuple[str, bool]]:
    """The stored versions, and whether each has the name."""
    if (interface := _find_interface(side, package, old, ros)) is not None:
        yield from _list_interface_presence(interface, ros)
        return
    line = load_shipped().find_line(package, ros)
    if line is None:
        return
    for which in _SIDES.get(side, ()):
        name = old.lower() if which == "command" else old
        events = line.events.get(which, {})
        if which == "c++" and "::" not in name:
            yield from _list_bare_presence(line, package, ros, name)
        elif name in events or _is_always_there(package, ros, which, name):
            for place, version in enumerate(line.versions):
                if version not in line.approximate:
                    yield version, _is_there(line, which, name, place)
            return


def _is_there(line: Line, side: str, name: str, place: int) -> bool:
    """Whether a version has a name, and all that it stands in: what goes with its class has no event of its own."""
    events, separator = line.events.get(side, {}), _SEPARATOR.get(side, "\0")
    scopes = accumulate(name.split(separator), lambda scope, part: f"{scope}{separator}{part}")
    return all(find_standing(side, events[scope], place).there for scope in scopes if scope in events)


def _list_bare_presence(line: Line, package: str, ros: int, name: str) -> Iterator[tuple[str, bool]]:
    """The same for a bare name of C++: that of a type or macro in whatever scope."""
    known = [full for full in _read_names(package, ros) if full == name or full.endswith(f"::{name}")]
    for place, version in enumerate(line.versions):
        if known and version not in line.approximate:
            yield version, any(_is_there(line, "c++", full, place) for full in known)


def _is_always_there(package: str, ros: int, side: str, name: str) -> bool:
    if side in ("c++", "python", "header"):
        return name in _read_names(package, ros)
    history = load_shipped().find_history(package, ros)
    build = history.build(history.versions[-1]) if history is not None else None
    if build is None:
        return False
    known = {"command": build.commands, "variable": build.variables, "target": tuple(t.name for t in build.targets)}
    return name in known[side]


@lru_cache(maxsize=4)
def _read_names(package: str, ros: int) -> dict[str, tuple[str, ...]]:
    history = load_shipped().find_history(package, ros)
    return history.index_names() if history is not None else {}


def _find_replacements(side: str, package: str, old: str, ros: int) -> tuple[set[str], bool]:
    """What the stored surfaces name as replacement, and whether the name was deprecated in some version."""
    line = load_shipped().find_line(package, ros)
    instead: set[str] = set()
    warns = False
    for which in _SIDES.get(side, ()):
        events = line.events.get(which, {}).get(old, ()) if line is not None else ()
        instead.update(reported.instead for event in events for reported in event.reported)
        warns = warns or any(reported.kind == "deprecated" for event in events for reported in event.reported)
    return instead, warns


def _find_interface(side: str, package: str, old: str, ros: int) -> Symbol | None:
    """The interface that a generated header, or a name of C++ or Python, is made from, or its field or constant; None
    where the table of interfaces has none."""
    history = load_fields().find_history(package, ros)
    if history is None:
        return None
    if side == "header":
        head, _, stem = old.rpartition(".")[0].partition("/")
        name = history.by_header.get(stem) if head == package else None
        return Symbol("interface", name, (package,)) if name else None
    head, *parts = re.split(r"::|\.|/", old)
    kinds = (parts.pop(0),) if parts and parts[0] in _KINDS else _KINDS if side == "msg" or ros == 1 else ()
    name, *rest = parts or [""]
    base, _, part = name.rpartition("_")
    if part in _SECTIONS:
        name, rest = base, [part, *rest]
    section = rest.pop(0).lower() if rest and rest[0] in _SECTIONS else ""
    for kind in kinds:
        definition = history.find_definition(f"{kind}/{name}") if head == package else None
        if definition is not None and not rest:
            return Symbol("interface", f"{kind}/{name}", (package,))
        if definition is None or len(rest) != 1:
            continue
        for one in definition.sections:
            if section in ("", one) and definition.list_members(one, rest[0]):
                return Symbol("field", f"{kind}/{name}.{one}.{rest[0]}", (package,))
    return None


_KINDS = ("msg", "srv", "action")
_SECTIONS = frozenset(("Request", "Response", "Goal", "Result", "Feedback"))


def _list_interface_presence(interface: Symbol, ros: int) -> Iterator[tuple[str, bool]]:
    """The versions in which anything of its package changed, and whether each has an interface, field or constant."""
    history = load_fields().find_history(interface.packages[0], ros)
    name, *member = interface.name.split(".")
    definition = history.find_definition(name) if history is not None else None
    if history is None or definition is None:
        return
    members = definition.list_members(*member) if member else ()
    spans = [row.spans for row in members] if member else [definition.spans]
    for state, version in enumerate(history.starts):
        yield version, any(covers(one, state) for one in spans)


def drop_superseded(file: Path) -> tuple[dict[str, Any], Counter[tuple[str, str]]]:
    """A file's content without superseded rows, and with bounds as the stored versions have them, and how many rows of
    each kind had which verdict."""
    content = read_table(file, dict[str, Any])
    count: Counter[tuple[str, str]] = Counter()
    kept = []
    for group in content["changes"]:
        if file.name == GENERAL:
            group = _drop_twice(group, count)
            if not group["names"]:
                continue
        # Of platform libraries nothing is stored; a name that comes back, or is only deprecated, says more.
        asked = not group.get("library") and not group["kind"].startswith("package")
        ros = _find_generation(group) if asked else None
        if group.get("library") and file.name != PYPI_FILE:
            judged = _drop_declared(group, count) if group["kind"].startswith("api") else [group]
            kept += [left for one in judged for left in _drop_read_from_pypi(one, count)]
            continue
        by_bound: dict[tuple[tuple[str, str | int], ...], dict[str, str]] = {}
        for old, new in group["names"].items():
            found, rows = _judge(group, ros, old, new) if ros is not None else ("unknown", [{}])
            count[group["kind"], found] += 1
            if found not in _GOES[file.name in _DERIVED]:
                for bounds in rows:
                    by_bound.setdefault(tuple(bounds.items()), {})[old] = new
        kept += [{**group, **dict(bounds), "names": names} for bounds, names in by_bound.items()]
    return {**content, "changes": kept}, count


def _drop_twice(group: dict[str, Any], count: Counter[tuple[str, str]]) -> dict[str, Any]:
    """A group of the general table without names to whose rows in more special ones it adds nothing."""
    special = _load_special_rows()
    left = {}
    for old, new in group["names"].items():
        shared = {key: value for key, value in group.items() if key != "names"}
        row = msgspec.convert({**shared, "old": old, "new": new}, ChangeRow)
        first = special.get((row.kind, row.package, old, row.ros))
        if first is not None and merge_rows(first, row) == first:
            count[row.kind, "twice"] += 1
        else:
            left[old] = new
    return {**group, "names": left}


@cache
def _load_special_rows() -> dict[tuple[str, str, str, int], ChangeRow]:
    found: dict[tuple[str, str, str, int], ChangeRow] = {}
    for name in _SPECIAL:
        for row in read_rows(DATA / name):
            found.setdefault((row.kind, row.package, row.old, row.ros), row)
    return found


def _drop_declared(group: dict[str, Any], count: Counter[tuple[str, str]]) -> Iterator[dict[str, Any]]:
    """A group of rows on a library of C++ without names that Debian's newest version declares, and with the bounds that
    Debian's versions tell where older ones do. Of a name that was said to be deprecated first, that stays."""
    bound = group.get("removed_in", "")
    if not bound or any(group.get(key) for key in ("back_in", "unless", "last_in")):
        yield group
        return
    found = {old: _judge_declared(group["package"], old, bound) for old in group["names"]}
    spelled = {(old.rpartition("::")[2], group["names"][old]): verdict for old, verdict in found.items() if verdict[0]}
    by_bounds: dict[tuple[str, str], dict[str, str]] = {}
    warned = {}
    for old, new in group["names"].items():
        verdict, *bounds = spelled.get((old.rpartition("::")[2], new), found[old])
        if verdict:
            count[group["kind"], verdict] += 1
        if verdict != "wrong":
            by_bounds.setdefault((bounds[0], bounds[1]), {})[old] = new
        elif group.get("deprecated_in"):
            warned[old] = new
    for (last, removed), names in by_bounds.items():
        yield {**group, **({"last_in": last, "removed_in": removed} if last else {}), "names": names}
    if warned:
        yield {**{key: value for key, value in group.items() if key != "removed_in"}, "names": warned}


def _judge_declared(package: str, old: str, bound: str) -> tuple[str, str, str]:
    """What Debian's versions make of a bound from which on a library lacks a name of C++: `wrong`, `contradicted` with
    the last version that has it and the first that has not, or nothing."""
    libraries = load_libraries()
    packages = (package, *map(libraries.find_by_package, DEBIAN_PACKAGES.get(package, ())))
    library = next((one for one in packages if one and libraries.list_versions(one)), "")
    has = [(version, old in _list_declared(library, platform))
           for platform, version in (libraries.list_versions(library) if library else {}).items()]  # fmt: skip
    against = [place for place, (version, there) in enumerate(has) if there and is_at_least(version, bound)]
    if not against:
        return "", "", ""
    last = max(against)
    return ("wrong", "", "") if last == len(has) - 1 else ("contradicted", has[last][0], has[last + 1][0])


@cache
def _list_declared(library: str, platform: str) -> frozenset[str]:
    """The names that whoever includes the right header of a library on a platform has."""
    return frozenset(
        entity.name for entity in load_libraries().list_declared(library, platform)
        if entity.kind != "using" and all(one.text.startswith("!defined(") != one.negated for one in entity.conditions)
    )  # fmt: skip


def _drop_read_from_pypi(group: dict[str, Any], count: Counter[tuple[str, str]]) -> Iterator[dict[str, Any]]:
    """A group of rows on a library without those that wheels answer, and what these say to write instead."""
    left, instead = {}, {}
    for old, new in group["names"].items():
        told = _load_read_from_pypi().get((group["kind"], group["package"], old))
        found = "unknown" if told is None else _compare_bounds(group, told)
        bare = not group.get("removed_in") and not group.get("deprecated_in")
        count[group["kind"], "more" if found == "answered" and new else found] += 1
        if found == "answered" and new and not bare:
            instead[old] = new
        elif found != "answered" or new:
            left[old] = new
    shared = {key: value for key, value in group.items() if key not in ("removed_in", "deprecated_in", "names")}
    for fields, names in ((group, left), (shared, instead)):
        if names:
            yield {**fields, "names": names}


@cache
def _load_read_from_pypi() -> dict[tuple[str, str, str], dict[str, Any]]:
    groups = read_table(DATA / PYPI_FILE, dict[str, Any])["changes"]
    return {(group["kind"], group["package"], old): group for group in groups for old in group["names"]}


def _compare_bounds(group: dict[str, Any], told: dict[str, Any]) -> str:
    """What wheels make of the bounds of a row, by the versions that platforms have; `unknown` where they say less."""
    if group.get("back_in") or group.get("new_since") or group.get("unless"):
        return "unknown"
    versions = list_platform_versions(group["package"])
    for bound in ("removed_in", "deprecated_in"):
        said, read = group.get(bound, ""), told.get(bound, "")
        if said and not read:
            return "unknown"
        gone = {version for version in versions if said and is_at_least(version, said)}
        if said and gone != {version for version in versions if is_at_least(version, read)}:
            return "contradicted"
    return "answered"


def _find_generation(group: dict[str, Any]) -> int | None:
    """The generation of ROS whose versions rows mean, 0: either; None where their names come back within one. Where ROS
    2 goes on with higher numbers, names that are back with the first of these are gone in ROS 1."""
    package, back = group["package"], group.get("back_in")
    if not back:
        return group.get("ros", 0)
    lines = {ros: line for ros in (1, 2) if (line := load_shipped().find_line(package, ros)) is not None}
    later = {(ros, is_at_least(version, back)) for ros, line in lines.items() for version in line.versions}
    return 1 if 1 in lines and later <= {(1, False), (2, True)} else None


def _judge(group: dict[str, Any], ros: int, old: str, new: str) -> tuple[str, list[dict[str, str | int]]]:
    """The verdict on a row of a group, and what the rows have instead that stand for it where the stored versions
    contradict its bound: one for each generation of ROS that lost the name, unless all of that is told without it."""
    kind, package = group["kind"], group["package"]
    given: str = group.get("removed_in", "")
    deprecated = group.get("deprecated_in", "")
    found, rows = judge_row(kind, package, old, new, given, ros, bool(deprecated)), [{}]
    bounds = dict.fromkeys((ros,) if ros else (1, 2), given)
    if found == "contradicted":
        derived = derive_bounds(kind, package, old, ros)
        if not derived:
            return "wrong", rows
        verdicts = {
            one: judge_row(kind, package, old, new, bound, one, bool(deprecated) and _may_hold(deprecated, one))
            for one, bound in derived.items()
        }
        if set(verdicts.values()) <= {"answered", "more"}:
            found, bounds = max(verdicts.values()), derived
            rows = [
                {
                    "removed_in": bound,
                    # The new name came with the version that lost the old one.
                    **({"new_since": bound} if group.get("new_since") == given else {}),
                    **({"ros": one} if given in DISTROS or len(derived) > 1 else {}),
                }
                for one, bound in derived.items()
            ]
    if found == "answered" and kind.partition("-")[0] in _SIDES:
        tests = ((_make_gone_test(bound, package, one), one) for one, bound in bounds.items())
        found = found if all(is_told(kind, package, old, *test) for test in tests) else "more"
    return found, rows


def format_content(content: dict[str, Any], parting: str = "\n  ") -> str:
    """A file's content. parting: what stands before each name, a line for each or a space."""
    groups = []
    for group in content["changes"]:
        head = ", ".join(f"{json.dumps(key)}: {json.dumps(value)}" for key, value in group.items() if key != "names")
        names = f",{parting}".join(f"{json.dumps(old)}: {json.dumps(new)}" for old, new in group["names"].items())
        listed = names if parting == " " else f"{parting}{names}\n"
        groups.append(f'{{{head}, "names": {{{listed}}}}}')
    rest = {key: value for key, value in content.items() if key != "changes"}
    if parting == " ":
        lists = [f'"{key}": [\n' + ",\n".join(map(json.dumps, value)) + "\n]" for key, value in rest.items()]
        return '{"changes": [\n' + "\n],\n".join([",\n".join(groups), *lists]) + "}\n"
    last = ", ".join(f"{json.dumps(key)}: {json.dumps(value)}" for key, value in rest.items())
    return '{"changes": [\n' + ",\n".join(groups) + "\n], " + last + "}\n"


def write_changes(file: Path, content: dict[str, Any]) -> None:
    """Writes a file's content, packed where it is."""
    if file.suffix == ".zst":
        write_table(file, content)
    else:
        parting = "\n  " if b'"names": {\n' in file.read_bytes() else " "
        write_file(file, format_content(content, parting).encode())


def main(arguments: list[str]) -> None:
    """Prints what becomes of the rows of each file, and with --write takes out those that are superseded."""
    for file in sorted(DATA.glob("changes*.json*")):
        content, count = drop_superseded(file)
        before = sum(count.values())
        changed = content != read_table(file, dict[str, Any])
        after = sum(len(group["names"]) for group in content["changes"])
        print(f"{file.name}: {before} rows, {after} left")
        for (kind, found), number in sorted(count.items()):
            print(f"  {kind:16} {found:13} {number}")
        if "--write" in arguments and changed:
            write_changes(file, content)


if __name__ == "__main__":
    main(sys.argv[1:])
