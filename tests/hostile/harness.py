"""What an attack is, the place it happens in, how it is run, and what must hold whatever was tried."""

from __future__ import annotations

import hashlib
import http.server
import json
import os
import secrets
import shutil
import socket
import stat
import subprocess
import sys
import tempfile
import threading
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import pygit2

from . import outputs

# What the installed command does; older versions began elsewhere.
ENTRY = """try:
    from rosimpact.impact.cli.start import main
except ImportError:
    from rosimpact.impact.cli.app import main
import sys
sys.argv[0] = "rosimpact"
sys.exit(main())
"""
# Runs several commands, one after the other, and writes the names of all modules that they loaded into a file.
EVERY_COMMAND = """import json, sys
try:
    from rosimpact.impact.cli.start import main
except ImportError:
    from rosimpact.impact.cli.app import main
lines, listing = sys.argv[1:]
for sys.argv in json.loads(lines):
    try:
        main()
    except SystemExit as ended:
        assert ended.code in (0, 1), (sys.argv, ended.code)
with open(listing, "w") as file:
    file.write(" ".join(sorted(sys.modules)))
"""
# Interrupts are sent once this has made the file: Python's own start is not ours to mend.
BEGUN = (
    """try:
    from rosimpact.edges import interrupts
    interrupts.install()
except ImportError:
    pass
import os, sys
open(os.environ["HOME"] + "/begun", "w").close()
"""
    + ENTRY
)
MANIFEST = """<?xml version="1.0"?>
<package format="3">
  <name>{name}</name><version>1.0.0</version><description>d</description>
  <maintainer email="a@b.org">a</maintainer><license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  {depends}
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.8)
project({name})
find_package(ament_cmake REQUIRED)
{more}
ament_package()
"""
NODE = """#include <rclcpp/rclcpp.hpp>
#include <std_msgs/msg/int32.hpp>
#include <tf2_geometry_msgs/tf2_geometry_msgs.h>
class {Class} : public rclcpp::Node {{
 public:
  {Class}() : Node("{node}") {{
    pub_ = create_publisher<std_msgs::msg::Int32>("{topic}", 10);
    timer_ = create_wall_timer(std::chrono::seconds(1), [this]() {{
      std_msgs::msg::Int32 m;
      m.data = ++count_;
      if (count_ > {bound}) {{
        pub_->publish(m);
      }}
    }});
  }}
 private:
  int count_ = 0;
  rclcpp::Publisher<std_msgs::msg::Int32>::SharedPtr pub_;
  rclcpp::TimerBase::SharedPtr timer_;
}};
int main(int argc, char** argv) {{ rclcpp::init(argc, argv); rclcpp::spin(std::make_shared<{Class}>()); }}
"""
LAUNCH = """from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([Node(package="{package}", executable="{program}")])
"""


def depends(*names: str) -> str:
    return "".join(f"<depend>{name}</depend>" for name in names)


def manifest(name: str, *names: str) -> str:
    return MANIFEST.format(name=name, depends=depends(*names))


def cmake(name: str, more: str = "") -> str:
    return CMAKE.format(name=name, more=more)


