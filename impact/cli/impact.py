"""rosimpact impact."""

from pathlib import Path

from ...edges.console import UserError
from ...edges.version import __version__
from .output import deliver_answer, progress_bar, say_notes, style_of

IMPACT_FORMATS = ("text", "json", "markdown")


def impact(
    path: Path, *, base, rev, package, topic, node, format, output, all, jobs, quiet, follow_links
) -> int:  # fmt: skip
    """Prints what the changes since a base reach. Returns the exit status: 0, or 2 (failed)."""

    def answer() -> str:
        if not base:
            raise UserError("--base: missing; give the revision to compare with, such as origin/main")
        from ..analysis.downstream import chosen
        from ..analysis.impact import reached
        from ..report import impact as impact_report

        progress = None if quiet else progress_bar()
        found = reached(path, base, rev=rev, jobs=jobs, progress=progress, follow_links=follow_links)
        say_notes(found.notes)
        part = chosen(found.impact, package, topic, node)
        if format == "json":
            return impact_report.as_json(
                part, impact_report.ImpactHeading(__version__, found.root, found.rev, found.base)
            )
        if format == "markdown":
            return impact_report.markdown(part)
        return impact_report.text(part, all, style_of(output))

    return deliver_answer(answer, format, IMPACT_FORMATS, output, path)
