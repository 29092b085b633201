"""`rosimpact corpus`: the command line of the corpus; thin, imports late."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from ..edges.console import UserError

if TYPE_CHECKING:
    from .gather_commands import Manner
    from .labelling import Suggest

app = typer.Typer(
    help="The corpus of bug reports: gather, label, count, publish.", no_args_is_help=True, rich_markup_mode=None
)


def _refuse_suggestion(title: str, body: str) -> tuple[str, dict[str, float]]:
    raise UserError("no classifier is at hand")


_suggest: Suggest = _refuse_suggestion


def set_suggester(suggest: Suggest) -> None:
    """What suggests labels on the labelling screen from now on. The corpus itself knows of no classifier."""
    global _suggest
    _suggest = suggest


# -- gathering ---------------------------------------------------------------------------------------------------------

_Store = Annotated[
    Path | None, typer.Option(help="The store; $ROSIMPACT_CORPUS, else corpus.sqlite in your data folder.")
]
_Api = Annotated[
    str, typer.Option(help="Another address: of GitHub Enterprise; where one service is gathered, another one of it.")
]
_Wait = Annotated[
    float, typer.Option(min=0, help="Minutes to wait in all when a service says so; then stop, to go on another time.")
]
_Archive = Annotated[Path | None, typer.Option(help="A clone of ros-infrastructure/answers-archive.")]
_Verbose = Annotated[bool, typer.Option("--verbose", "-v", help="A line for each page.")]
_Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No progress.")]


def _make_manner(
    store: _Store = None, api: _Api = "", wait: _Wait = 60.0, verbose: _Verbose = False, quiet: _Quiet = False
) -> Manner:
    from math import isfinite

    from .gather_commands import Manner

    if not isfinite(wait):
        raise typer.BadParameter("--wait takes a number of minutes, such as 60")
    return Manner(store, api, wait, verbose, quiet)


def _add_manner_options(command: Callable[..., None]) -> Callable[..., None]:
    """The command with the options of _make_manner() after its own, of which it gets `manner`."""
    own, shared = (
        # a type that is imported late is not known here, and no option's
        inspect.signature(function, eval_str=True, locals={"Manner": object}).parameters
        for function in (command, _make_manner)
    )

    @functools.wraps(command)
    def run(**given: Any) -> None:
        manner = _make_manner(**{name: given.pop(name) for name in shared})
        command(**given, manner=manner)

    options = [*(option for name, option in own.items() if name != "manner"), *shared.values()]
    run.__annotations__ = {option.name: option.annotation for option in options}
    run.__signature__ = inspect.Signature(options)  # type: ignore[attr-defined]
    return run


@app.command("gather")
@_add_manner_options
def gather(
    what: Annotated[str, typer.Argument(help="github:OWNER/NAME, ros-answers or stack-exchange.")],
    since: Annotated[str, typer.Option(help="Only what was posted from this day on (2024-01-31).")] = "",
    pulls: Annotated[bool, typer.Option("--pulls", help="GitHub: pull requests too.")] = False,
    search: Annotated[str, typer.Option(help="GitHub: only what this search finds; of all, if no repository.")] = "",
    tag: Annotated[
        list[str] | None, typer.Option(help="Stack Exchange: with this tag; ros and ros2 if none. May be repeated.")
    ] = None,
    archive: _Archive = None,
    pages: Annotated[Path | None, typer.Option(help="ROS Answers: a folder of saved question pages.")] = None,
    *,
    manner: Manner,
) -> None:
    """Gather reports into the store; what is there already is only brought up to date.

    Stopped at any point, the same command goes on from there. Exit status 1: stopped since the service asks for a
    longer wait; everything is kept. Tokens: GITHUB_TOKEN or GH_TOKEN, STACK_EXCHANGE_KEY, or the keyring.
    """
    from . import gather_commands as commands

    raise typer.Exit(
        commands.gather(
            what, since=since, pulls=pulls, search=search, tags=tuple(tag or ()), archive=archive, pages=pages,
            manner=manner,
        )
    )  # fmt: skip


@app.command("hydrate")
@_add_manner_options
def hydrate(
    labels: Annotated[Path | None, typer.Option(help="The labels; those of the corpus when left out.")] = None,
    texts: Annotated[
        Path | None, typer.Option("--from", help="Take the texts from this JSON Lines file, and ask nobody.")
    ] = None,
    archive: _Archive = None,
    *,
    manner: Manner,
) -> None:
    """Gather the texts of all labelled reports by their ids, and say which are gone."""
    from . import gather_commands as commands

    raise typer.Exit(commands.hydrate(labels, texts, archive=archive, manner=manner))


@app.command("refresh")
@_add_manner_options
def refresh(
    source: Annotated[
        list[str] | None, typer.Option(help="Only github, ros-answers or robotics-se. May be repeated.")
    ] = None,
    limit: Annotated[int | None, typer.Option(min=1, help="So many at most, those asked for longest ago.")] = None,
    archive: _Archive = None,
    *,
    manner: Manner,
) -> None:
    """Ask for every report in the store again: edits are taken over, deleted reports lose their text."""
    from . import gather_commands as commands

    raise typer.Exit(commands.refresh(tuple(source or ()), limit, archive=archive, manner=manner))


@app.command("export")
def export(
    file: Annotated[Path, typer.Argument(help="*.jsonl or *.parquet.")],
    store: _Store = None,
) -> None:
    """Write all reports to a JSON Lines or Parquet file."""
    from . import gather_commands as commands

    raise typer.Exit(commands.export(file, store=store))


@app.command("status")
def status(store: _Store = None) -> None:
    """Show what is in the store and how far each gathering is."""
    from . import gather_commands as commands

    raise typer.Exit(commands.print_status(store=store))


# -- labels ------------------------------------------------------------------------------------------------------------


@app.command("label")
def label(
    reports: Annotated[
        Path | None, typer.Option(help="The texts: a store or a JSON Lines file; the gathered store when left out.")
    ] = None,
    labels: Annotated[
        Path | None, typer.Option(help="The labels; made when it is not there. In a checkout: those of the corpus.")
    ] = None,
    annotator: Annotated[str, typer.Option(help="Who answers; your login name when left out.")] = "",
    second: Annotated[
        bool, typer.Option("--second", help="Read what one other annotator has read, without seeing their answer.")
    ] = False,
    disagreements: Annotated[
        bool, typer.Option("--disagreements", help="Decide where two annotators differ, with both answers in sight.")
    ] = False,
    source: Annotated[
        list[str] | None, typer.Option(help="Only github, ros-answers or robotics-se. May be repeated.")
    ] = None,
    repository: Annotated[list[str] | None, typer.Option(help="Only OWNER/NAME. May be repeated.")] = None,
    listed: Annotated[bool, typer.Option("--list", help="Print what would be shown, and open nothing.")] = False,
) -> None:
    """Label reports in the terminal: the report on one side, guide and keys on the other.

    Every answer is saved at once. The next session goes on where this one stopped.
    """
    from . import label_commands

    if second and disagreements:
        raise typer.BadParameter("--second and --disagreements exclude each other; leave one out")
    mode = "second" if second else "disagreements" if disagreements else "first"
    raise typer.Exit(
        label_commands.label(
            reports, labels, annotator, mode, tuple(source or ()), tuple(repository or ()), listed, _suggest
        )
    )  # fmt: skip


@app.command("stats")
def stats(
    labels: Annotated[Path | None, typer.Option(help="A labels file; those of the corpus when left out.")] = None,
    reports: Annotated[
        Path | None,
        typer.Option(help="The texts, for years and distros: a store or a JSON Lines file; the gathered store if any."),
    ] = None,
    format: Annotated[str, typer.Option("--format", "-f", help="text or json.")] = "text",
    plots: Annotated[Path | None, typer.Option(help="Also draw the numbers into this folder, as SVG and PNG.")] = None,
) -> None:
    """Count labels by year, distro, project, kind and phase, and say how far two annotators agree."""
    from . import label_commands

    raise typer.Exit(label_commands.print_stats(labels, reports, format, plots))


import_app = typer.Typer(
    help="Other studies' bug records, mapped to labels.", no_args_is_help=True, rich_markup_mode=None
)
app.add_typer(import_app, name="import")


@import_app.command("robust")
def import_robust(
    folder: Annotated[Path, typer.Argument(help="A clone of github.com/robust-rosin/robust.", metavar="DIR")],
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Write what has a label to this file, as labels.")
    ] = None,
    format: Annotated[str, typer.Option("--format", "-f", help="text counts; json tells of every record.")] = "text",
) -> None:
    """Map ROBUST's bug records to labels, as far as their codes tell, and say how sure that is."""
    from . import label_commands

    raise typer.Exit(label_commands.import_robust(folder, output, format))
