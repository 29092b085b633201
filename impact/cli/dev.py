"""`rosimpact dev`: for people who work on rosimpact itself; CONTRIBUTING.md says how."""

from pathlib import Path
from typing import Annotated

import typer

from ...edges.console import write

app = typer.Typer(help="For work on rosimpact itself.", no_args_is_help=True, rich_markup_mode=None)


@app.callback()
def _dev() -> None:
    """For work on rosimpact itself."""


@app.command("new-rule")
def new_rule(
    name: Annotated[str, typer.Argument(help="The rule's name, lower-case words joined by dashes: removed-header.")],
    family: Annotated[str, typer.Option(help="The folder of impact/rules for the rule: api, packages ...")],
    root: Annotated[Path, typer.Option(help="The checkout of rosimpact.")] = Path("."),
) -> None:
    """Write a rule's module and its first file of cases, which work and are to be edited."""
    from .new_rule import write_rule

    module, cases = write_rule(root, name, family)
    steps = (
        ("git add -N impact tests", "so that `git diff` shows new files"),
        (f"python -m pytest tests/rules -k {cases.stem}", "does the rule find what its cases expect?"),
        (f"python -m pytest tests/rules -k {cases.stem} --update-cases", "writes what it finds into them"),
        ("python -m pytest tests/rules -n auto --update-cases", "the same for the cases of all rules"),
        ("python docs/rules.py > docs/rules.md", "the list of rules"),
    )
    width = max(len(command) for command, _ in steps)
    lines = "".join(f"  {command:{width}}   # {why}\n" for command, why in steps)
    write(f"{module}\n{cases}\n\nEdit both (docs/queries.md lists what a rule can ask), then:\n{lines}")
