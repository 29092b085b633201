"""rosimpact check."""

import os
import sys
from contextlib import suppress
from importlib import import_module
from pathlib import Path

from ...edges.console import UserError, format_count, is_obeyed, run_command, say
from ...edges.files import read_file
from ...edges.limits import get_limits
from ...edges.version import __version__
from ..analysis.check import Checked
from ..analysis.check import run as run_check
from ..analysis.findings import SettingsError, has_failures
from ..analysis.report import AnalysisCoverage, Report
from ..analysis.session import Options
from ..report.style import PLAIN, choose_style
from ..tree import WorkingTree, shown
from .output import PARSED_SO_FAR, check_output, deliver, make_progress_bar, print_answer, save, validate_choice

FORMATS = ("text", "json", "sarif", "github", "markdown", "html")
FAIL_ON = ("error", "warning", "note", "never")


def _fail(message: str, format: str, output: Path | None, path: object) -> int:
    """Says why a check failed, in the format asked for too, so that valid JSON is printed all the same. Returns 2."""
    say(f"rosimpact: {message}")
    if format in FORMATS and format != "text":
        text = render(Report(__version__, "", (), (), AnalysisCoverage(), failure=message), format, notes=False)
        with suppress(UserError):
            try:
                deliver(text, output, format, path)
            except UserError:
                if output is not None:
                    print_answer(text, format)
    return 2


def check(
    path: Path, *, target, format, output, rev, base, select, ignore, fail_on, notes, preview, baseline,
    write_baseline, prune_baseline, fix, diff, config, jobs, quiet, install,
    follow_links,
) -> int:  # fmt: skip
    """Runs the check and prints its report. Returns the exit status: 0, 1 (findings), 2 (failed) or 130."""

    def run_and_report() -> int:
        validate_choice("--format", format, FORMATS)
        validate_choice("--fail-on", fail_on or FAIL_ON[0], FAIL_ON)
        if prune_baseline and baseline is None:
            raise UserError("--prune-baseline: no baseline was given; name it with --baseline")
        if prune_baseline and (select or ignore):
            raise UserError("--prune-baseline: what other rules find would be removed; leave out --select and --ignore")
        known = _read_baseline_text(baseline)
        for file in (output, write_baseline, baseline if prune_baseline else None):
            check_output(file, path)
        options = Options(
            target, rev, base, select, ignore, preview, jobs, config, known, install=install,
            follow_links=follow_links,
        )  # fmt: skip
        checked = run_check(path, options, None if quiet else make_progress_bar())
        incomplete = False
        if fix and not diff:
            incomplete = not _write_fixes(path, checked)
            checked = run_check(path, options, None)
        report = checked.report
        if report.failure and (format != "text" or output or diff or write_baseline):
            say(f"rosimpact: {report.failure}")
        if baseline is not None and prune_baseline and report.packages:
            _prune(baseline, known, report, path)
        if write_baseline:
            return _write_new_baseline(write_baseline, report, path)
        if diff:
            patch, incomplete = _patch(checked, output)
            deliver(patch, output, "patch", path)
        else:
            deliver(render(report, format, notes, output, _find_prefix(path, checked)), output, format, path)
        if format == "github" and not diff:
            _write_step_summary(report)
        if report.failure or incomplete:
            return 2
        return int(has_failures(report.findings, fail_on or checked.config.fail_on or "error"))

    return run_command(run_and_report, PARSED_SO_FAR, path, lambda message: _fail(message, format, output, path))


def _write_step_summary(report: Report) -> None:
    """Adds to the summary of the step where GitHub runs one. The report is out already, so a failure is but told."""
    from ..report.github import write_step_summary

    try:
        write_step_summary(report, os.environ)
    except OSError as error:
        say(f"rosimpact: the step summary cannot be written: {error.strerror}; check GITHUB_STEP_SUMMARY")


