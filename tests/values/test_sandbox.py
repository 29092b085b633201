"""Programs that run apart: what they print, how long they take and what they start has an end."""

import sys

from rosimpact.impact.values.sandbox import run_apart


def test_what_a_program_prints_without_an_end_is_cut_off(tmp_path):
    ended = run_apart([sys.executable, "-c", "while True: print('x' * 100_000)"], tmp_path, seconds=20)
    assert ended.status != 0
    assert len(ended.output) == 5_000_000


def test_input_output_and_status(tmp_path):
    code = "import os, sys; print(sys.stdin.read().upper(), os.getcwd()); print('no', file=sys.stderr); sys.exit(3)"
    ended = run_apart([sys.executable, "-c", code], tmp_path, text="go")
    assert (ended.status, ended.output, ended.errors) == (3, f"GO {tmp_path}\n", "no\n")
    assert not ended.is_late


def test_a_program_that_waits_is_stopped(tmp_path):
    ended = run_apart([sys.executable, "-c", "import time; time.sleep(60)"], tmp_path, seconds=1)
    assert ended.is_late and ended.status < 0
