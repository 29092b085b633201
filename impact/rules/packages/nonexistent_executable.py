"""nonexistent-executable: a launch file starts a program that a package of the workspace does not install.

What it does
    Compares the nodes that launch files and scripts start from packages of the workspace with the programs that these
    packages install into lib/<package>: entry points, targets, scripts and components.

Why it breaks
    `ros2 launch` and `ros2 run` stop with "executable not found".

Severity
    error for nodes that are always started; warning under a condition; note in examples.

Example
    Node(package='sled_driver', executable='sled_drvier')

Use instead
    Node(package='sled_driver', executable='sled_driver')

Not reported
    Targets without an install rule (missing-install reports them); packages whose CMake or setup code cannot be read
    completely; tests, which often contain launch files left over from ROS 1; packages of ROS 1.
"""

import difflib
import posixpath
from collections.abc import Iterator
from fnmatch import fnmatchcase

from ...model.python.programs import list_programs
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, list_place_doubts, rule


@rule(
    texts={
        "": Text("`{upstream}` has no executable `{subject}`", "[[did you mean `{alike}`?]]"),
        "folder": Text(
            "`{subject}` is installed into `{folder}`, but ROS 2 looks for executables in `lib/{upstream}`",
            "install it into lib/{upstream}",
        ),
    },
)
def nonexistent_executable(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    if view.target.ros == 1:
        return
    for use in package.linked.references:
        reference = use.reference
        owner = view.workspace.packages.get(reference.package)
        if use.role == "test" or reference.kind != "executable" or "$" in reference.name or not reference.name:
            continue
        name, programs = reference.name, list_programs(owner) if owner is not None else None
        if owner is None or programs is None:
            continue
        folders = {folder for known, folder in programs.items() if fnmatchcase(name, known) for folder in folder}
        own = f"lib/{owner.name}"
        if own in folders or "" in folders or any("$" in folder for folder in folders):
            continue
        doubts = (*list_place_doubts(view, use.role), not reference.conditional or Doubt.CONDITIONAL)
        startable = (one for one, places in programs.items() if not places.isdisjoint((own, "")))
        plain = [one for one in startable if "*" not in one] if not folders else []
        close = difflib.get_close_matches(posixpath.basename(name), plain, 1)
        data = {"upstream": owner.name, "alike": close[0] if close else "", "folder": min(folders, default="")}
        yield Diagnostic(use.at, name, package.name, data, "folder" if folders else "", doubts)
