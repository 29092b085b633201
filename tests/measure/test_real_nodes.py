"""Real nodes in a small form: two cells of one second over a limited link, each queue, two sides, each kind of node.

What is compiled is one node of roscpp; the link is tried by rospy, whose nodes are not."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from rosimpact.impact.measure.children import find_program, run_program
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


def test_what_a_killed_run_leaves_is_removed_by_the_next_which_continues(allowed, rospy, say, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    say("measure", "network", "--loopback", *SIZES, *SHORT, "--rates", "bad")  # sets the cache up, and runs nothing
    output = tmp_path / "network.jsonl"
    arguments = ("network", *SIZES, *SHORT, "--repeat", "2", "--link", "50mbit", "--nodes", "rospy")
    killed = start_command(tmp_path, *arguments)
    wait_for(lambda: output.exists() and output.read_bytes().count(b"\n") == 3, killed)  # in the midst of a repetition
    left = [name for name in list_namespaces() if f"-{killed.pid}-" in name]
    killed.kill()
    killed.communicate(timeout=30)
    assert len(left) == 3 and set(left) <= set(list_namespaces())
    with open(output, "ab") as file:
        file.write(b'{"repetition":1,"publish')  # as far as the disk got

    said = say("measure", *arguments, "--format", "json")
    assert said.status == 0, said.err
    assert "removed what earlier runs left behind: " in said.err and all(name in said.err for name in left)
    assert "2 runs of a cell to measure" in said.err and "2 of 4 are in network.jsonl already" in said.err
    assert set(left) & set(list_namespaces()) == set()
    found = [(result.repetition, result.variant) for result in load_results(output)[1]]
    assert found == [(0, "full"), (0, "pruned"), (1, "full"), (1, "pruned")]
    # Nothing is measured again, and what is removed does not depend on that.
    again = say("measure", *arguments, "--format", "json")
    assert again.status == 0 and "0 runs of a cell to measure" in again.err
    assert again.out == said.out


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


def test_what_a_plan_gains(rospy, say, tmp_path):
    fleet = Path(__file__).parents[2] / "examples" / "fleet"
    given = ("prune", fleet, "--topic", "/track", "--measure", "--loopback", "--nodes", "rospy", "--seconds", "1")
    said = say(*given, "--repeat", "2", "--rate", "20", "--results", tmp_path, "--format", "json")
    assert said.status == 0, said.err
    (gain,) = json.loads(said.out)["plans"][0]["gains"]
    # 20, a text of 5; two arrays of 10 float64 and a text of 10, of which one array is kept.
    assert (gain["full"]["bytes"], gain["pruned"]["bytes"]) == (20 + 9 + 2 * 84 + 14, 20 + 9 + 84)
    for cell in (gain["full"], gain["pruned"]):
        assert cell["repetitions"] == 2 and cell["latency"]["mean"]["low"] <= cell["latency"]["mean"]["high"]
    again = say(*given, "--repeat", "2", "--rate", "20", "--results", tmp_path)
    assert again.status == 0 and "0 runs of a cell to measure" in again.err
    assert "measured  /track  at 20 Hz, as src/fleet_eye/src/eye.cpp:65 fills it: vehicle 5" in again.out


@pytest.fixture
def machines(allowed):
    """Two machines as far as the network goes: namespaces with a cable between them and no route elsewhere. Gives what
    a command begins with to be run on each, and their addresses."""
    names = [f"two-machines-{os.getpid()}-{side}" for side in "ab"]
    ip = find_program("ip")
    try:
        for name in names:
            run_program([ip, "netns", "add", name])
        cable = ("type", "veth", "peer", "name", "eth0", "netns", names[1])
        run_program([ip, "link", "add", "eth0", "netns", names[0], *cable])
        for last, name in enumerate(names, 1):
            run_program([ip, "-n", name, "address", "add", f"10.78.0.{last}/24", "dev", "eth0"])
            for device in ("lo", "eth0"):
                run_program([ip, "-n", name, "link", "set", device, "up"])
        yield [((ip, "netns", "exec", name), f"10.78.0.{last}") for last, name in enumerate(names, 1)]
    finally:
        for name in names:
            subprocess.run([ip, "netns", "delete", name], check=False, capture_output=True)


def test_two_machines_each_started_by_hand(machines, rospy, say, tmp_path):
    """Nothing is shared but the cable: the master, the publishing side and the subscriber find each other over it."""
    say("measure", "show", tmp_path / "none.jsonl")  # sets the cache up, and runs nothing
    (robot, address), (desk, own) = machines
    command = [sys.executable, "-c", START, "measure"]
    # A robot at a cable has no route elsewhere, and has to be told which address the other machine sees.
    alone = subprocess.run([*robot, *command, "publisher", "--nodes", "rospy"], capture_output=True, text=True)
    assert alone.returncode == 2 and "give it with --address" in alone.stderr
    serving = subprocess.Popen(
        [*robot, *command, "publisher", "--nodes", "rospy", "--address", address], stderr=subprocess.PIPE, text=True
    )
    try:
        assert serving.stderr is not None
        line = serving.stderr.readline()
        master = re.search(r"rosimpact measure subscriber --master (http://10\.78\.0\.1:11311)$", line)
        assert master, line
        output = tmp_path / "two.jsonl"
        subscriber = subprocess.run(
            [*desk, *command, "subscriber", "--nodes", "rospy", "--master", master[1], "--output", output, *SIZES,
             *SHORT], capture_output=True, text=True, timeout=300, cwd=tmp_path,
        )  # fmt: skip
        assert subscriber.returncode == 0, subscriber.stderr
        assert "two machines: CLOCK_REALTIME on both" in subscriber.stdout
        assert "latencies are known to within ±" in subscriber.stdout
        found = read(output)
        assert (found["full"].bytes, found["pruned"].bytes) == (60_032, 20_024)
        for result in found.values():
            # One clock after all, so that the offset is 0 within what is said of it.
            assert abs(result.clock_offset_ms) <= result.clock_uncertainty_ms + 0.001
            assert result.delivered > 0 and result.latency_mean_ms > -result.clock_uncertainty_ms
        assert serving.stderr.readline() == f"{own} is connected\n"
    finally:
        serving.send_signal(signal.SIGINT)
        assert serving.wait(30) == 130
