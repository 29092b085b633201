"""removed-plugin: a plugin or component is asked for by a name that the target's version of its package does not have.

What it does
    Reports names of plugins and components in parameter files, launch files and robot descriptions that an earlier or
    later version of the package declares and the target's does not; names from packages that the target does not have
    and package.xml does not declare; libraries that Gazebo loads and that only the other ROS has; misspelt names; and
    names that a package of the workspace does not declare.

Why it breaks
    pluginlib finds no class of that name, so the node that asks for it does not start.

Severity
    error for components and nodelets that a launch file loads in every run, and for plugins in robot descriptions
    (`<ros2_control>`) that a launch file reads in every run and gives to what loads them; warning for what parameter
    files and other robot descriptions name, since which of them is used is not known, under a condition, for tests, for
    names that no version has, and where something about the target's version is guessed; note in examples.

Example
    plugin: "nav2_behaviors/Spin"               # Humble and Iron

Use instead
    plugin: "nav2_behaviors::Spin"              # Jazzy and later

Not reported
    What the workspace itself provides; names without the name of a package that no version is known to declare;
    files in folders named after another distro.
"""

import difflib
import re

from ....edges.memory import cache_in_derived
from ...model.package import ReferenceUse
from ...model.python.programs import has_unknown_commands
from ...model.read_plugins import find_read_plugins
from ...model.settings import get_plugin_package
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, list_place_doubts, rule
from .diagnosis import (
    GONE_PACKAGE,
    build_availability_texts,
    diagnose,
    find_gone_package,
    find_missing,
    is_of_another_distro,
)  # fmt: skip


@rule(
    texts={
        **build_availability_texts(),
        "package": GONE_PACKAGE,
        "library": Text("`{subject}` is not available in {upstream} {version}, only in ROS {other}"),
        "generation": Text("`{subject}` belongs to {upstream}, which is only released for ROS {other}"),
        "own": Text("`{subject}` is not declared by {upstream}", help="[[did you mean `{alike}`?]]"),
    },
)
def removed_plugin(view: TargetView, package: Package):
    declared = _list_declared(view)
    own = set().union(*declared.values())
    files = frozenset(package.linked.files)
    for use in package.linked.references:
        name = use.reference.name
        # The type of a transmission is a word for whoever reads the description; nothing loads it as it stands.
        if use.reference.kind != "plugin" or name in own or name.startswith(("$", "transmission_interface/")):
            continue
        if is_of_another_distro(view, use.at.path, files):
            continue
        head = use.reference.package or get_plugin_package(name)
        loaded = bool(use.reference.package) and not use.reference.conditional
        known = declared.get(head, set())
        if known:
            owner = view.workspace.packages[head]
            if not any("$" in one for one in known) and not has_unknown_commands(owner):
                close = difflib.get_close_matches(name, sorted(known), 1)
                data = {"upstream": head, "alike": close[0] if close else ""}
                doubts = (*list_place_doubts(view, use.role), loaded or Doubt.LATE, use.role != "test" or Doubt.TEST)
                yield Diagnostic(use.at, name, package.name, data, "own", doubts)
            continue
        if library := _LIBRARY.fullmatch(name):
            owner = "" if use.reference.conditional else _find_lost_owner(view, library[1])
            if owner:
                yield from find_gone_package(view, package, use, owner, name)
            elif not use.reference.conditional and (owner := _find_other_generation(view, library[1])):
                version = view.target.find_version(owner) or ""
                data = {"upstream": owner, "version": version, "other": 3 - view.target.ros}
                kind = "library" if version else "generation"
                doubts = (*list_place_doubts(view, use.role), Doubt.LATE)
                # Which simulator the descriptions are for is one question, and settled for all of them at once.
                same = (Together(f"{name} is of the other generation", everywhere=True),)
                yield Diagnostic(use.at, name, package.name, data, kind, doubts, together=same)
            continue
        found = find_missing(view, "plugin", name, _list_candidates(view, package, use))
        if found is not None and view.may_have(found.package):
            continue  # in another version, which was not read
        loaded = loaded or _is_read(view, use, head if found is None else found.package)
        if found is None:
            yield from find_gone_package(view, package, use, head, name, loaded or Doubt.LATE)
            continue
        other = _find_respelling(view, found.package, name)
        doubts = (*list_place_doubts(view, use.role), loaded or Doubt.LATE, use.role != "test" or Doubt.TEST)
        found = found._replace(replacement=other, moved_to="") if other else found
        if found.form == "never" and not found.alike and found.package not in view.build_environment(package):
            doubts = (*doubts, Doubt.PRIVATE)
        yield diagnose(found, use.at, name, package.name, doubts)


