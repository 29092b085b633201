"""Versions of libraries in conda-forge and in RoboStack's distros by day, from the history of their pins.

What is built there is built against the versions that `conda_build_config.yaml` pins on that day: conda-forge's own,
and those that RoboStack puts in their place for a distro. A pin that leaves last numbers open (`3.*`) means the newest
version that the recipe had by then, where the clone of the recipe is at hand. Of several values that a Linux build may
have, nothing is kept. RoboStack also holds whatever is installed beside its packages to versions: the constraints of a
distro's mutex package. What nothing is held to is built against what its recipe had by that day.

Which package of conda is which library is told by its name, or by the rosdep keys that RoboStack resolves to it: the
library of the Debian packages that these install elsewhere. Where no clone of a recipe is at hand, the versions that
the table had before stand for it. What a merge brought counts from the day on which its branch had it.

    python -P -m rosimpact.databuild.conda CLONES       # OWNER+NAME: conda-forge+conda-forge-pinning-feedstock,
                                                        # RoboStack+ros-DISTRO, conda-forge+NAME-feedstock
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from datetime import datetime, timezone
from functools import cache, partial
from pathlib import Path
from typing import Any

import yaml

from ..impact.targets.platform import normalize_library_name
from ..impact.targets.providers.libraries import load_libraries
from ..impact.targets.providers.library import DEBIAN_PACKAGES
from ..impact.targets.snapshot import load_snapshot
from ..impact.targets.tables import DATA
from ..impact.targets.unpacked import read_table
from ..impact.targets.version import is_at_least
from .git import BuildError, open_repository, read_file_versions, read_first_parents
from .providers import read_keys
from .sid import FILE, PACKAGES, write_channels
from .surface.releases import find_git_directory

PINNING = "conda-forge+conda-forge-pinning-feedstock"
CHANNEL = "conda-forge"
_ROBOSTACK = "RoboStack+ros-"
_RECIPE = re.compile(r"conda-forge\+(?P<name>.+)-feedstock\Z")
# The compiler is pinned under the name of a build variable, by its major version, which is what matters of it.
_VARIABLES = {"cxx_compiler_version": "gcc", "gxx_compiler_version": "gcc"}
_LINUX = frozenset(("linux", "unix", "linux64", "linux_64", "x86_64"))
# What else a package of conda has in its name.
_ENDING = re.compile(r"(?:-abi)?-(?:devel|dev|main)\Z")
_ITEM = re.compile(r"\s*-\s+(?P<value>'[^']*'|\"[^\"]*\"|[^#\n]*?)\s*(?:#\s*\[(?P<selector>.*)\]\s*)?\Z")
_KEY = re.compile(r"(?P<name>[A-Za-z][\w-]*):\s*(?P<value>[\w.*'\"]+)?\s*(?:#\s*\[(?P<selector>.*)\]\s*)?\Z")
_CONSTRAINTS = re.compile(r"(?P<space>\s*)run_constrain(?:ts|ed):\s*\Z")
_CONSTRAINT = re.compile(
    r"(?P<space>\s*)-\s+(?P<name>[\w.-]+)\s+=*(?P<version>\d[\d.]*)[.*]*\s*(?:#\s*\[(?P<selector>.*)\]\s*)?\Z"
)
_MUTEX = (
    "vinca.yaml",
    "additional_recipes/ros2-distro-mutex/recipe.yaml",
    "additional_recipes/ros-distro-mutex/recipe.yaml",
)
"""Files of RoboStack's repositories that may have the constraints of a distro's mutex package, the newest first."""
_OUTPUT = re.compile(r"^\s+(?:-\s+)?name:\s*[\"']?([\w.-]+)[\"']?\s*(?:#.*)?\Z", re.MULTILINE)
_VERSION = re.compile(r"\d+(?:\.\d+)*")
_SET = re.compile(r"(?:\{%-?\s*set\s+version\s*=\s*|^\s{2}version:\s*)[\"']?(\d+(?:[.-]\d+)+)[\"']?", re.MULTILINE)


def read_pins(text: str) -> dict[str, list[str]]:
    """What a conda_build_config.yaml pins for a build on Linux (x86_64), by name, as written: all values that such a
    build may have. Selectors that ask anything but the platform do not hold."""
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
    return values


def read_constraints(text: str) -> dict[str, str]:
    """What the recipe of a mutex package holds the packages beside it to, by name: versions, whose last numbers may be
    open. Ranges are left out."""
    found: dict[str, str] = {}
    depth = -1
    for line in text.splitlines():
        start = _CONSTRAINTS.match(line)
        if start is not None:
            depth = len(start["space"])
        elif depth >= 0 and line.strip():
            item = _CONSTRAINT.match(line)
            if item is not None and len(item["space"]) >= depth:
                if _holds(item["selector"]):
                    found.setdefault(item["name"], item["version"].strip("."))
            elif not line.lstrip().startswith(("-", "#")):
                depth = -1
    return found


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
    wanted = _fold(normalize_library_name(_ENDING.sub("", pin.replace("_", "-"))))
    return next((one for one in libraries if _fold(one) == wanted), "")


@cache
def _fold(name: str) -> str:
    plain = _ENDING.sub("", name.lower().replace("_", "-")).removeprefix("lib")
    return re.sub(r"[^\w+]", "", plain)


def read_resolutions(text: str) -> dict[str, tuple[str, ...]]:
    """The packages of conda that a robostack.yaml resolves each rosdep key to on Linux, the main one first."""
    found: dict[str, tuple[str, ...]] = {}
    for key, systems in yaml.safe_load(text).items():
        packages = systems.get("robostack") if isinstance(systems, dict) else None
        if isinstance(packages, dict):
            packages = [one for name in ("linux", "unix") for one in packages.get(name) or ()]
        found[key] = tuple(str(one).split()[0] for one in packages or ())
    return found


def name_libraries(resolutions: Mapping[str, tuple[str, ...]], libraries: Collection[str]) -> dict[str, str]:
    """Packages of conda with the libraries that they are, by the Debian packages of their rosdep keys: the main package
    of a key whose Debian packages are of one library. resolutions: as read_resolutions() gives them. libraries: those
    that a package's own name may tell."""
    keys = read_keys(load_snapshot())
    own = {package: name for name, packages in DEBIAN_PACKAGES.items() for package in packages}
    own |= {package: name for name, package in PACKAGES.items()}
    found: dict[str, str] = {}
    for key in sorted(resolutions, key=lambda key: (-keys.uses[key], key)):
        debian = keys.debian.get(key, ())
        named = {own.get(one) or load_libraries().find_by_package(one) for one in debian}
        for package in resolutions[key][:1]:
            # What a key brings along with the library has another name.
            words = _split_words(package)
            alike = {name for name in named if not words.isdisjoint(_split_words(name))}
            alike = alike & set(own.values()) or alike
            if len(alike) == 1 and not find_library(package, libraries):
                found.setdefault(package, *alike)
    return found


