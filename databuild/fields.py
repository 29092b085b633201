"""Builds data/fields.json.zst: which version of a package has which interface, with which fields and constants.

Reads git clones at their tags. A package's version is that of its package.xml at the tag; packages that no distro ever
released are left out. Only names, types of nested interfaces and versions are kept. The format is told in fields.py.

    python -P -m rosimpact.databuild.fields REPOSITORIES --output FILE

REPOSITORIES is a folder of clones called `OWNER+NAME` (or with the git directory below).
"""

from __future__ import annotations

import argparse
import re
import sys
from collections.abc import Iterable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

from ..impact.facts.interface import PRIMITIVES, Interface, extract
from ..impact.targets.snapshot import load_snapshot
from ..impact.targets.version import parse
from .surface.releases import find_git_directory
from .table_file import write_table

# One member of an interface: section, name, nested type (`*` behind it for arrays; `!` for constants), written type.
Member = tuple[str, str, str, str]
# kind/Name to its members.
Definitions = dict[str, tuple[Member, ...]]


class Released(NamedTuple):
    """A package at a tag. ros: the generations it builds for."""

    package: str
    ros: tuple[int, ...]
    version: str
    definitions: Definitions


_NAME = re.compile(rb"<name>\s*([^<\s]+)\s*</name>")
_VERSION = re.compile(rb"<version[^>]*>\s*(\d+\.\d+\.\d+)\s*</version>")
_TOOL = re.compile(rb"<(?:buildtool|build)_depend[^>]*>\s*(catkin|ament_cmake\w*|rosidl_default_generators)\s*<")
_PRIMITIVE = PRIMITIVES | {"time", "duration"}
_BUILTIN = {"Header": "std_msgs/Header", "time": "", "duration": ""}
_ASIDE = frozenset({"test", "tests", "testing", "doc", "docs", "example", "examples"})
_KINDS = ("msg", "srv", "action")


class FieldsReader:
    """Released packages of a git repository at any commit. repository: a pygit2.Repository."""

    def __init__(self, repository, wanted: frozenset[str]):
        self._repository, self._wanted = repository, wanted
        self._folders: dict[bytes, tuple[Released, ...]] = {}
        self._parsed: dict[tuple[bytes, str], tuple[Member, ...]] = {}

    def read_packages(self, tree) -> tuple[Released, ...]:
        """All wanted packages in a tree that define interfaces."""
        known = self._folders.get(tree.id.raw)
        if known is None:
            known = self._folders[tree.id.raw] = tuple(self._find_packages(tree))
        return known

    def _find_packages(self, tree) -> Iterator[Released]:
        entries = {entry.name: entry for entry in tree}
        manifests = [n for n in ("package.xml", "package_ROS2.xml", "package_ROS1.xml") if n in entries]
        if not manifests:
            for name, entry in entries.items():
                if entry.type_str == "tree" and name not in _ASIDE and not name.startswith("."):
                    yield from self.read_packages(entry)
            return
        definitions = None
        for file in manifests:
            if entries[file].type_str != "blob":
                continue
            text = entries[file].data
            name, version = _NAME.search(text), _VERSION.search(text)
            if not name or not version or name.group(1).decode() not in self._wanted:
                continue
            tools = set(_TOOL.findall(text))
            ros = tuple(g for g, there in ((1, b"catkin" in tools), (2, bool(tools - {b"catkin"}))) if there)
            if definitions is None:
                definitions = self._read_definitions(tree, name.group(1).decode())
            if definitions and ros and not _takes_files_of_others(entries.get("CMakeLists.txt")):
                yield Released(name.group(1).decode(), ros, version.group(1).decode(), definitions)

    def _read_definitions(self, tree, package: str) -> Definitions:
        found: Definitions = {}
        for path, entry in _walk(tree, ""):
            name, _, kind = path.rpartition("/")[2].rpartition(".")
            if kind in _KINDS and not _ASIDE & set(path.split("/")[:-1]):
                key = (entry.id.raw, package)
                if key not in self._parsed:
                    self._parsed[key] = _list_members(extract(entry.data, kind), package)
                found.setdefault(f"{kind}/{name}", self._parsed[key])
        return found


_FILES_OF = re.compile(rb"\$\{(\w+)_(?:MSG|SRV|ACTION|IDL)_FILES\}")


def _takes_files_of_others(cmake) -> bool:
    """True when a CMakeLists.txt generates interfaces whose files another package's configuration lists."""
    text = cmake.data if cmake is not None and cmake.type_str == "blob" else b""
    return any(
        not re.search(rb"(?:set|list|file|glob)\s*\([^)]*\b" + match.group(1) + rb"_", text, re.IGNORECASE)
        for match in _FILES_OF.finditer(text)
    )


def _walk(tree, prefix: str):
    for entry in tree:
        if entry.type_str == "tree":
            yield from _walk(entry, f"{prefix}{entry.name}/")
        elif entry.type_str == "blob":
            yield prefix + entry.name, entry


def _list_members(definition: Interface, package: str) -> tuple[Member, ...]:
    found = []
    for section in definition.sections:
        for field in section.fields:
            nested = _find_nested_type(field.type, package)
            mark = nested + ("*" if nested and field.array else "")
            found.append((section.name, field.name, mark, field.type + field.array))
        found.extend((section.name, constant.name, "!", constant.type) for constant in section.constants)
    return tuple(found)


