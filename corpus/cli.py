"""`rosimpact corpus`: the command line of the corpus; thin, imports late."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer(
    help="The corpus of bug reports: gather, label, count, publish.", no_args_is_help=True, rich_markup_mode=None
)

# -- gathering ---------------------------------------------------------------------------------------------------------


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
            reports, labels, annotator, mode, tuple(source or ()), tuple(repository or ()), listed
        )
    )  # fmt: skip
