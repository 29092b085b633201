"""What is known of the headers that packages include, as the rules on them ask for it."""

from collections.abc import Iterator
from typing import NamedTuple

from ....edges.memory import cache_in_derived
from ...model.absent_headers import is_answered, list_files_of_other_generation
from ...model.package import IncludeUse
from ...targets.providers.library import find_versioned_folder
from ...targets.symbol import Availability
from ..vocabulary import Doubt, FixAction, Package, TargetView, list_place_doubts
from .moved_header import respell
from .parameter_header import ParameterHeaders


class HeaderLoss(NamedTuple):
    """What the first source that knows of a header tells of it. found: how the target stands to it; None where it
    cannot be known. kind: of the text, where the state of that does not say it. ordered: places in sources go before
    those in headers."""

    found: Availability | None
    kind: str = ""
    fix: tuple[FixAction, ...] = ()
    ordered: bool = False


class IncludedHeaders:
    """Headers of others that a workspace includes, on one target."""

    def __init__(self, view: TargetView):
        self._view = view
        self._quiet: set[str] = set()
        self._parameters = ParameterHeaders(view)

    def list_asked(self, package: Package) -> Iterator[tuple[IncludeUse, tuple[Doubt, ...]]]:
        """The includes of a package that the target compiles, with what speaks against an error there. Those of headers
        that the workspace provides are left out, and those that rules of their own report; of a package that is made
        for both generations of ROS also those of files for the other one, unless they are surely compiled here."""
        view = self._view
        foreign = list_files_of_other_generation(view, package)
        for include in package.linked.includes:
            path = include.path
            if path in self._quiet or not view.applies(include.conditions):
                continue
            if self._parameters.find_fault(package, include):
                continue
            if view.workspace.provides_header(path):
                self._quiet.add(path)
                continue
            if find_versioned_folder(view.target, path) is None:
                doubts = self._collect_doubts(package, include)
                if not doubts or include.at.path not in foreign:
                    yield include, doubts

    def _collect_doubts(self, package: Package, include: IncludeUse) -> tuple[Doubt, ...]:
        doubts = list_place_doubts(self._view, include.role, include.conditions)
        if not include.targets:
            return (*doubts, Doubt.UNCOMPILED)
        compiling = (target for target in package.build.targets if target.name in include.targets)
        return doubts if any(self._view.is_sure(t.conditions) for t in compiling) else (*doubts, Doubt.CONDITIONAL)

    def skip(self, path: str) -> None:
        """Leaves a header of which nothing is known to be wrong out from now on, unless a place may say otherwise."""
        known = any(row.state != "deprecated" for row in self._view.find_reviewed("header", path))
        found = self._view.find_header_availability(path)
        if not known and is_answered(self._view, path) and (found is None or not found.alike):
            self._quiet.add(path)

    def find_loss(self, package: Package, include: IncludeUse) -> HeaderLoss | None:
        """What reviewed rows, stored releases and platforms tell of an included header that another version or platform
        has; None for all others."""
        view, path = self._view, include.path
        rows = {row.state: row for row in view.find_reviewed("header", path)}
        row = self._find_row(rows) or rows.get("upcoming")
        if row is not None and view.takes_other_version(package, row.package):
            return None
        if row is not None and (row.horizon is None or view.is_active_on(row.horizon, include.conditions)):
            as_it_is = row.form == "renamed" and row.state != "not yet"
            fix = respell(view, package, include, row.replacement) if as_it_is else ()
            return HeaderLoss(row, fix=fix, ordered=row.state == "upcoming")
        found = view.find_header_availability(path, include.conditions)
        if found is not None and found.form != "never" and (found.is_missing or found.state == "upcoming"):
            fix = () if found.state == "not yet" else respell(view, package, include, found.replacement)
            return HeaderLoss(found, fix=fix, ordered=True)
        found = view.find_lost_header(path)
        if found is None:
            return None
        if found.form == "platform" and view.unknown_contents.may_hold(package, path):
            return HeaderLoss(None)
        return HeaderLoss(found, found.form)

    def _find_row(self, rows: dict[str, Availability]) -> Availability | None:
        """The reviewed row on a path that the target lacks. rows: all on that path, by their state."""
        view = self._view
        row = rows.get("removed")
        if row is not None and view.may_have(row.package):
            return None
        if row is not None and not view.has_nested_header(row.package, row.symbol.name):
            return row
        row = rows.get("not yet")
        path = row.symbol.name if row is not None else ""
        if row is None or row.form != "renamed" or view.has_released_header(path.partition("/")[0], path):
            return None  # the package that it is called after has it
        return row if view.has_released_header(row.package, path) is False else None


@cache_in_derived
def get_included_headers(view: TargetView) -> IncludedHeaders:
    """Those of a view, made once."""
    return IncludedHeaders(view)
