"""Names whose header reaches a file only by luck: what missing-include and missing-standard-include report."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.cmake.build import is_for_tests
from ...model.cpp.lost_headers import LostHeader, LostHeaders
from ...model.package import NeededHeader
from ...targets.providers.message_headers import parse_type
from ...targets.providers.standard import get_bit
from ..vocabulary import Diagnostic, Doubt, Insert, Package, TargetView, Together, rate_newest

LOST = "`{name}` is used without `<{subject}>`, "
"""How the texts of both begin."""


def find_missing_includes(view: TargetView, standard: bool) -> Iterator[Diagnostic]:
    """The names that files use without their headers, of the standard libraries or, with `standard` false, of all
    others."""
    # Macros that a file of the workspace defines, maybe where nothing else does.
    defined = frozenset().union(*(package.linked.defined for package in view.workspace))
    for package in view:
        headers, places = LostHeaders(view, package), _Places(package)
        precompiled = any(use.name == "target_precompile_headers" for use in package.build.uses)
        reported: set[tuple[str, str]] = set()
        for need in package.linked.needed_headers:
            if bool(get_bit(need.name)) is not standard:
                continue
            if need.role == "aside" or need.name in defined or not view.applies(need.conditions):
                continue
            if owner := _find_lacking_owner(view, package, need):
                if ("", need.name) not in reported:
                    reported.add(("", need.name))
                    doubt = Doubt.INCOMPLETE if places.compiles(need) else Doubt.UNCOMPILED
                    yield Diagnostic(need.at, need.name, package.name, {"owner": owner}, "no interface", (doubt,))
                continue
            lost = headers.find(need)
            if lost is None or precompiled or (need.at.path, lost.header) in reported:
                continue
            # That none ever brought a name of a ROS package rests on all of its headers having been read.
            known = lost.once or lost.standard or need.name.startswith("boost::") or parse_type(need.name) is not None
            sure = known and places.compiles(need) and lost.sure and need.role == "build"
            sure = sure and view.is_sure(need.conditions)
            if lost.standard and not lost.once and not (sure and lost.now):
                continue
            reported.add((need.at.path, lost.header))
            horizon = "" if lost.now else view.horizon
            doubt = None
            if not sure:
                unsure = Doubt.INCOMPLETE if known and lost.sure else Doubt.UNCHECKED
                doubt = unsure if places.matters(need, lost) else Doubt.UNCOMPILED
            yield Diagnostic(
                need.at,
                lost.header,
                package.name,
                {"name": need.name, "by": lost.by, "version": lost.version, "horizon": horizon},
                kind="dropped" if lost.once else "never",
                doubts=(rate_newest(view) if sure and not lost.now else doubt,),
                together=(Together(f"{lost.by} of {horizon}", True),) if not lost.now else (),
                fix=_include(view, package, need, lost.header) if lost.by == "gcc" else (),
            )


def _find_lacking_owner(view: TargetView, package: Package, need: NeededHeader) -> str:
    """The other package of the workspace that has interfaces alone, and not the one that a type would be made from."""
    made, workspace = parse_type(need.name), view.workspace
    owner = workspace.packages.get(made.package) if made is not None and made.ros == view.target.ros else None
    if made is None or owner is None or owner.name == package.name or not workspace.interface_names.get(owner.name):
        return ""
    if owner.linked.source_targets or owner.build.unresolved:
        return ""  # it may have classes of its own
    if any(g.how == "reconfigure" for g in owner.build.generated):
        return ""
    name, has = made.name.rpartition("::")[2], workspace.interface_names[owner.name]
    known = name in has or (made.ros == 1 and workspace.is_interface_header(owner.name, f"{name}.h"))
    return "" if known else owner.name


class _Places:
    """The files of a package that its targets compile, and the headers that it installs."""

    def __init__(self, package: Package):
        sources = package.linked.source_targets
        built = {t.name for t in package.build.targets if t.kind != "test" and not is_for_tests(t.conditions)}
        self._compiled = {path for path, targets in sources if built.intersection(targets)}
        self._public = package.linked.public_headers
        self._offered = {path for path, _ in sources}.intersection(self._public)

    def compiles(self, need: NeededHeader) -> bool:
        """Whether a target other than a test compiles the file."""
        return need.at.path in self._compiled

    def matters(self, need: NeededHeader, lost: LostHeader) -> bool:
        """Whether somebody compiles the file: a target here, or who includes it where it is installed."""
        path = need.at.path
        if not lost.now:
            return False
        return (
            path in self._compiled
            or path in self._offered
            or (lost.sure and not lost.standard and path in self._public)
        )


def _include(view: TargetView, package: Package, need: NeededHeader, header: str) -> tuple[Insert, ...]:
    """The fix that includes a header behind the standard C++ headers of the file that sort before it; nothing where it
    includes none outside of conditions."""
    above = (i for i in package.linked.includes if i.at.path == need.at.path and i.at.line < need.at.line)
    standard = [i for i in above if not i.conditions and "." not in i.path and view.is_standard(i.path)]
    before = [i for i in standard if i.path < header] or standard
    return (Insert(need.at.path, max(i.at.line for i in before), f"#include <{header}>"),) if before else ()
