"""Proof of a pruning: both versions built, run under the same input, and what their nodes publish compared."""

from __future__ import annotations

import contextlib
import json
import os
import re
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ...edges.console import UserError
from ...edges.documents import DocumentError, load_json
from ...edges.files import read_text
from .planner import PrunePlan, TopicPlan
from .session import Prepared, write_copy

_TOPLEVEL = ("/opt/ros/noetic/share", "/opt/ros/melodic/share", "/usr/share")
_NEEDS = "catkin, cmake and a compiler; on Debian: apt install catkin libroscpp-dev ros-message-generation"
_ERROR = re.compile(r"\berror\b|\bError\b|No rule|not found", re.ASCII)
_GOAL = re.compile(r"(?<=-)\d{9,}\.\d+\Z")
_BUILD_SECONDS = 1_800
_MOST_BYTES = 1_000_000_000
Say = Callable[[str], None]


class TopicResult(NamedTuple):
    """What was compared of a topic and a node. before, after: messages; bytes of a message on the wire, on average.
    how: `in order` or `as a set`. difference: the first, empty where there is none."""

    topic: str
    node: str
    before: int
    after: int
    bytes_before: float
    bytes_after: float
    how: str
    difference: str = ""


class Verification(NamedTuple):
    """failure: why a version could not be built or run; empty else. exits: commands that ended otherwise."""

    failure: str
    topics: tuple[TopicResult, ...] = ()
    exits: tuple[str, ...] = ()

    @property
    def is_equal(self) -> bool:
        """Whether both versions were built, and were seen to do the same."""
        return not self.failure and not self.exits and not any(one.difference for one in self.topics)


class _Message(NamedTuple):
    size: int
    fields: Any


class _Run(NamedTuple):
    """What was seen of a run: messages by topic and node, and how each command ended, None for one that had to be
    stopped."""

    messages: dict[tuple[str, str], list[_Message]]
    ended: list[int | None]


def verify(
    root: Path, prepared: Prepared, *, commands: Sequence[str] = (), seconds: float = 10.0,
    say: Say = lambda text: None, keep: Path | None = None,
) -> Verification:  # fmt: skip
    """Builds a workspace of ROS 1 before and after its pruning; with commands, runs both for some seconds, and compares
    what is published. commands: each starts a node, or plays a recording: `package/executable arguments`, or
    anything of the shell. keep: a folder for both versions, a temporary one without. Raises UserError where something
    that it needs is missing."""
    if not prepared.plan.plans:
        raise UserError(f"{root}: nothing is pruned, so that there is nothing to compare")
    python = find_python() if commands else ""
    toplevel = find_toplevel()
    with contextlib.ExitStack() as stack:
        if keep is None:
            folder = Path(stack.enter_context(tempfile.TemporaryDirectory(prefix="rosimpact-verify-")))
        else:
            folder = keep
            if folder.exists() and any(folder.iterdir()):
                raise UserError(f"{folder}: is not empty; name a new folder")
        runs: list[_Run] = []
        empty = prepared._replace(plan=PrunePlan((), (), {}, {}), originals={})
        for name, version in (("before", empty), ("after", prepared)):
            say(f"building the workspace as it is {name} pruning")
            failure = build(root, folder / name, version, toplevel)
            if failure:
                return Verification(f"the workspace {name} pruning does not build: {failure}")
        for name in ("before", "after") if commands else ():
            say(f"running the workspace as it is {name} pruning, {seconds:g} s")
            runs.append(run(folder / name, commands, seconds, python))
        return compare(prepared.plan.plans, runs[0], runs[1], commands) if runs else Verification("")


def find_toplevel() -> Path:
    """catkin's CMake file for whole workspaces. Raises UserError."""
    prefixes = [Path(one, "share") for one in os.environ.get("CMAKE_PREFIX_PATH", "").split(os.pathsep) if one]
    for share in (*prefixes, *map(Path, _TOPLEVEL)):
        found = share / "catkin" / "cmake" / "toplevel.cmake"
        if found.is_file() and shutil.which("cmake"):
            return found
    raise UserError(f"--verify: needs {_NEEDS}")


