"""What the commands do: options to a report, a report to a stream and an exit status."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Sequence
from contextlib import suppress
from pathlib import Path

from ...edges.console import (
    UserError,
    counted,
    escape_json,
    is_obeyed,
    json_text,
    rewrite,
    run_command,
    say,
    steps,
    visible,
    write,
    write_exactly,
    write_json,
)
from ...edges.files import check_writable_path, outermost, read_file, write_file
from ...edges.limits import limits
from ...edges.version import __version__
from ..analysis.check import Checked
from ..analysis.check import run as run_check
from ..analysis.findings import SettingsError, fails
from ..analysis.report import Coverage, Report
from ..analysis.session import Options
from ..report.style import PLAIN, Style, style_for
from ..tree import WorkingTree, shown

FORMATS = ("text", "json", "sarif", "github", "markdown", "html")
FAIL_ON = ("error", "warning", "note", "never")
_TEXT_OR_JSON = ("text", "json")


_READ_SO_FAR = "interrupted; what was read is kept, and the next run continues from there"
_PARSED_SO_FAR = "interrupted; what was parsed is kept, and the next run continues from there"


def _fail(message: str, format: str, output: Path | None, path: object) -> int:
    """Says why a check failed, in the format asked for too, so that valid JSON is printed all the same. Returns 2."""
    say(f"rosimpact: {message}")
    if format in FORMATS and format != "text":
        text = render(Report(__version__, "", (), (), Coverage(), failure=message), format, notes=False)
        with suppress(UserError):
            try:
                _deliver(text, output, format, path)
            except UserError:
                if output is not None:
                    _print(text, format)
    return 2


def _deliver_answer(
    answer: Callable[[], str],
    format: str = "text",
    known: Sequence[str] = ("text",),
    output: Path | None = None,
    path: object = "",
) -> int:
    """Delivers what a command says, its errors as one line. Returns the exit status: 0, 2 (failed), 130 (interrupted).

    answer: makes the text. known: the formats that the command has. path: what an error without a file of its own is
    about.
    """

    def work() -> int:
        _one_of("--format", format, known)
        _check_output(output, path)
        _deliver(answer(), output, format, path)
        return 0

    return run_command(work, _READ_SO_FAR, path)


def _one_of(option: str, given: str, known: Sequence[str]) -> None:
    """Raises UserError when an option has a value that it does not know."""
    if given not in known:
        raise UserError(f"{option} {given}: unknown; choose one of {', '.join(known)}")


def _say_notes(notes: Iterable[str]) -> None:
    for note in notes:
        say(f"rosimpact: {note}")


def check(
    path: Path, *, targets, format, output, rev, base, select, ignore, fail_on, notes, preview, baseline,
    write_baseline, prune_baseline, fix, diff, config, jobs, quiet, install=None,
    follow_links=False,
) -> int:  # fmt: skip
    """Runs the check and prints its report. Returns the exit status: 0, 1 (findings), 2 (failed) or 130."""

    def work() -> int:
        _one_of("--format", format, FORMATS)
        _one_of("--fail-on", fail_on or FAIL_ON[0], FAIL_ON)
        if prune_baseline and baseline is None:
            raise UserError("--prune-baseline: no baseline was given; name it with --baseline")
        known = _baseline(baseline)
        for file in (output, write_baseline, baseline if prune_baseline else None):
            _check_output(file, path)
        options = Options(
            targets, rev, base, select, ignore, preview, jobs, config, known, install=install,
            follow_links=follow_links,
        )  # fmt: skip
        checked = run_check(path, options, None if quiet else _progress())
        incomplete = False
        if fix and not diff:
            incomplete = not _fixed(path, checked)
            checked = run_check(path, options, None)
        report = checked.report
        if report.failure and (format != "text" or output or diff or write_baseline):
            say(f"rosimpact: {report.failure}")
        if baseline is not None and prune_baseline and report.packages:
            _prune(baseline, known, report, path)
        if write_baseline:
            return _new_baseline(write_baseline, report, path)
        if diff:
            patch, incomplete = _patch(checked, output)
            _deliver(patch, output, "patch", path)
        else:
            _deliver(render(report, format, notes, output, _prefix(path, checked)), output, format, path)
        if format == "github" and not diff:
            _write_step_summary(report)
        if report.failure or incomplete:
            return 2
        return int(fails(report.findings, fail_on or checked.config.fail_on or "error"))

    return run_command(work, _PARSED_SO_FAR, path, lambda message: _fail(message, format, output, path))


def _write_step_summary(report: Report) -> None:
    """Adds to the summary of the step where GitHub runs one. The report is out already, so a failure is but told."""
    from ..report.github import write_step_summary

    try:
        write_step_summary(report, os.environ)
    except OSError as error:
        say(f"rosimpact: the step summary cannot be written: {error.strerror}; check GITHUB_STEP_SUMMARY")


def _baseline(file: Path | None) -> str:
    """The text of a baseline file, checked, so that a wrong one is named before the work starts."""
    if file is None:
        return ""
    from ..analysis.findings import read_baseline

    try:
        text = read_file(file, limits().baseline)
        read_baseline(text)
        return text.decode("utf-8-sig")
    except OSError as error:
        raise UserError(f"{file}: {error.strerror}; write a baseline with --write-baseline {file}") from None
    except (SettingsError, UnicodeDecodeError) as error:
        raise UserError(f"{file}: {error}") from None


def _new_baseline(file: Path, report: Report, path: Path) -> int:
    """Writes all of today's findings, those that an older baseline knows included."""
    from ..analysis.findings import format_baseline, sort_findings

    if not report.packages:
        raise UserError(f"{file}: not written, because nothing was analysed")
    found = sort_findings([*report.findings, *report.known])
    _save(file, format_baseline(found), path)
    say(f"rosimpact: {file}: {counted(len(found), 'finding')}")
    return 2 if report.failure else 0


