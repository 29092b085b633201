"""rosimpact impact."""

from pathlib import Path

from ...edges.console import UserError
from ...edges.version import __version__
from .output import find_style, make_command, make_progress_bar, say_notes


@make_command("text", "json", "markdown")
def impact(
    path: Path, *, base, rev, package, topic, node, format, output, all, jobs, quiet, follow_links
) -> str:  # fmt: skip
    """What the changes since a base reach."""
    if not base:
        raise UserError("--base: missing; give the revision to compare with, such as origin/main")
    from ..analysis.downstream import analyze_impact
    from ..report import impact as report

    progress = None if quiet else make_progress_bar()
    found = analyze_impact(
        path, base, rev=rev, jobs=jobs, progress=progress, follow_links=follow_links, packages=package, topics=topic,
        nodes=node,
    )  # fmt: skip
    say_notes(found.notes)
    if format == "json":
        return report.render_json(found, __version__)
    if format == "markdown":
        return report.render_markdown(found.impact)
    return report.render_text(found.impact, all, find_style(output))
