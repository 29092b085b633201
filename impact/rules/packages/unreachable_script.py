"""unreachable-script: programs of an ament_python package are installed where `ros2 run` does not find them.

What it does
    Compares the folders that setup.cfg gives to colcon (`install_scripts` under [install], for `colcon build`, and
    `script_dir` under [develop], for `colcon build --symlink-install`) with lib/<package>, for packages whose setup.py
    or setup.cfg has entry points under console_scripts. Without these options, programs are installed into bin.

Why it breaks
    `ros2 run` and nodes of launch files look for a program in lib/<package> alone: "No executable found".

Severity
    error where a launch file or script of the workspace starts such a program of the package in any case; warning
    otherwise, and where only one of the two ways to build is concerned.

Example
    [develop]
    script_dir=$base/lib/sled_driver        # copied from there, in setup.cfg of the package sled_tools
    [install]
    install_scripts=$base/lib/sled_driver

Use instead
    [develop]
    script_dir=$base/lib/sled_tools
    [install]
    install_scripts=$base/lib/sled_tools

Not reported
    Command-line tools, which belong in bin: programs of packages that name no folder, as long as their module does not
    import rclpy and no launch file or script of the workspace starts them as a node; packages whose setup.cfg says
    `$base/bin`; programs that data_files put into lib/<package> too; folders with another variable than `$base`;
    packages of ROS 1 and those that CMake builds.
"""

import posixpath
from collections.abc import Iterator
from fnmatch import fnmatchcase
from typing import NamedTuple

from ...facts.setup import SetupFile
from ...model.cmake.build import At
from ...model.view import View
from ...model.workspace import Package
from ..fix_actions import Replace
from ..rule import Diagnostic, rule
from ..severity import Doubt
from ..text import Text

# The commands of setuptools that colcon runs: what they call the folder of programs, and for which build.
_OPTIONS = {"install": "install_scripts", "develop": "script_dir"}
_BUILDS = {"install": "colcon build", "develop": "colcon build --symlink-install"}


class _Folder(NamedTuple):
    """Where a command installs programs, as written, and where that is written."""

    text: str
    at: At


@rule(
    scope="target",
    severity="error",
    preview=True,
    texts={
        "": Text(
            "`{build}` installs {programs:} into `{folder}`, but `ros2 run` and launch files look in `lib/{package}`",
            help="write {lines:} in {file}",
        ),
        "outside": Text(
            "`{build}` installs {programs:} outside of the install space: `{folder}` does not begin with `$base/`",
            help="write {lines:} in {file}",
        ),
    },
)
def unreachable_script(view: View) -> Iterator[Diagnostic]:
    if view.target.ros == 1:
        return
    for package in view:
        if package.build_type != "ament_python":
            continue
        files = {path: file for path, file in package.digest.setup if posixpath.dirname(path) == package.path}
        code = posixpath.join(package.path, "setup.py")
        if code not in files or any(file.problems for file in files.values()):
            continue
        if any(clause.startswith(("options", "arguments")) for clause in files[code].unresolved):
            continue
        folders = {
            command: _Folder(text, At(path, line))
            # Of several files, setuptools reads setup.py first and pyproject.toml last.
            for path, file in sorted(files.items(), reverse=True)
            for command, text, line in file.script_folders
        }
        if any(folder.text == "$base/bin" for folder in folders.values()):
            continue
        wrong = [command for command in _OPTIONS if _is_wrong(package, folders.get(command))]
        if wrong:
            yield from _lost(view, package, files, folders, wrong)


def _is_wrong(package: Package, folder: _Folder | None) -> bool:
    """True when a folder is surely not lib/<package>. Without a folder, it is bin."""
    if folder is None:
        return True
    base, _, rest = posixpath.normpath(folder.text.replace("${base}", "$base")).partition("/")
    if "$" in rest or (base.startswith("$") and base != "$base"):
        return False
    return base != "$base" or rest != f"lib/{package.name}"


def _lost(
    view: View, package: Package, files: dict[str, SetupFile], folders: dict[str, _Folder], wrong: list[str]
) -> Iterator[Diagnostic]:
    settings = posixpath.join(package.path, "setup.cfg")
    started = _started(view, package)
    programs: dict[str, At] = {}
    for path in sorted(files):
        if posixpath.basename(path) not in ("setup.py", "setup.cfg"):
            continue
        for name, module, line in files[path].entry_points:
            if any(_is_data(package, file, name) for file in files.values()):
                continue
            if folders or name in started or _is_node(package, files[path], module):
                programs.setdefault(name, At(path, line))
    if not programs:
        return
    first = folders.get(wrong[0])
    if first is not None:
        at = first.at
    elif settings in files:
        at = At(settings, 1)
    else:
        at = next(iter(programs.values()))
    folder = "$base/bin" if first is None else first.text.replace("${base}", "$base")
    right = f"$base/lib/{package.name}"
    lines: list[str] = []
    for command in reversed(wrong):
        if command not in folders:
            lines.append(f"[{command}]")
        lines.append(f"{_OPTIONS[command]}={right}")
    doubts = []
    if not any(started.get(name) for name in programs):
        doubts.append(Doubt.LATE)
    if len(wrong) == 1:
        doubts.append(Doubt.CONDITIONAL)
    yield Diagnostic(
        at,
        _OPTIONS[wrong[0]],
        package.name,
        data={
            "build": _BUILDS[wrong[0]],
            "programs": tuple(sorted(programs)),
            "folder": folder.removeprefix("$base/"),
            "lines": tuple(lines),
            "file": settings,
        },
        kind="" if folder.startswith("$base/") else "outside",
        doubts=tuple(doubts),
        fix=_fix(folders, wrong, right, settings),
    )


def _started(view: View, package: Package) -> dict[str, bool]:
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


def _fix(folders: dict[str, _Folder], wrong: list[str], right: str, settings: str) -> tuple[Replace, ...]:
    """The right folder instead of each wrong one, where setup.cfg names all of them."""
    if any(command not in folders or folders[command].at.path != settings for command in wrong):
        return ()
    return tuple(Replace(settings, folders[c].at.line, 0, folders[c].text, right) for c in wrong)
