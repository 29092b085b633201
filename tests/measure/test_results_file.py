"""The file of results: continued, refused, damaged, as Parquet; and what is printed of it."""

import json

import msgspec
import pytest
from rosimpact.edges.console import UserError
from rosimpact.impact.measure.intervals import NetworkResult, summarize
from rosimpact.impact.measure.plan import Conditions, NetworkCell, NetworkPlan
from rosimpact.impact.measure.results import ResultsFile, RunHeader, load_results, write_parquet
from rosimpact.impact.measure.run import list_left
from rosimpact.impact.report.measure import render_json, render_text

HEADER = RunHeader(conditions=Conditions(), clock="one clock")


def result(repetition=0, fields=25, variant="full", **more):
    given = {
        "repetition": repetition, "publishers": 1, "fields": fields, "rate": 50, "variant": variant, "bytes": 25_120,
        "offered_mbit": 10.0, "published": 500, "arrived": 480, "delivered": 470, "achieved_rate": 50.0,
        "late_percent": 0.0, "dropped_percent": 6.0, "dropped_publisher_percent": 4.0,
        "dropped_subscriber_percent": 2.0, "latency_mean_ms": 2.0, "latency_p50_ms": 2.0, "latency_p95_ms": 3.0,
        "latency_p99_ms": 4.0, "latency_max_ms": 5.0, "waited_ms": 0.1,
    }  # fmt: skip
    return NetworkResult(**{**given, **more})


@pytest.fixture
def path(tmp_path):
    file = ResultsFile(tmp_path / "r.jsonl", HEADER)
    file.add(result())
    file.add(result(1))
    return file.path


def test_a_second_run_continues(path):
    plan = NetworkPlan(conditions=Conditions(), publishers=(1,), fields=(25,), rates=(50,), repeat=3)
    told = []
    left = list_left(plan, ResultsFile(path, HEADER), told.append)
    cells = [(repetition, cell.variant) for repetition, cell in left]
    assert cells == [(0, "pruned"), (1, "pruned"), (2, "full"), (2, "pruned")]
    assert told == ["4 runs of a cell to measure, about 0.8 minutes, 2 of 6 are in " + f"{path} already"]


def test_a_line_that_was_cut_off_is_measured_again(path):
    whole = path.read_bytes()
    path.write_bytes(whole[:-30])
    file = ResultsFile(path, HEADER)
    assert [each.repetition for each in file.results] == [0]
    file.add(result(1))
    assert path.read_bytes() == whole


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", ""),
        (b"{}\n", "1: is no header"),
        (b"hello\n", "1: is no header"),
        (b'{"schema": 99, "clock": "x"}\n', "of this version"),
        (b"half a line", "holds no results"),
        (msgspec.json.encode(HEADER) + b"\n{}\n", "2: is no result"),
    ],
)
def test_other_files_are_left_alone(tmp_path, content, said):
    path = tmp_path / "r.jsonl"
    path.write_bytes(content)
    if not said:
        assert ResultsFile(path, HEADER).results == []
        return
    with pytest.raises(UserError, match=said):
        ResultsFile(path, HEADER)
    assert path.read_bytes() == content


def test_other_conditions_are_refused_and_named(path):
    other = RunHeader(conditions=Conditions(queue=100), clock="one clock")
    with pytest.raises(UserError, match="queue 10, not 100"):
        ResultsFile(path, other)


def test_parquet_has_the_conditions_too(path, tmp_path):
    parquet = pytest.importorskip("pyarrow.parquet")
    header, results = load_results(path)
    write_parquet(tmp_path / "r.parquet", results, header.conditions)
    rows = parquet.read_table(tmp_path / "r.parquet").to_pylist()
    assert [(row["repetition"], row["latency_mean_ms"], row["nodes"], row["link"]) for row in rows] == [
        (0, 2.0, "roscpp", 100_000_000),
        (1, 2.0, "roscpp", 100_000_000),
    ]


def test_without_pyarrow(tmp_path, monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(UserError, match=r"rosimpact\[measure\]"):
        write_parquet(tmp_path / "r.parquet", [], Conditions())


def test_what_is_printed():
    rows = [result(0), result(1, latency_mean_ms=4.0), result(0, variant="pruned", achieved_rate=30.0)]
    text = render_text(HEADER, summarize(rows))
    full, pruned = text.splitlines()[1:3]
    # t(0.975, 1) = 12.706, times 1.414 / 1.414; percent and milliseconds do not go below 0.
    assert full.split("  ")[0] == "25 fields, full" and "3.00 ±12.71" in full and "6.0 ±0.0" in full
    assert pruned.startswith("25 fields, pruned") and "±" not in pruned
    assert "25 fields, 50 Hz, pruned: published at 30.0 Hz" in text
    cells = json.loads(render_json(HEADER, summarize(rows)))["cells"]
    assert cells[0]["latency"]["mean"]["mean"] == 3.0 and cells[0]["cell"]["variant"] == "full"


def test_summaries_are_of_cells():
    found = summarize([result(0), result(0, 50), result(1)])
    assert [(each.cell.fields, each.repetitions) for each in found] == [(25, 2), (50, 1)]
    assert found[0].cell == NetworkCell(1, 25, 50, "full")
