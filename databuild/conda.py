"""Versions of libraries in conda-forge and in RoboStack's distros by day, from the history of their pins.

What is built there is built against the versions that `conda_build_config.yaml` pins on that day: conda-forge's own,
and those that RoboStack puts in their place for a distro. A pin that leaves last numbers open (`3.*`) means the newest
version that the recipe had by then, where the clone of the recipe is at hand. Of several values that a Linux build may
have, nothing is kept.

    python -P -m rosimpact.databuild.conda CLONES       # OWNER+NAME: conda-forge+conda-forge-pinning-feedstock,
                                                        # RoboStack+ros-DISTRO, conda-forge+NAME-feedstock
"""

from __future__ import annotations

import ast
import json
import re
import sys
from collections.abc import Collection, Iterator, Mapping
from datetime import datetime, timezone
from functools import cache
from pathlib import Path
from typing import Any

import yaml
import zstandard

from ..edges.files import write_file
from ..impact.targets.distro.conda import SID
from ..impact.targets.platform import normalize_library_name
from ..impact.targets.tables import DATA
from ..impact.targets.unpacked import read_table
from ..impact.targets.version import is_at_least
from .git import BuildError, open_repository, read_file_versions, read_first_parents
from .surface.releases import find_git_directory

PINNING = "conda-forge+conda-forge-pinning-feedstock"
CHANNEL = "conda-forge"
_ROBOSTACK = "RoboStack+ros-"
_RECIPE = re.compile(r"conda-forge\+(?P<name>.+)-feedstock\Z")
# The compiler is pinned under the name of a build variable, by its major version, which is what matters of it.
_VARIABLES = {"cxx_compiler_version": "gcc", "gxx_compiler_version": "gcc"}
_LINUX = frozenset(("linux", "unix", "linux64", "linux_64", "x86_64"))
_ITEM = re.compile(r"\s*-\s+(?P<value>'[^']*'|\"[^\"]*\"|[^#\n]*?)\s*(?:#\s*\[(?P<selector>.*)\]\s*)?\Z")
_KEY = re.compile(r"(?P<name>[A-Za-z][\w-]*):\s*(?P<value>[\w.*'\"]+)?\s*(?:#\s*\[(?P<selector>.*)\]\s*)?\Z")
_VERSION = re.compile(r"\d+(?:\.\d+)*")
_SET = re.compile(r"(?:\{%-?\s*set\s+version\s*=\s*|^\s{2}version:\s*)[\"']?(\d+(?:\.\d+)+)[\"']?", re.MULTILINE)


def read_pins(text: str) -> dict[str, str]:
    """What a conda_build_config.yaml pins for a build on Linux (x86_64), by name, as written; names with several
    values that such a build may have are left out. Selectors that ask anything but the platform do not hold."""
    values: dict[str, list[str]] = {}
    name = ""
    for line in text.splitlines():
        key = _KEY.match(line)
        if key is not None:
            name = key["name"] if _holds(key["selector"]) else ""
            if name and key["value"]:
                values.setdefault(name, []).append(key["value"].strip("'\""))
            continue
        item = _ITEM.match(line)
        if item is not None and name and item["value"] and _holds(item["selector"]):
            values.setdefault(name, []).append(item["value"].strip("'\""))
        elif item is None and line.strip() and not line.lstrip().startswith("#") and not line[0].isspace():
            name = ""
    return {name: found[0] for name, found in values.items() if len(set(found)) == 1}


@cache
def _holds(selector: str | None) -> bool:
    """Whether a selector (`linux and not aarch64`) holds for Linux on x86_64."""
    if selector is None:
        return True
    try:
        return _evaluate(ast.parse(selector.strip(), mode="eval").body)
    except (SyntaxError, ValueError):
        return False


def _evaluate(node: ast.expr) -> bool:
    if isinstance(node, ast.Name):
        return node.id in _LINUX
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.Not):
        return not _evaluate(node.operand)
    if isinstance(node, ast.BoolOp):
        return (all if isinstance(node.op, ast.And) else any)(_evaluate(one) for one in node.values)
    if isinstance(node, (ast.Compare, ast.Call)):
        return False  # of the environment or a compiler
    raise ValueError(ast.dump(node))


def find_library(pin: str, libraries: Collection[str]) -> str:
    """The library, of those named, that a pin is of; empty where its name tells none."""
    if pin in _VARIABLES:
        return _VARIABLES[pin]
    wanted = _fold(normalize_library_name(pin.replace("_", "-")))
    return next((one for one in libraries if _fold(one) == wanted), "")


@cache
def _fold(name: str) -> str:
    plain = name.lower().replace("_", "-")
    return re.sub(r"\W", "", re.sub(r"-(?:devel|dev|main)\Z", "", plain).removeprefix("lib"))


