"""mixed-distros: a Dockerfile or CI job installs or sources a distro that its image cannot have.

What it does
    For each stage of a Dockerfile and each CI job, compares the distro of its image and of ROS_DISTRO with the Debian
    packages `ros-<distro>-*` and the folders /opt/ros/<distro> that it names. Also reports Debian packages that their
    distro has not released.

Why it breaks
    "E: Unable to locate package", or "No such file or directory", when the image is built.

Severity
    warning, since the workspace may be built elsewhere too.

Example
    FROM ros:jazzy
    RUN apt-get update && apt-get install -y ros-humble-nav2-bringup

Use instead
    FROM ros:jazzy
    RUN apt-get update && apt-get install -y ros-jazzy-nav2-bringup

Not reported
    Stages and jobs with a variable, a matrix or a condition for the image or distro; distros of the same platform,
    whose packages can be installed side by side; packages that no distro has ever released, which may come from another
    archive.
"""

from collections.abc import Iterator
from functools import cache

from ...facts.distros import ContainerPart, DistroUse
from ...targets.distro.distro import DistroTarget
from ...targets.distro.known import list_known_distros
from ...targets.resolve import parse_image
from ..vocabulary import At, Diagnostic, Text, Workspace, rule


@rule(
    scope="workspace",
    severity="warning",
    preview=True,
    texts={
        "": Text("`{subject}` does not exist in an image of {distro}", help="write `{instead}`"),
        "never": Text("`{subject}` does not exist: {name} is not released in {distro}[[, but in {last}]]"),
    },
)
def mixed_distros(workspace: Workspace) -> Iterator[Diagnostic]:
    names = {known.name for known in list_known_distros()}
    for path, file in workspace.outside.containers.items():
        reported: set[str] = set()
        for part in file.parts:
            own = _find_distro(part)
            for use in part.uses:
                if use.distro in names and use.text not in reported:
                    for diagnostic in _check_use(path, use, own):
                        reported.add(use.text)
                        yield diagnostic


def _find_distro(part: ContainerPart) -> str:
    """The one distro that a part runs with; empty where that is not known."""
    if part.open:
        return ""
    images = (parse_image(image, list_known_distros()) for image in part.images)
    found = {image[0] for image in images if image is not None}
    names = {known.name for known in list_known_distros()}
    distros = {distro for distro in part.distros if distro in names}
    both = found | distros
    return next(iter(both)) if len(both) == 1 and (found or not part.images) else ""


def _check_use(path: str, use: DistroUse, own: str) -> Iterator[Diagnostic]:
    at = At(path, use.line, use.column)
    if own and use.distro != own and _make_target(use.distro).platform != _make_target(own).platform:
        data = {"distro": own, "instead": use.text.replace(use.distro, own, 1)}
        yield Diagnostic(at, use.text, data=data)
    elif use.text.startswith("ros-") and use.distro != "rolling":
        name = use.text.removeprefix(f"ros-{use.distro}-")
        target = _make_target(use.distro)
        underscored = name.replace("-", "_")
        last = target.find_last_distro(underscored)
        if last and name not in _list_debian_names(use.distro):
            yield Diagnostic(at, use.text, data={"distro": use.distro, "name": underscored, "last": last}, kind="never")


@cache
def _make_target(distro: str) -> DistroTarget:
    return DistroTarget(distro)


@cache
def _list_debian_names(distro: str) -> frozenset[str]:
    return frozenset(name.replace("_", "-") for name in _make_target(distro).list_released())
