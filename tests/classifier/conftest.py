from pathlib import Path

import pytest
from written_reports import rows, write


@pytest.fixture(scope="session")
def labelled(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """Files of labels and of reports."""
    folder = tmp_path_factory.mktemp("labelled")
    reports, labels = rows()
    return write(folder / "labels.jsonl", labels), write(folder / "reports.jsonl", reports)
