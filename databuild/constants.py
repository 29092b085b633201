"""Builds data/constants.json.zst: constants of released packages that are texts as topics, frames and services have
them, by header, module of Python or message.

Read is what the newest version that each distro has of a package installs of headers and modules, as far as clones of
the repositories are at hand. A constant that two versions give different values is left out.

    python -P -m rosimpact.databuild.constants CLONES
"""

from __future__ import annotations

import os
import posixpath
import re
import sys
from collections import defaultdict
from collections.abc import Iterable, Iterator
from pathlib import Path

from ..impact.facts.cpp import flow as cpp
from ..impact.facts.flow import DataMember, FlowFile
from ..impact.facts.python import flow as python
from ..impact.model.package import find_folder_role
from ..impact.targets.constants import ReleasedConstants
from ..impact.targets.snapshot import Snapshot, load_snapshot
from ..impact.targets.tables import DATA
from ..impact.tree import Tree, TreeError
from .surface.clones import Clone, Clones
from .surfaces import plan
from .table_file import write_table

_HEADERS = (".h", ".hpp", ".hh", ".hxx", ".ipp", ".tpp")
_PACKAGE = re.compile(rb"<name>\s*([\w-]+)\s*</name>")
# A name of a topic, a service, a frame or a parameter, or a part of one.
_NAME = re.compile(r"~?/?[A-Za-z_]\w*(?:/\w+)*/?\Z")
_LONGEST = 60
# What a file without it has no constant of.
_IN_CPP = re.compile(rb'^\s*#\s*define\s+\w+\s+"|\b(?:const|constexpr)\b[^;{}()]*[={]\s*"', re.MULTILINE)
_IN_PYTHON = re.compile(rb"^[ \t]*[A-Z_]\w*(?:\s*:\s*\w+)?\s*=\s*[rbu]?['\"]", re.MULTILINE)
_CONST = re.compile(r"\bconst(?:expr)?\b")
_CAPITALS = re.compile(r"[A-Z][A-Z0-9_]*\Z")
_IN_MESSAGE = re.compile(r"^\s*w?string(?:<=\d+)?\s+(\w+)\s*=\s*(.*?)\s*$", re.MULTILINE)

Constant = tuple[str, str, str, str]
"""Kind (`headers`, `modules`, `messages`), where it is, its name and its value."""


def read_constants(
    tree: Tree, packages: Iterable[str], known: dict[object, list[tuple[str, str]]]
) -> Iterator[Constant]:  # fmt: skip
    """The constants that packages of a tree install. known: those of files, by their content, to add to."""
    paths = [entry.path for entry in tree.list_entries()]
    asked = set(packages)
    for manifest in paths:
        if posixpath.basename(manifest) != "package.xml":
            continue
        named = _PACKAGE.search(tree.read(manifest))
        if named is None or named[1].decode() not in asked:
            continue
        base = posixpath.dirname(manifest)
        start = f"{base}/" if base else ""
        inside = [path[len(start) :] for path in paths if path.startswith(start)]
        for inner in inside:
            place = _locate(inner, named[1].decode(), inside)
            if place is not None and find_folder_role(inner) is None:
                key = tree.find_content_id(start + inner)
                if key not in known:
                    known[key] = list(_read_file(tree.read(start + inner), place[0]))
                yield from ((*place, name, value) for name, value in known[key])


def _locate(inner: str, package: str, inside: list[str]) -> tuple[str, str] | None:
    """Kind and place of a file of a package, by its path in it: the header as it is included, the module, the message.
    None for what has no constants, or is not installed."""
    head, _, rest = inner.partition("/")
    if inner.endswith(_HEADERS):
        return ("headers", rest) if head == "include" and rest else None
    if inner.endswith(".msg") and head == "msg" and "/" not in rest:
        return "messages", f"{package}/{rest.removesuffix('.msg')}"
    if not inner.endswith(".py"):
        return None
    path = rest if head == "src" else inner
    top = inner[: len(inner) - len(path)] + path.partition("/")[0]
    if "/" not in path or f"{top}/__init__.py" not in inside:
        return None
    return "modules", path.removesuffix(".py").removesuffix("/__init__").replace("/", ".")


def _read_file(data: bytes, kind: str) -> Iterator[tuple[str, str]]:
    if kind == "messages":
        found = _IN_MESSAGE.findall(data.decode("utf-8", "replace"))
        yield from ((name, value.strip("\"'")) for name, value in found if _is_name(value.strip("\"'")))
        return
    if not (_IN_CPP if kind == "headers" else _IN_PYTHON).search(data):
        return
    facts = cpp.extract(data) if kind == "headers" else python.extract(data)
    between = "::" if kind == "headers" else "."
    for name, constant in _list_members(facts, between):
        value = constant.value
        if value is not None and value.kind == "text" and _is_name(value.text):
            yield name, value.text


def _list_members(facts: FlowFile, between: str) -> Iterator[tuple[str, DataMember]]:
    """What is constant: in C++ as it says, or as a macro; in Python by its name in capitals."""
    rows = [(constant.name, constant) for constant in facts.constants]
    rows += [(f"{cls.name}{between}{member.name}", member) for cls in facts.classes for member in cls.members]
    for name, member in rows:
        if facts.language == "cpp":
            said = not member.type or _CONST.search(member.type) is not None
        else:
            said = _CAPITALS.match(name.rpartition(".")[2]) is not None
        if said:
            yield name, member


def _is_name(text: str) -> bool:
    return len(text) <= _LONGEST and _NAME.match(text) is not None


def read_clones(clones: Clones, data: Snapshot) -> Iterator[Constant]:
    """The constants of all that a folder of clones has of the newest versions of released packages."""
    distros = [name for (name,) in data.fetch("SELECT name FROM distro")]
    jobs, _ = plan(clones, distros, (), "newest", data)
    known: dict[object, list[tuple[str, str]]] = {}
    for job in jobs:
        opened: dict[str, Clone] = {}
        for state in job.states:
            clone = opened.setdefault(state.clone, Clone(Path(state.place), state.clone))
            try:
                yield from read_constants(clone.read_tree(state.revision), state.packages, known)
            except (TreeError, OSError) as error:
                print(f"{state.clone} {state.version}: {error}", file=sys.stderr)


def build_table(read: Iterable[Constant]) -> ReleasedConstants:
    """The table of constants that have one value."""
    found: dict[str, dict[str, dict[str, set[str]]]] = {"headers": {}, "modules": {}, "messages": {}}
    for kind, place, name, value in read:
        found[kind].setdefault(place, defaultdict(set))[name].add(value)
    return ReleasedConstants(**{
        kind: {
            place: same
            for place, names in sorted(places.items())
            if (same := {name: next(iter(values)) for name, values in sorted(names.items()) if len(values) == 1})
        }
        for kind, places in found.items()
    })  # fmt: skip


def main(arguments: list[str]) -> None:
    """Writes the table."""
    table = build_table(read_clones(Clones(Path(os.path.abspath(arguments[0]))), load_snapshot()))
    write_table(DATA / "constants.json.zst", table)


if __name__ == "__main__":
    main(sys.argv[1:])
