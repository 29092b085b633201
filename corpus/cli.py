"""`rosimpact corpus`: the command line of the corpus; thin, imports late."""

from __future__ import annotations

import typer

app = typer.Typer(
    help="The corpus of bug reports: gather, label, count, publish.", no_args_is_help=True, rich_markup_mode=None
)

# -- gathering ---------------------------------------------------------------------------------------------------------


# -- labels ------------------------------------------------------------------------------------------------------------
