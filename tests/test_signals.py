"""Ctrl-C, requests to end, and shortages: one line, a status, nothing left behind."""

import json
import os
import pty
import resource
import select
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import z3
from rosimpact.edges import console

MANIFEST = """<package format="3"><name>{0}</name><version>1.0.0</version><description>d</description>
<maintainer email="a@b.org">a</maintainer><license>MIT</license><buildtool_depend>ament_cmake</buildtool_depend>
<depend>no_such_key</depend><export><build_type>ament_cmake</build_type></export></package>
"""
# What the installed command does; a letter on the descriptor tells that our part of the program has begun.
PROGRAM = """
import os, sys
from rosimpact.edges import interrupts
interrupts.install()
os.write({0}, b"s")
from rosimpact.impact.cli.start import main
sys.argv[0] = "rosimpact"
sys.exit(main())
"""


@pytest.fixture(scope="module")
def ws(tmp_path_factory) -> Path:
    """A workspace that is worth several processes."""
    root = tmp_path_factory.mktemp("signals") / "ws"
    for number in range(12):
        package = root / f"p{number}"
        (package / "src").mkdir(parents=True)
        (package / "package.xml").write_text(MANIFEST.format(package.name))
        (package / "CMakeLists.txt").write_text(
            f"project({package.name})\nfind_package(rclcpp)\nadd_executable(a src/f0.cpp)\n"
            "target_link_libraries(b rclcpp)\n"
        )
        for place in range(8):
            lines = "".join(f"int f{number}_{place}_{k}() {{ return {k}; }}\n" for k in range(150))
            (package / f"src/f{place}.cpp").write_text("#include <rclcpp/rclcpp.hpp>\n" + lines)
    return root


class Run:
    """A check that has begun, alone in its session, with a cache of its own."""

    def __init__(self, ws: Path, cache: Path, *arguments: str):
        self.cache = cache
        began, told = os.pipe()
        self.process = subprocess.Popen(
            [sys.executable, "-c", PROGRAM.format(told), "check", str(ws), "-t", "jazzy", "-f", "json", *arguments],
            env={**os.environ, "ROSIMPACT_CACHE": str(cache), "PYTHONDONTWRITEBYTECODE": "1"},
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            pass_fds=(told,),
            start_new_session=True,
        )
        os.close(told)
        assert os.read(began, 1) == b"s"
        os.close(began)

    def end(self) -> tuple[int, str, str]:
        out, err = self.process.communicate(timeout=120)
        return self.process.returncode, out.decode(), err.decode()

    def left(self) -> list[str]:
        """Processes of the session that live on."""
        found = []
        for place in os.listdir("/proc"):
            try:
                if place.isdigit() and int(Path(f"/proc/{place}/stat").read_text().rpartition(")")[2].split()[3]) == (
                    self.process.pid
                ):
                    found.append(place)
            except OSError:
                continue
        return found


def is_clean(status: int, out: str, err: str) -> None:
    assert status in (1, 130), err
    lines = err.splitlines()
    assert len(lines) <= 1, err
    if status == 130:
        assert out == "" and len(lines) == 1 and "rosimpact: interrupted" in lines[0]
    else:
        assert json.loads(out)["findings"]


@pytest.mark.parametrize("signalled", [signal.SIGINT, signal.SIGTERM])
def test_signal_after_the_interpreter_let_go_of_its_handlers(signalled):
    """The report is written and the modules are being cleared away."""
    program = f"""
import os
from rosimpact.edges import interrupts
interrupts.install()
class Last:
    def __del__(self, kill=os.kill, me=os.getpid(), write=os.write):
        write(1, b"last")
        kill(me, {int(signalled)})
last = Last()
interrupts.finish(1)
raise SystemExit(1)
"""
    ended = subprocess.run([sys.executable, "-c", program], capture_output=True, timeout=60)
    assert (ended.returncode, ended.stdout) == (1, b"last")


@pytest.mark.parametrize("signalled", [signal.SIGINT, signal.SIGTERM])
def test_interrupted_at_any_moment(ws, tmp_path, signalled):
    """One process alone and the whole group, from the first import to the report."""
    statuses = set()
    for number in range(7):
        run = Run(ws, tmp_path / str(number))
        time.sleep(number**2 * 0.05)
        if number % 2:
            os.killpg(run.process.pid, signalled)
        else:
            run.process.send_signal(signalled)
        ended = run.end()
        is_clean(*ended)
        statuses.add(ended[0])
        deadline = time.monotonic() + 20
        while run.left() and time.monotonic() < deadline:
            time.sleep(0.05)
        assert not run.left(), "no process lives on"
    assert 130 in statuses


def test_what_was_interrupted_is_gone_on_with(ws, tmp_path):
    for wait in (0.3, 0.9):
        run = Run(ws, tmp_path)
        time.sleep(wait)
        run.process.send_signal(signal.SIGINT)
        is_clean(*run.end())
    status, out, err = Run(ws, tmp_path).end()
    assert (status, err) == (1, "")
    status, other, _ = Run(ws, tmp_path / "other").end()
    assert json.loads(out)["findings"] == json.loads(other)["findings"]


def test_twice_in_a_row_is_once(ws, tmp_path):
    run = Run(ws, tmp_path)
    time.sleep(0.7)
    for _ in range(5):
        run.process.send_signal(signal.SIGINT)
        time.sleep(0.01)
    is_clean(*run.end())


