"""`rosimpact env diff`: what differs between two machines, and beside a workspace what of it matters to that."""

from __future__ import annotations

import json
from pathlib import Path

import jsonschema
import pytest

ROOT = Path(__file__).parents[1]
EXAMPLE = ROOT / "examples/ros2_ws"
FILES = {
    "package.xml": """<package format="3">
  <name>eye</name><version>1.0.0</version><description>d</description>
  <maintainer email="a@b.org">a</maintainer><license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <depend>cv_bridge</depend>
  <depend>libopencv-dev</depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
""",
    "CMakeLists.txt": """cmake_minimum_required(VERSION 3.8)
project(eye)
find_package(ament_cmake REQUIRED)
find_package(cv_bridge REQUIRED)
find_package(OpenCV 9 REQUIRED)
add_library(eye a.cpp b.cpp)
target_link_libraries(eye cv_bridge::cv_bridge opencv_core)
install(TARGETS eye DESTINATION lib)
ament_package()
""",
    "a.cpp": "#include <cv_bridge/cv_bridge.h>\n#include <opencv2/core.hpp>\n",
    "b.cpp": "#include <cv_bridge/cv_bridge.h>\n",
}


@pytest.fixture
def ws(tmp_path) -> Path:
    """One package: what it includes is gone on jazzy, what it asks for is nowhere."""
    for name, text in FILES.items():
        path = tmp_path / "ws/eye" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return tmp_path / "ws"


def test_two_machines_alone(say):
    said = say("env", "diff", "humble", "jazzy")
    assert said.status == 0 and said.err == ""
    lines = said.out.splitlines()
    assert lines[0].startswith("compared: humble (") and " and jazzy (" in lines[0]
    rows = {line.split()[0]: line.split()[1:] for line in lines[3:-2]}
    assert rows["opencv"] == ["4.5.4", "4.6.0"]
    assert rows["nav2_map_server"][0].startswith("1.1.")
    assert rows["gazebo_ros"][1] == "-"
    assert int(lines[-1].split()[0].replace(",", "")) > 1000
    assert say("env", "diff", "humble", "humble").out.splitlines()[-1] == "0 differences"


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("humble", "gutsy"), "gutsy"),
        (("humble", "jazzy", "--format", "xml"), "choose one of text, json"),
        (("humble", "jazzy", "/nowhere"), "/nowhere"),
    ],
)
def test_what_cannot_be_done_is_told_in_a_line(say, arguments, words):
    said = say("env", "diff", *arguments)
    assert said.status == 2 and words in said.err and len(said.err.splitlines()) == 1


def test_what_breaks_on_one_machine_comes_first(say, ws):
    said = say("env", "diff", "humble", "jazzy", ws)
    assert said.status == 0
    lines = said.out.splitlines()
    heads = [line for line in lines if line.startswith(("error[", "warning["))]
    what = "`cv_bridge/cv_bridge.h` is not available in cv_bridge 4.1.0 (removed in 4.0.0)"
    assert heads == [f"error[removed-header] jazzy: {what}"]
    assert [line for line in lines if line.startswith("  → ")] == ["  → eye/a.cpp:1:10"]
    assert "  and 1 more place: eye/b.cpp:1" in lines
    assert lines.index(heads[0]) < next(n for n, line in enumerate(lines) if line.startswith("what it uses"))
    assert "1 error only on jazzy · 1 finding on both" in lines[-1]


def test_versions_of_what_the_workspace_uses_with_what_of_it(say, ws):
    lines = say("env", "diff", "humble", "jazzy", ws).out.splitlines()
    start = next(n for n, line in enumerate(lines) if line.startswith("what it uses"))
    rows = {line.split()[0]: line.split(maxsplit=3)[1:] for line in lines[start + 1 : -2]}
    assert rows["opencv"] == ["4.5.4", "4.6.0", "eye: finds OpenCV, includes opencv2/core.hpp"]
    assert rows["cv_bridge"][2] == "eye: includes cv_bridge/cv_bridge.h"
    assert rows["ament_cmake"][2] == "eye: found"
    assert rows["cmake"][2] == rows["gcc"][2] == "eye: built with"
    assert "nav2_map_server" not in rows and "python3" not in rows, "what nothing uses is only counted"
    assert int(lines[-1].rpartition("of what it uses, ")[2].split()[0].replace(",", "")) > 1000


