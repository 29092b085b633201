"""Runs commands of rosimpact in forked children of one process that has imported all of it, and watches them.

A line of JSON on standard input asks for one run (see `Run` in harness.py), a line of JSON on the answering descriptor
tells how it ended. This file is run by the interpreter that has rosimpact, and needs nothing else.
"""

import contextlib
import functools
import gc
import importlib
import json
import os
import resource
import signal
import sys
import time

TICK = 0.004
LOOK = 0.2  # seconds between two looks at /proc
STILL = 6.0  # seconds without any use of the processor after which a run counts as blocked
KILL_MEMORY = 2_500_000_000
TICKS = os.sysconf("SC_CLK_TCK")
PAGE = os.sysconf("SC_PAGE_SIZE")


def session_of(leader):
    """{pid: (seconds of processor time with reaped children, bytes resident)} of all processes of a session."""
    found = {}
    for name in filter(str.isdigit, os.listdir("/proc")):
        try:
            if os.getsid(int(name)) != leader:
                continue
            with open(f"/proc/{name}/stat", "rb") as file:
                fields = file.read().rpartition(b") ")[2].split()
        except OSError:
            continue
        seconds = sum(map(int, fields[11:15])) / TICKS
        found[int(name)] = (seconds, int(fields[21]) * PAGE, fields[0])
    return found


def start(job):
    """The child's side: its session, streams, limits and environment; then the program, or main() for a warm run."""
    os.setsid()
    os.chdir(job["cwd"])
    if job["stdin"] == "tty":
        slave = os.openpty()[1]
        os.dup2(slave, 0)
    else:
        os.dup2(os.open(job["stdin"] or "/dev/null", os.O_RDONLY), 0)
    for number, name in ((1, job["stdout"]), (2, job["stderr"])):
        if name == "closed":
            os.close(number)
        elif name == "broken":
            reading, writing = os.pipe()
            os.close(reading)
            os.dup2(writing, number)
        else:
            os.dup2(os.open(name, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o600), number)
    os.closerange(3, 256)
    for name, value in job["limits"].items():
        resource.setrlimit(getattr(resource, name), (value, value))
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)
    if job["direct"]:
        signal.signal(signal.SIGPIPE, signal.SIG_DFL)
        os.execve(job["command"][0], job["command"], {**job["environment"]})
    os.environ.clear()
    os.environ.update(job["environment"])
    sys.argv = job["command"]


def watch(child, job):
    """Waits for the child. Gives what is known of its end."""
    began = begun = looked = moved = time.monotonic()
    used = most = 0.0
    killed = ""
    pending = job["signal"]
    while True:
        pid, status, usage = os.wait4(child, os.WNOHANG)
        now = time.monotonic()
        if pid:
            break
        if pending and pending[3:] and not os.path.exists(pending[3]):
            begun = now
        elif pending and now - begun >= pending[1]:
            with contextlib.suppress(OSError):  # at its end, or before it has a group
                (os.killpg if pending[2:3] == ["group"] else os.kill)(child, pending[0])
            pending = None
        if now - looked > LOOK and not killed:
            looked = now
            processes = session_of(child)
            seconds = sum(each[0] for each in processes.values())
            most = max(most, *(each[1] for each in processes.values()), 0)
            if seconds > used + 0.02:
                used, moved = seconds, now
            if seconds > job["seconds"]:
                killed = "processor time"
            elif most > KILL_MEMORY:
                killed = "memory"
            elif now - moved > STILL and not any(each[2] == b"D" for each in processes.values()):
                killed = "blocked"
            elif now - began > job["wall"]:
                killed = "time"
            if killed:
                for each in processes:
                    end(each)
        time.sleep(TICK)
    left = []
    for _ in range(20):
        left = [each for each, what in session_of(child).items() if what[2] != b"Z"]
        if not left:
            break
        time.sleep(0.05)
    for each in left:
        end(each)
    return {
        "status": os.waitstatus_to_exitcode(status),
        "cpu": max(used, usage.ru_utime + usage.ru_stime),
        "rss": max(int(most), usage.ru_maxrss * 1024),
        "wall": now - began,
        "killed": killed,
        "left": 0 if killed else len(left),
    }


def end(pid):
    with contextlib.suppress(OSError):
        os.kill(pid, signal.SIGKILL)


def warm(names):
    for name in names:
        if (name.startswith("_") and "." not in name) or "__main__" in name:
            continue
        try:
            importlib.import_module(name)
        except BaseException:
            continue
    prepare()


def prepare():
    """Builds what every run builds from the program's own code alone, whatever its workspace and cache hold."""
    try:
        import typer.main
        from rosimpact.impact.cli.app import _select_command
        from rosimpact.impact.facts import kinds
        from rosimpact.impact.rules.rule import load_rules
    except ImportError:  # older versions
        return
    load_rules()
    for kind in kinds.EXTRACTORS:
        kinds._make_decoder(kind)
    build = typer.main.get_command = functools.cache(typer.main.get_command)
    for name in ("check", "graph", "impact", "logic", "upgrade", "why", "env"):
        build(_select_command(name))


def look_up(workspace, environment):
    """Checks a workspace in this process, so that runs know already what the targets and the program's tables hold."""
    os.environ.clear()
    os.environ.update(environment)
    try:
        from rosimpact.edges import processes
        from rosimpact.impact.analysis.check import check
        from rosimpact.impact.analysis.session import Options
    except ImportError:  # older versions
        return
    may_fork, processes.may_fork = processes.may_fork, lambda: False
    check(workspace, Options(targets=("humble", "jazzy", "lyrical"), preview=True, jobs=1))
    processes.may_fork = may_fork


def main():
    answers = int(sys.argv[1])  # no object, which would close what has its number in a child
    for line in sys.stdin:
        job = json.loads(line)
        if "warm" in job:
            warm(job["warm"])
            if "workspace" in job:
                look_up(job["workspace"], job["environment"])
            gc.collect()
            gc.freeze()
            os.write(answers, b"{}\n")
            continue
        sys.stdout.flush()
        child = os.fork()
        if not child:
            start(job)
            return True
        os.write(answers, json.dumps(watch(child, job)).encode() + b"\n")
    return False


if __name__ == "__main__" and main():
    try:
        from rosimpact.impact.cli.start import main as run
    except ImportError:  # older versions
        from rosimpact.impact.cli.app import main as run

    sys.stdin = os.fdopen(0, closefd=False)
    sys.exit(run())