def read_history(clone: Path, path: str) -> Iterator[tuple[str, str]]:
    """The days on which a file of a clone changed, oldest first, with its text at their end. Raises BuildError."""
    directory = find_git_directory(clone)
    if directory is None:
        raise BuildError(f"{clone} is no clone; fetch it first")
    repository = open_repository(directory)
    line = read_first_parents(repository, repository[repository.head.target])
    versions = read_file_versions(repository, line, {"": [path]})[""]
    days = {datetime.fromtimestamp(one.ts, timezone.utc).date().isoformat(): one.blob for one in versions}
    for day, blob in days.items():
        if blob and blob in repository:
            yield day, repository[blob].data.decode("utf-8", "replace")


def read_releases(clone: Path) -> dict[str, str]:
    """The versions of a recipe by the day on which each came, oldest first."""
    found: dict[str, str] = {}
    for path in ("recipe/meta.yaml", "recipe/recipe.yaml"):
        for day, text in read_history(clone, path):
            reported = _SET.search(text)
            if reported is not None:
                found[day] = reported[1]
    rows: dict[str, str] = {}
    for day, version in sorted(found.items()):
        if version != next(reversed(rows.values()), ""):
            rows[day] = version
    return rows


def resolve_version(pin: str, day: str, releases: Mapping[str, str]) -> str:
    """The version that a pin means on a day: the newest of the recipe that begins so, else the pin itself where it has
    more than one number, or stands for a year; empty where that cannot be known. releases: versions by day."""
    plain = _VERSION.match(pin)
    if plain is None:
        return ""
    version = plain.group()
    fitting = [one for since, one in releases.items() if since <= day and f"{one}.".startswith(f"{version}.")]
    newest = ""
    for one in fitting:
        newest = one if not newest or is_at_least(one, newest) else newest
    return newest or (version if "." in version or len(version) > 3 else "")


def build(clones: Path) -> dict[str, dict[str, dict[str, str]]]:
    """The versions of libraries by day: by distro of RoboStack or `conda-forge`, then by library, the first day of
    each; an empty version: not pinned from then on. Raises BuildError where conda-forge's pins are not at hand."""
    platforms: dict[str, dict[str, Any]] = yaml.safe_load((DATA / "platform_versions.yaml").read_bytes())["platforms"]
    libraries = {name for row in platforms.values() for name in row}
    of_pin = cache(lambda pin: find_library(pin, libraries))
    sources = {CHANNEL: (clones / PINNING, "recipe/conda_build_config.yaml")}
    releases: dict[str, dict[str, str]] = {}
    for clone in sorted(clones.iterdir()):
        recipe = _RECIPE.match(clone.name)
        if clone.name.startswith(_ROBOSTACK):
            sources[clone.name.removeprefix(_ROBOSTACK)] = clone, "conda_build_config.yaml"
        elif recipe is not None and clone.name != PINNING and of_pin(recipe["name"]):
            releases[of_pin(recipe["name"])] = read_releases(clone)
    table: dict[str, dict[str, dict[str, str]]] = {}
    for channel, (clone, path) in sources.items():
        found: dict[str, dict[str, str]] = {}
        for day, text in read_history(clone, path):
            now: dict[str, str] = {}
            for pin, value in read_pins(text).items():
                library = of_pin(pin)
                version = resolve_version(value, day, releases.get(library, {})) if library else ""
                version = value if pin in _VARIABLES else version
                if version:
                    now.setdefault(library, version)
            for library in {*now, *found}:
                rows = found.setdefault(library, {})
                if now.get(library, "") != next(reversed(rows.values()), ""):
                    rows[day] = now.get(library, "")
        if channel == CHANNEL:
            # What no build is held to is as its recipe has it.
            found |= {name: rows for name, rows in releases.items() if rows and not any(found.get(name, {}).values())}
        table[channel] = {name: rows for name, rows in sorted(found.items()) if any(rows.values())}
    return table


def write_channels(file: Path, channels: dict[str, dict[str, dict[str, str]]]) -> None:
    """The table, a library a line."""
    lines = (
        f"{json.dumps(channel)}: {{\n"
        + ",\n".join(f"  {json.dumps(name)}: {json.dumps(rows)}" for name, rows in libraries.items())
        + "\n}"
        for channel, libraries in channels.items()
    )
    text = "{\n" + ",\n".join(lines) + "\n}\n"
    write_file(file, zstandard.ZstdCompressor(level=19).compress(text.encode()))


def main(arguments: list[str] | None = None) -> None:
    (folder,) = sys.argv[1:] if arguments is None else arguments
    table, file = build(Path(folder)), DATA / "conda.json.zst"
    if file.exists():  # what sid.py adds stays
        before = read_table(file, dict[str, dict[str, dict[str, str]]])
        table.update({channel: rows for channel, rows in before.items() if channel == SID})
    write_channels(file, table)
    print(f"{len(table)} channels, {sum(map(len, table.values()))} libraries")


if __name__ == "__main__":
    main()
