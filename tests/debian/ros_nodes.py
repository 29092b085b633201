"""Real nodes of ROS 1, each started on a master of its own, and what they register there."""

from __future__ import annotations

import contextlib
import os
import re
import signal
import socket
import struct
import subprocess
import time
import xmlrpc.client
import zlib
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

# Registrations are taken as complete when nothing has changed for QUIET seconds; a node has DEADLINE seconds to begin.
QUIET, DEADLINE = 2.0, 60.0
COMPANION = "/companion"
PYTHON = "/usr/bin/python3"

Named = frozenset[tuple[str, str]]


class Registered(NamedTuple):
    """What a node registers. name: its own. The others are (name, type) as the node itself tells; type `*` is any."""

    name: str
    publishers: Named
    subscribers: Named
    services: Named


class NodeFailed(Exception):
    """A node did not come up; the text holds the end of what it printed."""


def missing() -> str:
    """What is not installed that every node needs; empty when all is there."""
    for path in (PYTHON, "/usr/bin/rosmaster"):
        if not Path(path).exists():
            return f"{path} is not installed (apt-get install -y python3-rosmaster python3-rostopic)"
    imports = "import rospy, rosgraph, std_msgs.msg"
    if subprocess.run([PYTHON, "-c", imports], env=environment("", Path()), capture_output=True).returncode:
        return "rospy and std_msgs are not installed (apt-get install -y python3-rostopic python3-std-msgs)"
    return ""


def environment(master: str, logs: Path) -> dict[str, str]:
    """What Debian's nodes want of the environment: no setup.bash, no Python but the system's."""
    kept = {name: os.environ[name] for name in ("HOME", "LANG", "LC_ALL", "TMPDIR") if name in os.environ}
    return {
        **kept, "PATH": "/usr/sbin:/usr/bin:/sbin:/bin", "ROS_MASTER_URI": master, "ROS_IP": "127.0.0.1",
        "ROS_LOG_DIR": str(logs), "ROS_ROOT": "/usr/share/ros", "ROS_PACKAGE_PATH": "/usr/share",
        "ROS_ETC_DIR": "/etc/ros", "ROS_PYTHON_VERSION": "3", "ROS_VERSION": "1", "QT_QPA_PLATFORM": "offscreen",
    }  # fmt: skip


def registered(
    command: list[str], logs: Path, speaks_on: tuple[str, ...] = (), parameters: Mapping[str, Any] | None = None
) -> Registered:
    """Starts a node, waits until it has registered all that it will, and stops it. logs: a folder of its own.

    speaks_on: topics on which it is sent strings. Raises NodeFailed.
    """
    logs.mkdir(parents=True, exist_ok=True)
    port = _free_port()
    uri = f"http://127.0.0.1:{port}"
    around = environment(uri, logs)
    companion = [PYTHON, str(Path(__file__).with_name("ros_companion.py")), *speaks_on]
    with (
        _process([PYTHON, "/usr/bin/rosmaster", "--core", "-p", str(port)], around, logs / "master.out") as master,
        _process(companion, around, logs / "companion.out", wait_for=lambda: _answers(uri, master)) as helper,
    ):
        server = _server(uri)
        _until(lambda: COMPANION in _nodes(server), helper, "the companion does not register")
        for name, value in (parameters or {}).items():
            server.setParam("/test", name, value)
        with _process(command, around, logs / "node.out") as node:
            own = _settled(server, node)
            return _read(server, own)


def _settled(server, node: _Process) -> str:
    """The name of the one node beside the companion, once nothing changes any more and the companion hears it."""

    def others(state) -> set[str]:
        return {name for kind in state for _, nodes in kind for name in nodes} - {COMPANION}

    def unheard(state) -> list[str]:
        heard = {topic for topic, nodes in state[1] if COMPANION in nodes}
        spoken = [topic for topic, nodes in state[0] if nodes != [COMPANION] and not topic.startswith("/rosout")]
        return [topic for topic in spoken if topic not in heard]

    last, since, end = None, time.monotonic(), time.monotonic() + DEADLINE
    while time.monotonic() < end:
        node.must_run()
        state = server.getSystemState("/test")[2]
        now = time.monotonic()
        if state != last:
            last, since = state, now
        found = others(state)
        if found and not unheard(state) and now - since > QUIET:
            if len(found) != 1:
                raise NodeFailed(f"{' '.join(node.command)} is several nodes: {sorted(found)}")
            return found.pop()
        time.sleep(0.05)
    raise NodeFailed(f"{' '.join(node.command)} does not come to rest at the master: {node.tail()}")


