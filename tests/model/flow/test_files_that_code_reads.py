"""YAML files of the workspace that programs read by themselves."""

import pytest
from joining import graph_on_disk, manifest

CODE = """
    import os
    import sys
    from pathlib import Path

    import rclpy
    import rospkg
    import yaml
    from ament_index_python.packages import get_package_share_directory
    from rclpy.node import Node
    from std_msgs.msg import Empty

    class Rig(Node):
        def __init__(self):
            super().__init__("rig")
            LOAD
            MAKE

    def main():
        rclpy.init()
        rclpy.spin(Rig())
"""
TEXT = """
    topics: {odom: /base/odom, lists: [/a, b]}
    arms:
      left: {topic: left/joints, rate: 10}
      right: {topic: right/joints, rate: 20}
    cameras:
      - {name: front, number: 1}
      - {name: rear, number: 2}
"""
SHARE = 'path = os.path.join(get_package_share_directory("rig"), "config", "rig.yaml")\n            '
OPEN = "with open(path) as f:\n                c = yaml.safe_load(f)"
ODOM = 'self.create_publisher(Empty, c["topics"]["odom"], 1)'


def list_topics(tmp_path, load=SHARE + OPEN, make=ODOM, text=TEXT, launch=""):
    files = {
        "rig/package.xml": manifest("rig", "ament_python"),
        "rig/setup.py": """
            from setuptools import setup
            setup(name="rig", packages=["rig"], data_files=[("share/rig/config", ["config/rig.yaml"])],
                  entry_points={"console_scripts": ["rig = rig.rig:main"]})
        """,
        "rig/rig/__init__.py": "",
        "rig/rig/rig.py": CODE.replace("LOAD", load).replace("MAKE", make),
        "rig/rig/rig.yaml": text,
        "rig/config/rig.yaml": text,
    }
    if launch:
        files["rig/launch/rig.launch.xml"] = launch
    found = graph_on_disk(tmp_path, files, "rig/launch/rig.launch.xml" if launch else "")
    return {(one.topic, one.how) for one in found.endpoints if one.role == "publisher" and not one.implied}


@pytest.mark.parametrize("load", [
    SHARE + OPEN,
    SHARE + OPEN + " or {}",
    SHARE + "c = yaml.load(open(path), Loader=yaml.SafeLoader)",
    'path = Path(get_package_share_directory("rig")) / "config" / "rig.yaml"\n            ' + OPEN,
    'path = get_package_share_directory("rig") + "/config/rig.yaml"\n            ' + OPEN,
    'path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "rig.yaml")\n            ' + OPEN,
    'path = os.path.join(os.path.dirname(__file__), "..", "config", "rig.yaml")\n            ' + OPEN,
    'path = Path(__file__).resolve().parent / "rig.yaml"\n            c = yaml.safe_load(path.read_text())',
    'path = Path(__file__).parents[1] / "config/rig.yaml"\n            c = yaml.safe_load(path.read_text())',
    'c = yaml.safe_load(open(rospkg.RosPack().get_path("rig") + "/config/rig.yaml"))',
])  # fmt: skip
def test_where_the_file_is(tmp_path, load):
    assert list_topics(tmp_path, load) == {("/base/odom", "literal")}


@pytest.mark.parametrize(("make", "expected"), [
    (ODOM, {"/base/odom"}),
    ('self.create_publisher(Empty, c["arms"]["left"]["topic"], 1)', {"/left/joints"}),
    ('for name in c["topics"]["lists"]: self.create_publisher(Empty, name, 1)', {"/a", "/b"}),
    ('for arm in c["arms"].values(): self.create_publisher(Empty, arm["topic"], 1)', {"/left/joints", "/right/joints"}),
    ('for name, arm in c["arms"].items(): self.create_publisher(Empty, name, 1)', {"/left", "/right"}),
    ('self.create_publisher(Empty, c["topics"].get("odom"), 1)', {"/base/odom"}),
    ('self.create_publisher(Empty, c.get("topics", {}).get("odom", "other"), 1)', {"/base/odom"}),
    ('for name in c["arms"].keys(): self.create_publisher(Empty, name, 1)', {"/left", "/right"}),
    ('for one in c["cameras"]: self.create_publisher(Empty, f"{one[\'name\']}_{one[\'number\']}", 1)',
     {"/front_1", "/rear_2"}),
])  # fmt: skip
def test_what_is_in_it(tmp_path, make, expected):
    assert list_topics(tmp_path, make=make) == {(name, "literal") for name in expected}


@pytest.mark.parametrize(("load", "text"), [
    ("path = sys.argv[1]\n            " + OPEN, TEXT),
    ('path = os.path.join(get_package_share_directory("other"), "config", "rig.yaml")\n            ' + OPEN, TEXT),
    ('path = os.path.join(get_package_share_directory("rig"), "config", "none.yaml")\n            ' + OPEN, TEXT),
    (SHARE + OPEN, "topics: [odom"),
    (SHARE + OPEN, "arms: {}"),
    (SHARE + "path = sys.argv[1] if len(sys.argv) > 1 else path\n            " + OPEN, TEXT),
])  # fmt: skip
def test_a_file_that_is_not_known_names_nothing(tmp_path, load, text):
    assert not {name for name, how in list_topics(tmp_path, load, text=text) if how == "literal"}


BY_PARAMETER = SHARE + 'path = self.declare_parameter("file", path).value\n            ' + OPEN


def test_a_file_that_a_parameter_names_by_default(tmp_path):
    assert list_topics(tmp_path, BY_PARAMETER) == {("/base/odom", "default")}


def test_a_file_that_a_launch_names(tmp_path):
    launch = """
        <launch><node pkg="rig" exec="rig">
          <param name="file" value="$(find-pkg-share rig)/config/rig.yaml"/>
        </node></launch>
    """
    assert list_topics(tmp_path, BY_PARAMETER, launch=launch) == {("/base/odom", "launch")}


def test_a_change_of_the_file_is_seen(tmp_path):
    assert list_topics(tmp_path) == {("/base/odom", "literal")}
    assert list_topics(tmp_path, text=TEXT.replace("/base/odom", "/base/pose")) == {("/base/pose", "literal")}
