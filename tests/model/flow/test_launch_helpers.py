"""Launch files in Python that call functions of other modules of the workspace."""

import pytest
from joining import graph_on_disk, manifest, write
from rosimpact.impact.analysis.session import open_tree
from rosimpact.impact.facts.launch.python import extract
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.flow.launch_changes import compare_launches
from rosimpact.impact.model.flow.workspace import link_for_flow

TALKER = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import String

    class Talker(Node):
        def __init__(self):
            super().__init__('talker')
            self.first = self.create_publisher(String, 'scan', 1)

    def main():
        rclpy.init()
        rclpy.spin(Talker())
"""
HELPER = """
    from launch.actions import DeclareLaunchArgument, GroupAction
    from launch.substitutions import LaunchConfiguration
    from launch_ros.actions import Node, PushRosNamespace
    from .constants import PROGRAM
    from . import constants as all_constants

    SIDES = ['left', 'right']

    def make_node(name, topic=all_constants.TOPIC, **more):
        return Node(package='talk', executable=PROGRAM, name=name, remappings=[('scan', topic)], **more)

    def make_nodes(names, namespace):
        nodes = []
        for name in names:
            nodes.append(make_node(f'{name}_talker', topic=f'/{name}/scan', namespace=namespace))
        return nodes

    def make_group(context, ns):
        return [GroupAction([PushRosNamespace(ns), *[make_node(side) for side in SIDES]])]

    class Stack:
        def __init__(self, name):
            self.name = name

        def start(self):
            return [DeclareLaunchArgument('topic', default_value='news'),
                    make_node(self.name, LaunchConfiguration('topic'))]
