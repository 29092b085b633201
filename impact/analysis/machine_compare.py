"""Two machines: what differs between them, and what of it matters to a workspace, the most harmful first."""

from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from ..config import load
from ..model.build_order import build_order
from ..model.flow.wire import WireDifference, list_wire_differences
from ..model.flow.workspace import get_flow
from ..model.view import TargetView
from ..model.workspace import Package
from ..targets.capture import MachineDifference, find_differences
from ..targets.resolve import parse_target
from .findings import UpgradeItem, group_items, rank
from .report import Report, ReportedTarget
from .session import Options
from .target_compare import compare_findings, open_sides

_MACHINE = ("distro", "date", "platform")


class DependencyUse(NamedTuple):
    """How a package of the workspace uses something. how: declared, built with, run with, or as in view.Need.
    subjects: what of it, as written, each once and in the order of first use; empty where there is nothing to name."""

    package: str
    how: str
    subjects: tuple[str, ...] = ()


class Used(NamedTuple):
    """A difference with who of the workspace uses what of it."""

    difference: MachineDifference
    uses: tuple[DependencyUse, ...] = ()


class Machines(NamedTuple):
    """What differs. first, second: the targets.

    machine: distro, date and platform. versions: of packages and libraries; beside a workspace those alone that it
    uses. others: how many more there are. report: the workspace judged on both; None without one, as is all that
    follows. harms: errors and warnings that hold on one of them alone, the gravest first; in each, the targets of the
    findings name the machine. both: how many hold on both. wire: what nodes of both cannot talk about.
    """

    first: ReportedTarget
    second: ReportedTarget
    machine: tuple[MachineDifference, ...]
    versions: tuple[Used, ...]
    others: int = 0
    report: Report | None = None
    harms: tuple[UpgradeItem, ...] = ()
    both: int = 0
    wire: tuple[WireDifference, ...] = ()


def compare_machines(first: str, second: str, path: Path | None = None) -> Machines:
    """What differs between two targets, in any form that `--target` takes. path: a workspace; with it, what matters to
    that. Raises as check() does."""
    if path is not None:
        return _compare_in_workspace(path, first, second)
    config = load(Path())
    one, other = (parse_target(text, config) for text in (first, second))
    found = find_differences(one, other)
    return Machines(
        ReportedTarget(one.name, one.distro, one.date, one.platform, "", one.notes),
        ReportedTarget(other.name, other.distro, other.date, other.platform, "", other.notes),
        tuple(d for d in found if d.kind in _MACHINE),
        tuple(Used(d) for d in found if d.kind not in _MACHINE),
    )


def _compare_in_workspace(path: Path, first: str, second: str) -> Machines:
    with open_sides(path, first, second, Options()) as (opened, one, other):
        order = build_order(opened.views[0])
        found = find_differences(opened.targets[0].target, opened.targets[1].target)
        uses = _collect_uses(opened.views)
        flow, targets = get_flow(opened.workspace), [each.target for each in opened.targets]
        same = targets[0].ros == targets[1].ros
        wire = list_wire_differences(flow.system, opened.workspace, *targets) if same else []
    versions = [
        Used(each, uses[each.name])
        for each in found
        if each.kind not in _MACHINE and each.name in uses and each.name not in opened.workspace.packages
    ]
    now, then = ([f for f in side.report.findings if rank(f.severity) >= rank("warning")] for side in (one, other))
    alone = compare_findings(now, then)
    report = one.report._replace(targets=(*one.report.targets, *other.report.targets))
    harms = [*group_items(alone.new, order), *group_items(compare_findings(then, now).new, order)]
    machine = tuple(d for d in found if d.kind in _MACHINE)
    return Machines(
        one.report.targets[0],
        other.report.targets[0],
        machine,
        tuple(sorted(versions, key=_rank_difference)),
        len(found) - len(machine) - len(versions),
        report,
        tuple(sorted(harms, key=lambda item: -rank(item.severity))),
        len(alone.both),
        tuple(wire),
    )


def _rank_difference(used: Used) -> tuple:
    """Sort key: what one machine lacks, then the greater jump, then what more packages use."""
    one, other = used.difference.first, used.difference.second
    numbers = [_split_version(version) for version in (one, other)]
    jump = next((place for place, (a, b) in enumerate(zip(*numbers, strict=False)) if a != b), len(numbers[0]))
    return bool(one and other), jump, -len({use.package for use in used.uses}), used.difference.name


def _split_version(version: str) -> list[str]:
    """Parts of a version without a leading zero, behind which the next part means what the first does elsewhere."""
    parts = version.split(".")
    return parts[1:] if parts[0] == "0" else parts


def _collect_uses(views: Iterable[TargetView]) -> dict[str, tuple[DependencyUse, ...]]:
    """Names of packages and libraries to who of the workspace uses them, and how, on any of the views."""
    found: dict[str, dict[tuple[str, str], dict[str, None]]] = {}
    for view in views:
        for package in view:
            for name, how, subject in _list_uses(view, package):
                subjects = found.setdefault(name, {}).setdefault((package.name, how), {})
                subjects.update({subject: None} if subject else {})
    return {
        name: tuple(DependencyUse(package, how, tuple(subjects)) for (package, how), subjects in by.items())
        for name, by in found.items()
    }


def _list_uses(view: TargetView, package: Package) -> Iterable[tuple[str, str, str]]:
    """(name, how, what of it) of all that a package uses."""
    for need in view.list_needs(package):
        for provider in need.providers[:1]:
            for name in (provider.name, *view.list_libraries(provider.name)):
                yield name, need.how, need.subject
    for declared in view.collect_declared(package):
        for name in (declared, *view.list_libraries(declared)):
            yield name, "declared", ""
    if package.build_type != "ament_python":
        yield "cmake", "built with", ""
        if package.linked.includes:
            yield "gcc", "built with", ""
    if package.linked.imports:
        yield "python3", "run with", ""