# OpenCV 9 is on no target; the header of tf2_geometry_msgs is gone in jazzy, ament_target_dependencies in lyrical.
HEALTHY: dict[str, str | bytes] = {
    "src/healthy/package.xml": manifest("healthy", "libopencv-dev", "rclcpp", "std_msgs", "tf2_geometry_msgs"),
    "src/healthy/CMakeLists.txt": cmake(
        "healthy",
        "find_package(OpenCV 9 REQUIRED)\nfind_package(rclcpp REQUIRED)\nfind_package(std_msgs REQUIRED)\n"
        "find_package(tf2_geometry_msgs REQUIRED)\nadd_executable(healthy_node src/node.cpp)\n"
        "ament_target_dependencies(healthy_node rclcpp std_msgs tf2_geometry_msgs)\n"
        "install(TARGETS healthy_node DESTINATION lib/healthy)",
    ),
    "src/healthy/src/node.cpp": NODE.format(Class="HealthyNode", node="healthy_node", topic="healthy_topic", bound=3),
    "src/healthy/launch/healthy.launch.py": LAUNCH.format(package="healthy", program="healthy_node"),
}
BAD: dict[str, str | bytes] = {
    "src/bad/package.xml": manifest("bad", "rclcpp"),
    "src/bad/CMakeLists.txt": cmake("bad", "find_package(rclcpp REQUIRED)"),
}
# What each command says of the healthy package, whatever else is in the workspace, in every format.
FOUND = {
    "check": "CMake asks for OpenCV 9, but the target has 4.6.0",
    "graph": "healthy_topic",
    "impact": "healthy_topic",
    "logic": "healthy_topic",
    "upgrade": "ament_target_dependencies",
    "why": "src/healthy/CMakeLists.txt",
    "env": "tf2_geometry_msgs.h",
}
COMMANDS: dict[str, tuple[str, ...]] = {
    "check": ("check", "{ws}", "-q", "-t", "jazzy"),
    "graph": ("graph", "{ws}", "-q"),
    "impact": ("impact", "{ws}", "-q", "--base", "HEAD~1"),
    "upgrade": ("upgrade", "{ws}", "-q", "--from", "jazzy", "--to", "lyrical"),
    "logic": ("logic", "{ws}", "-q"),
    "why": ("why", "OpenCV", "{ws}", "-t", "jazzy"),
    "env": ("env", "diff", "humble", "jazzy", "{ws}"),
}
FORMATS = {
    "check": ("text", "json", "sarif", "github", "markdown", "html"),
    "graph": ("text", "json", "graphml", "dot", "mermaid", "html"),
    "impact": ("text", "json", "markdown"),
    "upgrade": ("text", "json", "html"),
    "logic": ("text", "json", "html"),
    "why": ("text", "json"),
    "env": ("text", "json"),
}
# The exit status of each over the healthy workspace.
STATUS = {"check": 1, "graph": 0, "impact": 0, "upgrade": 1, "logic": 0, "why": 0, "env": 0}
NEEDS_GIT = ("impact", "logic")


class Place:
    """Where one attack happens. ws: the workspace. outside: what nobody may read or change. home, cache: the user's.
    out: for what is asked to be written. marker: what anything that is executed would make. token, secret: what must
    never be quoted, of files outside and of the environment. url: a server of this machine that must hear nothing."""

    def __init__(self, root: Path, url: str = "") -> None:
        self.root = root
        self.ws, self.outside, self.home = root / "ws", root / "outside", root / "home"
        self.cache, self.out, self.marker = root / "cache", root / "out", root / "marker"
        self.token = "canary" + secrets.token_hex(8)
        self.secret = "envcanary" + secrets.token_hex(8)
        self.url = url
        self.interpreter = ""
        for folder in (self.ws, self.outside, self.home, self.out):
            folder.mkdir(parents=True)
        write(self.outside, {"secret.txt": f"{self.token}\n", "key": f"KEY={self.token}\n"})

    def filled(self, text: str) -> str:
        for name in ("ws", "outside", "home", "cache", "out", "marker", "token", "secret", "url", "root"):
            text = text.replace("{" + name + "}", str(getattr(self, name)))
        return text


