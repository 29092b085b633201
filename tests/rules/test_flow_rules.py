"""What rules over the message flow leave alone, each beside the small change that makes them speak."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

import pytest
from rosimpact.impact.analysis.check import check, compare
from rosimpact.impact.analysis.session import Options

OPTIONS = Options(targets=("jazzy",), preview=True, jobs=1, select=("graph", "qos"))
MANIFEST = """<?xml version="1.0"?>
<package format="3">
  <name>quay</name>
  <version>1.0.0</version>
  <description>quay</description>
  <maintainer email="robots@example.org">Robots</maintainer>
  <license>Apache-2.0</license>
  <exec_depend>rclpy</exec_depend>
  <export><build_type>ament_python</build_type></export>
</package>
"""
HEAD = """import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.srv import GetMap
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy, qos_profile_sensor_data
from std_srvs.srv import Trigger

"""
STARTED = '<launch>\n  <node pkg="quay" exec="crane"/>\n  <node pkg="quay" exec="ship"/>\n</launch>\n'
TALKS = "self.out = self.create_publisher(Twist, 'course', 10)"
LISTENS = "self.create_subscription(Twist, 'course', print, 10)"


def node(name: str, *lines: str) -> str:
    """A module with a node that does these lines when it is made."""
    body = "".join(f"        {line}\n" for line in lines)
    return (
        f"{HEAD}\nclass {name.title()}(Node):\n    def __init__(self):\n        super().__init__('{name}')\n{body}\n\n"
        f"def main():\n    rclpy.init()\n    rclpy.spin({name.title()}())\n"
    )


def quay(crane: str, ship: str, launch: str = "", config: str = "") -> dict[str, str]:
    """A package of two nodes, a crane and a ship, of what each does."""
    scripts = "'crane = quay.crane:main', 'ship = quay.ship:main'"
    files = {
        "quay/package.xml": MANIFEST,
        "quay/setup.py": "from setuptools import setup\n\nsetup(name='quay', version='1.0.0', packages=['quay'],\n"
        f"      entry_points={{'console_scripts': [{scripts}]}})\n",
        "quay/quay/__init__.py": "",
        "quay/quay/crane.py": node("crane", *crane.split("\n")),
        "quay/quay/ship.py": node("ship", *ship.split("\n")),
    }
    if launch:
        files["quay/launch/quay.launch.xml"] = launch
    if config:
        files["quay/config/quay.yaml"] = config
    return files


def chandler(source: str, launch: str) -> dict[str, str]:
    """A package of one ROS 1 program in C++, which a launch file starts."""
    return {
        "quay/package.xml": MANIFEST.replace("<export><build_type>ament_python</build_type></export>", "")
        .replace('format="3"', 'format="2"')
        .replace(
            "<exec_depend>rclpy</exec_depend>", "<buildtool_depend>catkin</buildtool_depend><depend>roscpp</depend>"
        ),
        "quay/CMakeLists.txt": "cmake_minimum_required(VERSION 3.8)\nproject(quay)\n"
        "find_package(catkin REQUIRED COMPONENTS roscpp)\ncatkin_package()\n"
        "add_executable(chandler src/chandler.cpp)\ntarget_link_libraries(chandler ${catkin_LIBRARIES})\n",
        "quay/src/chandler.cpp": f"#include <ros/ros.h>\n{source}",
        "quay/launch/quay.launch": launch,
    }


def hold(header: str, source: str) -> dict[str, str]:
    """A package of one component in C++, in a header and a source, which a launch file starts."""
    return {
        "quay/package.xml": MANIFEST.replace("ament_python", "ament_cmake").replace("rclpy", "rclcpp_components"),
        "quay/CMakeLists.txt": "cmake_minimum_required(VERSION 3.8)\nproject(quay)\n"
        "find_package(ament_cmake REQUIRED)\nfind_package(rclcpp REQUIRED)\n"
        "find_package(rclcpp_components REQUIRED)\nfind_package(std_msgs REQUIRED)\n"
        "include_directories(include)\nadd_library(hold SHARED src/hold.cpp)\n"
        "ament_target_dependencies(hold rclcpp rclcpp_components std_msgs)\n"
        'rclcpp_components_register_nodes(hold "quay::Hold")\nament_package()\n',
        "quay/include/quay/hold.hpp": f"#include <rclcpp/rclcpp.hpp>\n#include <std_msgs/msg/empty.hpp>\n{header}",
        "quay/src/hold.cpp": f'#include "quay/hold.hpp"\n#include <rclcpp_components/register_node_macro.hpp>\n{source}'
        "RCLCPP_COMPONENTS_REGISTER_NODE(quay::Hold)\n",
        "quay/launch/quay.launch.xml": '<launch>\n  <node_container pkg="rclcpp_components" exec="component_container" '
        'name="all" namespace="">\n    <composable_node pkg="quay" plugin="quay::Hold" name="hold">\n'
        '      <remap from="weight" to="/mass"/>\n    </composable_node>\n  </node_container>\n</launch>\n',
    }


def with_inner(start: str, inner: str) -> str:
    """STARTED with something within the first node."""
    return STARTED.replace('exec="crane"/>', f'exec="crane" name="crane">{inner}</node>').replace("\n", start + "\n", 1)


REMAP = with_inner("", '<remap from="heading" to="/course"/>')
LOADS = with_inner("", '<param from="$(find-pkg-share quay)/config/quay.yaml"/>')
BEST = "profile = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)\n"


class Row(NamedTuple):
    """rule: its name. files: where it is silent. spoilt: path below quay/, old and new text: then it speaks, as
    gravely as told."""

    rule: str
    files: dict[str, str]
    spoilt: tuple[str, str, str]
    told: str = "warning"


ROWS = {
    "a node that offers both types": Row(
        "topic-type-mismatch",
        quay(TALKS + "\nself.old = self.create_publisher(TwistStamped, 'course', 10)",
             "self.create_subscription(TwistStamped, 'course', print, 10)", STARTED),
        ("quay/crane.py", "self.old = self.create_publisher(TwistStamped, 'course', 10)", "pass"),
        "error",
    ),
    "types that differ where a remapping parts the names": Row(
        "topic-type-mismatch",
        quay(TALKS, "self.create_subscription(TwistStamped, 'course', print, 10)",
             with_inner("", '<remap from="course" to="heading"/>')),
        ("launch/quay.launch.xml", 'from="course"', 'from="other"'),
        "error",
    ),
    "types that differ in nodes with others to talk to": Row(
        "topic-type-mismatch",
        quay(TALKS, "self.create_subscription(TwistStamped, 'course', print, 10)\n" + LISTENS),
        ("quay/ship.py", LISTENS, "pass"),
    ),
    "digits that tell names apart": Row(
        "near-miss-name",
        quay("self.out = self.create_publisher(Twist, 'course1', 10)",
             "self.create_subscription(Twist, 'course2', print, 10)"),
        ("quay/ship.py", "'course2'", "'courses1'"),
    ),
    "a publisher of an unknown name": Row(
        "near-miss-name",
        quay(TALKS + "\nself.any = self.create_publisher(Twist, input(), 10)",
             "self.create_subscription(Twist, 'courses', print, 10)"),
        ("quay/crane.py", "input()", "'far_away'"),
    ),
    "a publisher that is not seen to be made": Row(
        "near-miss-name",
        quay(TALKS + "\nself.pub = self.far_pub()\nself.pub.publish(Twist())",
             "self.create_subscription(Twist, 'courses', print, 10)"),
        ("quay/crane.py", "self.pub.publish(Twist())", "pass"),
    ),
    "a server of an unknown name": Row(
        "unmatched-client",
        quay("self.create_service(GetMap, 'port/chart', print)\nself.create_service(GetMap, input(), print)",
             "self.client = self.create_client(GetMap, 'chart')"),
        ("quay/crane.py", "input()", "'far_away'"),
    ),
    "a server that whoever starts it may put into the client's namespace": Row(
        "unmatched-client",
        quay("self.create_service(GetMap, 'chart', print)", "self.client = self.create_client(GetMap, '/port/chart')"),
        ("quay/crane.py", "'chart'", "'/chart'"),
    ),
    "services whose type says nothing": Row(
        "unmatched-client",
        quay("self.create_service(Trigger, 'port/start', print)\nself.client = self.create_client(Trigger, 'start')",
             LISTENS),
        ("quay/crane.py", "(Trigger", "(GetMap"),
    ),
    "a node that is handed to code from elsewhere": Row(
        "dead-remap",
        quay("import far\nfar.Tool(self)\n" + TALKS, LISTENS, REMAP),
        ("quay/crane.py", "import far\n        far.Tool(self)\n        ", ""),
    ),
    "a class whose members of elsewhere are given the node": Row(
        "dead-remap",
        hold('#include "far/tool.hpp"\nnamespace quay {\nclass Hold : public rclcpp::Node {\n public:\n'
             "  explicit Hold(const rclcpp::NodeOptions & options);\n private:\n"
             '  far::Tool<std_msgs::msg::Empty> tool_{this, "weight"};\n'
             "  rclcpp::Publisher<std_msgs::msg::Empty>::SharedPtr full_;\n};\n}\n",
             "namespace quay {\nHold::Hold(const rclcpp::NodeOptions & options) : Node(\"hold\", options) {\n"
             '  full_ = create_publisher<std_msgs::msg::Empty>("full", 1);\n}\n}\n'),
        ("include/quay/hold.hpp", '#include "far/tool.hpp"', ""),
    ),
    "a name that goes by another": Row(
        "dead-remap",
        quay(TALKS, LISTENS, REMAP.replace("heading", "course/compressed")),
        ("launch/quay.launch.xml", "course/compressed", "course/far"),
    ),
    "a program that loads a nodelet": Row(
        "unknown-parameter",
        chandler("#include <nodelet/loader.h>\nint main(int c, char** v) {\n  ros::init(c, v, \"chandler\");\n"
                 '  ros::NodeHandle pnh("~");\n  int rope;\n  pnh.param("rope", rope, 3);\n'
                 "  nodelet::Loader loader;\n  nodelet::M_string remap;\n  nodelet::V_string nargv;\n"
                 '  loader.load(ros::this_node::getName(), "far/Store", remap, nargv);\n  ros::spin();\n}\n',
                 '<launch>\n  <node pkg="quay" type="chandler" name="chandler">\n    <param name="sail" value="2"/>\n'
                 "  </node>\n</launch>\n"),
        ("src/chandler.cpp", '  loader.load(ros::this_node::getName(), "far/Store", remap, nargv);\n', ""),
        "note",
    ),
    "a name that is put together": Row(
        "dead-remap",
        quay("self.out = self.create_publisher(Twist, input(), 10)", LISTENS, REMAP),
        ("quay/crane.py", "input()", "'course'"),
    ),
    "parameters asked for by prefix": Row(
        "unknown-parameter",
        quay("self.declare_parameter('reach', 3.0)\nself.get_parameters_by_prefix('arm')", LISTENS, LOADS,
             "crane:\n  ros__parameters:\n    height: 3.0\n"),
        ("quay/crane.py", "self.get_parameters_by_prefix('arm')", "pass"),
        "note",
    ),
    "parameters for every node": Row(
        "unknown-parameter",
        quay("self.declare_parameter('reach', 3.0)", LISTENS, LOADS, "/**:\n  ros__parameters:\n    height: 3.0\n"),
        ("config/quay.yaml", "/**", "crane"),
        "note",
    ),
    "a profile that is chosen under a condition": Row(
        "qos-reliability",
        quay(BEST + "if rclpy.ok():\n    profile = QoSProfile(depth=1)\n" + TALKS.replace("10", "profile"), LISTENS),
        ("quay/crane.py", "if rclpy.ok():\n            profile = QoSProfile(depth=1)\n        ", ""),
    ),
    "a reliable publisher of a best-effort subscriber": Row(
        "qos-reliability",
        quay(BEST + TALKS + "\n" + LISTENS.replace("10", "profile"), "pass"),
        ("quay/crane.py", "'course', 10)\n        self.create_subscription(Twist, 'course', print, profile)",
         "'course', profile)\n        self.create_subscription(Twist, 'course', print, 10)"),
    ),
}  # fmt: skip


def written(folder: Path, files: dict[str, str]) -> Path:
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return folder


def said(folder: Path, rule: str, cache: Path) -> set[str]:
    return {f.severity for f in check(folder, OPTIONS._replace(cache=cache)).findings if f.rule == rule}


@pytest.mark.parametrize("row", ROWS.values(), ids=ROWS)
def test_what_is_left_alone(row: Row, tmp_path: Path):
    assert said(written(tmp_path / "a", row.files), row.rule, tmp_path / "cache") == set()
    path, old, new = row.spoilt
    spoilt = {**row.files, f"quay/{path}": row.files[f"quay/{path}"].replace(old, new)}
    assert spoilt != row.files
    assert said(written(tmp_path / "b", spoilt), row.rule, tmp_path / "cache") == {row.told}


@pytest.mark.parametrize(
    ("rosparam", "file", "lines"),
    [
        ('<rosparam file="$(find quay)/config/quay.yaml"/>', "config/quay.yaml", [1, 2, 3]),
        ("<rosparam>{rope: 3, sail: 2, store: {tar: 1}}</rosparam>", "launch/quay.launch", [3]),
    ],
)
def test_parameters_are_told_where_they_are_set_those_of_one_line_together(
    rosparam: str, file: str, lines: list[int], tmp_path: Path
):
    source = (
        'int main(int c, char** v) {\n  ros::init(c, v, "chandler");\n  ros::NodeHandle pnh("~");\n  ros::spin();\n}\n'
    )
    launch = f'<launch>\n  <node pkg="quay" type="chandler" name="chandler">\n    {rosparam}\n  </node>\n</launch>\n'
    files = {**chandler(source, launch), "quay/config/quay.yaml": "rope: 3\nsail: 2\nstore: {tar: 1}\n"}
    report = check(written(tmp_path / "ws", files), OPTIONS._replace(cache=tmp_path / "cache"))
    told = [(f.path.endswith(file), f.line, f.message) for f in report.findings if f.rule == "unknown-parameter"]
    assert [(here, line) for here, line, _ in told] == [(True, line) for line in lines]
    assert told[0][2].endswith("and 2 more that this line loads") == (len(lines) == 1)


RENAMED = {
    "both sides": ("'heading'", "'heading'", set()),
    "the publisher": ("'heading'", "'course'", {"warning"}),
    "the subscriber": ("'course'", "'heading'", {"warning"}),
}


@pytest.mark.parametrize(("talks", "listens", "told"), RENAMED.values(), ids=RENAMED)
def test_an_edge_is_lost_when_one_side_is_renamed(talks: str, listens: str, told: set[str], tmp_path: Path):
    base = written(tmp_path / "base", quay(TALKS, LISTENS))
    files = quay(TALKS.replace("'course'", talks), LISTENS.replace("'course'", listens))
    report = compare(written(tmp_path / "now", files), base, OPTIONS._replace(cache=tmp_path / "cache"))
    assert {f.severity for f in report.findings if f.rule == "lost-edge"} == told


def test_a_subscriber_that_was_removed_is_a_note(tmp_path: Path):
    base = written(tmp_path / "base", quay(TALKS, LISTENS))
    now = written(tmp_path / "now", quay(TALKS, "pass"))
    report = compare(now, base, OPTIONS._replace(cache=tmp_path / "cache"))
    assert {f.severity for f in report.findings if f.rule == "lost-edge"} == {"note"}


def test_what_was_said_is_remembered_until_something_changes(tmp_path, monkeypatch):
    """A second run joins no code; an edit of a node, or of a launch file, is judged anew."""
    from rosimpact.impact.model.flow.join import Join

    def findings():
        return [(one.rule, one.path, one.line) for one in check(tmp_path / "ws", options).findings]

    def edit(files):
        for path, text in files.items():
            (tmp_path / "ws" / path).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / "ws" / path).write_text(text)

    options = OPTIONS._replace(cache=tmp_path / "cache")
    wrong = LISTENS.replace("Twist", "TwistStamped")
    edit(quay(TALKS, wrong, STARTED))
    first = findings()
    assert "topic-type-mismatch" in [rule for rule, _, _ in first]
    with monkeypatch.context() as patch:
        patch.setattr(Join, "__init__", None)
        assert findings() == first
    remapped = STARTED.replace('exec="ship"/>', 'exec="ship"><remap from="curse" to="way"/></node>')
    edit(quay(TALKS, LISTENS, remapped))
    second = findings()
    assert "dead-remap" in [rule for rule, _, _ in second]
    assert "topic-type-mismatch" not in [rule for rule, _, _ in second]
    edit(quay(TALKS, LISTENS, STARTED))
    assert findings() == []
