"""ROS 1 on this machine: whether it is there, the nodes that are built with it, and its master."""

from __future__ import annotations

import contextlib
import hashlib
import os
import shutil
import socket
import sys
import time
import xmlrpc.client
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ...edges.console import UserError
from ...edges.files import read_file, write_file
from ...edges.processes import count_cores
from ..cache import cache_folder
from .children import Child, find_program, make_clean_environment, run_program
from .messages import PACKAGE, SentSchema
from .namespaces import NetworkSite, open_work_folder

NODES = Path(__file__).with_name("nodes")
PYTHON = "/usr/bin/python3"
MASTER_PORT = 11311
_BUILDING = 1_200
_SOURCE = 1 << 20
# Debian's packages of ROS 1, by a file of each below the prefix.
_DEBIAN = {
    "roscpp": {
        "include/ros/ros.h": "libroscpp-dev",
        "lib/gencpp/gen_cpp.py": "python3-gencpp",
        "bin/rosmaster": "python3-rosmaster",
    },
    "rospy": {
        "lib/python3/dist-packages/rospy/__init__.py": "python3-rospy",
        "lib/python3/dist-packages/std_msgs/msg/__init__.py": "python3-std-msgs",
        "lib/genpy/genmsg_py.py": "python3-genpy",
        "bin/rosmaster": "python3-rosmaster",
    },
}
_TOOLS = {"cmake": "cmake", "make": "make", "c++": "g++"}


class Ros1(NamedTuple):
    """An installation: its prefix, `/usr` for Debian's packages."""

    prefix: Path

    def make_environment(self, uri: str = "", address: str = "127.0.0.1", logs: Path = Path("/tmp")) -> dict[str, str]:
        """What its programs are given: no setup.bash, and no ROS_DISTRO, with which catkin's files look elsewhere."""
        made = {
            **make_clean_environment(), "ROS_MASTER_URI": uri, "ROS_IP": address, "ROS_LOG_DIR": str(logs),
            "ROS_ROOT": f"{self.prefix}/share/ros", "ROS_PACKAGE_PATH": f"{self.prefix}/share",
            "ROS_ETC_DIR": "/etc/ros", "ROS_PYTHON_VERSION": "3", "ROS_VERSION": "1",
        }  # fmt: skip
        if self.prefix != Path("/usr"):
            made |= {
                "CMAKE_PREFIX_PATH": str(self.prefix), "LD_LIBRARY_PATH": f"{self.prefix}/lib",
                "PYTHONPATH": f"{self.prefix}/lib/python3/dist-packages",
            }  # fmt: skip
        return made


def find_ros1(nodes: str) -> tuple[Ros1 | None, list[str]]:
    """The ROS 1 to measure with, and what is missing where there is none, each as a clause with what to do."""
    missing = [package for tool, package in _TOOLS.items() if nodes == "roscpp" and not find_program(tool)]
    absent: list[str] = []
    for prefix in _list_prefixes():
        absent = [package for file, package in _DEBIAN[nodes].items() if not (prefix / file).exists()]
        if not absent and not missing:
            return Ros1(prefix), []
    return None, [f"ROS 1 ({nodes}): apt-get install -y {' '.join(dict.fromkeys([*absent, *missing]))}"]


def _list_prefixes() -> list[Path]:
    """Where ROS 1 may be; the last one is that of Debian's packages."""
    opened = Path("/opt/ros")
    own = sorted(opened.iterdir()) if opened.is_dir() else []
    return [*(each for each in own if (each / "bin/rosmaster").exists()), Path("/usr")]


def prepare_nodes(ros: Ros1, nodes: str, schemas: Sequence[SentSchema]) -> list[Path]:
    """A folder for each of the messages with its node: `node`, a program, or the package that rospy imports. Those that
    were made before are taken from the cache. Raises UserError, with the end of what the compiler said."""
    folders = [cache_folder() / "measure" / f"{nodes}-{_compute_key(ros, nodes, schema)}" for schema in schemas]
    absent = {
        folder: schema for folder, schema in zip(folders, schemas, strict=True) if not (folder / "complete").exists()
    }
    if absent:
        with open_work_folder() as work:
            (_build_programs if nodes == "roscpp" else _make_modules)(ros, absent, work)
    return folders


def _compute_key(ros: Ros1, nodes: str, schema: SentSchema) -> str:
    """Of all that a node is made of."""
    parts = [str(ros.prefix), sys.platform, *map("\n".join, sorted(schema.render_definitions().items()))]
    if nodes == "roscpp":
        library = ros.prefix / "include/ros/common.h"  # it holds the version of roscpp
        parts += [str(read_file(path, _SOURCE)) for path in (NODES / "node.cpp", NODES / "CMakeLists.txt", library)]
    return hashlib.sha256("\0".join(parts).encode()).hexdigest()[:24]


