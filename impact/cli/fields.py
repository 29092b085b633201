"""rosimpact fields."""

import os
from pathlib import Path

from ...edges.console import UserError, make_step_reporter
from ...edges.version import __version__
from .output import find_style, make_command, make_progress_bar


@make_command("text", "json")
def fields(
    path: Path | None, *, bag, topic, limit, assume_closed, rev, config, follow_links, format, output, all, jobs, quiet
) -> str:
    """Which fields of topics are read and set, or what the messages of a bag hold, field by field."""
    if bag is None:
        if limit is not None:
            raise UserError("--limit: is for the messages of a recording; name it with --bag")
        from ..analysis.fields import collect_fields
        from ..report.fields import render_fields_json, render_fields_text

        report = collect_fields(
            path or Path("."), topics=topic, closed=assume_closed, rev=rev, config=config, jobs=jobs,
            progress=None if quiet else make_progress_bar(), follow_links=follow_links,
        ).report  # fmt: skip
        if format == "json":
            return render_fields_json(report, __version__)
        return render_fields_text(report, all, find_style(output))
    if assume_closed or rev:
        raise UserError("--bag: shows a recording alone; leave out --assume-closed and --rev")
    from ..analysis.bags import measure_bag
    from ..analysis.message_files import MessageFolders
    from ..report.bags import render_json, render_text

    folders = MessageFolders((path,) if path is not None else (), os.environ)
    progress = None if quiet else make_step_reporter()
    found = measure_bag(bag, topic, limit=limit, find_text=folders.find, progress=progress)
    return render_json(found) if format == "json" else render_text(found, str(bag), find_style(output))
