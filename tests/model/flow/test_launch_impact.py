"""What changes of launch files, parameter files and robot descriptions reach: one edit at a time."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import pytest
from joining import manifest, write
from rosimpact.impact.analysis.downstream import compute_impact
from rosimpact.impact.analysis.effects import NOTHING, Impact
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.flow.workspace import link_for_flow
from rosimpact.impact.report import impact as impact_report
from rosimpact.impact.tree import WorkingTree

NODE = """import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool
from std_srvs.srv import Trigger


class {cls}(Node):
    def __init__(self):
        super().__init__('{name}')
        {body}

    def on_message(self, message):
        {then}


def main():
    rclpy.init()
    rclpy.spin({cls}())
"""
TIDE = """self.gain = self.declare_parameter('gain', 1.0).value
        self.level = self.create_publisher(Bool, self.declare_parameter('out', 'level').value, 10)
        self.create_timer(1.0, self.on_message)"""
WATCH = """self.alarm = self.create_publisher(Bool, 'alarm', 10)
        self.create_subscription(Bool, 'level', self.on_message, 10)
        self.create_client(Trigger, 'silence')"""
HORN = """self.create_subscription(Bool, 'alarm', self.on_message, 10)
        self.create_service(Trigger, 'silence', self.on_message)"""
LAUNCH = """<launch>
  <arg name="side" default="north"/>
  <group>
    <push-ros-namespace namespace="$(var side)"/>
    <node pkg="harbour" exec="tide" name="tide">
      <param from="$(find-pkg-share harbour)/config/tide.yaml"/>
    </node>
    <node pkg="harbour" exec="watch"/>
  </group>
  <node pkg="harbour" exec="horn">
    <remap from="alarm" to="north/alarm"/>
    <remap from="silence" to="north/silence"/>
  </node>
  <node pkg="slam" exec="slam" name="slam"><remap from="scan" to="north/level"/></node>
  <node pkg="robot_state_publisher" exec="robot_state_publisher">
    <param name="robot_description" value="$(command 'xacro $(find-pkg-share harbour)/urdf/buoy.urdf.xacro')"/>
  </node>
  <include file="$(find-pkg-share nav2_bringup)/launch/navigation_launch.py">
    <arg name="params_file" value="$(find-pkg-share harbour)/config/nav.yaml"/>
  </include>
  <arg name="loud" default="false"/>
  <node pkg="harbour" exec="horn" name="loud" if="$(var loud)"><remap from="alarm" to="horn_alarm"/></node>
