"""When a packager's patch counts as found."""

import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[2] / "benchmarks"))

import patches

RECORD = {
    "expected_name": "io_service", "accepted_names": ["asio"], "expected_file": "a/x.hpp", "package": {"name": "a"}
}  # fmt: skip


def finding(severity, path, subject, package="a"):
    return {"severity": severity, "path": path, "subject": subject, "package": package}


@pytest.mark.parametrize(
    ("findings", "result"),
    [
        ([finding("error", "a/x.hpp", "io_service")], "file"),
        ([finding("warning", "a/y.hpp", "asio"), finding("note", "a/x.hpp", "io_service")], "package"),
        ([finding("error", "b/x.hpp", "io_service", "b")], "missed"),
        ([finding("note", "a/x.hpp", "asio")], "note"),
        ([finding("error", "a/x.hpp", "other"), finding("error", "a/x.hpp", None)], "missed"),
    ],
)
def test_what_counts_as_found(findings, result, monkeypatch):
    monkeypatch.setitem(patches._STATE, "same_name", lambda want, got: want == got)
    assert patches.judge(findings, RECORD) == result
