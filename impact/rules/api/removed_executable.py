"""removed-executable: a program, launch file or launch argument of another package is not there on a target.

What it does
    Reports nodes that launch files and scripts start, launch files that they include, and arguments that they give to
    those, which the target's version of the package does not install or declare, but an earlier or later version does;
    misspelt names; and nodes of packages that the target does not have and package.xml does not declare.

Why it breaks
    `ros2 launch` stops with "executable not found" or "file not found" when the file is started; an argument that is
    not declared has no effect in ROS 2, and stops roslaunch.

Severity
    error for what is always started or included in ROS 2; warning under a condition, for arguments, for tests, where
    something about the target's version is guessed, and in ROS 1, whose releases contain many launch files that are no
    longer used; note in examples, and for launch files of ROS 1 in a package of ROS 2.

Example
    Node(package='controller_manager', executable='spawner.py')     # gone in controller_manager 2.0

Use instead
    Node(package='controller_manager', executable='spawner')

Not reported
    What the workspace itself provides; arguments that any launch file of the target's version declares, since they are
    passed on; files in folders named after another distro.
"""

import posixpath
from collections.abc import Iterator

from ...model.package import ReferenceUse
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Upcoming, list_place_doubts, rule
from .diagnosis import (
    GONE_PACKAGE,
    UPSTREAM,
    build_availability_texts,
    diagnose,
    find_gone_package,
    find_missing,
    is_of_another_distro,
    make_version_together,
)  # fmt: skip


@rule(
    texts={
        **build_availability_texts(),
        "package": GONE_PACKAGE,
        "argument": Text(f"`{{file}}` of {UPSTREAM} no longer has an argument `{{name}}`"),
        "argument early": Text(f"`{{file}}` of {UPSTREAM} has no argument `{{name}}`[[ (added in {{since}})]]"),
    },
)
def removed_executable(view: TargetView, package: Package):
    files = frozenset(package.linked.files)
    for use in package.linked.references:
        reference = use.reference
        if is_of_another_distro(view, use.at.path, files) or (view.target.ros == 2 and use.at.path.endswith(".test")):
            continue
        if reference.package and reference.package != package.name and "$" not in reference.name:
            if reference.kind == "executable":
                yield from find_gone_package(view, package, use, reference.package, reference.name)
                yield from _report(view, package.name, use, "executable", reference.name)
            elif reference.kind in ("file", "sought"):
                path = _launch_file(view, reference.package, reference.name)
                yield from _report(view, package.name, use, "launch file", path)
                yield from _check_arguments(view, package.name, use, path)


def _report(view: TargetView, package: str, use: ReferenceUse, side: str, name: str) -> Iterator[Diagnostic | Upcoming]:
    found = find_missing(view, side, name, (use.reference.package,))
    if found is not None:
        sure = view.target.ros == 2 and not use.reference.conditional and use.role != "test"
        compiled = view.target.ros == 1 or not name.endswith((".launch", ".launch.xml"))
        doubts = (*list_place_doubts(view, use.role), sure or Doubt.LATE, compiled or Doubt.UNCOMPILED)
        yield diagnose(found, use.at, name, package, doubts)


def _launch_file(view: TargetView, package: str, name: str) -> str:
    """The launch file that is meant; on a command line it is told without its folder."""
    offer = view.offers.find_package(package) if "/" not in name else None
    if offer is None or any(posixpath.basename(launch.path) == name for launch in offer.build.launches):
        return name
    return next((one.name for one in offer.list_offered("launch file") if posixpath.basename(one.name) == name), name)


def _check_arguments(view: TargetView, package: str, use: ReferenceUse, path: str) -> Iterator[Diagnostic]:
    """Arguments given to an included launch file that no launch file of the target's version declares."""
    reference = use.reference
    for name in reference.arguments or ():
        found = find_missing(view, "launch argument", f"{path} {name}", (reference.package,))
        offer = view.offers.find_package(reference.package) if found is not None else None
        if found is None or offer is None or found.state == "upcoming":
            continue
        if any(name == known for launch in offer.build.launches for known, _ in launch.arguments):
            continue
        data = {"file": path, "name": name, "upstream": found.package, "version": found.version, "since": found.since}
        kind = "argument" if found.state == "removed" else "argument early"
        doubts = (*list_place_doubts(view, use.role), Doubt.LATE)
        yield Diagnostic(
            use.at, f"{path} {name}", package, data, kind, doubts,
            evidence=found.evidence, together=make_version_together(found.package),
        )  # fmt: skip
