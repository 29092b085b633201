"""What changes reach in a system of several launch files, which rosimpact.toml names."""

from pathlib import Path

import pytest
from joining import manifest, write
from rosimpact.impact.analysis.downstream import compute_impact
from rosimpact.impact.analysis.systems import choose_systems
from rosimpact.impact.config import SystemSetting
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.flow.workspace import link_for_flow
from rosimpact.impact.rules.graph.lost_edge import lost_edge
from rosimpact.impact.tree import WorkingTree

NODE = """import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool


class Ship(Node):
    def __init__(self):
        super().__init__('NAME')
        BODY

    def on_message(self, message):
        pass


def main():
    rclpy.init()
    rclpy.spin(Ship())
"""
TIDE = "self.level = self.create_publisher(Bool, self.declare_parameter('out', 'level').value, 10)"
WATCH = "self.create_subscription(Bool, 'level', self.on_message, 10)"
LAUNCH = """<launch>
  <arg name="side" default="north"/>
  <node pkg="pier" exec="NAME" name="NAME" namespace="$(var side)">MORE</node>
</launch>
"""
FILES = {
    "pier/package.xml": manifest("pier", "ament_python"),
    "pier/setup.py": "from setuptools import setup\nsetup(name='pier', packages=['pier'], entry_points={"
    "'console_scripts': ['tide = pier.tide:main', 'watch = pier.watch:main']})\n",
    "pier/pier/__init__.py": "",
    "pier/pier/tide.py": NODE.replace("NAME", "tide").replace("BODY", TIDE),
    "pier/pier/watch.py": NODE.replace("NAME", "watch").replace("BODY", WATCH),
    "pier/launch/tide.launch.xml": LAUNCH.replace("NAME", "tide").replace(
        "MORE", '<param from="$(find-pkg-share pier)/config/tide.yaml"/>'
    ),
    "pier/launch/watch.launch.xml": LAUNCH.replace("NAME", "watch").replace(
        "MORE", '<remap from="level" to="level"/>'
    ),
    "pier/config/tide.yaml": "/**:\n  ros__parameters:\n    out: level\n",
}
SYSTEMS = {"dock": SystemSetting(("tide.launch.xml", "watch.launch.xml side:=south"), {"side": "south"})}
YAML = {"pier/config/tide.yaml": FILES["pier/config/tide.yaml"].replace("out: level", "out: height")}
REMAP = {"pier/launch/watch.launch.xml": FILES["pier/launch/watch.launch.xml"].replace('to="level"', 'to="height"')}


@pytest.mark.parametrize(
    ("edits", "systems", "alone", "lost"),
    [
        (YAML, SYSTEMS, [("subscriber", "/south/level")], [("publisher renamed", "pier/config/tide.yaml")]),
        (REMAP, SYSTEMS, [("publisher", "/south/level")], [("subscriber renamed", "pier/launch/watch.launch.xml")]),
        # Two launch files that nothing says to be started together.
        (YAML, {}, [], []),
        # Both sides have the new name.
        ({**YAML, **REMAP}, SYSTEMS, [], []),
    ],
)
def test_edges_between_launch_files(tmp_path: Path, edits, systems, alone, lost):
    for folder, files in (("base", FILES), ("now", {**FILES, **edits})):
        write(tmp_path / folder, files)
    trees = [WorkingTree(tmp_path / folder) for folder in ("now", "base")]
    with Store(tmp_path / "cache") as store:
        now, base = (link_for_flow(tree, store, 1) for tree in trees)
        assert choose_systems(tmp_path / "now", systems, ((now, trees[0]), (base, trees[1]))) == []
        effects = compute_impact(now, base).effects
        found = list(lost_edge(now, base))
    assert [(each.role, each.name) for one in effects for each in one.alone] == alone
    assert [(one.kind, one.at.path) for one in found] == lost


def test_a_launch_file_that_is_not_there_is_noted(tmp_path: Path):
    write(tmp_path / "now", FILES)
    tree = WorkingTree(tmp_path / "now")
    systems = {"dock": SystemSetting(("lacking.launch.xml",), {})}
    with Store(tmp_path / "cache") as store:
        (note,) = choose_systems(tmp_path / "now", systems, ((link_for_flow(tree, store, 1), tree),))
    assert note.startswith("[systems.dock] lacking.launch.xml: no such file in the workspace")