def test_the_order_of_the_machines_is_that_of_the_question(say, ws):
    one = json.loads(say("env", "diff", "humble", "jazzy", ws, "-f", "json").out)
    other = json.loads(say("env", "diff", "jazzy", "humble", ws, "-f", "json").out)
    assert [item["target"] for item in one["harms"] + other["harms"]] == ["jazzy", "jazzy"]
    assert {(d["name"], d["first"], d["second"]) for d in one["versions"]} == {
        (d["name"], d["second"], d["first"]) for d in other["versions"]
    }


def test_what_the_workspace_itself_holds_is_no_difference(say, ws):
    (ws / "cv_bridge").mkdir()
    text = FILES["package.xml"].replace("<name>eye", "<name>cv_bridge").replace("  <depend>cv_bridge</depend>\n", "")
    (ws / "cv_bridge/package.xml").write_text(text)
    report = json.loads(say("env", "diff", "humble", "jazzy", ws, "-f", "json").out)
    assert "cv_bridge" not in {each["name"] for each in report["versions"]}


def test_errors_of_both_machines_come_before_warnings(say):
    report = json.loads(say("env", "diff", "laptop", "robot", EXAMPLE, "-f", "json").out)
    said = [(item["severity"], item["target"]) for item in report["harms"]]
    assert said == sorted(said) and {target for _, target in said} == {"laptop", "robot"}


@pytest.mark.parametrize("beside", [(), (EXAMPLE,)])
def test_json_is_what_the_schema_says(say, beside):
    schema = json.loads(say("env", "diff", "--schema").out)
    jsonschema.Draft202012Validator.check_schema(schema)
    assert schema == json.loads((ROOT / "docs/envdiff.schema.json").read_text()), (
        "rosimpact env diff --schema > docs/envdiff.schema.json"
    )
    report = json.loads(say("env", "diff", "humble", "jazzy", *beside, "-f", "json").out)
    jsonschema.validate(report, schema)
    assert ("harms" in report) is bool(beside)
    assert {each["kind"] for each in report["machine"]} == {"distro", "platform"}


def test_it_is_written_to_a_file(say, tmp_path):
    assert say("env", "diff", "humble", "jazzy", "-o", tmp_path / "diff.txt").out == ""
    assert "differences" in (tmp_path / "diff.txt").read_text().splitlines()[-1]


PILOT = """import rclpy
from nav2_msgs.action import NavigateToPose
from rclpy.action import ActionClient
from rclpy.node import Node
from std_msgs.msg import String
from yard_msgs.msg import Shed


class Pilot(Node):
    def __init__(self):
        super().__init__("pilot")
        self.goals = ActionClient(self, NavigateToPose, "navigate_to_pose")
        self.words = self.create_publisher(String, "words", 1)
        self.sheds = self.create_publisher(Shed, "sheds", 1)


if __name__ == "__main__":
    rclpy.init()
    Pilot()
"""


def test_what_nodes_on_both_cannot_talk_about_comes_first(say, ws):
    files = {
        "pilot/pilot.py": PILOT,
        "pilot/package.xml": FILES["package.xml"].replace("eye", "pilot"),
        "pilot/CMakeLists.txt": "project(pilot)\nfind_package(ament_cmake REQUIRED)\n"
        "install(PROGRAMS pilot.py DESTINATION lib/pilot)\nament_package()\n",
        "yard_msgs/package.xml": FILES["package.xml"].replace("eye", "yard_msgs"),
        # A marker has another field since humble; a message of the workspace holds one.
        "yard_msgs/msg/Shed.msg": "string name\nvisualization_msgs/Marker[] markers\n",
    }
    for name, text in files.items():
        path = ws / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    def tell(*targets: str) -> dict[tuple[str, str], dict]:
        found = json.loads(say("env", "diff", *targets, ws, "--format", "json").out)["wire"]
        return {(each["kind"], each["name"]): each for each in found}

    told = tell("humble", "jazzy")
    assert list(told) == [("action", "/navigate_to_pose")]
    assert told["action", "/navigate_to_pose"]["places"] == ["pilot/pilot.py:12"]
    assert say("env", "diff", "humble", "jazzy", ws).out.splitlines()[2] == "what nodes on both cannot talk about"
    told = tell("foxy", "humble")
    assert told["topic", "/sheds"]["type"] == "yard_msgs/Shed"
    assert told["topic", "/sheds"]["why"].startswith("in `markers`: only humble has the field")
    assert ("topic", "/words") not in told
    assert ("middleware", "") in tell("galactic", "humble")
