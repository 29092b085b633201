"""rosimpact logic."""

import os
from pathlib import Path

from ...edges.console import UserError, make_step_reporter
from ...edges.version import __version__
from .output import find_style, make_command, say_notes


@make_command("text", "json", "html", about="repository")
def logic(
    repository: Path, *, range, commits, since, package, topic, all, format, output, jobs, quiet
) -> str:  # fmt: skip
    """Where the logic of publishing changed."""
    from ..facts.store import Store
    from ..logic import repository as history
    from ..report import logic as logic_report
    from ..report import timeline

    with Store() as store:
        try:
            asked = history.Range(range, commits, since)
            found = history.read(os.fspath(repository), asked, store, jobs, None if quiet else make_step_reporter())
        except ValueError as error:
            raise UserError(f"--since: {error}") from None
        say_notes(store.notes)
    all_of_it, found = found, history.select(found, package, topic, all)
    missed = logic_report.describe_missed(all_of_it, package, topic, all)
    say_notes([missed] if missed else [])
    if format == "html":
        return timeline.render(found, __version__)
    if format == "json":
        return logic_report.render_json(found, __version__)
    return logic_report.render_text(found, find_style(output))