def _prune(file: Path, known: str, report: Report, path: Path) -> None:
    """Takes what is cured out of a baseline file."""
    from ..analysis.findings import prune_baseline, read_baseline

    text, gone = prune_baseline(read_baseline(known), [*report.findings, *report.known])
    if gone:
        _save(file, text, path)
    say(f"rosimpact: {file}: {gone} fixed, removed")


def _fixed(path: Path, checked: Checked) -> bool:
    """Writes the fixes of a check. Returns whether all that could be made were written."""
    from ..analysis import fix

    if not isinstance(checked.tree, WorkingTree):
        raise UserError("--fix: a revision cannot be changed; remove --rev, or print the changes with --diff")
    applied = _applied(checked)
    done = 0
    for name, data in applied.files.items():
        try:
            fix.write(path, name, data, checked.originals[name])
            done += 1
        except OSError as error:
            say(f"rosimpact: {shown(name)}: not fixed: {error.strerror}")
    for edit, reason in applied.refused:
        say(f"rosimpact: {shown(edit.path)}: not changed: {reason}")
    say(f"{counted(done, 'file')} changed")
    return done == len(applied.files)


def _applied(checked: Checked):
    from ..analysis import fix

    return fix.apply(fix.fixes(finding for finding in checked.report.findings if finding.new), checked.originals.get)


def _patch(checked: Checked, output: Path | None) -> tuple[str, bool]:
    """What the fixes would change, as `git apply` reads it, and whether some of it is left out: a patch holds lines of
    the workspace as they are, so that one which a terminal or CI would obey goes to a file alone."""
    from ..analysis import fix

    applied = _applied(checked)
    for edit, reason in applied.refused:
        say(f"rosimpact: {shown(edit.path)}: not changed: {reason}")
    parts: list[str] = []
    incomplete = False
    for name, data in applied.files.items():
        part = fix.unified_diff(name, checked.originals[name], data)
        if output is None and is_obeyed(part):
            incomplete = True
            say(
                f"rosimpact: {shown(name)}: its changes are not printed, because the lines around them contain "
                "control sequences or CI commands; write them to a file with --output"
            )
        else:
            parts.append(part)
    return "".join(parts), incomplete


