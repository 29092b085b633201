"""Real nodes in a small form: two cells of one second over a limited link, each queue, two sides, each kind of node.

What is compiled is one node of roscpp; the link is tried by rospy, whose nodes are not."""

import os
import re
import signal
import subprocess
import sys
import time

import pytest
from rosimpact.impact.measure.namespaces import list_namespaces
from rosimpact.impact.measure.results import load_results

# Messages of 60 and 20 kB, so that both need few fields to be compiled: 96 and 32 Mbit/s at 200 Hz.
SIZES = ("--fields", "3", "--keep", "1", "--field-bytes", "20000", "--publishers", "1")
SHORT = ("--rates", "200", "--seconds", "1", "--warm-up", "0.4", "--repeat", "1")
START = "import sys; from rosimpact.impact.cli.start import main; main()"


def read(path):
    return {result.variant: result for result in load_results(path)[1]}


def start_command(path, *arguments):
    return subprocess.Popen(
        [sys.executable, "-c", START, "measure", *arguments], cwd=path, text=True, stderr=subprocess.PIPE,
        stdout=subprocess.DEVNULL,
    )  # fmt: skip


def wait_for(condition, child, seconds=120):
    until = time.monotonic() + seconds
    while not condition():
        assert child.poll() is None and time.monotonic() < until, child.communicate()[1]
        time.sleep(0.05)


def test_a_run_over_a_link_is_stopped_cleaned_up_and_continued(allowed, rospy, say, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    say("measure", "network", "--loopback", *SIZES, *SHORT, "--rates", "bad")  # sets the cache up, and runs nothing
    output = tmp_path / "network.jsonl"
    arguments = ("network", *SIZES, *SHORT, "--link", "50mbit", "--nodes", "rospy")
    first = start_command(tmp_path, *arguments)
    wait_for(lambda: output.exists() and output.read_bytes().count(b"\n") == 2, first)
    assert len([name for name in list_namespaces() if f"-{first.pid}-" in name]) == 3
    first.send_signal(signal.SIGTERM)
    told = first.communicate(timeout=30)[1]
    assert first.returncode == 130 and "what was measured is kept in network.jsonl" in told
    assert [name for name in list_namespaces() if f"-{first.pid}-" in name] == []

    said = say("measure", *arguments, "--format", "json", "--parquet", "network.parquet")
    assert said.status == 0, said.err
    assert "1 run of a cell to measure" in said.err and "1 of 2 are in network.jsonl already" in said.err
    assert [name for name in list_namespaces() if f"-{os.getpid()}-" in name] == []
    found = read(output)
    full, pruned = found["full"], found["pruned"]
    assert (full.bytes, pruned.bytes) == (60_032, 20_024)
    # Half of what is offered goes through the link; what does not is dropped before it.
    assert 20 < full.dropped_publisher_percent < 80
    assert pruned.dropped_publisher_percent < full.dropped_publisher_percent / 2
    assert full.published == 200
    assert (tmp_path / "network.parquet").stat().st_size > 0
    shown = say("measure", "show", output)
    assert "3 fields, full" in shown.out and "links of 50mbit" in shown.out


def test_a_slow_callback_fills_the_queue_of_the_subscriber_alone(allowed, roscpp, say, tmp_path):
    output = tmp_path / "slow.jsonl"
    said = say(
        *("measure", "network", "--link", "1gbit", "--quiet", *SIZES, *SHORT, "--output", output),
        *("--keep", "0", "--callback-ms", "20", "--queue", "2"),
    )
    assert said.status == 0, said.err
    (result,) = read(output).values()
    # 50 of 200 are called back. A queue of two also overflows where its thread does not get a processor for 10 ms.
    assert result.published == 200 and 50 < result.dropped_percent < 90
    assert result.dropped_publisher_percent < result.dropped_subscriber_percent / 2
    assert result.waited_ms > 1


@pytest.mark.parametrize("nodes", ["rospy", "dds"])
def test_other_nodes(nodes, request, say, tmp_path):
    if nodes == "dds":
        pytest.importorskip("cyclonedds", reason="cyclonedds is not installed, see the `measure` extra")
    else:
        request.getfixturevalue("rospy")
    output = tmp_path / "other.jsonl"
    said = say(
        *("measure", "network", "--loopback", "--quiet", *SIZES, *SHORT, "--keep", "0", "--output", output),
        *("--nodes", nodes, "--callback-ms", "20", "--queue", "2"),
    )
    assert said.status == 0, said.err
    result = read(output)["full"]
    assert result.published == 200 and result.delivered <= result.arrived <= 200
    assert result.dropped_subscriber_percent > 30 and result.latency_mean_ms > 0


def test_two_sides_that_speak_over_the_network(roscpp, say, tmp_path):
    # As on two machines, but on one: both have the clock of the other.
    publisher = start_command(tmp_path, "publisher", "--address", "127.0.0.1", "--port", "11477")
    try:
        assert publisher.stderr is not None
        line = publisher.stderr.readline()
        master = re.search(r"--master (\S+)", line)
        assert master, line + publisher.stderr.read()
        output = tmp_path / "two.jsonl"
        said = say(
            *("measure", "subscriber", "--master", master[1], "--address", "127.0.0.1", *SIZES, *SHORT),
            *("--keep", "0", "--output", output),
        )
        assert said.status == 0, said.err
        result = read(output)["full"]
        assert result.delivered > 0 and result.latency_mean_ms > 0
        assert abs(result.clock_offset_ms) <= 2 * result.clock_uncertainty_ms + 0.01
        other = say(
            *("measure", "subscriber", "--master", master[1], "--address", "127.0.0.1", *SIZES, *SHORT),
            *("--nodes", "rospy", "--output", tmp_path / "other.jsonl"),
        )
        assert other.status == 2 and ("give both sides the same --nodes" in other.err or "ROS 1" in other.err)
    finally:
        publisher.send_signal(signal.SIGINT)
        assert publisher.wait(30) == 130
