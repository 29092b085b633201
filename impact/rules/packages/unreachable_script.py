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

from ...model.python.programs import ScriptFolder, ScriptSetup, list_started_programs
from ..vocabulary import At, Diagnostic, Doubt, Package, Replace, TargetView, Text, rule

# The commands of setuptools that colcon runs: what they call the folder of programs, and for which build.
_OPTIONS = {"install": "install_scripts", "develop": "script_dir"}
_BUILDS = {"install": "colcon build", "develop": "colcon build --symlink-install"}


@rule(
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
def unreachable_script(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    if view.target.ros == 1:
        return
    setup = ScriptSetup(package)
    if package.build_type != "ament_python" or not setup.is_known:
        return
    folders = setup.folders
    if any(folder.text == "$base/bin" for folder in folders.values()):
        return
    wrong = [command for command in _OPTIONS if _is_wrong(package, folders.get(command))]
    programs = setup.find_programs(view) if wrong else {}
    if programs:
        yield _diagnose(view, package, setup, programs, wrong)


def _is_wrong(package: Package, folder: ScriptFolder | None) -> bool:
    """True when a folder is surely not lib/<package>. Without a folder, it is bin."""
    if folder is None:
        return True
    base, _, rest = posixpath.normpath(folder.text.replace("${base}", "$base")).partition("/")
    if "$" in rest or (base.startswith("$") and base != "$base"):
        return False
    return base != "$base" or rest != f"lib/{package.name}"


def _diagnose(
    view: TargetView, package: Package, setup: ScriptSetup, programs: dict[str, At], wrong: list[str]
) -> Diagnostic:
    """wrong: the commands that install into a wrong folder."""
    folders = setup.folders
    first = folders.get(wrong[0])
    if first is not None:
        at = first.at
    elif setup.has_settings:
        at = At(setup.settings, 1)
    else:
        at = next(iter(programs.values()))
    folder = "$base/bin" if first is None else first.text.replace("${base}", "$base")
    right = f"$base/lib/{package.name}"
    lines: list[str] = []
    for command in reversed(wrong):
        if command not in folders:
            lines.append(f"[{command}]")
        lines.append(f"{_OPTIONS[command]}={right}")
    started = list_started_programs(view, package)
    doubts = (
        any(started.get(name) for name in programs) or Doubt.LATE,
        len(wrong) > 1 or Doubt.CONDITIONAL,
    )
    data = {
        "build": _BUILDS[wrong[0]],
        "programs": tuple(sorted(programs)),
        "folder": folder.removeprefix("$base/"),
        "lines": tuple(lines),
        "file": setup.settings,
    }
    kind = "" if folder.startswith("$base/") else "outside"
    fix = _replace_folders(folders, wrong, right, setup.settings)
    return Diagnostic(at, _OPTIONS[wrong[0]], package.name, data, kind, doubts, fix=fix)


def _replace_folders(
    folders: dict[str, ScriptFolder], wrong: list[str], right: str, settings: str
) -> tuple[Replace, ...]:
    """The right folder instead of each wrong one, where setup.cfg names all of them."""
    if any(command not in folders or folders[command].at.path != settings for command in wrong):
        return ()
    return tuple(Replace(settings, folders[c].at.line, 0, folders[c].text, right) for c in wrong)
