"""What holds on one target and not on another: one workspace, read once and judged on both."""

import os
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from typing import NamedTuple

from ..rules.rule import Finding
from .check import Checked
from .check_opened import check_opened
from .findings import rank
from .session import CheckError, OpenedWorkspace, Options, open_workspace, select_rules


class Sides(NamedTuple):
    """A workspace judged on two targets, each as a check of that target alone judges it."""

    opened: OpenedWorkspace
    first: Checked
    second: Checked


@contextmanager
def open_sides(
    path: str | os.PathLike[str],
    first: str,
    second: str,
    options: Options,
    progress: Callable[[int, int], None] | None = None,
) -> Iterator[Sides]:
    """A workspace on two targets, open as long as the context is. first, second: as after `--target`.

    options: as for check(), without targets. Raises as check() does, and CheckError where both are the same target or
    nothing could be analysed.
    """
    options = options._replace(targets=(first, second))
    with open_workspace(path, options, progress, lambda config: select_rules(options, config)) as opened:
        if len(opened.targets) < 2:
            raise CheckError(f"{first} and {second} are the same target; give two")
        one, other = (check_opened(path, options, alone) for alone in opened.split_by_target())
        for checked in (one, other):
            if checked.report.failure:
                raise CheckError(checked.report.failure)
        yield Sides(opened, one, other)


class Compared(NamedTuple):
    """Findings of one side. new: those that the other side lacks, or has with a lesser severity. both: the rest."""

    new: list[Finding]
    both: list[Finding]


def compare_findings(findings: Iterable[Finding], other: Iterable[Finding]) -> Compared:
    """Findings of one side against those of the other, by rule, package, path, line and subject, and by whether they
    hold already. A subject that has another name there, as rosdep keys do, is known by the rest of the message."""
    findings, other = list(findings), list(other)
    there: dict[tuple, int] = {}
    for finding in other:
        there[_make_key(finding)] = max(there.get(_make_key(finding), 0), rank(finding.severity))
    here = {_make_key(finding) for finding in findings}
    renamed: dict[tuple, list[int]] = defaultdict(list)
    for finding in other:
        if _make_key(finding) not in here:
            renamed[_make_nameless_key(finding)].append(rank(finding.severity))
    result = Compared([], [])
    for finding in findings:
        old = there.get(_make_key(finding), -1)
        if old < 0 and (others := renamed[_make_nameless_key(finding)]):
            old = others.pop()
        (result.both if old >= rank(finding.severity) else result.new).append(finding)
    return result


def _make_key(finding: Finding) -> tuple[str, str, str, int, str, bool]:
    return finding.rule, finding.package, finding.path, finding.line, finding.subject, finding.ahead


def _make_nameless_key(finding: Finding) -> tuple[str, str, str, int, int, str, bool]:
    said = finding.message.replace(f"`{finding.subject}`", "``")
    return finding.rule, finding.package, finding.path, finding.line, finding.column, said, finding.ahead
