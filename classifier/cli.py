"""`rosimpact triage` and `rosimpact classifier`: thin, imports late."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable, Collection
from pathlib import Path
from typing import IO, Annotated

import typer

app = typer.Typer(help="The triage model: train it anew, measure it.", no_args_is_help=True, rich_markup_mode=None)


def triage(
    context: typer.Context,
    report: Annotated[
        str, typer.Argument(help="The report: its text, a file, the address of an issue or question, or - for input.")
    ],
    format: Annotated[str, typer.Option("--format", "-f", help="text or json.")] = "text",
    jsonl: Annotated[
        bool,
        typer.Option("--jsonl", help="The file or input is JSON Lines with id, title, body; so is the output."),
    ] = False,
    model: Annotated[Path | None, typer.Option(help="Another model than the shipped one.")] = None,
) -> None:
    """Say what a bug report is about, how sure that is, which known reports are like it, and what to run next.

    A text's first line is the title. Input whose first line is JSON with `title` or `body` is taken as JSON Lines.
    """
    from .model import ClassifierError

    root = context.find_root().command
    commands = frozenset(getattr(root, "commands", ()))
    try:
        _format(format)
        _triage(report, format, jsonl, model, commands)
    except ClassifierError as error:
        _fail(str(error))


def _triage(report: str, format: str, jsonl: bool, file: Path | None, commands: Collection[str]) -> None:
    from .model import ClassifierError, load
    from .triage import as_json, as_text, from_argument, from_text, post_of, triage_all
    from .triage import triage as judge

    found = from_argument(report)
    model = load(file)
    if found is None or isinstance(found, Path):
        name = "standard input" if found is None else str(found)
        try:
            with _text_of(found) as stream:
                first = stream.readline()
                if jsonl or (first.lstrip().startswith("{") and post_of(first) is not None):
                    triage_all(model, _chain(first, stream), name)
                    return
                text = first + stream.read()
                if found is not None and "\0" in text:
                    raise ClassifierError(f"{name}: is no text; give a report as text or as JSON Lines")
                found = from_text(text, name)
        except OSError as error:
            raise ClassifierError(f"{name}: cannot be read: {error.strerror}; give another file") from None
    elif jsonl:
        raise ClassifierError("--jsonl: needs a file or - for standard input; leave it out for one report")
    if not (found.title or found.body):
        raise ClassifierError("the report is empty; give a text, a file, an address or - for standard input")
    answer = judge(model, found, commands)
    _write(as_json(answer) + "\n" if format == "json" else as_text(answer))


def _chain(first: str, rest: IO[str]):
    yield first
    yield from rest


def _text_of(file: Path | None) -> IO[str]:
    if file is None:
        return io.TextIOWrapper(sys.stdin.buffer, "utf-8", "replace")
    return file.open(encoding="utf-8", errors="replace")


@app.command()
def train(
    reports: Annotated[Path, typer.Option(help="The texts: a store of `rosimpact corpus`, or JSON Lines.")],
    labels: Annotated[
        Path | None, typer.Option(help="JSON Lines of labels; those of the corpus when left out.")
    ] = None,
    output: Annotated[Path, typer.Option("--output", "-o", help="The model to write.")] = Path("model.npz"),
    seed: Annotated[int, typer.Option(help="Of the splits that calibrate it.")] = 20,
) -> None:
    """Train a model on labelled reports; the same reports give the same model."""
    from .model import ClassifierError

    try:
        from .training import examples
        from .training import train as fit

        progress = _progress()
        model = fit(examples(_labels(labels), reports, progress), seed, progress)
        model.save(output)
    except ClassifierError as error:
        _fail(str(error))
    except KeyboardInterrupt:
        _interrupted()
    else:
        about = model.about
        _write(
            f"{output}: {about['reports']:,} reports, {len(model.labels)} labels, "
            f"abstains below {model.threshold:.2f}\n"
            f"labels {about['labels_digest']}\ntexts  {about['texts_digest']}\n"
        )


@app.command()
def evaluate(
    reports: Annotated[Path, typer.Option(help="The texts: a store of `rosimpact corpus`, or JSON Lines.")],
    labels: Annotated[
        Path | None, typer.Option(help="JSON Lines of labels; those of the corpus when left out.")
    ] = None,
    format: Annotated[str, typer.Option("--format", "-f", help="text or json.")] = "text",
    seed: Annotated[int, typer.Option(help="Of the splits and the intervals.")] = 20,
    ablations: Annotated[bool, typer.Option(help="Also measure what each part of it is worth.")] = True,
) -> None:
    """Measure the classifier on labelled reports, judging each by a model that has not seen its repository."""
    import json

    from .model import ClassifierError

    try:
        _format(format)
        from .evaluate import as_text
        from .evaluate import evaluate as measure
        from .training import examples

        progress = _progress()
        found = examples(_labels(labels), reports, progress)
        result = measure(found, seed=seed, ablations=ablations, progress=progress)
    except ClassifierError as error:
        _fail(str(error))
    except KeyboardInterrupt:
        _interrupted()
    else:
        _write(json.dumps(result, indent=1) + "\n" if format == "json" else as_text(result))


def _labels(file: Path | None) -> Path:
    from ..corpus.report import LABELS_FILE

    return file or LABELS_FILE


def _format(format: str) -> None:
    from .model import ClassifierError

    if format not in ("text", "json"):
        raise ClassifierError(f"--format {format}: unknown; choose text or json")


def _fail(message: str) -> None:
    print(f"rosimpact: {message.encode('utf-8', 'backslashreplace').decode()}", file=sys.stderr)
    raise typer.Exit(2)


def _interrupted() -> None:
    print("rosimpact: interrupted; nothing was written", file=sys.stderr)
    raise typer.Exit(130)


def _write(text: str) -> None:
    sys.stdout.flush()
    sys.stdout.buffer.write(text.encode("utf-8", "backslashreplace"))
    sys.stdout.flush()


def _progress() -> Callable[[str, int, int], None]:
    """A line on standard error: rewritten on a terminal, one a step elsewhere."""
    last = ""

    def show(what: str, done: int, total: int) -> None:
        nonlocal last
        if sys.stderr.isatty():
            sys.stderr.write(f"\r\x1b[K{what} {done}/{total}" + ("\n" if done >= total else ""))
            sys.stderr.flush()
        elif what != last:
            print(what, file=sys.stderr)
        last = what

    return show
