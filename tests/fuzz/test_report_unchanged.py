"""A hostile file costs itself at most: with it and without it, the report on all other packages is the same.

CI draws the same examples every time; ROSIMPACT_FUZZ_EXAMPLES=5000 draws as many others.
"""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import signal
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import pytest
from fuzz_targets import SEEDS
from fuzz_words import WORDS
from hypothesis import example, given, settings
from hypothesis import strategies as st
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.report import Report
from rosimpact.impact.analysis.session import Options
from rosimpact.impact.report import github, html, markdown, sarif, text
from rosimpact.impact.report import json as as_json

EXAMPLES = os.environ.get("ROSIMPACT_FUZZ_EXAMPLES", "")
SECONDS = 20

MANIFEST = """<?xml version="1.0"?>
<package format="3">
  <name>{name}</name><version>1.0.0</version><description>d</description>
  <maintainer email="a@b.org">a</maintainer><license>Apache-2.0</license>
  {depends}
  <export><build_type>{build}</build_type></export>
</package>
"""
# Each of the three packages has findings of its own, of rules that read different kinds of files.
HEALTHY = {
    "src/camera/package.xml": MANIFEST.format(
        name="camera",
        build="ament_cmake",
        depends="<buildtool_depend>ament_cmake</buildtool_depend><depend>rclcpp</depend>",
    ),
    "src/camera/CMakeLists.txt": (
        "cmake_minimum_required(VERSION 3.8)\nproject(camera)\nfind_package(ament_cmake REQUIRED)\n"
        "find_package(OpenCV 9 REQUIRED)\nfind_package(rclcpp REQUIRED)\nfind_package(tf2_ros REQUIRED)\n"
        "add_library(camera src/camera.cpp src/lost.cpp)\nament_target_dependencies(camera rclcpp)\nament_package()\n"
    ),
    "src/camera/src/camera.cpp": (
        "#include <rclcpp/rclcpp.hpp>\n#include <tf2_geometry_msgs/tf2_geometry_msgs.h>\n"
        "#include <nav2_util/node_utils.hpp>\n"
    ),
    "src/speech/package.xml": MANIFEST.format(name="speech", build="ament_python", depends="<depend>rclpy</depend>"),
    "src/speech/setup.py": (
        "from setuptools import setup\nsetup(name='speech', packages=['speech'], "
        "data_files=[('share/speech', ['package.xml'])],\n"
        "      entry_points={'console_scripts': ['say = speech.node:main']})\n"
    ),
    "src/speech/speech/__init__.py": "",
    "src/speech/speech/node.py": "import rclpy\nimport tf2_ros\n\ndef main():\n    pass\n",
    "src/start/package.xml": MANIFEST.format(
        name="start", build="ament_cmake", depends="<buildtool_depend>ament_cmake</buildtool_depend>"
    ),
    "src/start/CMakeLists.txt": (
        "cmake_minimum_required(VERSION 3.8)\nproject(start)\nfind_package(ament_cmake REQUIRED)\nament_package()\n"
    ),
    "src/start/launch/a.launch.xml": (
        "<launch><node pkg='speech' exec='shout'/><node pkg='nav2_amcl' exec='amcl'/></launch>\n"
    ),
}
PACKAGES = frozenset(("camera", "speech", "start"))

# Where a hostile file may lie: in a package of its own, in a folder of no package, in a nested one, at the root.
FOLDERS = ("src/hostile", "src/hostile/src", "loose", "src/hostile/launch", "src/loose/deep", "")
NAMES = (
    "package.xml", "CMakeLists.txt", "setup.py", "setup.cfg", "pyproject.toml", "a.cmake", "a.msg", "a.srv", "a.action",
    "a.idl", "a.cpp", "a.hpp", "a.h.in", "a.py", "__init__.py", "a.launch", "a.launch.py", "a.launch.xml",
    "a.launch.yaml", "a.yaml", "plugins.xml", "a.xacro", "a.urdf", "run", "run.sh", "a.cfg", "colcon.pkg",
    ".gitmodules", ".git", "package_ROS1.xml", "package_ROS2.xml", "manifest.xml", ".repos", "a.repos", "a.in",
    "README.md", "a.bin", "libx.so",
)  # fmt: skip
# These set up the whole workspace at its root, so that only nonsense in them must change nothing.
AT_ROOT = (
    "colcon.meta",
    "defaults.yaml",
    ".gitmodules",
    "colcon.pkg",
    "a.repos",
    "a.yaml",
    "a.cpp",
    "a.py",
    "plugins.xml",
)
ODD_NAMES = (
    b"::error::x.cpp", b"a\nb.py", b"\xff\xfe.cpp", b"##[error]a.msg", b"\x1b[31m.launch", b"-rf.py", b" .xml",
    b"a" * 250 + b".py", "\u202etxt.cpp".encode(), b"%25.yaml", b"a:1:2.cpp", b"|x|`y`.py", b"<b>.srv", b"'\".idl",
    b"...", b"COM1.cmake",
)  # fmt: skip
LINKS = (
    "/etc/passwd", "/dev/zero", "/dev/tty", "/proc/self/environ", "/proc/self/mem", "nowhere", ".", "..", "/", "/etc",
    "../..", "a.cpp", "../camera/CMakeLists.txt", "../camera", "../../src", "self", "/proc/self/fd/0", "x" * 4000,
)  # fmt: skip
MANIFEST_OF_HOSTILE = MANIFEST.format(name="hostile", build="ament_cmake", depends="<depend>rclcpp</depend>").encode()


class Hostile(NamedTuple):
    """A file, link, folder or pipe that is added. content: of a file; what else it is: `link:TARGET`, `folder`, `pipe`,
    `unreadable`."""

    path: bytes
    content: bytes = b""
    what: str = "file"