def _prefix(path: Path, checked: Checked) -> str:
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
        style = (
            PLAIN._replace(severities=severities) if output else style_for(sys.stdout, severities=severities)
        )
        return text.render(report, style)
    if format == "github":
        from ..report import github

        return github.render(report, prefix)
    if format == "json":
        from ..report import json as reporter
    elif format == "sarif":
        from ..report import sarif as reporter
    elif format == "markdown":
        from ..report import markdown as reporter
    else:
        from ..report import html as reporter
    return reporter.render(report)


def schema() -> int:
    """Prints the JSON schema of the JSON report."""
    from ..report.json import schema as text

    _print(text(), "json")
    return 0


def _deliver(text: str, output: Path | None, format: str, path: object = "") -> None:
    """Writes a text to the file asked for, or to standard output. Raises UserError when that cannot be written."""
    if output is None:
        _print(text, format)
    else:
        _save(output, text, path)


def _save(file: Path, text: str, path: object) -> None:
    """Writes a file that the user named. path: the workspace. Raises UserError."""
    place, beneath = _place_of(file, path)
    try:
        write_file(place, _bytes(text), beneath=beneath)
    except OSError as error:
        raise _cannot_write(file, error) from None


def _check_output(file: Path | None, path: object) -> None:
    """Raises UserError where a file that the user named would be refused, before long work is done for nothing."""
    if file is not None:
        place, beneath = _place_of(file, path)
        try:
            check_writable_path(place, beneath=beneath)
        except OSError as error:
            raise _cannot_write(file, error) from None


def _cannot_write(file: Path, error: OSError) -> UserError:
    return UserError(f"{visible(str(file))}: cannot be written: {error.strerror}; give another file")


def _place_of(file: Path, path: object) -> tuple[str, str | None]:
    """(path to write to, folder that must hold it without links in between).

    What lies in the workspace, or in the repository around it, around the current folder or around the file itself, was
    made by whoever made those: a link in them must not say where a report goes. None elsewhere, where folders are the
    user's own.
    """
    name = os.fspath(file)
    if not os.path.isabs(name):
        name = os.path.join(os.getcwd(), name)
    folders = [os.fspath(path)] if isinstance(path, str | os.PathLike) and path != "" else []
    folders += [found for folder in (*folders, ".") if (found := _repository_of(os.path.realpath(folder)))]
    folders += [found] if (found := _repository_of(os.path.dirname(os.path.abspath(name)))) else []
    beneath = outermost(name, folders)
    return (name, None) if beneath is None else (os.path.abspath(name), beneath)


def _repository_of(place: str) -> str:
    """The nearest folder with a `.git` in it, from an absolute path upwards; empty when there is none."""
    while not os.path.lexists(os.path.join(place, ".git")):
        place, last = os.path.dirname(place), place
        if place == last:
            return ""
    return place


def _bytes(text: str) -> bytes:
    return (text if text.endswith("\n") or not text else text + "\n").encode("utf-8", "surrogateescape")


_PRINTERS: dict[str, Callable[[str], None]] = {
    "json": write_json, "sarif": write_json, "html": write_exactly, "graphml": write_exactly, "dot": write_exactly,
    "github": write_exactly, "patch": write_exactly,
}  # fmt: skip
"""Formats whose makers escape what they hold; all others are for people."""


def _print(text: str, format: str) -> None:
    """Prints a text on standard output. Who reads no further has read enough: the exit status stays what it is. Raises
    UserError when it cannot be written."""
    with suppress(BrokenPipeError):
        _PRINTERS.get(format, write)(text)


def _progress() -> Callable[[int, int], None] | None:
    """A line on standard error that is rewritten while files are parsed; None when nobody watches."""
    if sys.stderr is None or not sys.stderr.isatty():
        return None

    def show(done: int, total: int) -> None:
        share = 100 * done // max(1, total)
        rewrite("" if done >= total else f"parsing {share:3d} % of {total / 1e6:.1f} MB", ended=False)

    return show


GRAPH_FORMATS = ("text", "json", "graphml", "dot", "mermaid", "html")


def graph_schema() -> int:
    """Prints the JSON schema of the graph's JSON."""
    from ..report.graph.json import schema as text

    _print(text(), "json")
    return 0