"""
BESIDE = "from launch_ros.actions import Node\n\nTALKER = Node(package='talk', executable='talker')\n"
FILES = {
    "talk/package.xml": manifest("talk", "ament_python"),
    "talk/setup.py": """
        from setuptools import setup
        setup(name='talk', packages=['talk'], entry_points={'console_scripts': ['talker = talk.talker:main']})
    """,
    "talk/talk/__init__.py": "",
    "talk/talk/talker.py": TALKER,
    "talk/talk/helping.py": HELPER,
    "talk/talk/constants.py": "PROGRAM = 'talker'\nTOPIC = 'cloud'\n",
    "talk/launch/beside.py": BESIDE,
    "robot/package.xml": manifest("robot", "ament_cmake"),
    "robot/CMakeLists.txt": "cmake_minimum_required(VERSION 3.16)\nproject(robot)\n",
    "robot/launch/beside.py": BESIDE.replace("package=", "name='wrong', package="),
}  # fmt: skip


def make_launch(imported: str, returned: str) -> str:
    return (
        f"from launch import LaunchDescription\nfrom launch.actions import OpaqueFunction\n{imported}\n"
        f"def generate_launch_description():\n    return LaunchDescription({returned})\n"
    )


def published(found):
    rows = ((one.node, one.topic) for one in found.endpoints if one.role == "publisher" and not one.implied)
    return sorted(rows)


@pytest.mark.parametrize(
    ("imported", "returned", "expected"),
    [
        ("from talk.helping import make_node", "[make_node('a')]", [("/a", "/cloud")]),
        ("from talk.helping import make_node as made", "[made('a', namespace='n')]", [("/n/a", "/n/cloud")]),
        ("import talk.helping", "[talk.helping.make_node('a')]", [("/a", "/cloud")]),
        ("import talk.helping as h", "[h.make_node('a')]", [("/a", "/cloud")]),
        ("from talk import helping", "[helping.make_node('a')]", [("/a", "/cloud")]),
        ("from talk.helping import *", "[make_node('a')]", [("/a", "/cloud")]),
        ("from talk.helping import make_nodes", "make_nodes(['a', 'b'], 'n')",
         [("/n/a_talker", "/a/scan"), ("/n/b_talker", "/b/scan")]),
        ("from talk.helping import SIDES, make_node", "[make_node(s) for s in SIDES]",
         [("/left", "/cloud"), ("/right", "/cloud")]),
        ("from talk.helping import make_group", "[OpaqueFunction(function=make_group, args=['g'])]",
         [("/g/left", "/g/cloud"), ("/g/right", "/g/cloud")]),
        ("from talk.helping import Stack", "Stack('s').start()", [("/s", "/news")]),
        ("from beside import TALKER", "[TALKER]", [("/talker", "/scan")]),
        # what is not there, or is not imported
        ("from talk.helping import absent", "[absent('a')]", []),
        ("from elsewhere.helping import make_node", "[make_node('a')]", []),
        ("", "[make_node('a')]", []),
    ],
)  # fmt: skip
def test_functions_of_other_modules_are_followed(tmp_path, imported, returned, expected):
    files = {**FILES, "talk/launch/a.launch.py": make_launch(imported, returned)}
    assert published(graph_on_disk(tmp_path, files, "talk/launch/a.launch.py")) == expected


def test_another_package_has_modules_of_packages_alone(tmp_path):
    """`beside` is found by the program beside it; who else would find it is not known."""
    files = {
        **FILES,
        "robot/launch/a.launch.py": make_launch("from talk.helping import make_node", "[make_node('a')]"),
        "robot/launch/b.launch.py": make_launch("from talking import TALKER", "[TALKER]"),
        "talk/launch/talking.py": BESIDE,
    }
    assert published(graph_on_disk(tmp_path, files, "robot/launch/a.launch.py")) == [("/a", "/cloud")]
    assert published(graph_on_disk(tmp_path, files, "robot/launch/b.launch.py")) == []


def test_a_module_that_two_packages_have_is_not_followed(tmp_path):
    files = {
        **FILES,
        "twin/package.xml": manifest("twin", "ament_python"),
        "twin/talk/__init__.py": "",
        "twin/talk/helping.py": HELPER,
        "robot/launch/a.launch.py": make_launch("from talk.helping import make_node", "[make_node('a')]"),
    }
    assert published(graph_on_disk(tmp_path, files, "robot/launch/a.launch.py")) == []


def test_what_a_helper_starts_is_told_at_the_line_that_calls_it(tmp_path):
    launch = make_launch("from talk.helping import make_nodes", "make_nodes(['a'], '')")
    files = {**FILES, "talk/launch/a.launch.py": launch}
    (node,) = graph_on_disk(tmp_path, files, "talk/launch/a.launch.py").nodes
    assert node.started == "talk/launch/a.launch.py:5"


def test_a_condition_in_a_helper_holds_for_what_it_starts(tmp_path):
    helper = """
        from launch.conditions import IfCondition
        from launch.substitutions import EnvironmentVariable
        from launch_ros.actions import Node

        def make(context):
            if EnvironmentVariable('SIM').perform(context) == 'true':
                return [Node(package='talk', executable='talker', name='sim')]
            return [Node(package='talk', executable='talker', name='real')]
    """
    launch = make_launch("from talk.choosing import make", "[OpaqueFunction(function=make)]")
    files = {**FILES, "talk/talk/choosing.py": helper, "talk/launch/a.launch.py": launch}
    found = graph_on_disk(tmp_path, files, "talk/launch/a.launch.py")
    assert {node.name: bool(node.uncertain) for node in found.nodes} == {"/sim": True, "/real": True}


@pytest.mark.parametrize(
    "helper",
    [
        "def make(): return make()",
        "from talk.helping import make\n",
        "from talk import b\nfrom talk.b import make\n",
        "import talk.helping\nmake = talk.helping.make\n",
        "def make(:\n",
    ],
)
def test_helpers_that_lead_nowhere(helper):
    launch = make_launch("from talk.helping import make", "[make()]").encode()
    helpers = {"talk.helping": (helper.encode(), "talk"), "talk.b": (b"from .helping import *\n", "talk")}
    found = extract(launch, helpers)
    assert [action.kind for action in found.actions] == ["unknown"]


def test_what_a_launch_file_imports_is_told():
    imported = "import os\nfrom launch_ros.actions import Node\nfrom talk.helping import make\nimport far.away"
    launch = make_launch(imported, "[]")
    assert extract(launch.encode()).imports == ("talk.helping.make", "far.away", "far")


def test_a_change_of_a_helper_changes_what_the_launch_file_starts(tmp_path):
    launch = make_launch("from talk.helping import make_node", "[make_node('a')]")
    files = {**FILES, "talk/launch/a.launch.py": launch}
    write(tmp_path / "old", files)
    write(tmp_path / "new", {**files, "talk/talk/constants.py": "PROGRAM = 'talker'\nTOPIC = 'points'\n"})
    with Store(tmp_path / ".cache") as store:
        old, new = (link_for_flow(open_tree(tmp_path / side, ""), store) for side in ("old", "new"))
        changes = compare_launches(new, old)
    (launch_change,) = changes.launches
    (node,) = launch_change.nodes
    assert [(one.name, one.old, one.new) for one in node.differences] == [("scan", "cloud", "points")]