def _split_words(name: str) -> set[str]:
    plain = name.lower().removeprefix("lib")
    return {word.rstrip("0123456789") for word in re.split(r"[^a-z0-9]+", plain)} - {"", "c", "cpp"}


def read_history(clone: Path, path: str) -> Iterator[tuple[str, str]]:
    """The days on which a file of a clone changed, oldest first, with its text at their end. Raises BuildError."""
    repository = _open_clone(clone)
    line = read_first_parents(repository, repository[repository.head.target])
    versions = read_file_versions(repository, line, {"": [path]})[""]
    days = {_format_day(one.ts): one.blob for one in versions}
    for day, blob in days.items():
        if blob and blob in repository:
            yield day, repository[blob].data.decode("utf-8", "replace")


def _open_clone(clone: Path) -> Any:
    directory = find_git_directory(clone)
    if directory is None:
        raise BuildError(f"{clone} is no clone; fetch it first")
    return open_repository(directory)


def _format_day(ts: int) -> str:
    return datetime.fromtimestamp(ts, timezone.utc).date().isoformat()


def read_branches(clone: Path, paths: Collection[str]) -> Iterator[tuple[str, list[tuple[str, dict[str, str]]]]]:
    """What merges brought to a clone's main line: the day of each, and the days of the commits on its branch, the
    newest first, with the texts of these files. Raises BuildError."""
    import pygit2

    repository = _open_clone(clone)
    for oid, ts in read_first_parents(repository, repository[repository.head.target]).commits:
        parents = repository[oid].parent_ids
        if len(parents) < 2 or not all(parent in repository for parent in parents):
            continue
        walker = repository.walk(parents[1], pygit2.enums.SortMode.TOPOLOGICAL)
        walker.simplify_first_parent()
        walker.hide(parents[0])
        yield _format_day(ts), [(_format_day(one.commit_time), _read_texts(one.tree, paths)) for one in walker]


