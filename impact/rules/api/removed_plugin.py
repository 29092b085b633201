"""removed-plugin: a plugin or component is asked for by a name that the target's version of its package does not have.

What it does
    Reports names of plugins and components in parameter files, launch files and robot descriptions that an earlier or
    later version of the package declares, and the target's does not.

Why it breaks
    pluginlib finds no class of that name, so the node that asks for it does not start.

Severity
    error for components and nodelets that a launch file loads in every run; warning for what parameter files and robot
    descriptions name, since which of them is used is not known, under a condition, for tests, and where something about
    the target's version is guessed; note in examples.

Example
    plugin: "nav2_behaviors/Spin"               # Humble and Iron

Use instead
    plugin: "nav2_behaviors::Spin"              # Jazzy and later

Not reported
    What the workspace itself provides; packages that the target does not have at all; files in folders that are called
    after another distro.
"""

import re
from collections.abc import Iterator

from ...model.package import ReferenceUse
from ...model.view import TargetView
from ...model.workspace import Package
from ..rule import Diagnostic, Doubt, Upcoming, doubts_of_place, rate_upcoming, rule
from .diagnosis import availability_texts, diagnose, find_missing, is_of_another_distro


@rule(scope="target", texts=availability_texts())
def removed_plugin(view: TargetView):
    own = {plugin.name or plugin.type for package in view.workspace for _, plugin in package.digest.plugins}
    for package in view:
        yield from rate_upcoming(_of_package(view, package, own))


def _of_package(view: TargetView, package: Package, own: set[str]) -> Iterator[Diagnostic | Upcoming]:
    files = frozenset(package.digest.files)
    for use in package.digest.references:
        name = use.reference.name
        # The type of a transmission is a word for whoever reads the description; nothing loads it as it stands.
        if use.reference.kind != "plugin" or name in own or name.startswith(("$", "transmission_interface/")):
            continue
        found = find_missing(view, "plugin", name, _packages(view, package, use))
        if found is None or is_of_another_distro(view, use.at.path, files):
            continue
        loaded = bool(use.reference.package) and not use.reference.conditional
        other = _respelt(view, found.package, name)
        doubts = (*doubts_of_place(view, use.role), loaded or Doubt.LATE, use.role != "test" or Doubt.TEST)
        found = found._replace(replacement=other, moved_to="") if other else found
        yield diagnose(found, use.at, name, package.name, doubts)


def _packages(view: TargetView, package: Package, use: ReferenceUse) -> list[str]:
    """Packages that may have a plugin: the one that is named, the one it is called after, else any that comes along."""
    head = re.split(r"/|::", use.reference.name)[0]
    named = [name for name in (use.reference.package, head) if name and view.is_package(name)]
    return named or sorted(view.closure(package))


def _respelt(view: TargetView, package: str, name: str) -> str:
    """The same class as the target's version calls it."""
    offer = view.offers.package(package)
    known = {plugin.name for plugin in offer.build.plugins} if offer is not None else set()
    return next((one for one in (name.replace("/", "::"), name.replace("::", "/")) if one != name and one in known), "")