def _read_baseline_text(file: Path | None) -> str:
    """The text of a baseline file, checked, so that a wrong one is named before the work starts."""
    if file is None:
        return ""
    from ..analysis.findings import read_baseline

    try:
        text = read_file(file, get_limits().baseline)
        read_baseline(text)
        return text.decode("utf-8-sig")
    except OSError as error:
        raise UserError(f"{file}: {error.strerror}; write a baseline with --write-baseline {file}") from None
    except (SettingsError, UnicodeDecodeError) as error:
        raise UserError(f"{file}: {error}") from None


def _write_new_baseline(file: Path, report: Report, path: Path) -> int:
    """Writes all of today's findings, those that an older baseline knows included."""
    from ..analysis.findings import format_baseline, sort_findings

    if not report.packages:
        raise UserError(f"{file}: not written, because nothing was analysed")
    found = sort_findings([*report.findings, *report.known])
    save(file, format_baseline(found), path)
    say(f"rosimpact: {file}: {format_count(len(found), 'finding')}")
    return 2 if report.failure else 0


def _prune(file: Path, known: str, report: Report, path: Path) -> None:
    """Takes what is fixed out of a baseline file."""
    from ..analysis.findings import prune_baseline, read_baseline

    text, gone = prune_baseline(read_baseline(known), [*report.findings, *report.known])
    if gone:
        save(file, text, path)
    say(f"rosimpact: {file}: {gone} fixed, removed")


def _write_fixes(path: Path, checked: Checked) -> bool:
    """Writes the fixes of a check. Returns whether all that could be made were written."""
    from ..analysis import fix

    if not isinstance(checked.tree, WorkingTree):
        raise UserError("--fix: a revision cannot be changed; remove --rev, or print the changes with --diff")
    applied = _apply_fixes(checked)
    done = 0
    for name, data in applied.files.items():
        try:
            fix.write(path, name, data, checked.originals[name])
            done += 1
        except OSError as error:
            say(f"rosimpact: {shown(name)}: not fixed: {error.strerror}")
    for edit, reason in applied.refused:
        say(f"rosimpact: {shown(edit.path)}: not changed: {reason}")
    say(f"{format_count(done, 'file')} changed")
    return done == len(applied.files)


def _apply_fixes(checked: Checked):
    from ..analysis import fix

    return fix.apply(fix.collect(finding for finding in checked.report.findings if finding.new), checked.originals.get)


def _patch(checked: Checked, output: Path | None) -> tuple[str, bool]:
    """What the fixes would change, as `git apply` reads it, and whether some of it is left out: a patch holds lines of
    the workspace as they are, so that one which a terminal or CI would obey goes to a file alone."""
    from ..analysis import fix

    applied = _apply_fixes(checked)
    for edit, reason in applied.refused:
        say(f"rosimpact: {shown(edit.path)}: not changed: {reason}")
    parts: list[str] = []
    incomplete = False
    for name, data in applied.files.items():
        part = fix.make_unified_diff(name, checked.originals[name], data)
        if output is None and is_obeyed(part):
            incomplete = True
            say(
                f"rosimpact: {shown(name)}: its changes are not printed, because the lines around them contain "
                "control sequences or CI commands; write them to a file with --output"
            )
        else:
            parts.append(part)
    return "".join(parts), incomplete


def _find_prefix(path: Path, checked: Checked) -> str:
    """The workspace's folder relative to the repository's root, which annotations need."""
    root = os.environ.get("GITHUB_WORKSPACE") or checked.tree.repositories.get("")
    if not root:
        return ""
    inside = os.path.relpath(os.path.realpath(path), os.path.realpath(root))
    return "" if inside == "." or inside.startswith("..") else inside.replace(os.sep, "/")


def render(report: Report, format: str, notes: bool, output: Path | None = None, prefix: str = "") -> str:
    """The report in one of the formats. output: the file it goes to, which has no colours and takes any sign."""
    if format == "text":
        from ..report import text

        severities = ("error", "warning", "note") if notes else ("error", "warning")
        style = PLAIN._replace(severities=severities) if output else choose_style(sys.stdout, severities=severities)
        return text.render(report, style)
    reporter = import_module(f"...report.{format}", __name__)
    return reporter.render(report, prefix) if format == "github" else reporter.render(report)
