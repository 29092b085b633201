"""What changed of the names that a package offers to Python between two versions."""

import re
from collections.abc import Mapping
from functools import cached_property

from ...impact.facts.python.surface import PythonParameter, is_private
from ...impact.targets.surface.python import UNKNOWN, PythonName, SurfaceNames, describe, is_callable, is_wrapped
from ...impact.targets.surface.surface import PythonSurface
from .version_change import OPEN, VersionChange


def compare(old: PythonSurface, new: PythonSurface) -> tuple[VersionChange, ...]:
    """What changed for those who use the package from Python, sorted by name. A name is left out
    where it cannot be known whether it is still there."""
    return _Comparison(SurfaceNames(old), SurfaceNames(new)).run()


class _Comparison:
    def __init__(self, old: SurfaceNames, new: SurfaceNames):
        self.old, self.new = old, new
        self.changes: dict[tuple[str, str], VersionChange] = {}
        self.seen: set[str] = set()

    def run(self) -> tuple[VersionChange, ...]:
        gone = self.compare_modules()
        # The shortest way to a thing is how its members are called.
        for name, entry in sorted(self.old.offered.items(), key=lambda item: (item[0].count("."), item[0])):
            found = self.new.find(name)
            if found is UNKNOWN:
                continue
            if found is None:
                self.report_missing(name, entry, gone)
            elif entry.where not in self.seen:
                self.seen.add(entry.where)
                self.compare_both(name, entry, found)
        for name, entry in self.new.offered.items():
            if self.old.find(name) is None and name not in self.moved_to:
                self.add("added", name, entry.kind, now=describe(entry), breaks=False)
        return tuple(sorted(self.changes.values(), key=lambda c: (c.name, c.kind)))

    @cached_property
    def moved_to(self) -> set[str]:
        return {change.instead for change in self.changes.values() if change.kind == "moved"}

    def add(self, kind: str, name: str, what: str, *, sure: bool = True, **more) -> None:
        more["sure"] = 1.0 if sure else OPEN
        change = VersionChange(self.old.surface.package, "python", kind, what, name, **more)
        self.changes.setdefault((kind, name), change)

    def compare_modules(self) -> list[str]:
        """Public modules that are gone: told once for the topmost."""
        gone: list[str] = []
        for name in sorted(self.old.modules):
            if any(is_private(part) for part in name.split(".")) or any(name.startswith(f"{g}.") for g in gone):
                continue
            if self.new.find(name) is None:
                gone.append(name)
                twins = [m for m in self.new.modules if m.rpartition(".")[2] == name.rpartition(".")[2]]
                twins = [m for m in twins if m not in self.old.modules and self.are_modules_alike(name, m)]
                if len(twins) == 1:
                    self.add("moved", name, "module", instead=twins[0])
                else:
                    self.add("removed", name, "module", old=name)
        for name in sorted(self.new.modules):
            if not any(is_private(part) for part in name.split(".")) and self.old.find(name) is None:
                self.add("added", name, "module", breaks=False)
        return gone

    def are_modules_alike(self, old: str, new: str) -> bool:
        had = {n for n in self.old.list_bound(self.old.modules[old]) if "." not in n}
        has = {n for n in self.new.list_bound(self.new.modules[new]) if "." not in n}
        return not had or len(had & has) * 2 >= len(had)

    def report_missing(self, name: str, entry: PythonName, gone: list[str]) -> None:
        """A name that can no longer be imported from where it was."""
        target = self.find_elsewhere(name, entry)
        inside = any(name.startswith(f"{module}.") for module in gone)
        if target:
            if not inside or (("moved", name.rpartition(".")[0]) not in self.changes):
                self.add("moved", name, entry.kind, instead=target, sure=not entry.conditional)
        elif not inside:
            self.add("removed", name, entry.kind, old=describe(entry), sure=not entry.conditional)

    def find_elsewhere(self, name: str, entry: PythonName) -> str:
        """Where else the thing can be imported from, empty where nowhere or where several things are like it."""
        last = name.rpartition(".")[2]
        found: dict[str, list[str]] = {}
        for path, other in self.new.offered.items():
            if path.rpartition(".")[2] != last or other.kind != entry.kind:
                continue
            before = self.old.find(path)
            same = before is not None and before.where == entry.where
            if same or (before is None and self.are_alike(entry, other)):
                found.setdefault(other.where, []).append(path)
        if len(found) != 1:
            return ""
        return min(next(iter(found.values())), key=lambda path: (path.count("."), path))

    def are_alike(self, old: PythonName, new: PythonName) -> bool:
        """Whether two things of one name may be the same: by the name of their module, else functions by their
        parameters, classes by their members."""
        if old.bound is None or new.bound is None:
            return False
        if old.where.split(".")[-2:] == new.where.split(".")[-2:] and old.where.count(".") > 2:
            return True
        if old.kind == "class":
            had, has = set(self.old.list_members(old)), set(self.new.list_members(new))
            return len(had & has) * 2 >= len(had) and (bool(had) or old.bound.bases == new.bound.bases)
        if old.kind == "function":
            had, has = ({p.name for p in b.parameters} for b in (old.bound, new.bound))
            return len(had & has) * 2 >= len(had | has)
        return old.bound.value == new.bound.value and bool(old.bound.value)

    def compare_both(self, name: str, old: PythonName, new: PythonName) -> None:
        """A thing that both have."""
        if old.bound is None or new.bound is None:
            return
        sure = not (old.conditional or new.conditional)
        of_class = name.endswith(".__init__")  # then it is told of the class
        if new.bound.deprecated and not old.bound.deprecated and not of_class:
            self.add("deprecated", name, old.kind, now=new.bound.deprecated, breaks=False, sure=sure)
        if old.kind == "class" and new.kind == "class":
            self.compare_classes(name, old, new)
        elif is_callable(old.kind) and is_callable(new.kind):
            self.compare_signatures(name, old, new, sure)
        elif _classify_use(old) != _classify_use(new) and "" not in (_classify_use(old), _classify_use(new)):
            if {old.kind, new.kind} != {"function", "class"}:  # both are called
                self.add("kind", name, old.kind, old=old.kind, now=new.kind, sure=sure)
        elif old.kind == "attribute" and old.bound.value and new.bound.value and old.bound.value != new.bound.value:
            self.add("default", name, old.kind, old=old.bound.value, now=new.bound.value, breaks=False, sure=sure)

    def compare_classes(self, name: str, old: PythonName, new: PythonName) -> None:
        mine = self.new.list_members(new)
        for member, had in self.old.list_members(old).items():
            dotted = f"{name}.{member}"
            has = mine.get(member) or self.new.find_member(new, member)
            if has is UNKNOWN:
                continue
            if has is None:
                if member != "__init__":
                    self.add("removed", dotted, had.kind, old=describe(had), sure=not had.conditional)
                elif had.bound is not None and had.bound.parameters:
                    self.add("signature", dotted, "method", old=describe(had), now="()", sure=not had.conditional)
            else:
                self.compare_both(dotted, had, has)
        for member, has in mine.items():
            if member != "__init__" and self.old.find_member(old, member) is None:
                self.add("added", f"{name}.{member}", has.kind, now=describe(has), breaks=False)

    def compare_signatures(self, name: str, old: PythonName, new: PythonName, sure: bool) -> None:
        assert old.bound is not None and new.bound is not None
        had, has = old.bound.parameters, new.bound.parameters
        sure = sure and not (is_wrapped(old.bound) or is_wrapped(new.bound))
        problem = explain_break(had, has)
        # Which keywords `**kwargs` stood for cannot be known.
        sure = sure and not (problem.startswith("`**"))
        if problem or [(p.name, p.kind) for p in had] != [(p.name, p.kind) for p in has]:
            self.add("signature", name, old.kind, old=describe(old), now=describe(new), breaks=bool(problem), sure=sure)
        before = {p.name: p.default for p in had}
        for parameter in has:
            value, now = before.get(parameter.name), parameter.default
            if value is None or now is None or "?" in (value, now):
                continue
            if value != now and not (_PATH.match(value) and _PATH.match(now) and _get_last(value) == _get_last(now)):
                at = f"{name}({parameter.name})"
                self.add("default", at, "parameter", old=value, now=now, breaks=False, sure=sure)


