"""rosimpact impact."""

from pathlib import Path

from ...edges.console import UserError
from ...edges.version import __version__
from .output import answers, progress_bar, say_notes, style_of


@answers("text", "json", "markdown")
def impact(
    path: Path, *, base, rev, package, topic, node, format, output, all, jobs, quiet, follow_links
) -> str:  # fmt: skip
    """What the changes since a base reach."""
    if not base:
        raise UserError("--base: missing; give the revision to compare with, such as origin/main")
    from ..analysis.downstream import chosen, reached
    from ..report import impact as report

    progress = None if quiet else progress_bar()
    found = reached(path, base, rev=rev, jobs=jobs, progress=progress, follow_links=follow_links)
    say_notes(found.notes)
    part = chosen(found.impact, package, topic, node)
    if format == "json":
        return report.as_json(part, found, __version__)
    return report.markdown(part) if format == "markdown" else report.text(part, all, style_of(output))