class Attack(NamedTuple):
    """One attack.

    name, group: what it is called, and its class. make: files of the workspace (path: content), or a function that
    makes them; nothing else is in the workspace but the healthy package and, with bad, a package to spoil. command:
    arguments, in which {ws}, {out}, {outside} and other attributes of the place may stand. status: exit statuses that
    are right. found: what has to be in the output; by default what the command says of the healthy package; empty when
    nothing has to. refusable: the status 2 is right as well, when this word is in one line on standard error. words,
    absent: further texts that must, must not be in the output. git: the workspace has two commits, what make gives is
    committed too. changes: what may change in the workspace. environment: added to the usual one; the value UNSET takes
    away. direct: run as the installed command, not in a warm process; program: as this program. before: what else is
    done to the place, its cache for instance. after: a further check; it gives what is wrong. limits: of resources, by
    their names. signal: its number, the seconds after which it is sent, and to whom. dear: takes long, and is no part
    of the sample.
    """

    name: str
    group: str
    make: Mapping[str, str | bytes] | Callable[[Place], Any]
    command: tuple[str, ...]
    status: tuple[int, ...] = (0, 1)
    found: str | None = None
    refusable: str = ""
    words: tuple[str, ...] = ()
    absent: tuple[str, ...] = ()
    git: bool = False
    bad: bool = True
    changes: tuple[str, ...] = ()
    environment: Mapping[str, str] = {}
    direct: bool = False
    program: tuple[str, ...] = ()
    before: Callable[[Place], Any] | None = None
    after: Callable[[Place, Ended], list[str]] | None = None
    cwd: str = "{ws}"
    stdin: str = ""
    stdout: str = ""
    stderr: str = ""
    limits: Mapping[str, int] = {}
    signal: tuple = ()
    seconds: float = 5.0
    memory: int = 1_000_000_000
    snapshot: bool = True
    colours: bool = False
    encoding: str = "utf-8"
    dear: bool = False


class Ended(NamedTuple):
    """How a run ended: exit status, both streams, seconds of processor time and of the clock, most bytes resident."""

    status: int
    out: bytes
    err: bytes
    cpu: float
    wall: float
    rss: int
    killed: str
    left: int


class Result(NamedTuple):
    """A row's outcome. failures: what did not hold; none when all is well."""

    name: str
    group: str
    failures: list[str]
    cpu: float
    rss: int


# -- making places -----------------------------------------------------------------------------------------------------


def write(root: Path, files: Mapping[str, str | bytes]) -> None:
    """Writes files below a folder; names may hold bytes that are no UTF-8, as surrogates."""
    for name, content in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if path.is_symlink():
            path.unlink()
        path.write_bytes(content.encode("utf-8", "surrogateescape") if isinstance(content, str) else content)


def link(path: Path, target: str | Path) -> None:
    """Puts a link where a file or nothing was."""
    path.parent.mkdir(parents=True, exist_ok=True)
    remove(path)
    path.symlink_to(target)


