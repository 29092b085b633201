"""What a version of a package offers to CMake and at run time, and what changed of it."""

import posixpath
from collections.abc import Callable, Iterable, Iterator

from ...impact.targets.surface.surface import BuildSurface
from .compare_python import PythonChange


def compare(old: BuildSurface, new: BuildSurface) -> tuple[PythonChange, ...]:
    """What changed for those who build on the package or start it, part by part, each sorted by name.

    A thing that is gone is not `sure` where it hung on a condition, or where the new version has things of its part
    that cannot be told and that the old one did not have.
    """
    found: list[PythonChange] = []
    for what, part, things in _PARTS:
        had, has = things(old), things(new)
        open_ended = any(where == part and (where, why) not in old.unknown for where, why in new.unknown)
        fresh = {name for name in has if name not in had}
        for name in sorted(had):
            shown, sure = had[name]
            if name not in has:
                target = _successor(what, name, fresh)
                kind = "moved" if target else "removed"
                found.append(PythonChange(kind, name, what, shown, target, True, sure and not open_ended))
            elif what == "plugin" and shown != has[name][0]:
                found.append(PythonChange("signature", name, what, shown, has[name][0], True, sure and has[name][1]))
        fresh -= {change.now for change in found if change.kind == "moved" and change.what == what}
        found += [PythonChange("added", name, what, "", has[name][0], False, has[name][1]) for name in sorted(fresh)]
    if old.standard != new.standard:
        now = str(new.standard or "")
        found.append(
            PythonChange("signature", "C++", "standard", str(old.standard or ""), now, new.standard > old.standard)
        )
    return (*found, *_arguments(old, new))


def _successor(what: str, name: str, fresh: Iterable[str]) -> str:
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


def _arguments(old: BuildSurface, new: BuildSurface) -> Iterator[PythonChange]:
    has = {launch.path: dict(launch.arguments) for launch in new.launches}
    for launch in old.launches:
        now = has.get(launch.path)
        if now is None:
            continue
        for name, default in launch.arguments:
            at = f"{launch.path} {name}"
            if name not in now:
                yield PythonChange("removed", at, "launch argument", default or "")
            elif now[name] is None and default is not None:
                yield PythonChange("signature", at, "launch argument", default, "must be given")
            elif now[name] != default and "?" not in (now[name], default):
                yield PythonChange("default", at, "launch argument", default or "", now[name] or "", False)
        for name, default in now.items():
            if name not in dict(launch.arguments):
                at = f"{launch.path} {name}"
                yield PythonChange("added", at, "launch argument", "", default or "", default is None)


_PARTS: tuple[tuple[str, str, Callable[[BuildSurface], dict[str, tuple[str, bool]]]], ...] = (
    ("cmake package", "", lambda s: {name: ("", True) for name in s.cmake_names}),
    ("target", "targets", lambda s: {t.name: (t.kind, t.sure) for t in s.targets}),
    ("library", "libraries", lambda s: {name: ("", True) for name in s.libraries}),
    ("dependency", "", lambda s: {name: ("", True) for name in s.dependencies}),
    ("system dependency", "system", lambda s: {name: ("", True) for name in s.system}),
    ("command", "commands", lambda s: {name: ("", True) for name in s.commands}),
    ("variable", "commands", lambda s: {name: ("", True) for name in s.variables}),
    ("executable", "programs", lambda s: {p.name: ("", p.sure) for p in s.programs}),
    ("plugin", "", lambda s: {p.name: (f"{p.type} ({p.base})", p.sure) for p in s.plugins}),
    ("launch file", "launches", lambda s: {f.path: ("", True) for f in s.launches}),
    ("header", "headers", lambda s: {h.include: ("", h.sure) for h in s.headers}),
)
