"""Builds data/find_modules.json: the headers and programs that CMake's own find modules look for.

    python -P -m rosimpact.databuild.find_modules FOLDER... --output DATA

FOLDER is the folder of modules of a CMake (`/usr/share/cmake-3.25/Modules`); several versions may be given, oldest
first, and what any of them looks for counts. A module succeeds when all that it requires is found, so whoever brings
the headers and programs makes it succeed; data/providers.sqlite.zst says who that is. Branches for other systems are
left out, and a variable stands for all that
the module ever sets it to.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator, Mapping
from pathlib import Path

import msgspec

from ..edges.files import write_file
from ..impact.facts.cmake import Command, extract
from ..impact.targets.tables import DATA

_KINDS = {"find_path": "header", "find_program": "program"}
_OPTION = re.compile(
    r"(?:NAMES|HINTS|PATHS|PATH_SUFFIXES|DOC|ENV|VALIDATOR|REQUIRED|NAMES_PER_DIR|NO_(?:[A-Z]+_)*(?:PATH|CACHE))\Z"
)
_OTHER_SYSTEM = re.compile(r"\b(?:(?:CMAKE_HOST_)?(?:WIN32|APPLE)|CYGWIN|MSVC\w*|MINGW|BEOS|HAIKU|ANDROID)\b")
_NAME = re.compile(r"[\w./+-]+\Z")


def find_requirements(data: bytes) -> dict[str, list[str]]:
    """What one module requires first. Returns its kind (`header`, `program`) with the names any of which will do; empty
    where that is a library, or hangs on the project. Further requirements often belong to components."""
    found: dict[str, tuple[str, list[str]]] = {}
    required: set[str] = set()
    lists: dict[str, list[str]] = {}
    for command in _select_linux_commands(list(extract(data).commands)):
        words = [word for argument in command.arguments for word in _expand_word(argument.text, lists)]
        if command.name == "set" and words:
            lists.setdefault(words[0], []).extend(words[1:])
        elif command.name == "list" and words[:1] == ["APPEND"]:
            lists.setdefault(words[1], []).extend(words[2:])
        kind = _KINDS.get(command.name)
        if kind and words:
            found.setdefault(words[0], (kind, []))[1].extend(n for n in _list_names(words[1:]) if _NAME.match(n))
        elif command.name == "find_package_handle_standard_args":
            required.update(words[1:])
    for variable, (kind, names) in found.items():
        if variable in required and names:
            return {kind: list(dict.fromkeys(names))}
    return {}


def _expand_word(text: str, lists: Mapping[str, list[str]]) -> list[str]:
    """A word, or where it is a reference to a variable all that it is ever set to."""
    return lists.get(text[2:-1], [text]) if text.startswith("${") and text.endswith("}") else [text]


def _list_names(words: list[str]) -> Iterator[str]:
    """The names of a find_path() or find_program() call, after its variable; in the short form the first word is one
    and the others are folders."""
    if words and not _OPTION.match(words[0]):
        yield words[0]
    taking = False
    for word in words:
        if _OPTION.match(word):
            taking = word == "NAMES"
        elif taking:
            yield word


def _select_linux_commands(commands: list[Command]) -> Iterator[Command]:
    """Commands outside of branches that only another system takes."""
    skipped: list[bool] = []
    for command in commands:
        name = command.name
        text = " ".join(argument.text for argument in command.arguments)
        other = _OTHER_SYSTEM.search(text) is not None and "NOT" not in text
        if name == "if":
            skipped.append(other)
        elif name == "elseif" and skipped:
            skipped[-1] = other
        elif name == "else" and skipped:
            skipped[-1] = False
        elif name == "endif" and skipped:
            skipped.pop()
        elif not any(skipped):
            yield command


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--output", type=Path, default=DATA)
    given = parser.parse_args(arguments)
    modules: dict[str, dict[str, list[str]]] = {}
    for folder in given.folders:
        for path in sorted(folder.glob("Find*.cmake")):
            made = find_requirements(path.read_bytes())
            if made:
                modules[path.stem.removeprefix("Find")] = made
    written = msgspec.json.format(msgspec.json.encode(modules, order="sorted"), indent=1) + b"\n"
    write_file(given.output / "find_modules.json", written)
    print(len(modules), "modules")


if __name__ == "__main__":
    main()