def fifo(path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    remove(path)
    os.mkfifo(path)


def unix_socket(path: Path) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    remove(path)
    here = os.open(".", os.O_RDONLY)
    listening = socket.socket(socket.AF_UNIX)
    try:
        os.chdir(path.parent)  # a socket's path has to be short
        listening.bind(path.name)
    finally:
        os.fchdir(here)
        os.close(here)
        listening.close()


def remove(path: Path) -> None:
    if path.is_symlink() or path.is_file():
        path.unlink()
    elif path.is_dir():
        shutil.rmtree(path)
    elif os.path.lexists(path):
        path.unlink()


def commit(
    folder: Path, message: str = "more", name: str = "a", email: str = "a@b.org", time: int = 1_700_000_000
) -> pygit2.Repository:
    """Commits everything of a folder, which becomes a repository. Links are committed as links."""
    if (folder / ".git").exists():
        repository = pygit2.Repository(str(folder))
    else:
        repository = pygit2.init_repository(str(folder), initial_head="main")
    repository.index.add_all()
    repository.index.write()
    who = pygit2.Signature(name, email, time, 0)
    parents = [] if repository.head_is_unborn else [repository.head.target]
    repository.create_commit("HEAD", who, who, message, repository.index.write_tree(), parents)
    return repository


def made(attack: Attack, place: Place) -> None:
    """Makes the workspace of an attack."""
    write(place.ws, HEALTHY)
    if attack.git:
        first = str(HEALTHY["src/healthy/src/node.cpp"]).replace("count_ > 3", "count_ > 5")
        write(place.ws, {"src/healthy/src/node.cpp": first})
        commit(place.ws, "one")
        write(place.ws, HEALTHY)
    if attack.bad:
        write(place.ws, BAD)
    if attack.git:
        commit(place.ws, "two", time=1_700_000_100)
    if callable(attack.make):
        attack.make(place)
    else:
        write(place.ws, {place.filled(name): _filled(content, place) for name, content in attack.make.items()})


def _filled(content: str | bytes, place: Place) -> str | bytes:
    return place.filled(content) if isinstance(content, str) else content


def state(root: Path) -> dict[str, tuple]:
    """What lies below a folder: kinds, link targets, sizes and contents."""
    found: dict[str, tuple] = {}
    for folder, folders, files in os.walk(os.fsencode(root)):
        for name in [*folders, *files]:
            path = os.path.join(folder, name)
            status = os.lstat(path)
            kind = stat.S_IFMT(status.st_mode)
            content: object = None
            if kind == stat.S_IFLNK:
                content = os.readlink(path)
            elif kind == stat.S_IFREG:
                content = status.st_mtime_ns if status.st_size > 5_000_000 else _digest(path)
            found[os.fsdecode(os.path.relpath(path, os.fsencode(root)))] = (kind, stat.S_IMODE(status.st_mode), content)
    return found


def _digest(path: bytes) -> str:
    with open(path, "rb") as file:
        return hashlib.sha1(file.read()).hexdigest()


# -- running -----------------------------------------------------------------------------------------------------------


class _Heard(http.server.BaseHTTPRequestHandler):
    def answer(self) -> None:
        self.server.heard.append(f"{self.command} {self.path}")  # pyright: ignore[reportAttributeAccessIssue]
        self.send_response(200)
        self.end_headers()
        self.wfile.write(b"%YAML 1.1\n---\ndistributions: {}\ntype: index\nversion: 4\n")

    do_GET = do_POST = do_HEAD = do_CONNECT = do_PUT = answer

    def log_message(self, format: str, *args: Any) -> None:
        return


class _Server:
    """A process that forks runs (server.py)."""

    def __init__(self, interpreter: str) -> None:
        reading, writing = os.pipe()
        self._process = subprocess.Popen(
            [
                interpreter,
                "-P" if sys.version_info >= (3, 11) else "-B",
                str(Path(__file__).with_name("server.py")),
                str(writing),
            ],
            stdin=subprocess.PIPE,
            pass_fds=(writing,),
            text=True,
            encoding="utf-8",
        )
        os.close(writing)
        self._answers = os.fdopen(reading, encoding="utf-8")

    def ask(self, question: dict[str, Any]) -> dict[str, Any]:
        assert self._process.stdin is not None
        self._process.stdin.write(json.dumps(question) + "\n")
        self._process.stdin.flush()
        line = self._answers.readline()
        if not line:
            raise RuntimeError("the server is gone")
        return json.loads(line)

    def end(self) -> None:
        assert self._process.stdin is not None
        self._process.stdin.close()
        self._process.wait()
        self._answers.close()


# Groups whose attacks concern what is read once in a process.
_FROM_THE_START = frozenset({"cache", "environment", "pipes"})


class Range:
    """Where attacks are run, one after the other. Use as a context manager.

    interpreter: a Python that has rosimpact. root: a folder for places, made when None. experience: whether runs may
    come from a process that has checked the healthy workspace before.
    """

    def __init__(self, interpreter: str = sys.executable, root: Path | None = None, experience: bool = False) -> None:
        self.interpreter = interpreter
        self.experience = experience
        self.root = Path(tempfile.mkdtemp(prefix="hostile-")) if root is None else root
        self._own = root is None
        self.script = str(self.root / "rosimpact")
        Path(self.script).write_text(f"#!{interpreter}\n{ENTRY}")
        Path(self.script).chmod(0o755)
        self._count = 0

    def __enter__(self) -> Range:
        self._web = http.server.ThreadingHTTPServer(("127.0.0.1", 0), _Heard)
        self._web.heard = []  # pyright: ignore[reportAttributeAccessIssue]
        threading.Thread(target=self._web.serve_forever, daemon=True).start()
        self.url = f"http://127.0.0.1:{self._web.server_address[1]}"
        self._fresh = _Server(self.interpreter)
        self._experienced: _Server | None = None
        self._warm()
        return self

    def __exit__(self, *_: object) -> None:
        for server in filter(None, (self._fresh, self._experienced)):
            server.end()
        self._web.shutdown()
        self._web.server_close()
        if self._own:
            shutil.rmtree(self.root, ignore_errors=True)

    def _warm(self) -> None:
        """Fills the cache that every run gets a copy of, and has the server import what the commands import."""
        place = Place(self.root / "warm", self.url)
        write(place.ws, HEALTHY | BAD)
        commit(place.ws)
        commit(place.ws)
        listing = place.out / "modules"
        lines = [["rosimpact", *map(place.filled, arguments)] for arguments in COMMANDS.values()]
        program = (self.interpreter, "-c", EVERY_COMMAND, json.dumps(lines), str(listing))
        ended = self._run(Attack("warm", "", {}, (), direct=True, program=program, seconds=60), place, [])
        assert ended.status == 0, ended
        self._modules = listing.read_text().split()
        self._fresh.ask({"warm": self._modules})
        self._warmed = place
        self.template = place.cache

    def _server_for(self, attack: Attack) -> _Server:
        """The process that runs an attack. One that has looked up before what the targets hold saves half of the time
        of a run. What concerns the cache, the environment or limits is run as in a process that has just begun, and so
        is everything with --attacks=all."""
        installed = attack.direct or attack.program
        if not self.experience or installed or attack.group in _FROM_THE_START or attack.environment or attack.limits:
            return self._fresh
        if self._experienced is None:
            self._experienced = _Server(self.interpreter)
            seen = {"workspace": str(self._warmed.ws), "environment": self._environment(self._warmed)}
            self._experienced.ask({"warm": self._modules, **seen})
        return self._experienced

    def _environment(self, place: Place) -> dict[str, str]:
        return {
            "PATH": os.environ.get("PATH", "/usr/bin:/bin"),
            "HOME": str(place.home),
            "LANG": "C.UTF-8",
            "XDG_CACHE_HOME": str(place.home / ".cache"),
            "ROSIMPACT_CACHE": str(place.cache),
            "CANARY": place.secret,
            **{name: self.url for name in ("http_proxy", "https_proxy", "HTTP_PROXY", "HTTPS_PROXY", "ALL_PROXY")},
        }

    def _run(self, attack: Attack, place: Place, arguments: list[str]) -> Ended:
        added = {name: place.filled(value) for name, value in attack.environment.items()}
        environment = self._environment(place) | added
        program = attack.program or ((self.interpreter, "-c", ENTRY) if attack.direct else ("rosimpact",))
        program = tuple(
            place.filled(part).replace("{python}", self.interpreter).replace("{script}", self.script)
            for part in program
        )
        streams = {"stdout": place.root / "stdout", "stderr": place.root / "stderr"}
        answer = self._server_for(attack).ask(
            {
                "command": [*program, *arguments],
                "cwd": place.filled(attack.cwd),
                "environment": {name: value for name, value in environment.items() if value != "UNSET"},
                "direct": attack.direct or bool(attack.program),
                "stdin": place.filled(attack.stdin),
                "stdout": attack.stdout or str(streams["stdout"]),
                "stderr": attack.stderr or str(streams["stderr"]),
                "limits": dict(attack.limits),
                "signal": [place.filled(part) if isinstance(part, str) else part for part in attack.signal],
                "seconds": attack.seconds,
                "wall": 90,
            }
        )
        out, err = (path.read_bytes() if path.exists() else b"" for path in streams.values())
        return Ended(out=out, err=err, **answer)

    def attempt(self, attack: Attack, keep: bool = False) -> Result:
        """Makes an attack's place, runs it, and gives what did not hold."""
        self._count += 1
        place = Place(self.root / str(self._count), self.url)
        place.interpreter = self.interpreter
        # Copies only where they may be written to in place: most runs only read these 20 MB. Through links they see the
        # status of the template's files, so that no run has to compare contents with the digests beside them.
        shutil.copytree(self.template, place.cache, copy_function=shutil.copy2 if attack.group == "cache" else _shared)
        try:
            made(attack, place)
            if attack.before is not None:
                attack.before(place)
            before = self._states(place) if attack.snapshot else {}
            self._web.heard.clear()  # pyright: ignore[reportAttributeAccessIssue]
            ended = self._run(attack, place, [place.filled(argument) for argument in attack.command])
            failures = list(self._judged(attack, place, ended, before))
            return Result(attack.name, attack.group, failures, ended.cpu, ended.rss)
        finally:
            if not keep:
                # Not shutil's, which recurs into folders.
                subprocess.run(["rm", "-rf", str(place.root)], check=False)

    def _states(self, place: Place) -> dict[str, tuple]:
        found = {f"ws/{name}": what for name, what in state(place.ws).items()}
        return found | {f"outside/{name}": what for name, what in state(place.outside).items()}

    def _judged(self, attack: Attack, place: Place, ended: Ended, before: dict[str, tuple]):
        if ended.killed:
            yield f"hangs: killed for {ended.killed} after {ended.cpu:.1f} s of work, {ended.wall:.1f} s in all"
        elif ended.cpu > attack.seconds + 0.5:
            yield f"slow: {ended.cpu:.1f} s of processor time"
        if ended.rss > attack.memory:
            yield f"memory: {ended.rss / 1e6:.0f} MB"
        if ended.left:
            yield f"leaves {ended.left} processes behind"
        refused = attack.refusable and ended.status == 2
        if not ended.killed and ended.status not in attack.status and not refused:
            yield f"status {ended.status}, not {' or '.join(map(str, attack.status))}"
        if refused and attack.refusable.encode() not in ended.err:
            yield f"{attack.refusable} is not named"
        if place.marker.exists():
            yield "executes what the workspace holds"
        if self._web.heard:  # pyright: ignore[reportAttributeAccessIssue]
            yield f"asks the network: {self._web.heard[0]}"  # pyright: ignore[reportAttributeAccessIssue]
        if attack.snapshot:
            after = self._states(place)
            allowed = {f"ws/{place.filled(name)}" for name in attack.changes}
            for name in sorted((before.keys() | after.keys()) - allowed):
                if before.get(name) != after.get(name):
                    yield f"changes {name!r}"
                    break
        texts = {"output": ended.out, "errors": ended.err}
        for path in sorted(place.out.rglob("*")):
            if path.is_file() and not path.is_symlink():
                texts[path.name] = path.read_bytes()
        for name, data in texts.items():
            for what, token in (("a file outside", place.token), ("the environment", place.secret)):
                if token.encode() in data:
                    yield f"quotes {what} in {name}"
            yield from outputs.plain_failures(name, data, attack.command, attack.colours, attack.encoding)
        everything = b"\n".join(texts.values()).decode(attack.encoding, "replace")
        main = b"\n".join(data for name, data in texts.items() if name != "errors").decode(attack.encoding, "replace")
        found = FOUND.get(attack.command[0], "") if attack.found is None else attack.found
        if not refused:
            if found and found not in main:
                yield f"the healthy package is not heard of: {_last(ended.err)}"
            for word in attack.words:
                if place.filled(word) not in everything:
                    yield f"{place.filled(word)!r} is not in the output"
            yield from outputs.format_failures(attack.command, ended, texts)
        for word in attack.absent:
            if place.filled(word) in everything:
                yield f"{place.filled(word)!r} is in the output"
        if attack.after is not None:
            yield from attack.after(place, ended)


def _shared(source: str, target: str) -> None:
    if os.path.basename(source).startswith(("distros", "providers")):
        os.symlink(source, target)
    else:
        shutil.copy2(source, target)


def _last(err: bytes) -> str:
    lines = err.decode("utf-8", "replace").strip().splitlines()
    return repr(lines[-1][:200]) if lines else "nothing is said"
