"""What a version of a package offers to CMake and at run time, and what changed of it."""

import posixpath
from collections.abc import Callable, Iterable, Iterator

from ...impact.targets.surface.surface import BuildSurface
from .version_change import OPEN, VersionChange


def compare(old: BuildSurface, new: BuildSurface) -> tuple[VersionChange, ...]:
    """What changed for those who build on the package or start it, part by part, each sorted by name.

    A thing that is gone is not `sure` where it hung on a condition, or where the new version has things of its part
    that cannot be known and that the old one did not have.
    """
    found: list[VersionChange] = []
    for what, things in THINGS.items():
        had, has = things(old), things(new)
        part = _PARTS.get(what, "")
        open_ended = any(where == part and (where, why) not in old.unknown for where, why in new.unknown)
        fresh = {name for name in has if name not in had}
        for name in sorted(had):
            shown, sure = had[name]
            if name not in has:
                instead = _find_next(what, name, fresh)
                kind = "moved" if instead else "removed"
                gone = sure and not open_ended
                found.append(_change(old, kind, what, name, shown, instead=instead, sure=gone))
            elif what == "plugin" and shown != has[name][0]:
                now, there = has[name]
                found.append(_change(old, "signature", what, name, shown, now, sure=sure and there))
        fresh -= {change.instead for change in found if change.kind == "moved" and change.what == what}
        for name in sorted(fresh):
            shown, sure = has[name]
            found.append(_change(old, "added", what, name, now=shown, breaks=False, sure=sure))
    if old.standard != new.standard:
        had, now = str(old.standard or ""), str(new.standard or "")
        found.append(_change(old, "signature", "standard", "C++", had, now, breaks=new.standard > old.standard))
    return (*found, *_compare_arguments(old, new))


def _change(
    of: BuildSurface, kind: str, what: str, name: str, old: str = "", now: str = "", *, sure: bool = True, **more
) -> VersionChange:
    return VersionChange(of.package, "build", kind, what, name, old, now, sure=1.0 if sure else OPEN, **more)


def _find_next(what: str, name: str, fresh: Iterable[str]) -> str:
    """The one new thing that bears the same last name, for things that have a path or a namespace."""
    if what == "target":
        same = [one for one in fresh if one.rpartition("::")[2] == name.rpartition("::")[2]]
    elif what in ("header", "launch file"):
        stem = posixpath.splitext(posixpath.basename(name))[0]
        same = [one for one in fresh if posixpath.splitext(posixpath.basename(one))[0] == stem]
        beside = [one for one in same if posixpath.dirname(one) == posixpath.dirname(name)]
        same = beside or same
    else:
        return ""
    return same[0] if len(same) == 1 else ""


def _compare_arguments(old: BuildSurface, new: BuildSurface) -> Iterator[VersionChange]:
    has = {launch.path: dict(launch.arguments) for launch in new.launches}
    for launch in old.launches:
        now = has.get(launch.path)
        if now is None:
            continue
        for name, default in launch.arguments:
            at = f"{launch.path} {name}"
            if name not in now:
                yield _change(old, "removed", "launch argument", at, default or "")
            elif now[name] is None and default is not None:
                yield _change(old, "signature", "launch argument", at, default, "must be given")
            elif now[name] != default and "?" not in (now[name], default):
                yield _change(old, "default", "launch argument", at, default or "", now[name] or "", breaks=False)
        for name, default in now.items():
            if name not in dict(launch.arguments):
                at = f"{launch.path} {name}"
                yield _change(old, "added", "launch argument", at, now=default or "", breaks=default is None)


# What of a surface can be unknown as a whole, by the sort of thing.
_PARTS = {
    "target": "targets",
    "library": "libraries",
    "system dependency": "system",
    "command": "commands",
    "variable": "commands",
    "executable": "programs",
    "launch file": "launches",
    "header": "headers",
}
THINGS: dict[str, Callable[[BuildSurface], dict[str, tuple[str, bool]]]] = {
    "cmake package": lambda s: {name: ("", True) for name in s.cmake_names},
    "target": lambda s: {t.name: (t.kind, t.sure) for t in s.targets},
    "library": lambda s: {name: ("", True) for name in s.libraries},
    "dependency": lambda s: {name: ("", True) for name in s.dependencies},
    "system dependency": lambda s: {name: ("", True) for name in s.system},
    "command": lambda s: {name: ("", True) for name in s.commands},
    "variable": lambda s: {name: ("", True) for name in s.variables},
    "executable": lambda s: {p.name: ("", p.sure) for p in s.programs},
    "plugin": lambda s: {p.name: (f"{p.type} ({p.base})", p.sure) for p in s.plugins},
    "launch file": lambda s: {f.path: ("", True) for f in s.launches},
    "header": lambda s: {h.include: ("", h.sure) for h in s.headers},
}
"""What a version has, by the sort of thing: names, each as it is shown and whether it surely is there."""
