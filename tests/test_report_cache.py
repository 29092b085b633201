"""A remembered report is what a fresh check would report, after any kind of edit, and is used where nothing changed."""

from __future__ import annotations

import os
from itertools import pairwise
from pathlib import Path

import pytest
from rosimpact.impact.analysis import check_opened as check_opened
from rosimpact.impact.analysis import report_cache
from rosimpact.impact.analysis.check import run
from rosimpact.impact.analysis.session import Options, select_rules
from rosimpact.impact.config import Config
from rosimpact.impact.facts.store import Store

MANIFEST = """<package format="3"><name>{name}</name><version>1.0.0</version><description>d</description>
<maintainer email="a@b.org">a</maintainer><license>MIT</license><buildtool_depend>ament_cmake</buildtool_depend>
<depend>rclcpp</depend>{depends}<export><build_type>ament_cmake</build_type></export></package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.8)
project({name})
find_package(ament_cmake REQUIRED)
find_package(rclcpp REQUIRED)
add_library({name} src/{name}.cpp)
target_include_directories({name} PUBLIC include)
ament_target_dependencies({name} rclcpp)
install(DIRECTORY include/ DESTINATION include)
ament_package()
"""


@pytest.fixture
def workspace(tmp_path):
    """Two packages, of which one includes the other's header without declaring it."""
    for name, depends, body in (
        ("sled", "", "#include <sled/sled.hpp>\nuint8_t a;\n"),
        ("dogs", "", "#include <sled/sled.hpp>\n#include <tf2_ros/buffer.h>\n"),
    ):
        folder = tmp_path / "ws" / name
        for path, text in {
            "package.xml": MANIFEST.format(name=name, depends=depends),
            "CMakeLists.txt": CMAKE.format(name=name),
            f"src/{name}.cpp": body,
            f"include/{name}/{name}.hpp": "#include <rclcpp/rclcpp.hpp>\n",
        }.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_text(text)
    return tmp_path / "ws"


def reported(checked) -> tuple:
    report = checked.report
    return (
        *(report.findings, report.suppressed, report.known, report.coverage, report.packages, report.targets),
        *([rule.name for rule in report.rules()], report.failure, checked.originals),
    )


def check(workspace: Path, cache: Path, **options) -> tuple:
    return reported(run(workspace, Options(("jazzy",), cache=cache, jobs=1, **options)))


def append(path: str, text: str):
    def edit(workspace: Path) -> None:
        with (workspace / path).open("a") as file:
            file.write(text)

    return edit


def write(path: str, text: str):
    return lambda workspace: (workspace / path).write_text(text)


EDITS = {
    "an include in a header": append("sled/include/sled/sled.hpp", "#include <tf2_sensor_msgs/tf2_sensor_msgs.h>\n"),
    "a source": write("sled/src/sled.cpp", "#include <opencv2/opencv.hpp>\nint a;\n"),
    "a comment that silences": write("sled/src/sled.cpp", "uint8_t a;  // rosimpact: allow\n"),
    "a declaration": write("dogs/package.xml", MANIFEST.format(name="dogs", depends="<depend>sled</depend>")),
    "CMake": append("dogs/CMakeLists.txt", "find_package(nosuch_thing REQUIRED)\n"),
    "a new file": write("dogs/src/more.cpp", "#include <vector>\n"),
    "settings": write("rosimpact.toml", '[check]\nignore = ["undeclared-package"]\n'),
    "severities": write("rosimpact.toml", '[paths."dogs/**"]\nseverity = {undeclared-package = "note"}\n'),
    "a marker": write("dogs/COLCON_IGNORE", ""),
    "no marker": lambda workspace: (workspace / "dogs/COLCON_IGNORE").unlink(),
    "a renamed header": lambda workspace: (workspace / "sled/include/sled/sled.hpp").rename(
        workspace / "sled/include/sled/sledge.hpp"
    ),
    "a link out of the workspace": lambda workspace: os.symlink("/etc/passwd", workspace / "sled/src/other.cpp"),
    "no file": lambda workspace: (workspace / "sled/src/sled.cpp").unlink(),
}


def test_what_is_remembered_is_what_a_fresh_check_says(workspace, tmp_path):
    answers = [check(workspace, tmp_path / "kept")]
    for number, (name, edit) in enumerate(EDITS.items()):
        edit(workspace)
        fresh = check(workspace, tmp_path / f"fresh{number}")
        assert check(workspace, tmp_path / "kept") == fresh, name
        assert check(workspace, tmp_path / "kept") == fresh, f"{name}, nothing changed"
        answers.append(fresh)
    unchanged = [name for name, (before, after) in zip(EDITS, pairwise(answers), strict=True) if before == after]
    assert unchanged == []


@pytest.fixture
def only_remembered(monkeypatch):
    """Makes it an error to judge anything."""

    def refuse():
        monkeypatch.setattr(check_opened, "check_opened", lambda *_, **__: pytest.fail("judged anew"))

    return refuse


def test_nothing_is_judged_where_nothing_changed(workspace, tmp_path, only_remembered):
    first = check(workspace, tmp_path / "cache")
    assert first[0]
    only_remembered()
    assert check(workspace, tmp_path / "cache") == first


OTHERS = {
    "another target": {"targets": ("humble",)},
    "a rule left out": {"ignore": ("missing-include",)},
    "preview rules": {"preview": True},
    "a baseline": {"baseline": '{"schema": 1, "findings": []}'},
}


@pytest.mark.parametrize("other", OTHERS.values(), ids=OTHERS)
def test_whoever_asks_otherwise_is_not_given_it(workspace, tmp_path, only_remembered, other):
    check(workspace, tmp_path / "cache")
    only_remembered()
    with pytest.raises(pytest.fail.Exception, match="judged anew"):
        run(workspace, Options(("jazzy",), cache=tmp_path / "cache", jobs=1)._replace(**other))


def test_a_file_of_no_known_kind_that_was_just_written_may_still_change(workspace, tmp_path, only_remembered):
    (workspace / "dogs/notes.odd").write_text("")
    check(workspace, tmp_path / "cache")
    only_remembered()
    with pytest.raises(pytest.fail.Exception, match="judged anew"):
        check(workspace, tmp_path / "cache")


@pytest.mark.parametrize("data", [b"", b"\x93\x01\x02\x03", b"no msgpack"])
def test_what_cannot_be_read_counts_as_lost(workspace, tmp_path, monkeypatch, data):
    keys = []
    make_key = report_cache.report_key
    monkeypatch.setattr(report_cache, "report_key", lambda *asked: keys.append(make_key(*asked)) or keys[-1])
    first = check(workspace, tmp_path / "cache")
    with Store(tmp_path / "cache") as store:
        store.remember("report", [(keys[0], data)])
    assert check(workspace, tmp_path / "cache") == first
    assert keys[0] == keys[1]


@pytest.mark.parametrize("preview", [True, False])
def test_facts_of_the_message_flow_are_made_where_a_rule_reads_them(tmp_path, preview):
    options = Options(preview=preview)
    wanted = any(rule.reads_flow for rule in select_rules(options, Config()).values())
    with Store(tmp_path) as store:
        assert report_cache.asks_flow(Config(), store, options) is wanted
