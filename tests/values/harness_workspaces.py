"""Small workspaces with callbacks, of both generations of ROS, and what tests of harnesses share."""

from __future__ import annotations

import shutil
import struct
from pathlib import Path

import pytest
from rosimpact.impact.analysis.session import open_tree
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.flow.workspace import link_for_flow, make_graph
from rosimpact.impact.values.harness.session import HarnessSession, PreparedCallback
from rosimpact.impact.values.harness.toolchain import find_clang, find_fuzzer, find_native_compiler
from rosimpact.impact.values.outcomes import NOWHERE, Bounds, Reaction, Witness

needs_clang = pytest.mark.skipif(not find_clang(), reason="clang 15 or newer is not installed")
needs_compiler = pytest.mark.skipif(
    not find_clang() or not find_native_compiler(),
    reason="clang 15 or newer, or a compiler with sanitizers, is missing",
)
needs_fuzzer = pytest.mark.skipif(
    not find_clang() or not find_native_compiler() or not find_fuzzer(), reason="clang with libFuzzer is not installed"
)

_MANIFEST = """<?xml version="1.0"?>
<package format="3"><name>{name}</name><version>1.0.0</version><description>d</description>
<maintainer email="a@b.c">m</maintainer><license>MIT</license>
<buildtool_depend>{tool}</buildtool_depend><depend>{client}</depend>{more}
<export><build_type>{tool}</build_type></export></package>
"""
_CATKIN = """cmake_minimum_required(VERSION 3.5)
project({name})
find_package(catkin REQUIRED COMPONENTS roscpp std_msgs sensor_msgs geometry_msgs {generation})
{messages}
catkin_package()
include_directories(include ${{catkin_INCLUDE_DIRS}})
add_executable(machine {sources})
target_link_libraries(machine ${{catkin_LIBRARIES}})
"""
_AMENT = """cmake_minimum_required(VERSION 3.8)
project({name})
find_package(ament_cmake REQUIRED)
find_package(rclcpp REQUIRED)
find_package(std_msgs REQUIRED)
add_executable(machine {sources})
ament_target_dependencies(machine rclcpp std_msgs)
ament_package()
"""


def write_workspace(
    root: Path, ros: int, files: dict[str, str], sources: str, messages: dict[str, str] | None = None
) -> Path:
    """A workspace of one package `machine`. files: by path in the package; messages: definitions by name."""
    package = root / "machine"
    tool, client = ("catkin", "roscpp") if ros == 1 else ("ament_cmake", "rclcpp")
    more = "<depend>message_generation</depend>" if messages else ""
    package.mkdir(parents=True)
    (package / "package.xml").write_text(_MANIFEST.format(name="machine", tool=tool, client=client, more=more))
    generated = ""
    for name, text in (messages or {}).items():
        (package / "msg").mkdir(exist_ok=True)
        (package / "msg" / f"{name}.msg").write_text(text)
    if messages:
        generated = f"add_message_files(FILES {' '.join(f'{one}.msg' for one in messages)})\ngenerate_messages()"
    cmake = _CATKIN if ros == 1 else _AMENT
    made = cmake.format(
        name="machine", sources=sources, messages=generated, generation="message_generation" if messages else ""
    )
    (package / "CMakeLists.txt").write_text(made)
    for path, text in files.items():
        (package / path).parent.mkdir(parents=True, exist_ok=True)
        (package / path).write_text(text)
    return root


class Prepared:
    """The callbacks of a workspace, prepared once. by_name: by the last part of their names."""

    def __init__(self, root: Path, folder: Path, kinds: tuple[str, ...], bounds: Bounds | None = None):
        self.store = Store(None)
        workspace = link_for_flow(open_tree(root, ""), self.store, 1)
        graph = make_graph(workspace, self.store, code_alone=True)
        self.session = HarnessSession(root, workspace, graph, bounds, folder)
        self.all = list(self.session.prepare(kinds=kinds))
        self.by_name: dict[str, PreparedCallback] = {one.callback.rpartition("::")[2]: one for one in self.all}
        self.root = root

    def replay(self, name: str, values: dict[str, int]):
        """One witness, replayed."""
        return self.by_name[name].replay([Witness(values, Reaction.CRASH, None, NOWHERE)])[0]

    def find_line(self, path: str, mark: str) -> int:
        """The line of a file that ends in `// mark`."""
        lines = (self.root / path).read_text().splitlines()
        return next(number for number, line in enumerate(lines, 1) if line.endswith(f"// {mark}"))


def text(path: str, value: str) -> dict[str, int]:
    """The inputs of a text field."""
    return {f"{path}.size": len(value), **{f"{path}[{at}]": byte for at, byte in enumerate(value.encode())}}


def double(value: float) -> int:
    """The bits of a float64."""
    return int.from_bytes(struct.pack("<d", value), "little")


def find_program(name: str) -> str | None:
    return shutil.which(name)
