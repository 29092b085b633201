"""rosimpact upgrade."""

from pathlib import Path

from ..analysis.findings import fails
from ..analysis.session import Options
from .check import FAIL_ON
from .output import answers, one_of, progress_bar, style_of


@answers("text", "json", "html")
def upgrade(
    path: Path, from_: str, to: str, *, packages, rev, config, format, output, fail_on, jobs, quiet, follow_links
) -> tuple[str, int]:  # fmt: skip
    """What an upgrade breaks; the status is 1 where something does."""
    one_of("--fail-on", fail_on or FAIL_ON[0], FAIL_ON)
    from ..analysis.upgrade import upgrade as compare
    from ..report import upgrade as report

    options = Options(rev=rev, config=config, jobs=jobs, follow_links=follow_links)
    found = compare(path, from_, to, options, packages, None if quiet else progress_bar())
    status = int(fails(found.brought, fail_on or found.fail_on or "error"))
    if format == "json":
        return report.as_json(found), status
    return report.as_html(found) if format == "html" else report.text(found, style_of(output)), status