def _find_nested_type(type_: str, package: str) -> str:
    """`geometry_msgs/Pose` for a nested interface however it is written, empty for a primitive."""
    plain = type_.partition("<=")[0].replace("/msg/", "/")
    if plain in _PRIMITIVE:
        return ""
    plain = _BUILTIN.get(plain, plain)
    return plain if "/" in plain else f"{package}/{plain}"


def read_repository(repository, wanted: frozenset[str]) -> Iterator[Released]:
    """Every wanted package at every tag; first those whose version the tag's name tells."""
    import pygit2

    reader = FieldsReader(repository, wanted)
    later = []
    for ref in sorted(r for r in repository.references if r.startswith("refs/tags/")):
        try:
            tree = repository.revparse_single(ref).peel(pygit2.Tree)
        except (KeyError, ValueError, pygit2.GitError):
            continue
        for released in reader.read_packages(tree):
            if ref.endswith(released.version):
                yield released
            else:
                later.append(released)
    yield from later


def build_table(released: Iterable[Released]) -> dict[str, str]:
    """`package generation` to its history, as fields.py reads it. Of one version told twice, the first counts."""
    known: dict[tuple[str, int], dict[str, Definitions]] = {}
    for item in released:
        for ros in item.ros:
            known.setdefault((item.package, ros), {}).setdefault(item.version, item.definitions)
    return {f"{package} {ros}": _format_history(versions) for (package, ros), versions in sorted(known.items())}


def _format_history(versions: dict[str, Definitions]) -> str:
    order = sorted(versions, key=parse)
    states: list[tuple[str, Definitions]] = []
    last: dict[int, str] = {}
    for version in order:
        last[parse(version)[0]] = version
        if not states or versions[version] != states[-1][1]:
            states.append((version, versions[version]))
    lines = [" ".join(version for version, _ in states), " ".join(last.values())]
    definitions = [definition for _, definition in states]
    for name in sorted({name for definition in definitions for name in definition}):
        having = [name in definition for definition in definitions]
        lines.append(f"{name}{_format_spans(having, [True] * len(having))}")
        sections: dict[str, dict[tuple[str, str], list[bool]]] = {}
        for place, definition in enumerate(definitions):
            for section, member, mark, _ in definition.get(name, ()):
                row = sections.setdefault(section, {}).setdefault((member, mark), [False] * len(definitions))
                row[place] = True
        successors = _find_successors(name, definitions)
        for section, members in sections.items():
            texts = []
            for (member, mark), there in members.items():
                if mark == "!" and there == having:
                    continue  # constants are only asked for where some version lacks them
                kind = mark if mark in ("", "!") else f":{mark}"
                new = successors.get((section, member))
                texts.append(f"{member}{kind}{_format_spans(there, having)}{f'>{new}' if new else ''}")
            lines.append(f" {section} {' '.join(texts)}")
    return "\n".join(lines)


def _format_spans(there: list[bool], usual: list[bool]) -> str:
    """`@2-5,7-`: in which states something is there; empty when it is there whenever it usually is."""
    if there == usual:
        return ""
    runs, start = [], None
    for place, has in enumerate((*there, False)):
        if has and start is None:
            start = place
        elif not has and start is not None:
            runs.append(f"{start}-" if place == len(there) else f"{start}-{place - 1}")
            start = None
    return "@" + ",".join(runs)


def _find_successors(name: str, definitions: list[Definitions]) -> dict[tuple[str, str], str]:
    """Members that went, with the one of the same type and kind in the same section that stands for them since."""
    last: dict[tuple[str, str], int] = {}
    for place, definition in enumerate(definitions):
        for section, member, _, _ in definition.get(name, ()):
            last[section, member] = place
    found: dict[tuple[str, str], str] = {}
    for place, (before, after) in enumerate(pairwise(definitions)):
        old, new = before.get(name), after.get(name)
        if old is None or new is None or old == new:
            continue
        kept = {row[:2] for row in new}
        gone = [row for row in old if row[:2] not in kept and last[row[:2]] == place]
        if not gone:
            continue
        # What came along with it or, deprecating it, before: not there when it first was.
        first = next(d[name] for d in definitions if name in d and gone[0][:2] in {row[:2] for row in d[name]})
        had = {row[:2] for row in first}
        came = [row for row in new if row[:2] not in had]
        for section, member, mark, type_ in gone:
            alike = [m for s, m, k, t in came if (s, k, t) == (section, mark, type_)]
            rivals = [m for s, m, k, t in gone if (s, k, t) == (section, mark, type_)]
            chosen = ""
            if len(alike) == len(rivals) == 1:
                chosen = alike[0]
            elif len(alike) == len(rivals):
                paired = alike[rivals.index(member)]
                chosen = paired if set(paired.split("_")) & set(member.split("_")) else ""
            if chosen:
                found[section, member] = chosen
    return found


def read_folder(folder: Path, wanted: frozenset[str]) -> Iterator[Released]:
    """What all clones in a folder have."""
    import pygit2

    for clone in sorted(folder.iterdir()):
        where = find_git_directory(clone) if clone.is_dir() and "-release" not in clone.name else None
        if where is not None:
            yield from read_repository(pygit2.Repository(str(where)), wanted)


def main(arguments: list[str] | None = None) -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("repositories", type=Path)
    parser.add_argument("--output", "-o", type=Path, required=True)
    given = parser.parse_args(arguments)
    wanted = frozenset(name for (name,) in load_snapshot().fetch("SELECT name FROM package"))
    found = build_table(read_folder(given.repositories, wanted))
    write_table(given.output, found)
    print(f"{given.output}: {len(found)} packages", file=sys.stderr)
    return 0


if __name__ == "__main__":
    sys.exit(main())
