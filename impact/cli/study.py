"""rosimpact study."""

from pathlib import Path


def study_run(*, names, full, reports, output, notebooks, quiet) -> int:
    """Runs the notebooks."""
    from ...corpus import study

    return study.run_study(names, full, reports, output, notebooks, quiet)


def study_predict(reports: Path, output: Path | None, quiet: bool) -> int:
    """Judges the labelled reports."""
    from ...classifier import study
    from ...corpus.study import find_notebooks

    return study.run_study(reports, output or find_notebooks() / "data", quiet)