def graph(
    path: Path, *, launch, arguments, nodes, topics, packages, around, hops, rev, base, format, output, everything,
    jobs, quiet, follow_links=False,
) -> int:  # fmt: skip
    """Draws the message-flow graph. Returns the exit status: 0, or 2 (failed)."""

    def answer() -> str:
        given = dict(argument.partition(":=")[::2] for argument in arguments)
        if any(":=" not in argument for argument in arguments):
            raise UserError("--set: write NAME:=VALUE")
        if given and not launch:
            raise UserError("--set: arguments belong to a launch file; name it with --launch")
        from ..analysis.graph import graphs
        from ..report.graph import draw

        found = graphs(
            path, rev=rev, base=base, launch=launch, arguments=given, jobs=jobs,
            progress=None if quiet else _progress(), follow_links=follow_links,
        )  # fmt: skip
        _say_notes(found.notes)
        return draw(
            found.now, format, found.before, nodes=nodes, topics=topics, packages=packages, around=around,
            hops=hops, everything=everything, style=_style(output),
        )  # fmt: skip

    return _deliver_answer(answer, format, GRAPH_FORMATS, output, path)


IMPACT_FORMATS = ("text", "json", "markdown")


def impact_schema() -> int:
    """Prints the JSON schema of the JSON of `impact`."""
    from ..report.impact import schema as text

    _print(text(), "json")
    return 0


def impact(
    path: Path, *, base, rev, packages, topics, nodes, format, output, everything, jobs, quiet, follow_links=False
) -> int:  # fmt: skip
    """Prints what the changes since a base reach. Returns the exit status: 0, or 2 (failed)."""

    def answer() -> str:
        if not base:
            raise UserError("--base: missing; give the revision to compare with, such as origin/main")
        from ..analysis.downstream import chosen
        from ..analysis.impact import reached
        from ..report import impact as impact_report

        progress = None if quiet else _progress()
        found = reached(path, base, rev=rev, jobs=jobs, progress=progress, follow_links=follow_links)
        _say_notes(found.notes)
        part = chosen(found.impact, packages, topics, nodes)
        if format == "json":
            return impact_report.as_json(part, impact_report.Told(__version__, found.root, found.rev, found.base))
        if format == "markdown":
            return impact_report.markdown(part)
        return impact_report.text(part, everything, _style(output))

    return _deliver_answer(answer, format, IMPACT_FORMATS, output, path)


def upgrade_schema() -> int:
    """Prints the JSON schema of the JSON of `upgrade`."""
    from ..report.upgrade import schema as text

    _print(text(), "json")
    return 0


def upgrade(
    path: Path, old: str, new: str, *, packages, rev, config, format, output, fail_on, jobs, quiet, follow_links=False
) -> int:  # fmt: skip
    """Prints what an upgrade breaks. Returns the exit status: 0 (safe), 1 (something breaks) or 2 (failed)."""
    from ..report import upgrade as report

    breaks = False

    def answer() -> str:
        nonlocal breaks
        _one_of("--fail-on", fail_on or FAIL_ON[0], FAIL_ON)
        from ..analysis.upgrade import upgrade as compare

        options = Options(rev=rev, config=config, jobs=jobs, follow_links=follow_links)
        found = compare(path, old, new, options, packages, None if quiet else _progress())
        breaks = fails(found.brought, fail_on or found.fail_on or "error")
        if format == "json":
            return report.as_json(found)
        return report.as_html(found) if format == "html" else report.text(found, _style(output))

    return _deliver_answer(answer, format, report.FORMATS, output, path) or int(breaks)


LOGIC_FORMATS = ("text", "json", "html")


