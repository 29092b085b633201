"""rosimpact upgrade."""

from pathlib import Path

from ..analysis.findings import has_failures
from ..analysis.session import Options
from .check import FAIL_ON
from .output import find_style, make_command, make_progress_bar, validate_choice


@make_command("text", "json", "html")
def upgrade(
    path: Path, from_: str, to: str, *, packages, rev, config, format, output, fail_on, jobs, quiet, follow_links
) -> tuple[str, int]:  # fmt: skip
    """What an upgrade breaks; the status is 1 where something does."""
    validate_choice("--fail-on", fail_on or FAIL_ON[0], FAIL_ON)
    from ..analysis.upgrade import compare_upgrade as compare
    from ..report import upgrade as report

    options = Options(rev=rev, config=config, jobs=jobs, follow_links=follow_links)
    found = compare(path, from_, to, options, packages, None if quiet else make_progress_bar())
    status = int(has_failures(found.brought, fail_on or found.fail_on or "error"))
    if format == "json":
        return report.render_json(found), status
    return report.render_html(found) if format == "html" else report.render_text(found, find_style(output)), status
