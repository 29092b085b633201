"""The programs that an ament_python package installs, and the folders that it gives to setuptools for them."""

from __future__ import annotations

import posixpath
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING, NamedTuple

from ..cmake.build import At

if TYPE_CHECKING:
    from ...facts.setup import SetupFile
    from ..view import TargetView
    from ..workspace import Package


class ScriptFolder(NamedTuple):
    """Where a command of setuptools installs programs, as written, and where that is written."""

    text: str
    at: At


class ScriptSetup:
    """The setup files of a package as far as they install programs."""

    def __init__(self, package: Package):
        self._package = package
        self._files = {
            path: file for path, file in package.digest.setup if posixpath.dirname(path) == package.path
        }
        self.settings = posixpath.join(package.path, "setup.cfg")
        """The path of setup.cfg, which may be missing."""

    @property
    def is_known(self) -> bool:
        """Whether there is a setup.py, and the files tell all about programs."""
        code = self._files.get(posixpath.join(self._package.path, "setup.py"))
        if code is None or any(file.problems for file in self._files.values()):
            return False
        return not any(clause.startswith(("options", "arguments")) for clause in code.unresolved)

    @property
    def has_settings(self) -> bool:
        """Whether there is a setup.cfg."""
        return self.settings in self._files

    @property
    def folders(self) -> dict[str, ScriptFolder]:
        """Folders by the command that installs into them: `install` or `develop`."""
        return {
            command: ScriptFolder(text, At(path, line))
            # Of several files, setuptools reads setup.py first and pyproject.toml last.
            for path, file in sorted(self._files.items(), reverse=True)
            for command, text, line in file.script_folders
        }

    def find_programs(self, view: TargetView) -> dict[str, At]:
        """Programs that `ros2 run` and launch files are to find, by their names: all entry points where a folder is
        given, else those that something starts as a node or whose module is one. Those that data_files put into
        lib/<package> are left out."""
        folders, started = self.folders, list_started_programs(view, self._package)
        programs: dict[str, At] = {}
        for path, file in sorted(self._files.items()):
            if posixpath.basename(path) not in ("setup.py", "setup.cfg"):
                continue
            for name, module, line, _ in file.entry_points:
                if any(_is_data(self._package, other, name) for other in self._files.values()):
                    continue
                if folders or name in started or _is_node(self._package, file, module):
                    programs.setdefault(name, At(path, line))
        return programs


def list_started_programs(view: TargetView, package: Package) -> dict[str, bool]:
    """Programs of the package that the workspace starts with `ros2 run` or as nodes, and whether in any case."""
    found: dict[str, bool] = {}
    for other in view.everyone():
        for use in other.digest.references:
            reference = use.reference
            if reference.kind == "executable" and reference.package == package.name:
                sure = use.role == "run" and not reference.conditional
                found[reference.name] = found.get(reference.name, False) or sure
    return found


def _is_node(package: Package, setup: SetupFile, module: str) -> bool:
    """True when the module of an entry point imports rclpy."""
    stem = module.replace(".", "/")
    places = {posixpath.join(package.path, root, f"{stem}{end}") for root in ("", "src", setup.package_dirs.get("", ""))
              for end in (".py", "/__init__.py")}  # fmt: skip
    return any(use.at.path in places and use.module.partition(".")[0] == "rclpy" for use in package.digest.imports)


def _is_data(package: Package, setup: SetupFile, name: str) -> bool:
    """True when data_files put a file of the program's name into lib/<package>."""
    return any(
        posixpath.normpath(destination) == f"lib/{package.name}" and fnmatchcase(name, posixpath.basename(pattern))
        for destination, pattern, _ in setup.data_files
    )
