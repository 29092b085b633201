"""rosimpact fields."""

import os
from pathlib import Path

from ...edges.console import UserError, make_step_reporter
from .output import find_style, make_command


@make_command("text", "json")
def fields(path: Path | None, *, bag, topic, limit, format, output, quiet) -> str:
    """What the messages of a bag hold, field by field."""
    if bag is None:
        raise UserError("--bag: missing; name a recording, such as drive.mcap")
    from ..analysis.bags import measure_bag
    from ..analysis.message_files import MessageFolders
    from ..report.bags import render_json, render_text

    folders = MessageFolders((path,) if path is not None else (), os.environ)
    progress = None if quiet else make_step_reporter()
    found = measure_bag(bag, topic, limit=limit, find_text=folders.find, progress=progress)
    return render_json(found) if format == "json" else render_text(found, str(bag), find_style(output))
