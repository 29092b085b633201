"""Namespaces, links and processes: made, found again, removed. Skips where the machine does not allow them."""

import contextlib
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from rosimpact.edges.console import UserError
from rosimpact.impact.measure import namespaces
from rosimpact.impact.measure.children import Child, find_program, run_program
from rosimpact.impact.measure.namespaces import list_namespaces, open_namespaces, open_work_folder, remove_leftovers

LINK = 20_000_000




def test_both_sides_reach_each_other_over_links_that_are_limited(allowed):
    with open_namespaces(LINK) as sites:
        mine = [name for name in list_namespaces() if f"-{os.getpid()}-" in name]
        assert [name.rpartition("-")[2] for name in mine] == ["publisher", "router", "subscriber"]
        shaped = [run_program([find_program("tc"), "-n", name, "qdisc", "show"]) for name in mine]
        assert len(re.findall(r"rate 20Mbit burst 4Kb", "".join(shaped))) == 4
        hello = (
            "import socket, sys\n"
            "with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as s:\n"
            " s.settimeout(5); s.bind((sys.argv[1], 0)); print(s.getsockname()[1], flush=True); print(s.recv(9))"
        )
        receiver = subprocess.Popen(
            [*sites.subscriber.prefix, sys.executable, "-c", hello, sites.subscriber.address],
            stdout=subprocess.PIPE, text=True,
        )  # fmt: skip
        assert receiver.stdout is not None
        port = int(receiver.stdout.readline())
        send = f"import socket; socket.socket(2, 2).sendto(b'hello', ('{sites.subscriber.address}', {port}))"
        run_program([*sites.publisher.prefix, sys.executable, "-c", send])
        assert receiver.communicate(timeout=10)[0] == "b'hello'\n"
    assert [name for name in list_namespaces() if f"-{os.getpid()}-" in name] == []


def test_they_are_removed_when_the_work_fails(allowed):
    with pytest.raises(ZeroDivisionError), open_namespaces(0):
        raise ZeroDivisionError
    assert [name for name in list_namespaces() if f"-{os.getpid()}-" in name] == []


STAYS = """
import sys, time
from rosimpact.impact.measure.namespaces import open_namespaces, open_work_folder
from rosimpact.impact.measure.children import Child
with open_work_folder() as folder, open_namespaces(0) as sites:
    if sys.argv[1] == "child":
        import subprocess
        subprocess.Popen([*sites.subscriber.prefix, "sleep", "60"], start_new_session=True)
    print("here", flush=True)
    time.sleep(60)
"""


def start_run(*arguments):
    child = subprocess.Popen(
        [sys.executable, "-c", STAYS, *arguments], stdout=subprocess.PIPE, text=True, env=dict(os.environ)
    )
    assert child.stdout is not None and child.stdout.readline() == "here\n"
    return child


def test_leftovers_of_a_killed_run_are_removed_and_those_of_a_living_one_are_not(allowed, tmp_path, monkeypatch):
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    monkeypatch.setattr("tempfile.tempdir", None)
    living, killed = start_run("alone"), start_run("child")
    try:
        killed.send_signal(signal.SIGKILL)
        killed.wait()
        left = [name for name in list_namespaces() if f"-{killed.pid}-" in name]
        assert len(left) == 3
        inside = run_program([find_program("ip"), "netns", "pids", left[-1]]).split()
        assert len(inside) == 1
        removed = remove_leftovers()
        assert set(left) < set(removed)
        assert [name for name in removed if f"-{living.pid}-" in name] == []
        assert [name for name in list_namespaces() if f"-{killed.pid}-" in name] == []
        assert len([name for name in list_namespaces() if f"-{living.pid}-" in name]) == 3
        assert len(list(tmp_path.iterdir())) == 1
        until = time.monotonic() + 10
        while Path(f"/proc/{inside[0]}").exists() and time.monotonic() < until:
            if "\nState:\tZ" in Path(f"/proc/{inside[0]}/status").read_text():
                break
            time.sleep(0.05)
        else:
            assert not Path(f"/proc/{inside[0]}").exists()
    finally:
        for each in (living, killed):
            each.kill()
            each.wait()
        remove_leftovers()


def test_a_name_is_ours_by_process_and_start():
    own = f"{namespaces._make_owner()}-router"
    assert namespaces._is_alive(namespaces._NAME, own)
    process, start = re.findall(r"\d+", own)
    assert not namespaces._is_alive(namespaces._NAME, f"rosimpact-{process}-{int(start) + 1}-router")
    assert not namespaces._is_alive(namespaces._NAME, f"rosimpact-{2**22 + 1}-{start}-router")
    assert not namespaces._NAME.fullmatch("rosimpact-mine")


def test_a_folder_for_temporary_files_goes_with_its_run(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    with open_work_folder() as folder:
        assert folder.parent == tmp_path and remove_leftovers() == []
    gone = tmp_path / "rosimpact-1-0-work-abc"
    (gone / "logs").mkdir(parents=True)
    (tmp_path / "rosimpact-report").mkdir()
    monkeypatch.setattr(namespaces, "list_namespaces", list)
    assert remove_leftovers() == [gone.name]
    assert [path.name for path in tmp_path.iterdir()] == ["rosimpact-report"]


def test_what_could_not_be_removed_is_not_said_to_be(tmp_path, monkeypatch):
    def refuse(command):
        raise UserError("not permitted")

    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    monkeypatch.setattr(namespaces, "run_program", refuse)
    monkeypatch.setattr(namespaces, "list_namespaces", lambda: ["rosimpact-1-0-router"])
    assert remove_leftovers() == []


# Children


@pytest.fixture
def start(tmp_path):
    started = []

    def run(code):
        started.append(Child([sys.executable, "-c", code], dict(os.environ), tmp_path / "log"))
        return started[-1]

    yield run
    for each in started:
        each.stop()


def test_only_lines_for_the_runner_are_heard(start):
    child = start("print('[ INFO] noise'); print('measure:ready', flush=True); print('measure:' + input())")
    assert child.wait_for_line(10) == "ready"
    child.send("start 5")
    assert child.wait_for_line(10) == "start 5"
    child.wait(10)


@pytest.mark.parametrize(
    ("code", "seconds", "said"),
    [
        ("import sys; sys.exit('no such topic')", 10, "ended with status 1: no such topic"),
        ("import time; time.sleep(60)", 0.3, "said nothing for 0.3 s"),
        ("print('something else', flush=True); import time; time.sleep(60)", 0.3, "said nothing"),
    ],
)
def test_a_child_that_does_not_answer(start, code, seconds, said):
    with pytest.raises(UserError, match=said):
        start(code).wait_for_line(seconds)


def test_a_child_is_stopped_though_it_ignores_the_request(start):
    child = start("import signal, time; signal.signal(15, signal.SIG_IGN); print('measure:on', flush=True)\n"
                  "while True: time.sleep(1)")  # fmt: skip
    child.wait_for_line(10)
    child.stop()
    assert not child.is_running()


def test_a_program_that_fails_says_why():
    with pytest.raises(UserError, match="`sh -c echo sorry >&2; exit 3` failed: sorry"):
        run_program(["sh", "-c", "echo sorry >&2; exit 3"])
    with pytest.raises(UserError, match="cannot be started"):
        run_program(["/no/such/program"])
    with pytest.raises(UserError, match="did not end within"), contextlib.suppress(subprocess.TimeoutExpired):
        run_program(["sleep", "60"], seconds=0.2)
