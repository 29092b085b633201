"""What several rules ask: how strong a need is, by what name one declares it, which watched uses a target refuses."""

from __future__ import annotations

from collections.abc import Iterator

from ..model.view import Need, View
from ..model.workspace import Package
from .rule import Hit

_HOW = {"find_package": 0, "component": 0, "include": 1, "import": 2, "plugin": 3, "launch": 4, "shell": 5}
_ROLE = {"build": 0, "run": 1, "test": 2, "aside": 3}


def weight(need: Need) -> tuple:
    """Sort key: what is surest to break comes first."""
    return (_ROLE[need.role], not need.certain, not need.required, _HOW[need.how], need.at.path, need.at.line)


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


def uses_refused(view: View, kind: str) -> Iterator[Hit]:
    """Hits for watched uses of a kind (`call-changed`, `field-changed`) that a target takes no longer, or not yet."""
    # What the workspace itself brings is as it brings it, whatever a release did.
    refused = {c.old: c for c in view.changes(kind) if c.package not in view.workspace.packages}
    if not refused:
        return
    for package in view:
        for use in package.digest.uses:
            change = refused.get(use.text)
            if change is None or not view.active(use.conditions) or not view.concerned(package, change, use.at.path):
                continue
            when = "is no longer" if change.state == "removed" else "is not yet"
            how = "in" if kind == "field-changed" else "taken by"
            sure = use.role in ("build", "run") and use.language == "cpp" and view.certain(use.conditions)
            yield Hit(
                use.at,
                use.text,
                f"`{use.text}` {when} {how} {change.package} {change.version}",
                change.new,
                package.name,
                severity="note" if use.role == "aside" else "error" if sure else "warning",
            )
