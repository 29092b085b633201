"""What the commands do: options to a report, a report to a stream and an exit status."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from .check import Options, __version__, check as run_check
from .config import ConfigError
from .findings import SettingsError, baseline as baseline_text, fails
from .report.report import Report
from .targets.distro import TargetError
from .targets.snapshot import SnapshotError
from .tree import TreeError

_OUR_ERRORS = (ConfigError, SettingsError, TargetError, SnapshotError, TreeError)


def failed(message: str, format: str = "text") -> int:
    """Prints why the tool failed; valid JSON is printed all the same. Returns 2."""
    print(f"rosimpact: {message}", file=sys.stderr)
    if format == "json":
        from .report.json import failure

        print(failure(__version__, "", message))
    return 2


def check(
    path: Path, *, targets, format, output, rev, base, select, ignore, fail_on, notes, preview, baseline, write_baseline,
    fix, diff, config, jobs, quiet,
) -> int:  # fmt: skip
    """Runs the check and prints its report. Returns the exit status: 0, 1 (findings) or 2 (failed, nothing analysed)."""
    from .check import CheckError
    from .cli import FORMATS

    if format not in FORMATS:
        return failed(f"--format {format}: unknown; choose one of {', '.join(FORMATS)}")
    if fail_on not in ("", "error", "warning", "note", "never"):
        return failed(f"--fail-on {fail_on}: unknown; choose error, warning, note or never", format)
    try:
        known = baseline.read_text(encoding="utf-8") if baseline else ""
        options = Options(targets, rev, base, select, ignore, preview, jobs, config, known)
        report = run_check(path, options, None if quiet else _progress())
    except (CheckError, *_OUR_ERRORS) as error:
        return failed(str(error), format)
    except OSError as error:
        return failed(f"{error.filename or path}: {error.strerror or error}; check that it can be read", format)
    except RecursionError:
        return failed("a file nests too deeply to be analysed; see --format json for what was read so far", format)
    if report.failure:
        print(f"rosimpact: {report.failure}", file=sys.stderr)
    if write_baseline:
        write_baseline.write_text(baseline_text(report.findings), encoding="utf-8")
        print(f"{write_baseline}: {len(report.findings)} findings", file=sys.stderr)
        return 2 if report.failure else 0
    if fix or diff:
        return _fix(path, report, diff)
    text = render(report, format, notes, output is None)
    if output is not None:
        output.write_text(text, encoding="utf-8", errors="surrogateescape")
    else:
        _write(text)
    if report.failure:
        return 2
    threshold = fail_on or load_fail_on(path, config)
    return 0 if threshold == "never" else int(fails(report.findings, threshold))


def load_fail_on(path: Path, config: Path | None) -> str:
    """The threshold of rosimpact.toml, `error` without one."""
    from .config import load

    return load(path if path.is_dir() else path.parent, config).fail_on or "error"


def render(report: Report, format: str, notes: bool, to_terminal: bool) -> str:
    """The report in one of the formats."""
    if format == "text":
        from .report import text

        severities = ("error", "warning", "note") if notes else ("error", "warning")
        return text.render(report, text.style_for(sys.stdout if to_terminal else open(os.devnull), severities=severities))
    if format == "json":
        from .report import json as reporter
    elif format == "sarif":
        from .report import sarif as reporter
    elif format == "github":
        from .report import github as reporter
    elif format == "markdown":
        from .report import markdown as reporter
    else:
        from .report import html as reporter
    return reporter.render(report)


def _write(text: str) -> None:
    data = text if text.endswith("\n") or not text else text + "\n"
    sys.stdout.buffer.write(data.encode("utf-8", "backslashreplace"))
    sys.stdout.flush()


def _progress():
    """A line on standard error that is rewritten while files are parsed; None when nobody watches."""
    if not sys.stderr.isatty():
        return None

    def show(done: int, total: int) -> None:
        share = 100 * done // max(1, total)
        end = "\r\x1b[K" if done >= total else ""
        sys.stderr.write(f"\rparsing {share:3d} % of {total / 1e6:.1f} MB{end}")
        sys.stderr.flush()

    return show


def _fix(path: Path, report: Report, diff: bool) -> int:
    from . import fix

    def read(name: str) -> bytes | None:
        try:
            return (path / name).read_bytes()
        except OSError:
            return None

    applied = fix.apply(fix.fixes(report.findings), read)
    for name, data in applied.files.items():
        if diff:
            _write(fix.unified_diff(name, read(name) or b"", data))
        else:
            fix.write(path / name, data)
    for edit, reason in applied.refused:
        print(f"{edit[0].path if edit else path}: not changed: {reason}", file=sys.stderr)
    if not diff:
        print(f"{len(applied.files)} files changed", file=sys.stderr)
    return 0


def explain(name: str | None) -> int:
    """Prints a rule's documentation, or the list of rules."""
    from .rules.rule import all_rules

    rules = all_rules()
    if name is None:
        family = ""
        for rule in sorted(rules.values(), key=lambda r: (r.family, r.name)):
            if rule.family != family:
                family = rule.family
                print(f"{family}:")
            print(f"  {rule.name:26s} {rule.severity:8s} {rule.documentation.splitlines()[0].split(': ', 1)[-1]}")
        return 0
    if name not in rules:
        from difflib import get_close_matches

        close = get_close_matches(name, rules, 1)
        return failed(f"no rule is called `{name}`" + (f"; did you mean `{close[0]}`?" if close else "; `rosimpact explain` lists them"))
    print(rules[name].documentation.rstrip())
    return 0


