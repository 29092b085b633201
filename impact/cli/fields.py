"""rosimpact fields."""

import os
from contextlib import suppress
from pathlib import Path

from ...edges.console import UserError, make_step_reporter
from ...edges.version import __version__
from .output import find_style, make_command, make_progress_bar


@make_command("text", "json")
def fields(
    path: Path | None, *, bag, topic, limit, assume_closed, length, rev, config, follow_links, format, output, all,
    jobs, quiet,
) -> str:
    """Which fields of topics are read and set, or what the messages of a bag hold, field by field."""
    from ..analysis.fields import collect_fields
    from ..report.fields import render_fields_json, render_fields_text, render_savings

    asked = {
        "closed": assume_closed, "rev": rev, "config": config, "jobs": jobs, "length": length,
        "progress": None if quiet else make_progress_bar(), "follow_links": follow_links,
    }  # fmt: skip
    if bag is None:
        if limit is not None:
            raise UserError("--limit: is for the messages of a recording; name it with --bag")
        answer = collect_fields(path or Path("."), topics=topic, **asked)
        if format == "json":
            return render_fields_json(answer, __version__)
        return render_fields_text(answer, all, find_style(output))
    from ..analysis.bags import measure_bag
    from ..analysis.message_files import MessageFolders
    from ..analysis.session import CheckError
    from ..report.bags import render_json, render_text

    folders = MessageFolders((path,) if path is not None else (), os.environ)
    progress = None if quiet else make_step_reporter()
    found = measure_bag(bag, topic, limit=limit, find_text=folders.find, progress=progress)
    if format == "json":
        return render_json(found)
    text = render_text(found, str(bag), find_style(output))
    if path is not None:
        # A folder of definitions alone is no workspace, and says nothing of who reads what.
        with suppress(CheckError):
            text += render_savings(collect_fields(path, **asked).report, found, find_style(output))
    return text