def _is_read(view: TargetView, use: ReferenceUse, owner: str) -> bool:
    """Whether a launch file has a description read in every run that names a plugin of a package, and starts what loads
    plugins of its base class: that brings pluginlib, and the package of the class."""
    started = find_read_plugins(view).get((use.at.path, use.at.line, use.at.column))
    history = view.offers.find_history(owner) if started else None
    plugins = history.list_all_plugins() if history is not None else ()
    bases = {plugin.base.partition("::")[0] for plugin in plugins if use.reference.name in (plugin.name, plugin.type)}
    loaders = [view.list_installed_with(one) for one in started or ()]
    return any("pluginlib" in loader and not bases.isdisjoint(loader) for loader in loaders)


# A file that Gazebo or Ignition loads.
_LIBRARY = re.compile(r"(?:lib)?([\w-]+)\.so")


def _find_lost_owner(view: TargetView, library: str) -> str:
    """A package that installed a library, where none that the target or the workspace has does; else empty."""
    if library in _list_made_libraries(view):
        return ""
    owners = view.offers.list_library_owners(library)
    return owners[0] if owners and not any(map(view.is_available, owners)) else ""


def _find_other_generation(view: TargetView, library: str) -> str:
    """A package that installs a library in the other ROS generation, and here none of the name, or that this one never
    had; else empty."""
    if library in _list_made_libraries(view) or view.offers.list_library_owners(library):
        return ""
    for owner in view.offers.list_library_owners(library, 3 - view.target.ros):
        offer = view.offers.find_package(owner)
        if view.target.ros == 2 and view.target.is_other_generation(owner) and not view.may_have(owner):
            return owner
        if offer is None or not offer.exact or not offer.build.libraries:
            continue
        if library not in offer.line.events.get("library", {}) and not any(
            part in ("libraries", "targets") for part, _ in offer.build.unknown
        ):
            return owner
    return ""


@cache_in_derived
def _list_made_libraries(view: TargetView) -> frozenset[str]:
    """The names of the libraries that the workspace builds."""
    return frozenset(
        target.output_name or target.name for package in view.workspace for target in package.build.targets
    )


@cache_in_derived
def _list_declared(view: TargetView) -> dict[str, set[str]]:
    """Names of the plugins and components of each package of the workspace."""
    found: dict[str, set[str]] = {}
    for package in view.workspace:
        names = {name for _, plugin in package.linked.plugins for name in (plugin.name, plugin.type) if name}
        components = (export.item for export in package.build.exports if export.how == "component")
        found[package.name] = names.union(components, package.linked.registered)
    return found


def _list_candidates(view: TargetView, package: Package, use: ReferenceUse) -> list[str]:
    """Packages that may have a plugin: the one that is named, the one it is called after, else any that comes along."""
    heads = (use.reference.package, get_plugin_package(use.reference.name))
    named = [name for name in heads if name and view.is_package(name) and view.is_available(name)]
    return named or sorted(name for name in view.build_environment(package) if name not in view.workspace.packages)


def _find_respelling(view: TargetView, package: str, name: str) -> str:
    """The same class as the target's version calls it."""
    offer = view.offers.find_package(package)
    known = {plugin.name for plugin in offer.build.plugins} if offer is not None else set()
    return next((one for one in (name.replace("/", "::"), name.replace("::", "/")) if one != name and one in known), "")