</launch>
"""
FILES = {
    "harbour/package.xml": manifest("harbour", "ament_python"),
    "harbour/setup.py": "from setuptools import setup\nsetup(name='harbour', packages=['harbour'], entry_points={"
    "'console_scripts': ['tide = harbour.tide:main', 'watch = harbour.watch:main', 'horn = harbour.horn:main']})\n",
    "harbour/harbour/__init__.py": "",
    "harbour/harbour/tide.py": NODE.format(cls="Tide", name="tide", body=TIDE, then="self.level.publish(Bool())"),
    "harbour/harbour/watch.py": NODE.format(cls="Watch", name="watch", body=WATCH, then="self.alarm.publish(message)"),
    "harbour/harbour/horn.py": NODE.format(cls="Horn", name="horn", body=HORN, then="pass"),
    "harbour/launch/harbour.launch.xml": LAUNCH,
    "harbour/config/tide.yaml": "/**:\n  ros__parameters:\n    # how much\n    gain: 2.0\n    out: level\n",
    "harbour/config/nav.yaml": "local_costmap:\n  ros__parameters:\n    radius: 0.2\n    topic: /north/alarm\n",
    "harbour/config/spare.yaml": "a: 1\n",
    "harbour/urdf/buoy.urdf.xacro": '<robot><xacro:include filename="parts/lamp.xacro"/></robot>\n',
    "harbour/urdf/parts/lamp.xacro": "<robot><link name='lamp'/></robot>\n",
}
XML, TIDE_YAML, NAV_YAML = "harbour/launch/harbour.launch.xml", "harbour/config/tide.yaml", "harbour/config/nav.yaml"
Between = Callable[[dict[str, str]], Impact]


@pytest.fixture
def between(tmp_path: Path) -> Between:
    """What the step from FILES to other files reaches; a file without text is removed."""

    def reach(edits: dict[str, str]) -> Impact:
        for folder, files in (("base", FILES), ("now", {**FILES, **edits})):
            write(tmp_path / folder, {name: text for name, text in files.items() if text or name.endswith("__.py")})
        with Store(tmp_path / "cache") as store:
            base, now = (link_for_flow(WorkingTree(tmp_path / folder), store, 1) for folder in ("base", "now"))
            return compute_impact(now, base)

    return reach


def edited(path: str, *pairs: tuple[str, str]) -> dict[str, str]:
    text = FILES[path]
    for old, new in pairs:
        assert text.count(old) == 1
        text = text.replace(old, new)
    return {path: text}


class Told(NamedTuple):
    """A change as it is told. at: file name and line."""

    kind: str
    change: str
    subject: str
    at: str
    why: str
    reaches: list[str] = []  # noqa: RUF012  NamedTuple default, never changed
    alone: list[str] = []  # noqa: RUF012


def tell(impact: Impact) -> list[Told]:
    return [
        Told(
            one.kind, one.change, one.subject, f"{one.path.rpartition('/')[2]}:{one.line}", one.why,
            sorted({hop.node for hop in one.reaches}), [f"{each.role} {each.name} {each.node}" for each in one.alone],
        )
        for one in impact.effects
    ]  # fmt: skip


EDITS: dict[str, tuple[dict[str, str], list[Told]]] = {
    "a remapping of a subscriber": (
        edited(XML, ('"alarm" to="north/alarm"', '"alarm" to="south/alarm"')),
        [Told("launch", "renamed", "/south/alarm", "harbour.launch.xml:11",
              "remapping `alarm` is `south/alarm`, was `north/alarm`; the subscriber `/north/alarm` is now "
              "`/south/alarm`", [], ["publisher /north/alarm /north/watch"])],
    ),
    "a remapping of a server that is gone": (
        edited(XML, ('    <remap from="silence" to="north/silence"/>\n', "")),
        [Told("launch", "renamed", "/silence", "harbour.launch.xml:10",
              "remapping `silence` is gone, was `north/silence`; the server `/north/silence` is now `/silence`",
              ["/north/watch"], ["client /north/silence /north/watch"])],
    ),
    "a parameter file gives a topic another name": (
        edited(TIDE_YAML, ("out: level", "out: height")),
        [Told("launch", "renamed", "/north/height", "tide.yaml:5",
              "parameter `out` is `height`, was `level`; the publisher `/north/level` is now `/north/height`",
              ["/horn", "/north/watch"], ["subscriber /north/level /north/watch"])],
    ),
    "a parameter": (
        edited(TIDE_YAML, ("gain: 2.0", "gain: 3.0")),
        [Told("parameter", "changed", "gain", "tide.yaml:4", "parameter `gain` is `3.0`, was `2.0`",
              ["/horn", "/north/watch"])],
    ),
    "a comment in a parameter file": (edited(TIDE_YAML, ("# how much", "# how much of it")), []),
    "a comment in a launch file": (edited(XML, ("<group>", "<group> <!-- of nodes -->")), []),
    "the default of an argument renames nodes": (
        edited(XML, ('default="north"', 'default="south"')),
        [Told("launch", "renamed", "/south/tide", "harbour.launch.xml:2",
              "the node was `/north/tide`; the publisher `/north/level` is now `/south/level`",
              ["/horn", "/north/watch", "/south/watch"], []),
         Told("launch", "renamed", "/south/watch", "harbour.launch.xml:2", "", ["/horn"],
              ["subscriber /north/alarm /horn", "server /north/silence /horn"])],
    ),
    "a node that is started no more": (
        edited(XML, ('    <node pkg="harbour" exec="watch"/>\n', "")),
        [Told("launch", "removed", "/north/watch", "harbour.launch.xml:8", "`harbour/watch` is no longer started",
              ["/horn"], ["subscriber /north/alarm /horn", "publisher /north/level /north/tide",
                          "server /north/silence /horn"])],
    ),
    "a second node": (
        edited(XML, ("</launch>", '  <node pkg="harbour" exec="watch" name="second" namespace="north"/>\n</launch>')),
        [Told("launch", "added", "/north/second", "harbour.launch.xml:23", "`harbour/watch` is started", ["/horn"])],
    ),
    "a remapping of a program of another package": (
        edited(XML, ('"scan" to="north/level"', '"scan" to="north/alarm"')),
        [Told("launch", "renamed", "/north/alarm", "harbour.launch.xml:14",
              "remapping `scan` is `north/alarm`, was `north/level`; the name `/north/level` is now `/north/alarm`",
              ["/horn", "/north/watch"])],
    ),
    "a condition": (
        edited(XML, ('<node pkg="harbour" exec="horn">', '<node pkg="harbour" exec="horn" if="$(env LOUD)">')),
        [Told("launch", "changed", "/horn", "harbour.launch.xml:10", "condition is new: `$(env LOUD)`")],
    ),
    "a part of a robot description": (
        edited("harbour/urdf/parts/lamp.xacro", ("'lamp'", "'lantern'")),
        [Told("parameter", "changed", "robot_description", "lamp.xacro:1",
              "`robot_description` is made from `harbour/urdf/parts/lamp.xacro`, which differs")],
    ),
    "a parameter file that is given to a launch file of another package": (
        edited(NAV_YAML, ("radius: 0.2", "radius: 0.3")),
        [Told("parameter", "changed", "radius", "nav.yaml:3", "parameter `radius` is `0.3`, was `0.2`")],
    ),
    "a topic in such a file": (
        edited(NAV_YAML, ("topic: /north/alarm", "topic: /north/level")),
        [Told("launch", "renamed", "/north/level", "nav.yaml:4",
              "parameter `topic` is `/north/level`, was `/north/alarm`; the name `/north/alarm` is now `/north/level`",
              ["/horn", "/north/watch"])],
    ),
    "a node of another name in a parameter file": (
        edited(NAV_YAML, ("local_costmap", "global_costmap")),
        [Told("parameter", "added", "/global_costmap", "nav.yaml:3", "2 parameters now set for a node of this name"),
         Told("parameter", "removed", "/local_costmap", "nav.yaml:3",
              "2 parameters no longer set for a node of this name")],
    ),
    "a remapping around an include": (
        edited(XML, ("  <include", '  <set_remap from="cmd_vel" to="north/level"/>\n  <include')),
        [Told("launch", "renamed", "/north/level", "harbour.launch.xml:18",
              "remapping `cmd_vel` is new: `north/level`; the name `/cmd_vel` is now `/north/level`",
              ["/horn", "/north/watch"])],
    ),
    "a remapping to the name itself": (
        edited(XML, ('"scan" to="north/level"/>', '"scan" to="north/level"/><remap from="map" to="/map"/>')),
        [Told("launch", "changed", "map:=/map", "harbour.launch.xml:14", "remapping `map` is new: `/map`")],
    ),
    "a remapping of what the defaults leave out": (
        {XML: LAUNCH.replace("horn_alarm", "siren")},
        [Told("launch", "renamed", "/siren", "harbour.launch.xml:22",
              "remapping `alarm` is `siren`, was `horn_alarm`; the subscriber `/horn_alarm` is now `/siren`; "
              "started only if $(arg loud)")],
    ),
    "a file that nothing uses": (
        {"harbour/config/spare.yaml": "a: 2\n"},
        [Told("launch", "changed", "harbour/config/spare.yaml", "spare.yaml:1",
              "no launch file of the workspace is known to use it")],
    ),
    "an argument that nothing uses": (
        edited(XML, ("<group>", '<arg name="other" default="1"/><group>')),
        [Told("launch", "changed", XML, "harbour.launch.xml:1",
              "what launch files are known to start is as it was")],
    ),
    "a launch file that was moved": ({XML: "", "harbour/launch/pier.launch.xml": LAUNCH}, []),
    "a launch file that is gone": (
        {XML: ""},
        [Told("launch", "removed", XML, "harbour.launch.xml:1", "the launch file is gone; it started 5 nodes")],
    ),
    "a launch file that is new": (
        {"harbour/launch/horn.launch.xml": '<launch><node pkg="harbour" exec="horn" name="h"/></launch>'},
        [Told("launch", "added", "harbour/launch/horn.launch.xml", "horn.launch.xml:1",
              "a new launch file starts 1 node")],
    ),
}  # fmt: skip


@pytest.mark.parametrize(("edits", "told"), EDITS.values(), ids=EDITS)
def test_what_each_edit_reaches(edits: dict[str, str], told: list[Told], between: Between):
    found = tell(between(edits))
    assert [one._replace(why=one.why if want.why else "") for one, want in zip(found, told, strict=False)] == told
    assert len(found) == len(told)


ROS1 = {
    "quay/package.xml": manifest("quay", "catkin"),
    "quay/CMakeLists.txt": "project(quay)\ncatkin_package()\n"
    "catkin_install_python(PROGRAMS crane.py DESTINATION ${CATKIN_PACKAGE_BIN_DESTINATION})\n",
    "quay/crane.py": "#!/usr/bin/env python\nimport rospy\nfrom std_msgs.msg import Bool\nrospy.init_node('crane')\n"
    "rope = rospy.get_param('limits/rope')\npub = rospy.Publisher(rospy.get_param('~out', 'load'), Bool)\n"
    "pub.publish(True)\n",
    "quay/launch/quay.launch": '<launch>\n  <group ns="$(env SIDE)">\n    <rosparam file="$(find quay)/quay.yaml"/>\n'
    '    <node pkg="quay" type="crane.py" name="crane"/>\n  </group>\n</launch>\n',
    "quay/quay.yaml": "limits: {rope: 3}\ncrane: {out: load}\n",
}


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("rope: 3", "rope: 4", ("parameter", "changed", "/<$SIDE>/limits/rope", ("/<$SIDE>/crane",))),
        ("out: load", "out: weight", ("launch", "renamed", "/<$SIDE>/weight", ("/<$SIDE>/crane",))),
    ],
)
def test_parameters_of_ros1_in_a_namespace_that_is_not_known(tmp_path: Path, old: str, new: str, told: tuple):
    write(tmp_path / "base", ROS1)
    write(tmp_path / "now", {**ROS1, "quay/quay.yaml": ROS1["quay/quay.yaml"].replace(old, new)})
    with Store(tmp_path / "cache") as store:
        base, now = (link_for_flow(WorkingTree(tmp_path / folder), store, 1) for folder in ("base", "now"))
        (found,) = compute_impact(now, base).effects
    assert (found.kind, found.change, found.subject, found.nodes) == told
    assert found.path == "quay/quay.yaml"


def test_a_change_of_code_is_told_as_one_under_the_names_of_the_launch(between: Between):
    watch = "harbour/harbour/watch.py"
    found = tell(between(edited(watch, ("'alarm'", "'alert'"))))
    assert [(one.kind, one.change, one.subject, one.reaches, one.alone) for one in found] == [
        ("condition", "changed", "/north/alarm, /north/alert", ["/horn"], ["subscriber /north/alarm /horn"])
    ]


def test_code_and_launch_in_one_change_are_told_apart(between: Between):
    both = edited("harbour/harbour/watch.py", ("'alarm'", "'alert'"))
    both |= edited(XML, ('exec="watch"', 'exec="watch" name="w"'))
    found = {(one.kind, one.change, one.subject) for one in tell(between(both))}
    assert ("launch", "renamed", "/north/w") in found
    assert ("topic", "removed", "/north/alarm") in found
    assert ("topic", "removed", "/north/level") not in found


def test_text(between: Between):
    text = impact_report.render_text(between(edited(XML, ('"alarm" to="north/alarm"', '"alarm" to="south/alarm"'))))
    assert "launch settings\n  renamed  /south/alarm  (/horn)  harbour/launch/harbour.launch.xml:11\n" in text
    assert "nothing in the workspace subscribes to /north/alarm of /north/watch any more" in text
    assert "1 launch setting changed; 0 nodes of 3 reached" in text


def test_without_a_change_nothing_is_told(between: Between):
    assert between({}) == NOTHING