def _read_texts(tree: Any, paths: Collection[str]) -> dict[str, str]:
    found: dict[str, str] = {}
    for path in paths:
        if path in tree:
            found[path] = tree[path].data.decode("utf-8", "replace")
    return found


def read_releases(clone: Path) -> dict[str, str]:
    """The versions of a recipe by the day on which each came, oldest first."""
    found: dict[str, str] = {}
    for path in ("recipe/meta.yaml", "recipe/recipe.yaml"):
        for day, text in read_history(clone, path):
            reported = _SET.search(text)
            if reported is not None:
                found[day] = reported[1].replace("-", ".")
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


def build(
    clones: Path, before: Mapping[str, Mapping[str, Mapping[str, str]]] | None = None
) -> dict[str, dict[str, dict[str, str]]]:
    """The versions of libraries by day: by distro of RoboStack or `conda-forge`, then by library, the first day of
    each; an empty version: not known from then on. before: the table that there was. Raises BuildError where
    conda-forge's pins are not at hand."""
    platforms: dict[str, dict[str, Any]] = yaml.safe_load((DATA / "platform_versions.yaml").read_bytes())["platforms"]
    libraries = {name for row in platforms.values() for name in row}
    robostack = [clone for clone in sorted(clones.iterdir()) if clone.name.startswith(_ROBOSTACK)]
    resolved = [read_resolutions(text) for clone in robostack if (text := _read_newest(clone, "robostack.yaml"))]
    by_key = name_libraries({key: value for one in resolved for key, value in one.items()}, libraries)
    of_pin = cache(lambda pin: find_library(pin, libraries) or by_key.get(pin, ""))
    kept = (before or {}).get(CHANNEL, {})
    recipes: dict[str, dict[str, str]] = {}
    for clone in sorted(clones.iterdir()):
        recipe = _RECIPE.match(clone.name)
        library = _name_recipe(clone, recipe["name"], of_pin) if recipe and clone.name != PINNING else ""
        if library:
            recipes[library] = read_releases(clone)
    pinned = _read_channel(clones / PINNING, {"recipe/conda_build_config.yaml": read_pins}, of_pin, recipes)
    # Rows of what was never pinned are those of its recipe.
    releases = {name: rows for name, rows in kept.items() if name not in pinned} | recipes
    table: dict[str, dict[str, dict[str, str]]] = {CHANNEL: {name: dict(rows) for name, rows in kept.items()}}
    for name in pinned.keys() | recipes:
        table[CHANNEL][name] = _fill_unpinned(pinned.get(name, {}), recipes.get(name, {}))
    for clone in robostack:
        files = {"conda_build_config.yaml": read_pins} | dict.fromkeys(_MUTEX, _read_held)
        found = _read_channel(clone, files, of_pin, releases)
        _move_to_branches(found, read_branches(clone, files), partial(_find_held, files, of_pin, releases))
        table[clone.name.removeprefix(_ROBOSTACK)] = {n: _fill_unpinned(rows, {}) for n, rows in found.items()}
    return {
        channel: {name: rows for name, rows in sorted(found.items()) if any(rows.values())}
        for channel, found in table.items()
    }


def _read_newest(clone: Path, path: str) -> str:
    """A file at the head of a clone; empty where it is not there."""
    return next(reversed([text for _, text in read_history(clone, path)]), "")


