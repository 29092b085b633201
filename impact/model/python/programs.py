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
        self._files = {path: file for path, file in package.linked.setup if posixpath.dirname(path) == package.path}
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

    def list_all(self) -> dict[str, set[str]] | None:
        """As list_programs(). Where entry points are installed is not asked, see unreachable-script."""
        found: dict[str, set[str]] = {}
        for file in self._files.values():
            if file.unresolved:
                return None
            for name, *_ in file.entry_points:
                found.setdefault(name, set()).add("")
            for name in file.scripts:
                found.setdefault(posixpath.basename(name), set()).add("")
            for destination, pattern, _ in file.data_files:
                if posixpath.normpath(destination).startswith("lib/"):
                    found.setdefault(posixpath.basename(pattern), set()).add(posixpath.normpath(destination))
        return found

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
    for other in view.list_built():
        for use in other.linked.references:
            reference = use.reference
            if reference.kind == "executable" and reference.package == package.name:
                sure = use.role == "run" and not reference.conditional
                found[reference.name] = found.get(reference.name, False) or sure
    return found


def list_programs(package: Package) -> dict[str, set[str]] | None:
    """Names of all programs that a package may install, or patterns of them, with the folders of the prefix; an empty
    folder stands for one that nothing tells, or for a target that no rule installs. None where not all is known."""
    if package.build_type == "ament_python":
        setup = ScriptSetup(package)
        return setup.list_all() if setup.is_known else None
    return _list_of_cmake(package) if package.build_type.startswith("ament_cmake") else None


# Targets that tell what they make, and names that only CMake itself would tell.
_MADE_ELSEWHERE = frozenset(("external", "fetched", "unknown"))
# What commands that make no program are called.
_HARMLESS = ("ament_", "rosidl_", "rclcpp_", "pluginlib_", "generate_parameter_", "find_package_", "nav2_package")


def has_unknown_commands(package: Package) -> bool:
    """True where CMake code calls commands that may build or install anything."""
    uses = (use for use in package.build.uses if use.kind == "command")
    return bool(package.build.unresolved) or any(not use.name.lower().startswith(_HARMLESS) for use in uses)


def _list_of_cmake(package: Package) -> dict[str, set[str]] | None:
    build = package.build
    if not build.files or has_unknown_commands(package) or any(t.kind in _MADE_ELSEWHERE for t in build.targets):
        return None
    found: dict[str, set[str]] = {}
    outputs = {target.name: target.output_name or target.name for target in build.targets}
    placed: set[str] = set()
    libraries = {target.name for target in build.targets if target.kind in ("library", "module")}
    for install in build.installs:
        if install.kind in ("python", "export"):
            if install.kind == "python" and package.linked.setup:
                return None
            continue
        for item in install.items:
            if "$" in item or "$" in install.rename:
                return None
            if install.kind == "directory":
                inside = item.rstrip("/") + "/"
                for path in package.linked.files:
                    if path.startswith(inside):
                        rest = path[len(inside) :] if item.endswith("/") else path[len(posixpath.dirname(item)) + 1 :]
                        folder = posixpath.dirname(posixpath.join(install.destination, rest))
                        found.setdefault(posixpath.basename(path), set()).add(posixpath.normpath(folder))
                continue
            placed.add(item)
            if item in libraries:
                continue
            name = install.rename or outputs.get(item, posixpath.basename(item))
            found.setdefault(name, set()).add(posixpath.normpath(install.destination) if install.destination else "")
    for target in build.targets:
        if "$" in target.name or "$" in outputs[target.name]:
            return None
        if target.name not in placed and target.name not in libraries:
            found.setdefault(outputs[target.name], set()).add("")
    for export in build.exports:
        if export.how == "component" and export.executable:
            found.setdefault(export.executable, set()).add("")
    return found


def _is_node(package: Package, setup: SetupFile, module: str) -> bool:
    """True when the module of an entry point imports rclpy."""
    stem = module.replace(".", "/")
    places = {posixpath.join(package.path, root, f"{stem}{end}") for root in ("", "src", setup.package_dirs.get("", ""))
              for end in (".py", "/__init__.py")}  # fmt: skip
    return any(use.at.path in places and use.module.partition(".")[0] == "rclpy" for use in package.linked.imports)


def _is_data(package: Package, setup: SetupFile, name: str) -> bool:
    """True when data_files put a file of the program's name into lib/<package>."""
    return any(
        posixpath.normpath(destination) == f"lib/{package.name}" and fnmatchcase(name, posixpath.basename(pattern))
        for destination, pattern, _ in setup.data_files
    )
