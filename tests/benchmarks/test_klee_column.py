"""What the benchmark beside KLEE reads of KLEE's folder, and what it prints."""

import json
import sys
from pathlib import Path

import pytest

sys.path.append(str(Path(__file__).parents[2] / "benchmarks"))

import values

DIVISION = """Error: integer division overflow
File: runtime/Sanitizer/ubsan/ubsan_handlers.cpp
Line: 37
assembly.ll line: 77473
State: 3
Stack: 
\t#000077473 in _ZN7__ubsanL12report_errorEPKcS1_(1, 2) at runtime/Sanitizer/ubsan/ubsan_handlers.cpp:37
\t#300023226 in _ZN4Node6onRateERK4Rate(1, 2) at {start}/src/node.cpp:8
\t#700020501 in _ZN2ri7deliverEv() at include/ri_core.hpp:415
"""
SIZE = "Error: concretized symbolic size\nFile: /usr/include/c++/12/bits/new_allocator.h\nLine: 137\nStack: \n"


@pytest.fixture
def workspace(tmp_path):
    (tmp_path / "ws" / "src").mkdir(parents=True)
    (tmp_path / "ws" / "src" / "node.cpp").write_text("\n")
    return tmp_path / "ws"


@pytest.mark.parametrize("cut", [0, 2])
def test_ways_crashes_and_what_it_gave_up_on(workspace, tmp_path, cut):
    found = tmp_path / "klee-last"
    found.mkdir()
    start = "/".join(str(workspace).split("/")[cut:])
    errors = {
        "1.handled": "Error: handled\n", "2.handled": "Error: handled\n", "3.ignored": "Error: ignored\n",
        "4.log": "Error: log-only\n", "5.overflow": DIVISION.replace("{start}", start), "6.model": SIZE,
    }  # fmt: skip
    for name, text in errors.items():
        (found / f"test00000{name}.err").write_text(text)
    (found / "info").write_text("KLEE: done: completed paths = 0\n")
    run = values.read_klee(found, workspace, 3.0)
    assert run.ways == {"handled": 2, "ignored": 1, "log-only": 1, "crash": 1}
    assert run.crashes == [values.Crash("division by zero", "src/node.cpp", 8)]
    assert (run.stopped, run.is_complete) == ({"concretized symbolic size": 1}, True)
    (found / "test000007.early").write_text("")
    assert not values.read_klee(found, workspace, 3.0).is_complete


def test_both_columns_and_the_sum():
    own = {"reason": "", "ways": {"handled": 1, "crash": 1}, "crashes": [["division by zero", "a.cpp", 8, True]],
           "complete": True, "seconds": 0.5}  # fmt: skip
    ran = values.KleeRun({"handled": 1, "crash": 1}, [values.Crash("abort", "a.cpp", 8)], {}, False, 9.0)
    theirs = {**ran._asdict(), "crashes": [list(one) for one in ran.crashes]}
    record = {"callback": "on", "type": "m/T", "rosimpact": own, "klee": theirs}
    assert values.render(record) == [
        "on  m/T",
        "  rosimpact 1 crash, 1 handled  |  division by zero :8  |  0.5 s",
        "  klee      1 crash, 1 handled  |  abort :8  |  9.0 s  not all ways",
    ]
    none = {**record, "klee": {**theirs, "reason": values.NO_KLEE, "crashes": []}}
    assert values.NO_KLEE in values.render(none)[2]
    first, second = values.summarize([record, none])
    assert "2 callbacks; rosimpact: 1 crashes" in first
    assert "KLEE ran on 1: 1 crashes, 1 on lines that rosimpact has, 0 of the same kind" in second


def test_what_the_study_reads(tmp_path):
    (tmp_path / "facts").write_text(json.dumps({"callback": "on"}) + "\n")
    values.write_study([tmp_path / "facts"], tmp_path / "out")
    rows = [json.loads(line) for line in (tmp_path / "out").read_text().splitlines()]
    assert rows[0] == {"of": "harness", "callback": "on"}
    real = rows[1:]
    assert len(real) >= 50 and {row["language"] for row in real} == {"cpp", "python"}
    assert all(isinstance(row["said"]["crashes"], list) for row in real)
    assert any(one["true"] is False for row in real for one in row["said"]["crashes"])