def logic(
    path: Path, *, range, number, since, packages, topics, everything, format, output, jobs, quiet
) -> int:  # fmt: skip
    """Prints where the logic of publishing changed. Returns the exit status: 0, or 2 (failed)."""

    def answer() -> str:
        from ..facts.store import Store
        from ..logic import repository as history
        from ..report import logic as logic_report
        from ..report import timeline

        with Store() as store:
            try:
                asked = history.Range(range, number, since)
                found = history.read(os.fspath(path), asked, store, jobs, None if quiet else steps())
            except ValueError as error:
                raise UserError(f"--since: {error}") from None
            _say_notes(store.notes)
        all_of_it, found = found, history.chosen(found, packages, topics, everything)
        missed = logic_report.missed(all_of_it, found, packages, topics)
        _say_notes([missed] if missed else [])
        if format == "html":
            return timeline.render(found, __version__)
        if format == "json":
            return logic_report.as_json(found, __version__)
        return logic_report.text(found, _style(output))

    return _deliver_answer(answer, format, LOGIC_FORMATS, output, path)


def _style(output: Path | None) -> Style:
    """How text is written: for the terminal that reads it; in a file or a pipe, lines are as long as they are."""
    from ..report.columns import UNBROKEN

    if output is not None:
        return PLAIN._replace(width=UNBROKEN)
    style = style_for(sys.stdout)
    return style if sys.stdout.isatty() else style._replace(width=UNBROKEN)


def surface_show(what: str, *, repos, all_of_it, format, output, jobs) -> int:
    """Prints what a version of a package offers. Returns the exit status: 0, or 2 (failed)."""
    from ..report import surface as report

    def answer(store) -> str:
        package, _, asked = what.partition("@")
        source, state = _surface(package, asked, repos, store, jobs)
        surface, hashes = state.surfaces[package], _hashes(package, source.asked, state)
        if format == "json":
            return report.show_json(surface, source, __version__, hashes)
        if format == "markdown":
            return report.show_markdown(surface, source, hashes)
        return report.show_text(surface, source, _style(output), all_of_it, hashes)

    return _of_surfaces(answer, format, output)


def surface_diff(what: str, old: str, new: str, *, repos, packages, all_of_it, format, output, jobs) -> int:
    """Prints what changed between two versions of a package, or of all packages of a clone. Returns the exit status:
    0, or 2 (failed)."""
    from ..report import surface as report

    def answer(store) -> str:
        from ..model.surface.clones import Clone
        from ..targets.surface.compare import State, compare, compare_states

        if os.path.isdir(what) and repos is None:
            clone = Clone(Path(what))
            states = [State(clone.surfaces(revision, store, jobs)) for revision in (old, new)]
            changes = compare_states(*states)
            unknown = [name for name in packages if name not in changes]
            if unknown:
                raise UserError(f"--packages {unknown[0]}: {clone.name} has no such package at {old} or {new}")
            changes = {name: each for name, each in changes.items() if (name in packages if packages else each)}
            sources = [report.Source(revision, "", clone.name, revision) for revision in (old, new)]
        else:
            (first, before), (second, after) = (_surface(what, asked, repos, store, jobs) for asked in (old, new))
            changes = {what: compare(before.surfaces[what], after.surfaces[what], before, after)}
            sources = [first, second]
            old_hashes, new_hashes = _hashes(what, first.asked, before), _hashes(what, second.asked, after)
            changes[what] = tuple(
                report.with_hashes(change, old_hashes, new_hashes) if change.kind == "wire" else change
                for change in changes[what]
            )
        found = report.Difference(sources[0], sources[1], changes)
        if format == "json":
            return report.diff_json(found, __version__)
        return (
            report.diff_markdown(found) if format == "markdown" else report.diff_text(found, _style(output), all_of_it)
        )

    return _of_surfaces(answer, format, output)


def surface_build(*, distros, repos, packages, all_versions, output, jobs, dask, quiet) -> int:
    """Writes the surfaces of released packages to a file. Returns the exit status: 0, or 2 (failed)."""

    def answer() -> str:
        from ...databuild.surfaces import all_distros, build
        from ..model.surface.clones import Clones

        if not distros:
            raise UserError("--distro: missing; name the distros to read, such as --distro humble --distro jazzy")
        if dask is not None and jobs is not None:
            raise UserError("--jobs: has no effect with --dask, which uses a cluster; give only one of the two")
        _check_output(output, "")
        report = None if quiet else steps()
        versions = "all" if all_versions else "newest"
        built = build(Clones(repos), all_distros(distros), output, packages, jobs, report, versions=versions, dask=dask)
        if not built.packages:
            raise UserError(f"{repos}: no clone has a package asked for; clone repositories there, with their tags")
        _say_notes(built.failed)
        told_of = f"{counted(built.packages, 'package')}, {counted(built.versions, 'version')}"
        return (
            f"{output}: {told_of}, {output.stat().st_size:,} bytes; "
            f"{built.approximate} with a branch for a missing tag, {len(built.missing)} without a clone"
        )

    return _deliver_answer(answer, path=output)


