"""`rosimpact triage` and `rosimpact classifier`: thin, imports late."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Annotated

import typer

app = typer.Typer(help="The triage model: train it anew, measure it.", no_args_is_help=True, rich_markup_mode=None)

_Reports = Annotated[Path, typer.Option(help="The texts: a store of `rosimpact corpus`, or JSON Lines.")]
_Labels = Annotated[Path | None, typer.Option(help="JSON Lines of labels; those of the corpus when left out.")]
_Format = Annotated[str, typer.Option("--format", "-f", help="text or json.")]


def triage(
    report: Annotated[
        str, typer.Argument(help="The report: its text, a file, the address of an issue or question, or - for input.")
    ],
    format: _Format = "text",
    jsonl: Annotated[
        bool,
        typer.Option("--jsonl", help="The file or input is JSON Lines with id, title, body; so is the output."),
    ] = False,
    model: Annotated[Path | None, typer.Option(help="Another model than the shipped one.")] = None,
) -> None:
    """Say what a bug report is about, how sure that is, which known reports are like it, and what to run next.

    A text's first line is the title. Input whose first line is JSON with `title` or `body` is taken as JSON Lines.
    """

    def work() -> None:
        _format(format)
        with _convert_errors():
            _triage(report, format, jsonl, model)

    _end(work, "interrupted")


def _triage(report: str, format: str, jsonl: bool, file: Path | None) -> None:
    from itertools import chain

    from ..edges.files import make_size_error
    from ..edges.limits import get_limits
    from .model import ClassifierError, load
    from .triage import interpret_argument, make_post, parse_post, render_json, render_triage, triage_all
    from .triage import triage as judge

    own = load(file) if file else None  # before an address is asked in vain
    found = interpret_argument(report)
    model = own or load()
    if found is None or isinstance(found, Path):
        name = "standard input" if found is None else str(found)
        try:
            with _open_text(found) as stream:
                lines = _read_lines(stream, name)
                first = next(lines, "")
                if jsonl or (first.lstrip().startswith("{") and parse_post(first) is not None):
                    triage_all(model, chain([first], lines), name)
                    return
                text = first + stream.read(get_limits().text)
                if stream.read(1):
                    raise make_size_error(name, get_limits().text)
                if found is not None and "\0" in text:
                    raise ClassifierError(f"{name}: is no text; give a report as text or as JSON Lines")
                found = make_post(text, name)
        except BrokenPipeError:
            raise  # of whoever reads the answers
        except OSError as error:
            raise ClassifierError(f"{name}: cannot be read: {error.strerror}; give another file") from None
    elif jsonl:
        raise ClassifierError("--jsonl: needs a file or - for standard input; leave it out for one report")
    if not (found.title or found.body):
        raise ClassifierError("the report is empty; give a text, a file, an address or - for standard input")
    answer = judge(model, found)
    _print(render_json(answer) if format == "json" else render_triage(answer), format)


def _read_lines(stream: IO[str], name: str) -> Iterator[str]:
    """The lines of a stream, of which none may be longer than a text. Raises OSError."""
    from ..edges.files import make_size_error
    from ..edges.limits import get_limits

    while line := stream.readline(get_limits().text + 1):
        if len(line) > get_limits().text:
            raise make_size_error(name, get_limits().text)
        yield line


def _open_text(file: Path | None) -> IO[str]:
    """A file, or standard input, as text without a byte-order mark. Raises OSError."""
    from ..edges.files import open_regular

    source = sys.stdin.buffer if file is None else os.fdopen(open_regular(file), "rb")
    return io.TextIOWrapper(source, "utf-8-sig", "replace")


def suggest_label(title: str, body: str) -> tuple[str, dict[str, float]]:
    """The likeliest label of a report and the probability of each, by the shipped model. Raises UserError."""
    from .triage import suggest

    return suggest(title, body)


@app.command()
def train(
    reports: _Reports,
    labels: _Labels = None,
    output: Annotated[Path, typer.Option("--output", "-o", help="The model to write.")] = Path("model.npz"),
    seed: Annotated[int, typer.Option(help="Of the splits that calibrate it.")] = 20,
) -> None:
    """Train a model on labelled reports; the same reports give the same model."""

    def work() -> None:
        from ..corpus.outputs import need_file
        from ..edges.console import format_count, make_step_reporter

        need_file(output)
        file = _find_labels(labels, reports)
        with _convert_errors():
            from .training import read_examples
            from .training import train as fit

            progress = make_step_reporter()
            made = fit(read_examples(file, reports, progress), seed, progress)
            made.save(output)
        about = made.about
        _print(
            f"{output}: {format_count(about['reports'], 'report')}, {format_count(len(made.labels), 'label')}, "
            f"abstains below {made.threshold:.2f}\n"
            f"labels {about['labels_digest']}\ntexts  {about['texts_digest']}\n",
            "text",
        )

    _end(work)


@app.command()
def evaluate(
    reports: _Reports,
    labels: _Labels = None,
    format: _Format = "text",
    seed: Annotated[int, typer.Option(help="Of the splits and the intervals.")] = 20,
    ablations: Annotated[bool, typer.Option(help="Also measure what each part of it is worth.")] = True,
) -> None:
    """Measure the classifier on labelled reports, judging each by a model that has not seen its repository."""

    def work() -> None:
        from ..edges.console import make_step_reporter

        _format(format)
        file = _find_labels(labels, reports)
        with _convert_errors():
            from .evaluate import evaluate as measure
            from .evaluate import render_text
            from .training import read_examples

            progress = make_step_reporter()
            found = read_examples(file, reports, progress)
            result = measure(found, seed=seed, ablations=ablations, progress=progress)
        if format == "json":
            import json

            _print(json.dumps(result, indent=1), format)
        else:
            _print(render_text(result), format)

    _end(work)


def _find_labels(file: Path | None, reports: Path) -> Path:
    """The file of the labels. It and the reports are looked into before scikit-learn is imported, which takes seconds.
    Raises CorpusError when one cannot be read."""
    from ..corpus.report import LABELS_FILE, read_labels
    from ..corpus.store import open_reports

    labels = file or LABELS_FILE
    read_labels(labels)
    next(open_reports(reports), None)
    return labels


def _format(format: str) -> None:
    from ..corpus.report import CorpusError

    if format not in ("text", "json"):
        raise CorpusError(f"--format {format}: unknown; choose text or json")


@contextmanager
def _convert_errors() -> Iterator[None]:
    """What the classifier cannot do ends a command as what the corpus cannot do does."""
    from ..corpus.report import CorpusError
    from .model import ClassifierError

    try:
        yield
    except ClassifierError as error:
        raise CorpusError(str(error)) from None


def _end(work: Callable[[], None], interrupted: str = "interrupted; nothing was written") -> None:
    """Runs a command's work and ends it: what fails is one line on standard error, and no traceback."""
    from ..edges.console import run_command

    raise typer.Exit(run_command(lambda: work() or 0, interrupted, "the classifier"))


def _print(text: str, format: str) -> None:
    from ..edges.console import escape_json, write, write_json

    if format == "json":
        write_json(escape_json(text))
    else:
        write(text)
