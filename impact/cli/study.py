"""`rosimpact study`: the command line of the study; thin, imports late."""

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer(help="The study: its notebooks, run anew.", no_args_is_help=True, rich_markup_mode=None)


@app.callback()
def root() -> None:
    pass


@app.command("run")
def study_run(
    names: Annotated[
        list[str] | None, typer.Argument(help="Notebooks, such as 03_updates or 03; all by default.")
    ] = None,
    full: Annotated[
        bool, typer.Option("--full", help="From the reports' texts and all distros, not the small form.")
    ] = False,
    reports: Annotated[
        Path | None, typer.Option(help="The reports' texts, JSON Lines; what reads reports needs them with --full.")
    ] = None,
    output: Annotated[
        Path, typer.Option("--output", "-o", help="Folder for the executed notebooks, figures and tables.")
    ] = Path("study"),
    notebooks: Annotated[Path | None, typer.Option(help="Folder of the notebooks, outside a checkout.")] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress on standard error.")] = False,
) -> None:
    """Run the notebooks and write their figures and tables.

    Exit status: 0 all were made, 1 a notebook failed or made not all of its figures, 2 the tool failed.
    """
    from ...corpus import study

    raise typer.Exit(study.command(names or (), full, reports, output, notebooks, quiet))


@app.command("predict")
def study_predict(
    reports: Annotated[Path, typer.Option(help="The reports' texts, JSON Lines.")],
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Folder for both files; that of the notebooks by default.")
    ] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No progress on standard error.")] = False,
) -> None:
    """Judge every labelled report by a model that has not seen its repository, for 02_triage; ids and numbers only.

    Writes triage_predictions.jsonl and triage_beside.json. It takes some minutes.
    """
    from ...classifier import study
    from ...corpus.study import notebooks_here

    raise typer.Exit(study.command(reports, output or notebooks_here() / "data", quiet))
