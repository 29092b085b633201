"""Builds data/commands.json.zst: the CMake functions and macros that packages give to those who find them.

    python -P -m rosimpact.databuild.commands FOLDER... --output DATA

FOLDER holds packages, as sources or as they are installed (`/opt/ros/jazzy/share`, the files of Debian's `catkin`).
What the shipped surfaces have of other packages is added. A name counts whatever version has it; those that begin with
an underscore are a package's own, and those without any (`assert`) may be anybody's.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Iterator
from pathlib import Path

from ..impact.facts.cmake import extract
from ..impact.facts.manifest import extract as read_manifest
from ..impact.model.cmake.names import COMMANDS
from ..impact.targets.surface.store import load_shipped
from ..impact.targets.tables import DATA
from .table_file import write_table

_NAME = re.compile(r"[a-z][a-z0-9]*_\w+\Z")
_SCRIPT = re.compile(r"\.cmake(\.in|\.em)?\Z")
_ASIDE = frozenset({"test", "tests", "doc", "examples", "templates"})


def find_commands(folder: Path) -> Iterator[tuple[int, str, str]]:
    """The ROS generation, command and package of each function and macro that the packages of a folder define."""
    manifests = {path.parent: path for path in sorted(folder.rglob("package.xml"))}
    for root, path in manifests.items():
        manifest = read_manifest(path.read_bytes())
        generation = 2 if "ament" in " ".join(kind for kind, _ in manifest.build_types) else 1
        for script in sorted(root.rglob("*")):
            top = script.relative_to(root).parts[0]
            if not _SCRIPT.search(script.name) or not script.is_file() or top in _ASIDE:
                continue
            if any(parent in manifests for parent in script.parents if parent != root and root in parent.parents):
                continue
            for command in extract(script.read_bytes()).commands:
                if command.name in ("function", "macro") and command.arguments:
                    name = command.arguments[0].text.lower()
                    if _NAME.match(name):
                        yield generation, name, manifest.name


def find_stored() -> Iterator[tuple[int, str, str]]:
    """The same of the shipped surfaces."""
    surfaces = load_shipped()
    for package in sorted(surfaces.packages):
        for generation in surfaces.list_ros(package):
            history = surfaces.find_history(package, generation)
            for version in history.versions if history is not None else ():
                build = history.build(version) if history is not None else None
                for name in build.commands if build is not None else ():
                    if _NAME.match(name):
                        yield generation, name, package


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", type=Path)
    parser.add_argument("--output", type=Path, default=DATA)
    given = parser.parse_args(arguments)
    owners: dict[str, dict[str, set[str]]] = {"1": {}, "2": {}}
    for generation, name, package in [*find_stored(), *(row for f in given.folders for row in find_commands(f))]:
        if name not in COMMANDS:
            owners[str(generation)].setdefault(name, set()).add(package)
    made = {ros: {name: " ".join(sorted(found)) for name, found in rows.items()} for ros, rows in owners.items()}
    write_table(given.output / "commands.json.zst", made, order="sorted")
    print(*(f"ROS {ros}: {len(rows)} commands" for ros, rows in made.items()), sep=", ")


if __name__ == "__main__":
    main()
