"""rosimpact study."""

from pathlib import Path


def study_run(*, names, full, reports, output, notebooks, quiet) -> int:
    """Runs the notebooks."""
    from ...corpus import study

    return study.command(names, full, reports, output, notebooks, quiet)


def study_predict(reports: Path, output: Path | None, quiet: bool) -> int:
    """Judges the labelled reports."""
    from ...classifier import study
    from ...corpus.study import notebooks_here

    return study.command(reports, output or notebooks_here() / "data", quiet)
