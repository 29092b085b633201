"""What several rules ask: how strong a need is, by what name one declares it, which watched uses a target refuses."""

from __future__ import annotations

from collections.abc import Iterator

from ..model.package import NameUse
from ..model.view import Need, View, weight
from ..model.workspace import Package
from ..targets.library import default_standard, standard_year
from ..targets.target import Change
from ..targets.uses import function_of, standards_of
from ..targets.version import at_least
from .rule import Hit

__all__ = ["circular", "name_to_declare", "present", "weight"]


def present(view: View, name: str) -> bool:
    """True when a dependency of this name can be had on the target: in the workspace, released, or a rosdep key."""
    return view.available(name)


def circular(view: View, package: Package, name: str) -> bool:
    """True when what would be declared comes with the package itself, or is of the workspace and needs it."""
    other = view.workspace.packages.get(name)
    if other is None:
        return package.name in view.spread([name])
    return package.name in view.closure(other) or any(
        provider.name == package.name for need in view.needs(other) for provider in need.providers[:1]
    )


def name_to_declare(view: View, need: Need) -> str | None:
    """The name a person would put into the manifest for a need: the first provider that can be had on the target."""
    other = "python3-" if view.target.python_major == 2 else "python-"
    for provider in sorted(need.providers, key=lambda p: p.name.startswith(other)):
        if provider.name and present(view, provider.name):
            return provider.name
    return None


# What every C++ file is compiled with, whatever its package declares.
_COMPILER = frozenset({"gcc", "glibc", "linux-headers"})


def for_tests(made) -> bool:
    """True for what CMake finds or makes only where tests are built."""
    return any("TESTING" in c.text for c in made.conditions)


def uses_refused(view: View, kind: str) -> Iterator[Hit]:
    """Hits for watched uses of a kind (`call-changed`, `field-changed`) that a target takes no longer, or not yet, or
    that only the newest distro's libraries take no longer."""
    # What the workspace itself brings is as it brings it, whatever a release did.
    refused = {c.old: c for c in view.changes(kind) if c.package not in view.workspace.packages}
    coming = {label: c for label, c in view.later.items() if c.kind == kind and c.package not in _COMPILER}
    if not refused and not coming:
        return
    # A method that the workspace declares may be meant wherever its name is called.
    own = {function for package in view.workspace for function in package.digest.functions}
    for package in view:
        warned: set[str] = set()
        for use in package.digest.uses:
            if function_of(use.text) in own:
                continue
            change = refused.get(use.text)
            later = None if change is not None else coming.get(use.text)
            change = change or later
            if (
                change is None
                or not view.active(use.conditions)
                or not (change.package in _COMPILER or view.concerned(package, change, use.at.path))
                or (later is not None and not view.later_active(use.conditions))
            ):
                continue
            where = _under_standard(view, package, use, change)
            if where is None:
                continue
            shown = use.shown or use.text
            certain = use.language == "cpp" and view.certain(use.conditions)
            if later is not None:
                loud = view.horizon_is_near and certain and use.role == "build" and later.package not in warned
                if loud:
                    warned.add(later.package)
                yield Hit(
                    use.at,
                    shown,
                    f"`{shown}` is taken, and no longer by {later.package} {later.version} of {view.horizon}",
                    later.new,
                    package.name,
                    severity="warning" if loud else "note",
                )
                continue
            when = "is no longer" if change.state == "removed" else "is not yet"
            how = "in" if kind == "field-changed" else "taken by"
            yield Hit(
                use.at,
                shown,
                f"`{shown}` {when} {how} {change.package} {change.version}{where}",
                change.new,
                package.name,
                severity=_how_bad(view, use, certain),
            )


def _how_bad(view: View, use: NameUse, certain: bool) -> str:
    if use.role == "aside" or (not certain and any(c.language == "cpp" for c in use.conditions)):
        return "note"  # an #if around it most likely tells the versions apart
    return "error" if certain and view.built(use.role) else "warning"


def _under_standard(view: View, package: Package, use: NameUse, change: Change) -> str | None:
    """How a message names the C++ standard that a use fails under (empty: under any); None where it does not fail."""
    refused_from, needs = standards_of(change.old)
    if not refused_from and not needs:
        return ""
    build = package.build
    default = default_standard(view.target)
    own = [t.standard for t in build.targets if t.name in use.targets and t.standard]
    fixed = view.standard(package)
    set_for = ([fixed[0]] if fixed else []) + own
    have = max((standard_year(number) for number in set_for), default=default)
    if have is None:
        return None
    if not set_for and any(u.kind == "command" for u in build.uses):
        return None  # a macro of another package may set it
    if refused_from:
        return f" in C++{have % 100:02d}" if have >= refused_from else None
    # CMake raises the standard to what the exported targets of rclcpp and others ask for: 17 at most, until GCC 15.
    raised = view.target.ros == 2 and (needs < 2020 or at_least(view.target.library("gcc") or "", "15"))
    if have >= needs or raised or not use.targets or use.role != "build" or not view.certain(use.conditions):
        return None
    return f" in C++{have % 100:02d}"