def _name_recipe(clone: Path, name: str, of_pin: Callable[[str], str]) -> str:
    """The library that a recipe makes, by its name or that of its outputs; empty where none is known."""
    if found := of_pin(name):
        return found
    text = _read_newest(clone, "recipe/recipe.yaml") or _read_newest(clone, "recipe/meta.yaml")
    return next(filter(None, map(of_pin, _OUTPUT.findall(text))), "")


def _read_held(text: str) -> dict[str, list[str]]:
    return {name: [version] for name, version in read_constraints(text).items()}


def _read_channel(
    clone: Path,
    files: Mapping[str, Callable[[str], dict[str, list[str]]]],
    of_pin: Callable[[str], str],
    releases: Mapping[str, Mapping[str, str]],
) -> dict[str, dict[str, str | None]]:
    """What each library is held to, by day: None where it is to nothing, empty where that cannot be told. files: how
    each is read; what the first of them says of a library counts."""
    read = {path: dict(read_history(clone, path)) for path in files}
    found: dict[str, dict[str, str | None]] = {}
    now: dict[str, str] = {}
    for day in sorted({day for texts in read.values() for day in texts}):
        now |= {path: texts[day] for path, texts in read.items() if day in texts}
        held = _find_held(files, of_pin, releases, day, now)
        for library in {*held, *found}:
            rows = found.setdefault(library, {})
            if held.get(library) != next(reversed(rows.values()), None):
                rows[day] = held.get(library)
    return found


def _find_held(
    files: Mapping[str, Callable[[str], dict[str, list[str]]]],
    of_pin: Callable[[str], str],
    releases: Mapping[str, Mapping[str, str]],
    day: str,
    texts: Mapping[str, str],
) -> dict[str, str]:
    """What libraries are held to by the texts of these files on a day, as _read_channel() has it."""
    held: dict[str, str] = {}
    for path in files:
        for pin, values in files[path](texts.get(path, "")).items():
            library = of_pin(pin)
            if library and len(set(values)) > 1:
                held.setdefault(library, "")
            elif library:
                version = values[0] if pin in _VARIABLES else resolve_version(values[0], day, releases.get(library, {}))
                if version:
                    held.setdefault(library, version)
    return held


def _move_to_branches(
    found: dict[str, dict[str, str | None]],
    branches: Iterable[tuple[str, list[tuple[str, dict[str, str]]]]],
    of_texts: Callable[[str, Mapping[str, str]], Mapping[str, str]],
) -> None:
    """Dates what a merge changed by the day from which its branch had it to its end: it was built with that then."""
    for merged, commits in branches:
        changed = {name: rows[merged] for name, rows in found.items() if rows.get(merged)}
        first: dict[str, str] = {}
        for day, texts in commits:
            held = of_texts(merged, texts) if changed else {}
            changed = {name: version for name, version in changed.items() if held.get(name) == version}
            first.update(dict.fromkeys(changed, day))
        for name, day in first.items():
            before = max((one for one in found[name] if one < merged), default="")
            if before < day < merged:
                found[name] = dict(sorted({**found[name], day: found[name].pop(merged)}.items()))


def _fill_unpinned(rows: Mapping[str, str | None], releases: Mapping[str, str]) -> dict[str, str]:
    """The versions by day of what is held to versions on some days, and has those of its recipe on the others."""
    found: dict[str, str] = {}
    held: str | None = None
    newest = ""
    for day in sorted({*rows, *releases}):
        held, newest = rows.get(day, held), releases.get(day, newest)
        version = newest if held is None else held
        if version != next(reversed(found.values()), ""):
            found[day] = version
    return found


def main(arguments: list[str] | None = None) -> None:
    (folder,) = sys.argv[1:] if arguments is None else arguments
    file = DATA / FILE
    before = read_table(file, dict[str, dict[str, dict[str, str]]]) if file.exists() else {}
    table = before | build(Path(folder), before)  # what sid.py adds, and distros that are not at hand, stay
    write_channels(file, table)
    print(f"{len(table)} channels, {sum(map(len, table.values()))} libraries")


if __name__ == "__main__":
    main()