def find_python() -> str:
    """The Python that has rospy, and netifaces, which rospy imports when it connects and Debian's packages of it do not
    bring. Raises UserError."""
    for python in ("/usr/bin/python3", shutil.which("python3") or "", sys.executable):
        if python and os.path.exists(python):
            done = subprocess.run([python, "-c", "import rospy, rosgraph, netifaces"], capture_output=True, check=False)
            if not done.returncode:
                return python
    needed = "python3-rospy python3-netifaces python3-rosmaster"
    raise UserError(f"--verify: needs rospy and a master; on Debian: apt install {needed}")


def build(root: Path, folder: Path, prepared: Prepared, toplevel: Path) -> str:
    """Copies a workspace with its changes and builds it; gives the first errors, empty for none."""
    source = folder / "src"
    source.mkdir(parents=True)
    write_copy(root, source / "workspace", prepared)
    shutil.copy(toplevel, source / "CMakeLists.txt")
    inner = source / "workspace" / "src" / "CMakeLists.txt"
    if inner.is_symlink() or (inner.is_file() and "toplevel" in read_text(inner, _MOST_BYTES, "replace")):
        inner.unlink()
    environment = make_environment(folder)
    python = "/usr/bin/python3" if os.path.exists("/usr/bin/python3") else sys.executable
    configure = [
        "cmake", "-S", str(source), "-B", str(folder / "build"), f"-DPYTHON_EXECUTABLE={python}",
        f"-DPython3_EXECUTABLE={python}",  # what packages of ament ask for, of which Debian's catkin has some
        f"-DCATKIN_DEVEL_PREFIX={folder / 'devel'}",
        # The default target builds no tests, but their libraries would have to be here.
        "-DCATKIN_ENABLE_TESTING=OFF",
    ]  # fmt: skip
    for command in (configure, ["cmake", "--build", str(folder / "build"), "--parallel", str(os.cpu_count() or 1)]):
        try:
            done = subprocess.run(
                command, capture_output=True, text=True, errors="replace", env=environment, timeout=_BUILD_SECONDS,
                check=False,
            )  # fmt: skip
        except subprocess.TimeoutExpired:
            return f"it takes more than {_BUILD_SECONDS} s"
        if done.returncode:
            lines = [line.strip() for line in (done.stderr + done.stdout).splitlines() if _ERROR.search(line)]
            return "; ".join(lines[:4]) or f"`{command[0]}` gives {done.returncode}"
    return ""


def make_environment(folder: Path, master: str = "") -> dict[str, str]:
    """The environment in which a built version runs. master: its address."""
    devel = folder / "devel"
    own = {key: value for key, value in os.environ.items() if key != "ROS_DISTRO" or os.path.isdir(f"/opt/ros/{value}")}
    packages = [str(devel / "lib" / name) for name in _list_folders(devel / "lib")]
    python = [str(devel / "lib" / name / "dist-packages") for name in _list_folders(devel / "lib") if "python" in name]

    def put_first(name: str, values: Sequence[str]) -> str:
        return os.pathsep.join([*values, *filter(None, [os.environ.get(name, "")])])

    own.update(
        PATH=put_first("PATH", packages),
        PYTHONPATH=put_first("PYTHONPATH", python),
        LD_LIBRARY_PATH=put_first("LD_LIBRARY_PATH", [str(devel / "lib")]),
        CMAKE_PREFIX_PATH=put_first("CMAKE_PREFIX_PATH", []),
        ROS_PACKAGE_PATH=os.pathsep.join([str(folder / "src"), os.environ.get("ROS_PACKAGE_PATH", "/usr/share")]),
        ROS_LOG_DIR=str(folder / "logs"),
        ROS_HOSTNAME="localhost",
    )
    own.pop("ROS_IP", None)
    if master:
        own["ROS_MASTER_URI"] = master
    return own


