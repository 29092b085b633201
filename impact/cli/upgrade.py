"""rosimpact upgrade."""

from pathlib import Path

from ..analysis.findings import fails
from ..analysis.session import Options
from .check import FAIL_ON
from .output import deliver_answer, one_of, progress_bar, style_of


def upgrade(
    path: Path, from_: str, to: str, *, packages, rev, config, format, output, fail_on, jobs, quiet, follow_links
) -> int:  # fmt: skip
    """Prints what an upgrade breaks. Returns the exit status: 0 (safe), 1 (something breaks) or 2 (failed)."""
    from ..report import upgrade as report

    breaks = False

    def answer() -> str:
        nonlocal breaks
        one_of("--fail-on", fail_on or FAIL_ON[0], FAIL_ON)
        from ..analysis.upgrade import upgrade as compare

        options = Options(rev=rev, config=config, jobs=jobs, follow_links=follow_links)
        found = compare(path, from_, to, options, packages, None if quiet else progress_bar())
        breaks = fails(found.brought, fail_on or found.fail_on or "error")
        if format == "json":
            return report.as_json(found)
        return report.as_html(found) if format == "html" else report.text(found, style_of(output))

    return deliver_answer(answer, format, report.FORMATS, output, path) or int(breaks)