def _build_programs(ros: Ros1, absent: Mapping[Path, SentSchema], work: Path) -> None:
    environment = ros.make_environment()
    for name in ("node.cpp", "CMakeLists.txt"):
        write_file(work / name, read_file(NODES / name, _SOURCE))
    for folder, schema in absent.items():
        _generate(ros, "gencpp/gen_cpp.py", schema, work / "generated" / folder.name / PACKAGE, work / "messages")
    build = work / "build"
    run_program([find_program("cmake"), "-S", str(work), "-B", str(build)], environment, _BUILDING)
    run_program([find_program("cmake"), "--build", str(build), "--", f"-j{count_cores()}"], environment, _BUILDING)
    for folder in absent:
        _keep(folder, {"node": build / folder.name})


def _make_modules(ros: Ros1, absent: Mapping[Path, SentSchema], work: Path) -> None:
    for folder, schema in absent.items():
        package = work / folder.name / PACKAGE
        _generate(ros, "genpy/genmsg_py.py", schema, package / "msg", work / "messages")
        run_program(
            [PYTHON, f"{ros.prefix}/lib/genpy/genmsg_py.py", "--initpy", "-p", PACKAGE, "-o", str(package / "msg")],
            ros.make_environment(),
        )
        write_file(package / "__init__.py", b"")
        _keep(folder, {f"{PACKAGE}/{path.relative_to(package)}": path for path in package.rglob("*.py")})


def _generate(ros: Ros1, generator: str, schema: SentSchema, output: Path, messages: Path) -> None:
    """Has ROS's own generator write the code of all messages of a schema to a folder."""
    messages = messages / output.parent.name
    texts = schema.render_definitions()
    for name, text in texts.items():
        write_file(messages / f"{name}.msg", text.encode())
    output.mkdir(parents=True)
    files = [str(messages / f"{name}.msg") for name in texts]
    templates = ["-e", f"{ros.prefix}/share/gencpp"] if generator.startswith("gencpp") else []
    # The generator of C++ takes one file at a time.
    for some in [[file] for file in files] if templates else [files]:
        run_program(
            [PYTHON, f"{ros.prefix}/lib/{generator}", *some, "-p", PACKAGE, "-I", f"{PACKAGE}:{messages}",
             "-o", str(output), *templates],
            ros.make_environment(),
        )  # fmt: skip


def _keep(folder: Path, files: Mapping[str, Path]) -> None:
    """Puts files into the cache; `complete` says that all are there."""
    for name, path in files.items():
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(path, target)
    write_file(folder / "complete", b"")


def make_command(ros: Ros1, nodes: str, folder: Path) -> tuple[list[str], dict[str, str]]:
    """How a node of a message is started, and what it needs in its environment."""
    if nodes == "roscpp":
        return [str(folder / "node")], {}
    paths = [str(NODES.parent), str(folder), ros.make_environment().get("PYTHONPATH", "")]
    return [PYTHON, "-m", "nodes.rospy_node"], {"PYTHONPATH": os.pathsep.join(filter(None, paths))}


def find_free_port() -> int:
    """A port of this machine that nobody listens on."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


@contextlib.contextmanager
def open_master(ros: Ros1, site: NetworkSite, port: int, logs: Path) -> Iterator[str]:
    """The address of a master that runs at a site until the end. Raises UserError where it does not come up."""
    uri = f"http://{site.address}:{port}"
    environment = ros.make_environment(uri, site.address, logs)
    command = [*site.prefix, PYTHON, f"{ros.prefix}/bin/rosmaster", "--core", "-p", str(port)]
    master = Child(command, environment, logs / "master.log")
    try:
        _wait_for_master(site, uri, master)
        yield uri
    finally:
        master.stop()


_ASK = "import sys, xmlrpc.client as x; sys.exit(x.ServerProxy(sys.argv[1]).getPid('/rosimpact')[0] != 1)"


def _wait_for_master(site: NetworkSite, uri: str, master: Child) -> None:
    until = time.monotonic() + 30
    while True:
        try:
            run_program([*site.prefix, PYTHON, "-c", _ASK, uri])
            return
        except UserError:
            if not master.is_running() or time.monotonic() > until:
                raise UserError(f"the ROS master does not come up: {master.read_end()}") from None
            time.sleep(0.2)


def check_master(uri: str) -> Any:
    """The master at an address. Raises UserError where none answers."""
    try:
        master = xmlrpc.client.ServerProxy(uri)
        master.getPid("/rosimpact")
        return master
    except (OSError, xmlrpc.client.Error, ValueError) as error:
        raise UserError(f"--master {uri}: no ROS master answers ({error}); start one with `roscore` there") from None