def _list_folders(folder: Path) -> list[str]:
    return sorted(one.name for one in folder.iterdir() if one.is_dir()) if folder.is_dir() else []


def run(folder: Path, commands: Sequence[str], seconds: float, python: str) -> _Run:
    """Runs commands with a master of their own, and records what is published. Raises UserError where the master does
    not start."""
    port = _find_port()
    environment = make_environment(folder, f"http://localhost:{port}")
    (folder / "logs").mkdir(exist_ok=True)
    recorded = folder / "recorded.jsonl"
    with contextlib.ExitStack() as stack:
        log = stack.enter_context(open(folder / "logs" / "output.txt", "ab"))

        def start(command: list[str]) -> subprocess.Popen[bytes]:
            process = subprocess.Popen(
                command, env=environment, stdout=log, stderr=log, stdin=subprocess.DEVNULL, start_new_session=True
            )
            stack.callback(_stop, process)
            return process

        start(["rosmaster", "--core", "-p", str(port)])
        _wait_for(port)
        recorder = start([python, str(Path(__file__).with_name("recorder.py")), str(recorded)])
        time.sleep(1.0)
        started = []
        for command in commands:
            started.append(start(["/bin/sh", "-c", f"exec {resolve_command(folder, command)}"]))
            time.sleep(0.5)
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline and any(one.poll() is None for one in started):
            time.sleep(0.1)
        ended = [one.poll() for one in started]
        for process in started:
            _stop(process)
        time.sleep(0.3)
        _stop(recorder)
    return _Run(_read_recorded(recorded), ended)


def resolve_command(folder: Path, command: str) -> str:
    """A command as the shell takes it: `package/executable arguments` becomes the path of what was built, or of a
    script of the package."""
    head, _, rest = command.partition(" ")
    package, slash, name = head.partition("/")
    if slash and name and "/" not in name and not head.startswith(("/", ".")):
        places = [folder / "devel" / "lib" / package / name, *sorted((folder / "src").rglob(f"{package}/**/{name}"))]
        for place in places:
            if place.is_file() and os.access(place, os.X_OK):
                return f"'{place}' {rest}"
        raise UserError(f"--run {command}: {package} has no program {name}; name it as `package/executable`")
    return command


def _find_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def _wait_for(port: int) -> None:
    for _ in range(100):
        with socket.socket() as one:
            one.settimeout(0.5)
            if not one.connect_ex(("127.0.0.1", port)):
                return
        time.sleep(0.1)
    raise UserError("--verify: the ROS master does not start; on Debian: apt install python3-rosmaster")


def _stop(process: subprocess.Popen[bytes]) -> None:
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
        if process.poll() is not None:
            break
        with contextlib.suppress(ProcessLookupError):
            os.killpg(process.pid, number)
        with contextlib.suppress(subprocess.TimeoutExpired):
            process.wait(3 if number != signal.SIGINT else 5)
    with contextlib.suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)


def _read_recorded(path: Path) -> dict[tuple[str, str], list[_Message]]:
    found: dict[tuple[str, str], list[_Message]] = {}
    lines = read_text(path, _MOST_BYTES).splitlines() if path.is_file() else []
    for line in lines:
        with contextlib.suppress(DocumentError, ValueError, TypeError):
            topic, node, size, fields, _ = load_json(line)
            found.setdefault((topic, _strip_number(node)), []).append(_Message(size, fields))
    return found


def _strip_number(node: str) -> str:
    """A node's name without the numbers that make an anonymous one."""
    return re.sub(r"_\d{4,}(_\d+)?\Z", "", node)