def seeds() -> list[bytes]:
    return [path.read_bytes() for path in sorted(SEEDS.glob("*/*"))]


_WORDS = sorted(
    {word.encode("utf-8", "surrogatepass") for words in WORDS.values() for word in words if len(word) < 1000}
)


@st.composite
def mutated(draw: st.DrawFn) -> bytes:
    """A valid file with words put in, pieces taken out and pieces repeated."""
    data = draw(st.sampled_from(seeds()))
    for _ in range(draw(st.integers(0, 5))):
        at = draw(st.integers(0, len(data)))
        end = min(len(data), at + draw(st.integers(0, 40)))
        way = draw(st.sampled_from(("put", "take", "repeat", "many")))
        if way == "put":
            data = data[:at] + draw(st.sampled_from(_WORDS)) + data[at:]
        elif way == "many":
            data = data[:at] + draw(st.sampled_from(_WORDS)) * draw(st.sampled_from((10, 1000))) + data[at:]
        elif way == "take":
            data = data[:at] + data[end:]
        else:
            data = data[:end] + data[at:end] * draw(st.sampled_from((1, 3, 300))) + data[end:]
    return data


CONTENTS = st.one_of(mutated(), st.binary(max_size=400), st.lists(st.sampled_from(_WORDS), max_size=60).map(b"".join))


@st.composite
def hostile(draw: st.DrawFn) -> Hostile:
    folder = draw(st.sampled_from(FOLDERS))
    what = draw(st.sampled_from(("file",) * 12 + ("link", "link", "folder", "pipe", "unreadable")))
    if folder == "":
        name = draw(st.sampled_from(AT_ROOT))
        return Hostile(name.encode(), draw(st.binary(max_size=300)) if what == "file" else b"", "file")
    name = draw(st.one_of(st.sampled_from(NAMES).map(str.encode), st.sampled_from(ODD_NAMES)))
    path = folder.encode() + b"/" + name
    if what == "link":
        return Hostile(path, what=f"link:{draw(st.sampled_from(LINKS))}")
    return Hostile(path, draw(CONTENTS) if what in ("file", "unreadable") else b"", what)


def add(root: bytes, one: Hostile) -> None:
    path = os.path.join(root, one.path)
    os.makedirs(os.path.dirname(path), exist_ok=True)
    if os.path.isdir(path) and not os.path.islink(path):
        shutil.rmtree(path)
    with contextlib.suppress(FileNotFoundError):
        os.remove(path)
    if one.what.startswith("link:"):
        os.symlink(one.what[5:], path)
    elif one.what == "folder":
        os.makedirs(path, exist_ok=True)
    elif one.what == "pipe":
        os.mkfifo(path)
    else:
        Path(os.fsdecode(path)).write_bytes(one.content)
        if one.what == "unreadable":
            os.chmod(path, 0)


@contextlib.contextmanager
def in_time() -> Iterator[None]:
    """Makes a run that hangs a failure."""

    def over(*_: object) -> None:
        raise TimeoutError(f"takes longer than {SECONDS} s")

    before = signal.signal(signal.SIGALRM, over)
    signal.alarm(SECONDS)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def about_others(report: Report) -> list[dict]:
    """The findings on the healthy packages, as JSON."""
    return [as_json.build_finding_data(finding) for finding in report.findings if finding.package in PACKAGES]


@pytest.fixture(scope="module")
def place(tmp_path_factory) -> Path:
    """A folder for the cache and, in a folder of its own to which links may lead, the workspace."""
    return tmp_path_factory.mktemp("unchanged")


@pytest.fixture(scope="module")
def expected(place) -> list[dict]:
    """The findings without any hostile file."""
    for name, content in HEALTHY.items():
        path = place / "around" / "ws" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(content)
    report = checked(place)
    found = about_others(report)
    assert {finding["package"] for finding in found} == PACKAGES, "each package has a finding, so that losing one shows"
    assert not report.failure
    return found


def checked(place: Path) -> Report:
    return check(place / "around" / "ws", Options(targets=("jazzy",), cache=place / "cache", jobs=1))


def all_formats(report: Report) -> Iterator[str]:
    for form in (as_json, sarif, github, markdown, html, text):
        yield form.render(report)


@settings(max_examples=int(EXAMPLES or 40), derandomize=not EXAMPLES, database=None)
@given(st.lists(hostile(), min_size=1, max_size=8))
@example([Hostile(b"src/hostile/package.xml", MANIFEST_OF_HOSTILE)])
def test_unchanged(place, expected, files):
    root = place / "around" / "ws"
    added = [Hostile(b"src/hostile/package.xml", MANIFEST_OF_HOSTILE), *files]
    try:
        for one in added:
            add(os.fsencode(root), one)
        with in_time():
            report = checked(place)
            shown = list(all_formats(report))
        assert not report.failure
        assert about_others(report) == expected
        assert report.coverage.parsed <= report.coverage.files
        json.loads(shown[0])
        assert "this is a fault of rosimpact" not in shown[0]
        told = {problem for problem in report.coverage.unresolved}
        assert all(problem.isprintable() for problem in told)
        for document in shown:
            document.encode()  # raises for lone surrogates
    finally:
        remove(root, files)


def remove(root: Path, files: list[Hostile]) -> None:
    """Takes away all that was added."""
    for folder in ("src/hostile", "loose", "src/loose"):
        shutil.rmtree(os.path.join(os.fsencode(root), folder.encode()), ignore_errors=True)
    for one in files:
        with contextlib.suppress(OSError):
            os.remove(os.path.join(os.fsencode(root), one.path))