def env_capture(output: Path | None) -> int:
    """Writes this machine as a target."""
    from .targets.capture import capture, to_json

    text = to_json(capture())
    if output is None:
        _write(text)
        return 0
    try:
        output.parent.mkdir(parents=True, exist_ok=True)
        output.write_text(text, encoding="utf-8")
    except OSError as error:
        return failed(f"{output}: cannot be written: {error.strerror}; give another file")
    print(f"{output}: written; use it with --target {output}", file=sys.stderr)
    return 0


def env_diff(first: str, second: str, path: Path | None, format: str) -> int:
    """Prints what differs between two targets, with what the workspace uses marked and first."""
    from .config import load
    from .targets.capture import differences
    from .targets.resolve import parse_target

    try:
        config = load(path if path is not None else Path("."))
        a, b = parse_target(first, config), parse_target(second, config)
        used = _used(path, (first,)) if path is not None else {}
    except _OUR_ERRORS as error:
        return failed(str(error), format)
    rows = [d._replace(used_by=used.get(d.name, ())) for d in differences(a, b)]
    rows.sort(key=lambda d: (not d.used_by, d.kind != "library", d.name))
    if format == "json":
        import json

        _write(json.dumps([d._asdict() for d in rows], indent=1))
        return 0
    width = max((len(d.name) for d in rows), default=0)
    for d in rows:
        mark = "*" if d.used_by else " "
        users = f"  used by {', '.join(d.used_by[:4])}{' …' if len(d.used_by) > 4 else ''}" if d.used_by else ""
        print(f"{mark} {d.name:{width}s}  {d.first or '-':>14s}  {d.second or '-':>14s}{users}")
    print(f"{len(rows)} differences" + (f", {sum(bool(d.used_by) for d in rows)} used by {path}" if path is not None else ""))
    return 0


def _used(path: Path, targets: tuple[str, ...]) -> dict[str, tuple[str, ...]]:
    """Names the workspace declares or uses, to the packages that do."""
    from .check import open_workspace

    used: dict[str, set[str]] = {}
    with open_workspace(path, Options(targets=targets)) as opened:
        for view in opened.views:
            for package in view:
                names = set(view.declared(package))
                for need in view.needs(package):
                    names.update(p.name for p in need.providers[:1])
                for name in names:
                    used.setdefault(name, set()).add(package.name)
                    for library in view.libraries_of(name):
                        used.setdefault(library, set()).add(package.name)
    return {name: tuple(sorted(packages)) for name, packages in used.items()}


def why(name: str, path: Path, targets: tuple[str, ...], format: str) -> int:
    """Prints who provides a name on each target, in which version, since when, and who in the workspace uses it."""
    from .why import answers, as_text

    try:
        found = answers(name, path, targets)
    except _OUR_ERRORS as error:
        return failed(str(error), format)
    if format == "json":
        import json

        _write(json.dumps([a._asdict() for a in found], indent=1))
    else:
        _write(as_text(name, found))
    return 0 if any(a.offers for a in found) else 1


def data_status() -> int:
    """Prints the date and contents of the shipped data."""
    from .targets.build_data import status

    _write(status())
    return 0


def data_build(rosdistro: Path, output: Path, caches: Path | None) -> int:
    """Builds the snapshot from git repositories."""
    from .targets.build_data import build

    try:
        build(rosdistro, output, caches, progress=_step())
    except (*_OUR_ERRORS, OSError) as error:
        return failed(str(error))
    return 0


def data_update() -> int:
    """Refreshes the snapshot over the network."""
    from .targets.build_data import update

    try:
        _write(update(progress=_step()))
    except (*_OUR_ERRORS, OSError) as error:
        return failed(str(error))
    return 0


def _step():
    def show(text: str) -> None:
        print(text, file=sys.stderr)

    return show