def _surface(package: str, asked: str, repos: Path | None, store, jobs):
    """Where a version of a package was found, and its state: in clones, else in what is shipped."""
    from ..model.surface.clones import Clones
    from ..model.surface.installed import is_installed, surface_at
    from ..model.surface.stored_versions import StoredVersions
    from ..report.surface import Source
    from ..targets.surface.store import shipped

    if is_installed(asked):
        surface, state = surface_at(package, asked)
        return Source(asked, surface.version, asked, "installed"), state
    if repos is None:
        versions = StoredVersions(shipped())
        asked = asked or versions.newest(package)
        stored, state = versions.surface(package, asked)
        return Source(asked, stored.version, "the shipped surfaces", stored.stored, stored.approximate), state
    clones = Clones(repos)
    asked = asked or clones.newest(package)
    found, state = clones.surface(package, asked, store, jobs)
    revision = found.revision.removeprefix("refs/").partition("/")[2] or found.revision
    return Source(asked, found.version, found.clone.name, revision, found.approximate), state


def _hashes(package: str, asked: str, state) -> dict[str, str]:
    """The hashes of a package's interfaces, by `msg/Name`, as far as all that is in them is known: in the state of its
    repository, or of other packages of the distro that was asked for."""
    from ..model.surface.installed import is_installed
    from ..model.surface.stored_versions import StoredVersions
    from ..targets.hashes import hash_of
    from ..targets.surface.store import shipped

    others = None if asked[:1].isdigit() or is_installed(asked) else StoredVersions(shipped())

    def find(name: str):
        owner, _, short = name.partition("/")
        if owner in state.surfaces:
            return dict(state.surfaces[owner].interfaces).get(f"msg/{short}")
        return others.message(asked, name) if others is not None else None

    surface = state.surfaces[package]
    ros = 2 if surface.build.build_type.startswith("ament") else 1
    known = ((name, hash_of(f"{package}/{name}", ros, definition, find)) for name, definition in surface.interfaces)
    return {name: told for name, told in known if told is not None}


def _of_surfaces(answer: Callable, format: str, output: Path | None) -> int:
    """Delivers what a command on surfaces says."""
    from ..report.surface import FORMATS as known

    def with_store() -> str:
        from ..facts.store import Store

        with Store() as store:
            text = answer(store)
            _say_notes(store.notes)
        return text

    return _deliver_answer(with_store, format, known, output)


def explain(name: str | None) -> int:
    """Prints the documentation of a rule or group, or the list of them. Returns the exit status: 0, or 2 (no such
    rule)."""
    from ..rules import explain as pages
    from ..rules.rule import all_rules

    rules = all_rules()
    try:
        text = pages.list_rules(rules) if name is None else pages.explain(name, rules)
    except KeyError as error:
        say(f"rosimpact: {error.args[0]}")
        return 2
    return _deliver_answer(lambda: text)


def env_capture(output: Path | None) -> int:
    """Writes this machine as a target."""

    def work() -> int:
        from ..targets.capture import capture, to_json

        _check_output(output, "")
        machine = capture()
        _deliver(to_json(machine), output, "json")
        if not machine.distro:
            say("rosimpact: no ROS distro was found here; set `distro` in the file before you use it as a target")
        if output is not None:
            say(f"rosimpact: {output}: written; use it with --target {output}")
        return 0

    return run_command(work, "interrupted; nothing was written", "this machine")


def env_diff_schema() -> int:
    """Prints the JSON schema of the JSON of `env diff`."""
    from ..report.machines import schema as text

    _print(text(), "json")
    return 0