def test_the_key_on_a_terminal(ws, tmp_path):
    for wait in (0.0, 0.4, 1.0):
        process, terminal = pty.fork()
        if process == 0:
            os.environ["ROSIMPACT_CACHE"] = str(tmp_path / str(wait))
            os.execv(sys.executable, [sys.executable, "-c", PROGRAM.format(1), "check", str(ws), "-t", "jazzy"])
        assert os.read(terminal, 1) == b"s"
        time.sleep(wait)
        os.write(terminal, b"\x03")
        said = b""
        waiting = select.poll()
        waiting.register(terminal, select.POLLIN)
        try:
            while waiting.poll(60_000) and (piece := os.read(terminal, 65536)):
                said += piece
        except OSError:
            pass  # the other end is closed
        status = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
        os.close(terminal)
        assert status in (130, 1) and b"Traceback" not in said and b"Exception" not in said
        assert status == 1 or b"rosimpact: interrupted" in said


def test_an_ignored_interrupt_stays_ignored(ws, tmp_path):
    """`nohup`, and `&` in a script: the keys are for somebody else."""
    ignored = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        run = Run(ws, tmp_path)
    finally:
        signal.signal(signal.SIGINT, ignored)
    for _ in range(3):
        time.sleep(0.2)
        run.process.send_signal(signal.SIGINT)
    assert run.end()[0] == 1


def limited(kind: int, limit: int):
    def apply() -> None:
        resource.setrlimit(kind, (limit, limit))

    return apply


COMMAND = [sys.executable, "-c", "import sys; from rosimpact.impact.cli.start import main; sys.exit(main())"]


@pytest.mark.parametrize("files", [5, 12, 18, 24])
def test_few_open_files(ws, cache, files):
    run = subprocess.run(
        [*COMMAND, "check", str(ws), "-t", "jazzy"],
        env={**os.environ, "ROSIMPACT_CACHE": str(cache)},
        preexec_fn=limited(resource.RLIMIT_NOFILE, files),
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert run.returncode in (1, 2)
    assert "Traceback" not in run.stderr and "fault of rosimpact" not in run.stderr + run.stdout


@pytest.mark.parametrize("megabytes", [40, 100, 220])
def test_little_memory(ws, cache, megabytes):
    run = subprocess.run(
        [*COMMAND, "check", str(ws), "-t", "jazzy", "-j", "1"],
        env={**os.environ, "ROSIMPACT_CACHE": str(cache)},
        preexec_fn=limited(resource.RLIMIT_AS, megabytes << 20),
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert run.returncode in (1, 2)
    assert "Traceback" not in run.stderr and "fault of rosimpact" not in run.stderr + run.stdout


@pytest.mark.parametrize("closed", [(0,), (1,), (2,), (0, 1, 2)])
def test_closed_streams(ws, cache, closed):
    """No file of ours gets the place of a stream, and with it what is printed."""

    def close() -> None:
        for descriptor in closed:
            os.close(descriptor)

    run = subprocess.run(
        [*COMMAND, "check", str(ws), "-t", "jazzy"],
        env={**os.environ, "ROSIMPACT_CACHE": str(cache)},
        preexec_fn=close,
        capture_output=True,
        text=True,
        timeout=60,
    )
    assert run.returncode == (2 if 1 in closed else 1)
    assert "Traceback" not in run.stderr and "fault of rosimpact" not in run.stderr
    assert 1 in closed or "nonexistent-target" in run.stdout


# (error, what is said of it)
SHORTAGES = [
    (MemoryError(), "not enough memory"),
    (OSError(12, "Cannot allocate memory"), "not enough memory"),
    (ImportError("x.so: failed to map segment from shared object"), "not enough memory"),
    (z3.Z3Exception(b"out of memory"), "not enough memory"),
    (OSError(24, "Too many open files", "/x"), "ulimit -n"),
    (OSError(23, "Too many open files in system"), "ulimit -n"),
    (OSError(11, "Resource temporarily unavailable"), "--jobs 1"),
    (RuntimeError("can't start new thread"), "--jobs 1"),
    (RecursionError("maximum recursion depth exceeded"), "nested too deeply"),
    (OSError(28, "No space left on device", "/x"), "/x: No space left on device; make room there"),
    (PermissionError(13, "Permission denied", "a\n::b"), "a\\n::b: Permission denied"),
    (OSError(5, "Input/output error"), "the place: Input/output error"),
]


@pytest.mark.parametrize(("error", "words"), SHORTAGES)
def test_what_runs_out_is_no_fault_of_rosimpact(capfd, error, words):
    def work() -> int:
        raise error

    assert console.run_command(work, about="the place") == 2
    said = capfd.readouterr().err
    assert words in said and "fault" not in said and len(said.splitlines()) == 1
    if not isinstance(error, OSError):
        assert words in console.describe_unforeseen(error), "the same where a rule or an extractor fails"


def test_a_start_that_fails_is_one_line():
    code = "import sys; sys.modules['rosimpact.impact.cli.app'] = None\n"
    code += "from rosimpact.impact.cli.start import main; main()"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert run.returncode == 2 and run.stdout == ""
    assert run.stderr.startswith("rosimpact: ") and len(run.stderr.splitlines()) == 1


def test_limits_that_cannot_be_read_are_named(say, ws, monkeypatch):
    from rosimpact.edges import limits

    monkeypatch.setenv("ROSIMPACT_LIMITS", "cpp=much")
    limits.get_limits.cache_clear()
    try:
        said = say("check", ws, "-t", "jazzy")
    finally:
        limits.get_limits.cache_clear()
    assert said.status == 2 and "ROSIMPACT_LIMITS" in said.err and "cpp=32MB" in said.err