def _read(server, own: str) -> Registered:
    slave = _server(server.lookupNode("/test", own)[2])
    services = [name for name, nodes in server.getSystemState("/test")[2][2] if own in nodes]
    return Registered(
        own,
        frozenset(map(tuple, slave.getPublications("/test")[2])),
        frozenset(map(tuple, slave.getSubscriptions("/test")[2])),
        frozenset((name, _service_type(server.lookupService("/test", name)[2], name)) for name in services),
    )


def _service_type(uri: str, service: str) -> str:
    """The type of a service, asked of its provider as `rosservice type` does (a TCPROS header with `probe`)."""
    match = re.fullmatch(r"rosrpc://(.+):(\d+)", uri)
    assert match, uri
    fields = [f"{key}={value}".encode() for key, value in
              (("probe", "1"), ("md5sum", "*"), ("callerid", "/test"), ("service", service))]  # fmt: skip
    body = b"".join(struct.pack("<I", len(field)) + field for field in fields)
    with socket.create_connection((match[1], int(match[2])), timeout=10) as connection:
        connection.sendall(struct.pack("<I", len(body)) + body)
        with connection.makefile("rb") as stream:
            body = stream.read(struct.unpack("<I", stream.read(4))[0])
    while body:
        size = struct.unpack("<I", body[:4])[0]
        key, _, value = body[4 : 4 + size].decode().partition("=")
        if key == "type":
            return value
        body = body[4 + size :]
    return ""


class _Process:
    """A child in a session of its own, with what it prints in a file."""

    def __init__(self, command: list[str], around: Mapping[str, str], out: Path):
        self.command, self.out = command, out
        with out.open("wb") as stream:
            self.child = subprocess.Popen(
                command, env=dict(around), stdin=subprocess.DEVNULL, stdout=stream, stderr=subprocess.STDOUT,
                start_new_session=True,
            )  # fmt: skip

    def tail(self) -> str:
        """The end of what it printed."""
        return self.out.read_bytes()[-800:].decode("utf-8", "replace")

    def must_run(self) -> None:
        """Raises NodeFailed when it has ended."""
        if self.child.poll() is not None:
            raise NodeFailed(f"{' '.join(self.command)} ended with {self.child.returncode}: {self.tail()}")

    def stop(self) -> None:
        """Ends it and whatever it started."""
        for kind, seconds in ((signal.SIGTERM, 5.0), (signal.SIGKILL, 30.0)):
            with contextlib.suppress(ProcessLookupError):
                os.killpg(self.child.pid, kind)
            with contextlib.suppress(subprocess.TimeoutExpired):
                self.child.wait(seconds)
                break
        with contextlib.suppress(ProcessLookupError):
            os.killpg(self.child.pid, signal.SIGKILL)


@contextlib.contextmanager
def _process(
    command: list[str], around: Mapping[str, str], out: Path, wait_for: Callable[[], None] | None = None
) -> Iterator[_Process]:
    if wait_for is not None:
        wait_for()
    one = _Process(command, around, out)
    try:
        yield one
    finally:
        one.stop()


def _until(reached: Callable[[], bool], process: _Process, failure: str) -> None:
    end = time.monotonic() + DEADLINE
    while not reached():
        process.must_run()
        if time.monotonic() > end:
            raise NodeFailed(f"{failure}: {process.tail()}")
        time.sleep(0.05)


def _answers(uri: str, master: _Process) -> None:
    def reached() -> bool:
        try:
            return _server(uri).getPid("/test")[0] == 1
        except OSError:
            return False

    _until(reached, master, "the master does not answer")


def _nodes(server) -> set[str]:
    return {name for kind in server.getSystemState("/test")[2] for _, nodes in kind for name in nodes}


def _server(uri: str) -> Any:
    return xmlrpc.client.ServerProxy(uri)


def _free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return one.getsockname()[1]


def program(package: str, name: str) -> str:
    """Where Debian installs a program of a ROS package; empty when it is not there."""
    found = Path("/usr/lib") / package / name
    return str(found) if found.exists() else ""


def png(path: Path) -> Path:
    """Writes a small grey picture."""

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    rows = b"".join(b"\0" + b"\x80" * 96 for _ in range(32))
    head = struct.pack(">IIBBBBB", 32, 32, 8, 2, 0, 0, 0)
    parts = (chunk(b"IHDR", head), chunk(b"IDAT", zlib.compress(rows)), chunk(b"IEND", b""))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + b"".join(parts))
    return path