def compare(plans: Sequence[TopicPlan], before: _Run, after: _Run, commands: Sequence[str]) -> Verification:
    """What two runs published, compared on the fields that are kept."""
    keep = {topic: plan.keep for plan in plans for topic in plan.topics}
    exits = tuple(
        f"`{command}` ended with {_name_exit(one)} before, and {_name_exit(other)} after"
        for command, one, other in zip(commands, before.ended, after.ended, strict=True)
        if one != other
    )
    results: list[TopicResult] = []
    for key in sorted({*before.messages, *after.messages}):
        first, second = before.messages.get(key, []), after.messages.get(key, [])
        paths = keep.get(key[0])
        old, new = (
            [_spell(keep_paths(leave_out_run(key[0], one.fields), paths)) for one in rows] for rows in (first, second)
        )
        how, difference = find_difference(old, new)
        results.append(
            TopicResult(*key, len(old), len(new), _average(first), _average(second), how, difference)
        )
    if not results:
        return Verification("nothing was published in either run; give it more --seconds, or other commands")
    return Verification("", tuple(results), exits)


def leave_out_run(topic: str, fields: Any) -> Any:
    """A message without what differs from run to run: numbers that actionlib makes of the time for its goals, and in
    logs the lines of the source, which move where code is added, and the order in which a node names its topics."""
    if isinstance(fields, str):
        return _GOAL.sub("now", fields)
    if isinstance(fields, list):
        return [leave_out_run("", one) for one in fields]
    if not isinstance(fields, dict):
        return fields
    found = {name: leave_out_run("", value) for name, value in fields.items()}
    if topic == "/rosout":
        found = {name: value for name, value in found.items() if name not in ("file", "line")}
        found["topics"] = sorted(found.get("topics", []))
    return found


def _average(messages: Sequence[_Message]) -> float:
    return sum(one.size for one in messages) / len(messages) if messages else 0.0


def _name_exit(status: int | None) -> str:
    return "no exit" if status is None else str(status)


def keep_paths(fields: Any, paths: Sequence[str] | None) -> Any:
    """The part of a message that some paths keep; all of it for None. `seq` of headers counts messages, and is left
    out."""
    if isinstance(fields, list):
        return [keep_paths(one, paths) for one in fields]
    if not isinstance(fields, dict):
        return fields
    found = {}
    for name, value in fields.items():
        if name == "seq" and "frame_id" in fields:
            continue
        if paths is None or name in paths:
            found[name] = keep_paths(value, None)
            continue
        inner = [path.partition(".")[2] for path in paths if path.startswith(f"{name}.")]
        if inner:
            found[name] = keep_paths(value, inner)
    return found


def _spell(value: Any) -> str:
    return json.dumps(value, sort_keys=True)


def find_difference(old: Sequence[str], new: Sequence[str]) -> tuple[str, str]:
    """How two sequences of messages were compared, and the first difference, empty where there is none. Both runs begin
    and end at other moments: what only one of them has at its ends is left out, up to a half."""
    if not old or not new:
        return "in order", "" if len(old) == len(new) else f"{len(old)} messages before, {len(new)} after"
    found = next(_list_overlaps(old, new), None)
    if found is not None:
        return "in order", ""
    edge = max(3, max(len(old), len(new)) // 4)
    for rows, others, when in ((old, new, "before"), (new, old, "after")):
        have = set(others)
        inner = rows[edge:-edge] if len(rows) > 2 * edge else rows
        lost = next((one for one in inner if one not in have), None)
        if lost is not None:
            return "as a set", f"only {when}: {lost[:300]}"
    return "as a set", ""


def _list_overlaps(old: Sequence[str], new: Sequence[str]) -> Iterator[int]:
    """Offsets at which both sequences are the same for at least half of the shorter one."""
    least = max(1, (min(len(old), len(new)) + 1) // 2)
    for offset in sorted(range(-len(new) + least, len(old) - least + 1), key=abs):
        first, second = max(0, offset), max(0, -offset)
        length = min(len(old) - first, len(new) - second)
        if length >= least and old[first : first + length] == new[second : second + length]:
            yield offset
