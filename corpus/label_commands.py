"""What the commands on labels do: options to a session, a table or a file, and an exit status."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from ..edges.console import escape, escape_json, format_count, format_json, run_command, say, write, write_json
from .report import LABELS_FILE, SOURCES, BugReport, CorpusError, find_repository

if TYPE_CHECKING:
    from .labelling import Suggest

FORMATS = ("text", "json")


def label(
    reports: Path | None, labels: Path | None, annotator: str, mode: str, sources: Sequence[str],
    repositories: Sequence[str], listed: bool, suggest: Suggest,
) -> int:  # fmt: skip
    """Opens the labelling screen, or lists what it would show. Returns the exit status."""
    return run_command(
        lambda: _label(reports, labels, annotator, mode, sources, repositories, listed, suggest),
        "interrupted; every answer given is saved",
    )


def _label(
    reports: Path | None, labels: Path | None, annotator: str, mode: str, sources: Sequence[str],
    repositories: Sequence[str], listed: bool, suggest: Suggest,
) -> int:  # fmt: skip
    for source in sources:
        if source not in SOURCES:
            raise CorpusError(f"--source {source}: unknown; choose one of {', '.join(SOURCES)}")
    file = labels or _find_own_labels()
    name = annotator.strip() or _find_login()
    from .labelling import Session, find_journal, read_current_labels, read_journal, select_offered, select_reports

    if not listed:
        from .label_screen import need_terminal

        need_terminal()
    there = _load_reports(reports)
    _need_repositories(repositories, there)
    texts = select_reports(there, sources, repositories)
    if listed:
        found = read_current_labels(file)
        shown = select_offered(texts, found, read_journal(find_journal(file)), mode, name)
        for report in shown:
            known = found.get(report.id)
            given = "\t" + " / ".join(known.annotators) if known and mode == "disagreements" else ""
            write(f"{escape(report.id)}{given}\t{_format_line(report.title)}")
        say(f"{len(shown):,} of {format_count(len(texts), 'report')}")
        return 0
    from .label_screen import run

    with Session(file, name, mode, texts) as session:
        if not session.queue:
            say(_explain_empty(mode, texts))
            return 0
        run(session, suggest)
        done, left = session.done, len(session.queue)
    say(f"{done:,} answered, {left:,} left; labels in {file}")
    return 0


def _explain_empty(mode: str, texts: list[BugReport]) -> str:
    if not texts:
        return "no report is left by --source and --repository; leave one of them out"
    kind = {"first": "unlabelled", "second": "read by one annotator other than you", "disagreements": "disputed"}[mode]
    return f"none of {format_count(len(texts), 'report')} is {kind}"


def _need_repositories(names: Sequence[str], reports: list[BugReport]) -> None:
    """Raises CorpusError for a repository of which there is no report: its name is misspelt, or it is not gathered."""
    there = {find_repository(report.id) for report in reports} if names else set()
    for name in names:
        if name.lower() not in there:
            raise CorpusError(
                f"--repository {name}: no report is of it; check the name, or gather it with "
                f"`rosimpact corpus gather github:{name}`"
            )


def _find_own_labels() -> Path:
    """The labels of the corpus, where this is a checkout; an installed copy would be lost at the next upgrade."""
    if (LABELS_FILE.parents[1] / "pyproject.toml").exists():
        return LABELS_FILE
    raise CorpusError("label: no file for the labels; give one with --labels, it is made when it is not there")


def _load_reports(chosen: Path | None) -> list[BugReport]:
    from .store import open_reports, store_path

    path = store_path(chosen)
    if chosen is None and not path.exists():
        raise CorpusError("no reports at hand; gather some with `rosimpact corpus gather`, or give --reports FILE")
    return list(open_reports(path))


def _find_login() -> str:
    import getpass

    try:
        return getpass.getuser()
    except (OSError, KeyError):
        raise CorpusError("label: nobody knows who you are; give a name with --annotator") from None


def _format_line(text: str) -> str:
    return escape(" ".join(text.split()))


def print_stats(labels: Path | None, reports: Path | None, format: str, plots: Path | None) -> int:
    """Prints the numbers of labels, and draws them into a folder. Returns the exit status."""
    return run_command(lambda: _print_stats(labels, reports, format, plots))


def _print_stats(labels: Path | None, reports: Path | None, format: str, plots: Path | None) -> int:
    if format not in FORMATS:
        raise CorpusError(f"--format {format}: unknown; choose text or json")
    if plots is not None:
        from .plots import need_plots

        need_plots(plots)
    from .labelling import read_current_labels
    from .stats import compute_stats, print_text, render_json
    from .store import open_reports, store_path

    file = labels or LABELS_FILE
    if not file.exists():
        raise CorpusError(f"{file}: is not there; give a labels file with --labels")
    found = list(read_current_labels(file).values())
    path = store_path(reports)
    texts = open_reports(path) if reports is not None or path.exists() else None
    numbers = compute_stats(found, texts)
    if format == "json":
        write_json(escape_json(render_json(numbers)))
    else:
        print_text(numbers)
    if plots is not None:
        from .plots import draw

        written = draw(numbers, plots)
        say(f"{format_count(len(written), 'plot')} in {plots}")
    return 0


def import_robust(folder: Path, output: Path | None, format: str) -> int:
    """Prints what ROBUST's records map to, and writes those with a label to a file. Returns the exit status."""
    return run_command(lambda: _import_robust(folder, output, format))


def _import_robust(folder: Path, output: Path | None, format: str) -> int:
    if format not in FORMATS:
        raise CorpusError(f"--format {format}: unknown; choose text or json")
    from .report import write_rows
    from .robust import CONFIDENCES, make_rows, read_robust, summarize

    records = read_robust(folder)
    say(records.licence)
    for path, fault in records.unreadable:
        say(f"rosimpact: {path}: passed over: {fault}")
    if format == "json":
        import msgspec

        write_json(format_json(msgspec.to_builtins(records.mapped)))
    else:
        write(f"{'':16}{''.join(f'{name:>10}' for name in CONFIDENCES)}")
        for name, counts in summarize(records.mapped).items():
            write(f"{name:16}{''.join(f'{counts[level]:>10,}' for level in CONFIDENCES)}")
        write(format_count(len(records.mapped), "record"))
    if output is not None:
        written = write_rows(output, make_rows(records.mapped))
        say(f"{output}: {format_count(written, 'label')}; texts come with `rosimpact corpus hydrate --labels {output}`")
    return 0