# One constant may be called by several paths (`_rclpy.ClockType.ROS_TIME`, `ClockType.ROS_TIME`).
_PATH = re.compile(r"[A-Za-z_][\w.]*\Z")


def _get_last(path: str) -> str:
    return path.rpartition(".")[2]


def _classify_use(entry: PythonName) -> str:
    """How a thing is used: `value` without a call; empty where it cannot be known, since a name may stand for a class
    or a function."""
    if entry.kind in ("attribute", "instance"):
        return "value" if entry.bound is not None and entry.bound.value else ""
    return "value" if entry.kind == "property" else "call" if is_callable(entry.kind) else entry.kind


def explain_break(old: tuple[PythonParameter, ...], new: tuple[PythonParameter, ...]) -> str:
    """Why a call that the old parameters took may fail with the new ones, empty where none does."""
    kinds = {parameter.kind for parameter in new}
    by_name: Mapping[str, PythonParameter] = {p.name: p for p in new if p.kind in ("normal", "keyword")}
    had = [p for p in old if p.kind in ("positional", "normal")]
    has = [p for p in new if p.kind in ("positional", "normal")]
    for parameter in old:
        if parameter.kind == "args" and "args" not in kinds:
            return f"`*{parameter.name}` is gone"
        if parameter.kind == "kwargs" and "kwargs" not in kinds:
            return f"`**{parameter.name}` is gone"
        if parameter.kind in ("normal", "keyword") and parameter.name not in by_name and "kwargs" not in kinds:
            return f"`{parameter.name}` is gone"
        now = by_name.get(parameter.name)
        if now is not None and now.default is None and parameter.default is not None:
            return f"`{parameter.name}` must be given"
    for number, parameter in enumerate(had):
        if number >= len(has):
            if "args" not in kinds:
                return f"`{parameter.name}` is no longer taken by position"
        elif has[number].name != parameter.name and parameter.kind == "normal":
            return f"`{has[number].name}` stands where `{parameter.name}` stood"
        elif parameter.kind == "positional" and has[number].default is None and parameter.default is not None:
            return f"`{has[number].name}` must be given"
    known = {parameter.name for parameter in old}
    for number, parameter in enumerate(new):
        takes_over = parameter.kind == "positional" and number < len(had)
        if parameter.kind in ("args", "kwargs") or parameter.default is not None or takes_over:
            continue
        if parameter.name not in known:
            return f"`{parameter.name}` must be given"
    return ""
