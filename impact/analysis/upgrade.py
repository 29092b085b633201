"""What an upgrade breaks, as a list of work: a workspace on the target it leaves and on the one it moves to."""

import shlex
import time
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from ..model.build_order import build_order
from ..rules.rule import Finding
from ..rules.severity import Doubt
from . import fix
from .findings import UpgradeItem, group_items, rank
from .report import Report, ReportedPackage, ReportedTarget
from .session import CheckError, Options, make_reader
from .target_compare import compare_findings, open_sides


class Upgrade(NamedTuple):
    """What there is to do.

    old: the target that is left. report: the check on the target that is moved to, with all its findings. packages:
    those that were asked for, in build order. breaks: errors and warnings that the upgrade brings. deprecations: what
    will go next. brought: the findings of both that the old target lacks. both: errors and warnings that the old
    target has too. over: those that hold on the old target alone. fixable: fingerprints of findings that `check --fix`
    fixes. command: which does that. check_old: the command that lists what the old target has already. fail_on: what
    the configuration says, empty without.
    """

    old: ReportedTarget
    report: Report
    packages: tuple[ReportedPackage, ...]
    breaks: tuple[UpgradeItem, ...]
    deprecations: tuple[UpgradeItem, ...]
    brought: tuple[Finding, ...]
    both: tuple[Finding, ...]
    over: tuple[Finding, ...]
    fixable: frozenset[str]
    command: str
    check_old: str
    fail_on: str = ""
    seconds: float = 0.0

    @property
    def new(self) -> ReportedTarget:
        """The target that is moved to."""
        return self.report.targets[0]

    def count_fixes(self, item: UpgradeItem) -> int:
        """How many findings of an item `check --fix` fixes."""
        return sum(finding.fingerprint in self.fixable for finding in item.findings)


def compare_upgrade(
    path: Path,
    old: str,
    new: str,
    options: Options,
    packages: Sequence[str] = (),
    progress: Callable[[int, int], None] | None = None,
) -> Upgrade:
    """What moving a workspace from one target to another breaks. old, new: targets, as after `--target`.

    options: as for check(), without targets. packages: only these, all when empty. Raises as check() does, and
    CheckError for a package that is not there, or where both targets are the same.
    """
    started = time.perf_counter()
    with open_sides(path, old, new, options, progress) as (opened, before, after):
        order = build_order(opened.views[1])
    report = after.report
    folders = {package.name: package.path for package in report.packages}
    for name in packages:
        if name not in folders:
            raise CheckError(f"--packages {name}: the workspace has no such package")
    wanted = set(packages or ("", *order))
    warning = {rule.name for rule in report.rules() if Doubt.DEPRECATED in rule.doubts}

    def is_late(finding: Finding) -> bool:
        return finding.ahead or finding.rule in warning

    now, then = (
        [finding for finding in side.report.findings if not wanted.isdisjoint(finding.packages)]
        for side in (after, before)
    )
    reported, lost = compare_findings(now, then), compare_findings(then, now)
    return Upgrade(
        old=before.report.targets[0],
        report=report,
        packages=tuple(ReportedPackage(name, folders[name]) for name in order if name in wanted),
        breaks=tuple(group_items((f for f in reported.new if _is_grave(f) and not is_late(f)), order)),
        deprecations=tuple(group_items((f for f in now if is_late(f)), order)),
        brought=tuple(f for f in reported.new if _is_grave(f) or is_late(f)),
        both=tuple(f for f in reported.both if _is_grave(f) and not is_late(f)),
        over=tuple(f for f in lost.new if _is_grave(f) and not is_late(f)),
        fixable=_find_fixable(report.findings, make_reader(after.tree)),
        # Of a revision, what would change is shown.
        command=_format_command(path, new, options, "--diff" if options.rev else "--fix"),
        check_old=_format_command(path, old, options),
        fail_on=after.config.fail_on,
        seconds=time.perf_counter() - started,
    )


def _is_grave(finding: Finding) -> bool:
    return rank(finding.severity) >= rank("warning")


def _find_fixable(findings: Iterable[Finding], read: Callable[[str], bytes | None]) -> frozenset[str]:
    """Fingerprints of the findings whose fixes can all be applied."""
    findings = [finding for finding in findings if finding.fix]
    refused = {edit for edit, _ in fix.apply(fix.collect(findings), read).refused}
    return frozenset(finding.fingerprint for finding in findings if refused.isdisjoint(finding.fix))


def _format_command(path: Path, target: str, options: Options, *ends: str) -> str:
    """The check of one of the targets, as one types it."""
    words = ["rosimpact", "check", str(path), "--target", target]
    words += ["--config", str(options.config)] if options.config else []
    words += ["--rev", options.rev] if options.rev else []
    words += ["--follow-links"] if options.follow_links else []
    return shlex.join([*words, *ends])
