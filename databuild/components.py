"""Builds data/components.json.zst: which components CMake packages have that list them themselves.

    python -P -m rosimpact.databuild.components WORK --suite bookworm=APT_CONF ... --clones CLONES --output DATA

Of VTK the configuration in Debian's development package says which there are, suite by suite. Of the libraries of
Gazebo (Ignition until 2022) the tags of their repositories tell, major version by major version, which is a part of the
package's name: what some release of it adds with `gz_add_component` counts. WORK keeps what was downloaded until it is
read. What no suite and no clone is given of stays as it is. Names only.
"""

from __future__ import annotations

import argparse
import os
import re
import subprocess
import sys
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from functools import lru_cache
from pathlib import Path

from ..impact.facts.cmake import Command, extract
from ..impact.targets.providers.components import FILE, ComponentTable
from ..impact.targets.tables import DATA
from ..impact.targets.unpacked import read_table
from ..impact.tree import Tree, TreeError
from .libraries import extract_upstream_version
from .surface.clones import Clone, VersionError
from .surface.unpacked_deb import DebError, read_members
from .table_file import write_table

_PACKAGES = {"VTK": "libvtk9-dev"}
"""CMake packages that list their components, and who installs them."""
_LISTED = re.compile(rb'_AVAILABLE_COMPONENTS"?\s+"([^"]*)"')
_RELEASE = re.compile(r"(?:ignition|gz)-(?P<library>[a-z-]+)(?P<major>\d+)_\d+\.\d+\.\d+\Z")
_OLD_RELEASE = re.compile(r"ignition-(?P<library>[a-z-]+)_(?P<major>\d+)\.\d+\.\d+\Z")
_ADDING = ("gz_add_component", "ign_add_component")
_ASIDE = re.compile(r"(?:^|/)(?:tests?|examples?|tutorials?|docs?|third_party)/")
_VARIABLE = re.compile(r"\$\{(\w+)\}")
_STARTS = ("gz", "ignition")


def read_listed(members: Mapping[str, bytes]) -> frozenset[str]:
    """The components that a configuration lists. members: files of a package."""
    texts = (data for path, data in sorted(members.items()) if path.lower().endswith("-config.cmake"))
    return frozenset(name for text in texts for found in _LISTED.findall(text) for name in found.decode().split(";"))


def download(package: str, configuration: Path, work: Path) -> Path | None:
    """A package of a suite; None where it has none."""
    work.mkdir(parents=True, exist_ok=True)
    subprocess.run(
        ["apt-get", "-qq", "download", package], cwd=work, check=False, capture_output=True,
        env={**os.environ, "APT_CONFIG": str(configuration)},
    )  # fmt: skip
    return next(work.glob(f"{package}_*.deb"), None)


def read_suites(suites: Mapping[str, Path], work: Path) -> dict[str, dict[str, tuple[str, str]]]:
    """CMake package to suite to the version there and its components."""
    found: dict[str, dict[str, tuple[str, str]]] = defaultdict(dict)
    for suite, configuration in suites.items():
        for package, debian in _PACKAGES.items():
            file = download(debian, configuration, work / suite)
            if file is None:
                continue
            try:
                names = read_listed({path: one.data for path, one in read_members(file).items()})
            except (DebError, OSError) as error:
                print(file.name, error, file=sys.stderr, flush=True)
                continue
            version = extract_upstream_version(file.name.split("_")[1].replace("%3a", ":"))
            if names:
                found[package][f"debian {suite}"] = version, " ".join(sorted(names))
            print(suite, package, version, len(names), flush=True)
            file.unlink()
    return dict(found)


def list_added(files: Iterable[Iterable[Command]]) -> frozenset[str] | None:
    """The components that CMake files add; None where the name of one cannot be told. files: their commands."""
    found: set[str] = set()
    inside: list[tuple[str, str, str]] = []  # function, its parameter, and a name with it
    calls: dict[str, list[str]] = defaultdict(list)
    for commands in files:
        values: dict[str, str] = {}
        function = parameter = ""
        for command in commands:
            words = [argument.text for argument in command.arguments]
            name = command.name.lower()
            if name in ("function", "macro") and len(words) > 1:
                function, parameter = words[0].lower(), words[1]
            elif name in ("endfunction", "endmacro"):
                function = parameter = ""
            elif name == "set" and len(words) == 2:
                values[words[0]] = words[1]
            elif name in _ADDING and words:
                text = _expand(words[0], values)
                open_names = set(_VARIABLE.findall(text))
                if open_names == {parameter}:
                    inside.append((function, parameter, text))
                elif "$" in text:
                    return None
                else:
                    found.add(text)
            elif words and "$" not in words[0]:
                calls[name].append(words[0])
    for function, parameter, text in inside:
        found.update(text.replace(f"${{{parameter}}}", one) for one in calls[function])
    return frozenset(found)


def _expand(text: str, values: Mapping[str, str]) -> str:
    """A text with the values of variables, as far as they are known."""
    return _VARIABLE.sub(lambda found: values.get(found[1], found[0]), text)


def _read_files(tree: Tree) -> Iterator[Iterable[Command]]:
    for entry in tree.list_entries():
        if entry.path.rpartition("/")[2] == "CMakeLists.txt" and not _ASIDE.search(entry.path):
            yield _read_commands(tree.read(entry.path))


@lru_cache(maxsize=4096)
def _read_commands(data: bytes) -> tuple[Command, ...]:
    """The commands of a file, which most releases have as it is."""
    return extract(data).commands if b"_add_" in data else ()


def read_gazebo(clones: Iterable[Path]) -> dict[str, str]:
    """CMake packages of Gazebo's libraries, by both their names, to their components; without those of which some
    release has one whose name cannot be told. clones: their clones."""
    added: dict[str, set[str] | None] = {}
    for folder in clones:
        try:
            clone = Clone(folder)
            for tag, ref in sorted(clone.tags.items()):
                release = _RELEASE.match(tag) or _OLD_RELEASE.match(tag)
                key = f"{release['library']}{release['major']}" if release else ""
                if not release or added.get(key, set()) is None:
                    continue
                names = list_added(_read_files(clone.read_tree(ref)))
                before = added.setdefault(key, set())
                added[key] = None if names is None or before is None else before | names
            print(folder.name, flush=True)
        except (VersionError, TreeError, OSError) as error:
            print(f"{folder.name}: {error}", file=sys.stderr, flush=True)
    told = {key: " ".join(sorted(names)) for key, names in sorted(added.items()) if names}
    return {f"{start}-{key}": names for key, names in told.items() for start in _STARTS}


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("work", type=Path)
    parser.add_argument("--suite", action="append", default=[], help='"bookworm=APT_CONF"')
    parser.add_argument("--clones", type=Path, help="with gazebosim+gz-common and its sisters")
    parser.add_argument("--output", type=Path, default=DATA)
    given = parser.parse_args(arguments)
    file = given.output / FILE
    before = read_table(file, ComponentTable) if file.exists() else ComponentTable()
    suites = {name: Path(path) for name, _, path in (text.partition("=") for text in given.suite)}
    of_suites = {**before.by_platform, **read_suites(suites, given.work)}
    clones = sorted(given.clones.glob("gazebosim+*")) if given.clones is not None else []
    always = {**before.always, **read_gazebo(clones)}
    size = write_table(file, ComponentTable(of_suites, always))
    print(len(of_suites) + len(always), "packages,", size, "bytes")


if __name__ == "__main__":
    main()
