"""hard-coded-distro: code names the folder or the Debian packages of a distro other than the target's.

What it does
    Reports paths below /opt/ros/<distro> in scripts, CMake code, launch files, Python and C++ of packages, and in
    scripts of the workspace, where the distro is not the target's. In shell scripts it also reports Debian packages
    `ros-<distro>-*`.

Why it breaks
    The folder does not exist on a machine that has only the target's distro, and the archive of its platform may not
    have the packages. On a machine with both, the code mixes two distros.

Severity
    warning; note in examples and documentation.

Example
    source /opt/ros/foxy/setup.bash

Use instead
    source /opt/ros/$ROS_DISTRO/setup.bash

Not reported
    Comments and messages; paths under a condition; files that read ROS_DISTRO or also name the target's distro; files
    and folders named after a distro; distros of the other ROS generation, which a bridge needs; tests; folders such as
    third_party; what a build has written into the source folder; scripts beside a Dockerfile, which run in its image.
"""

import posixpath
import re
from collections.abc import Iterator

from ...facts.distros import DistroFile
from ...model.package import find_folder_role
from ...targets.changes import DISTROS
from ...targets.distro.known import list_known_distros
from ...tree.paths import is_vendored
from ..vocabulary import At, Diagnostic, Doubt, TargetView, Text, list_place_doubts, rule


@rule(
    scope="target",
    severity="warning",
    preview=True,
    texts=Text(
        "`{subject}` is hard-coded, but the target is {distro}",
        help="use the environment variable ROS_DISTRO",
    ),
)
def hard_coded_distro(view: TargetView) -> Iterator[Diagnostic]:
    for package in view:
        for path, file in package.linked.distros:
            role = find_folder_role(package.strip_path(path)) or "run"
            yield from _list_uses(view, path, file, package.name, role)
    for path, file in view.workspace.outside.distro_scripts.items():
        yield from _list_uses(view, path, file, "", find_folder_role(path) or "run")


# Folders that CMake and catkin write into when a package is built in its own folder.
_BUILD_FOLDERS = frozenset(("CMakeFiles", "catkin_generated"))


def _list_uses(view: TargetView, path: str, file: DistroFile, package: str, role: str) -> Iterator[Diagnostic]:
    """The first use of each distro in a file."""
    own = view.target.distro
    others = {known.name for known in list_known_distros() if known.ros == view.target.ros and known.name != own}
    if own not in DISTROS or own in file.words.split() or is_vendored(path) or role == "test":
        return
    # What lies beside a Dockerfile is copied into its image, whose distro is not the target's.
    if any(posixpath.dirname(other) == posixpath.dirname(path) for other in view.workspace.outside.containers):
        return
    if any(word in DISTROS for word in re.split(r"[^a-z]+", path.lower())):
        return
    if not _BUILD_FOLDERS.isdisjoint(path.split("/")):
        return
    reported: set[str] = set()
    for use in file.uses:
        if use.distro in others and not use.tested and use.distro not in reported:
            reported.add(use.distro)
            doubts = (*list_place_doubts(view, role), Doubt.LATE)
            yield Diagnostic(At(path, use.line, use.column), use.text, package, {"distro": own}, doubts=doubts)