def env_diff(first: str, second: str, path: Path | None, format: str, output: Path | None = None) -> int:
    """Prints what differs between two targets; beside a workspace, what matters to it. Returns the exit status: 0, or 2
    (failed)."""
    from ..report import machines as report

    def answer() -> str:
        from ..analysis.machine_compare import machines

        found = machines(first, second, path)
        return report.as_json(found, __version__) if format == "json" else report.text(found, _style(output))

    return _deliver_answer(answer, format, report.FORMATS, output, path or "")


def why(
    name: str, path: Path | None, targets: tuple[str, ...], format: str, *, follow_links: bool = False
) -> int:  # fmt: skip
    """Prints who provides a name on each target, in which version, since when, and who in the workspace uses it; that
    of the current folder when no path is given, if it is one. Returns 1 when nobody provides it on some target."""
    unanswered = False

    def answer() -> str:
        nonlocal unanswered
        from ..analysis.why import answers, as_text, is_workspace

        here = path or Path()
        looked = path is not None or is_workspace(here)
        found = answers(name, here if looked else None, targets, follow_links=follow_links)
        answered = {a.target for a in found if any(offer.kind != "absent" for offer in a.offers)}
        unanswered = answered != {a.target for a in found}
        if format == "text":
            return as_text(name, found, looked=looked)
        return json_text(
            [answer._asdict() | {"offers": [offer._asdict() for offer in answer.offers]} for answer in found]
        )

    return _deliver_answer(answer, format, _TEXT_OR_JSON, path=path or Path()) or int(unanswered)


def data_status(format: str = "text") -> int:
    """Prints date, origin and contents of the distro data in use."""

    def answer() -> str:
        from ...databuild.snapshot import status

        found = status()
        if format == "json":
            import json

            return escape_json(json.dumps(found._asdict(), indent=1, default=str, ensure_ascii=False))
        origin = "updated" if found.updated else "shipped with rosimpact"
        lines = [f"distro data of {found.date}, {origin}, {found.packed / 1e6:.1f} MB, in {found.folder}"]
        lines += [f"from {name} {commit}" for name, commit in found.sources.items()]
        if found.last_syncs:
            newest = ", ".join(f"{name} {day}" for name, day in sorted(found.last_syncs.items()))
            lines.append(f"newest syncs: {newest}")
        kept = found.surfaces
        told_of = f"{counted(kept['packages'], 'package')}, {counted(kept['versions'], 'version')}"
        lines.append(f"surfaces of {told_of}, as of {kept['date']}, of {kept['distros']}")
        return "\n".join(lines)

    return _deliver_answer(answer, format, _TEXT_OR_JSON)


def data_build(rosdistro: Path, output: Path, work: Path | None, meta_ros: Path | None) -> int:
    """Builds the snapshot from git repositories."""

    def build_it() -> int:
        from ...databuild.snapshot import build
        from ..cache import cache_folder

        built = build(rosdistro, output, work or cache_folder() / "build", meta_ros, steps())
        _print(
            f"data of {built.date} in {output}: {counted(built.releases, 'release')}, "
            f"{counted(built.manifests, 'manifest')}, {counted(built.rules, 'rosdep rule')}, "
            f"{built.packed / 1e6:.1f} MB ({built.unpacked / 1e6:.1f} MB unpacked)",
            "text",
        )
        for name, count in built.unreadable.items():
            say(f"rosimpact: {name}: {counted(count, 'version')} of its distribution file could not be read")
        return 0

    return run_command(build_it, _READ_SO_FAR, rosdistro)


def data_update() -> int:
    """Refreshes the snapshot over the network."""

    def work() -> int:
        from ...databuild.snapshot import update

        found = update(report=steps())
        for failure in found.failures:
            say(f"rosimpact: not updated: {failure}")
        _print(
            f"data of {found.date} in {found.folder}: {counted(len(found.syncs), 'new sync')}, "
            f"{counted(found.releases, 'release')}, {counted(found.manifests, 'manifest')}, "
            f"{counted(found.rules, 'rosdep rule')}",
            "text",
        )
        return 0

    return run_command(work, "interrupted; the data in use stays", "the distro data")
