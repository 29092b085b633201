"""What a launch file does under conditions: names that are sure, and names that are not."""

from textwrap import dedent

import pytest
from joining import graph, graph_on_disk, manifest

TALKER = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import String

    class Talker(Node):
        def __init__(self):
            super().__init__('talker')
            self.declare_parameter('topic', 'chat')
            self.first = self.create_publisher(String, 'scan', 1)
            self.second = self.create_publisher(String, self.get_parameter('topic').value, 1)

    def main():
        rclpy.init()
        rclpy.spin(Talker())
"""
SETUP = """
    from setuptools import setup
    setup(name='talk', packages=['talk'], entry_points={'console_scripts': ['talker = talk.talker:main']})
"""
HEAD = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, GroupAction, IncludeLaunchDescription
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import EnvironmentVariable, LaunchConfiguration, ThisLaunchFileDir
from launch_ros.actions import Node, PushRosNamespace, SetParameter, SetRemap
MAYBE = IfCondition(EnvironmentVariable('MAYBE'))
NEVER = IfCondition('false')
TALKER = Node(package='talk', executable='talker', name='t')
def generate_launch_description():
"""


def start(tmp_path, body: str, launch: str = "talk/launch/a.launch.py", **more: str):
    """The graph of a package with one talker and of launch files in Python, by their names without ending."""
    texts = {"a": body, **more}
    files = {
        f"talk/launch/{name}.launch.py": HEAD + f"    return LaunchDescription([{dedent(text).strip()}])\n"
        for name, text in texts.items()
    }
    return graph_on_disk(
        tmp_path,
        {"talk/package.xml": manifest("talk", "ament_python"), "talk/setup.py": SETUP, "talk/talk/__init__.py": "",
         "talk/talk/talker.py": TALKER, **files},
        launch,
    )  # fmt: skip


def published(found):
    return {(one.topic, one.how) for one in found.endpoints if one.role == "publisher" and not one.implied}


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("TALKER", {("/scan", "literal"), ("/chat", "default")}),
        # a remapping
        ("SetRemap('scan', 'lidar'), TALKER", {("/lidar", "launch"), ("/chat", "default")}),
        ("GroupAction([SetRemap('scan', 'lidar')], condition=MAYBE), TALKER",
         {("/scan", "literal"), ("/chat", "default")}),
        ("SetRemap('scan', 'lidar', condition=MAYBE), TALKER", {("/<scan_or_lidar>", "partly"), ("/chat", "default")}),
        ("SetRemap('scan', 'scan', condition=MAYBE), TALKER", {("/scan", "literal"), ("/chat", "default")}),
        ("GroupAction([SetRemap('scan', 'lidar'), TALKER], condition=MAYBE)",
         {("/lidar", "launch"), ("/chat", "default")}),
        ("SetRemap('scan', 'lidar', condition=MAYBE), Node(package='talk', executable='talker', condition=MAYBE)",
         {("/lidar", "launch"), ("/chat", "default")}),
        # a parameter
        ("SetParameter('topic', 'news'), TALKER", {("/scan", "literal"), ("/news", "launch")}),
        ("SetParameter('topic', 'news', condition=MAYBE), TALKER",
         {("/scan", "literal"), ("/<news_or_not_given>", "partly")}),
        ("SetParameter('topic', 'old'), SetParameter('topic', 'news', condition=MAYBE), TALKER",
         {("/scan", "literal"), ("/<old_or_news>", "partly")}),
        ("SetParameter('topic', 'news'), SetParameter('topic', 'news', condition=MAYBE), TALKER",
         {("/scan", "literal"), ("/news", "launch")}),
        ("GroupAction([SetParameter('topic', 'news'), TALKER], condition=MAYBE)",
         {("/scan", "literal"), ("/news", "launch")}),
        # a namespace
        ("GroupAction([PushRosNamespace('r'), TALKER], condition=MAYBE)",
         {("/r/scan", "literal"), ("/r/chat", "default")}),
        ("PushRosNamespace('r', condition=MAYBE), TALKER",
         {("/<__or__r>/scan", "partly"), ("/<__or__r>/chat", "partly")}),
        ("PushRosNamespace('r', condition=NEVER), TALKER", {("/scan", "literal"), ("/chat", "default")}),
        ("GroupAction([PushRosNamespace('r')], condition=MAYBE, scoped=False), TALKER",
         {("/<__or__r>/scan", "partly"), ("/<__or__r>/chat", "partly")}),
        ("GroupAction([PushRosNamespace('r'), SetRemap('scan', 'lidar'), TALKER], condition=MAYBE, scoped=False)",
         {("/r/lidar", "launch"), ("/r/chat", "default")}),
        ("GroupAction([SetRemap('scan', 'lidar'), SetParameter('topic', 'news')], scoped=False, condition=MAYBE), "
         "TALKER",
         {("/<scan_or_lidar>", "partly"), ("/<news_or_not_given>", "partly")}),
    ],
)  # fmt: skip
def test_what_is_given_under_a_condition_is_not_sure(tmp_path, body, expected):
    assert published(start(tmp_path, body)) == expected


INCLUDED = "IncludeLaunchDescription([ThisLaunchFileDir(), '/b.launch.py'], condition=MAYBE)"


def test_what_an_included_file_sets_is_sure_for_what_it_starts_itself(tmp_path):
    inner = "DeclareLaunchArgument('ns', default_value='r'), PushRosNamespace(LaunchConfiguration('ns')), TALKER"
    found = start(tmp_path, INCLUDED, b=inner)
    assert published(found) == {("/r/scan", "literal"), ("/r/chat", "default")}
    assert [node.uncertain for node in found.nodes] == [("$(env MAYBE)",)]


def test_what_an_included_file_sets_is_not_sure_for_what_follows(tmp_path):
    inner = "DeclareLaunchArgument('ns', default_value='r'), SetRemap('scan', LaunchConfiguration('ns'))"
    after = "Node(package='talk', executable='talker', name=LaunchConfiguration('ns'))"
    found = start(tmp_path, f"{INCLUDED}, {after}", b=inner)
    assert published(found) == {("/<scan_or_r>", "partly"), ("/chat", "default")}
    assert [node.name for node in found.nodes] == ["/<r>"]


def test_a_program_behind_a_condition_that_does_not_hold_has_the_names_of_its_start(tmp_path):
    body = "GroupAction([PushRosNamespace('r'), SetRemap('scan', 'lidar'), TALKER], condition=NEVER)"
    found = start(tmp_path, body, launch="")
    assert published(found) == {("/r/lidar", "launch"), ("/r/chat", "default")}
    assert [(node.name, node.uncertain, node.launches) for node in found.nodes] == [
        ("/r/t", ("false",), ("talk/launch/a.launch.py",))
    ]
    assert start(tmp_path, body).nodes == ()


def test_a_program_that_some_launch_file_starts_has_no_names_of_conditions_that_do_not_hold(tmp_path):
    hidden = "GroupAction([PushRosNamespace('r'), TALKER], condition=NEVER)"
    found = start(tmp_path, hidden, launch="", b="TALKER")
    assert [(node.name, node.uncertain) for node in found.nodes] == [("/t", ())]


NODE = """
    import sys
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import String

    class Robot(Node):
        def __init__(self, number):
            super().__init__({})
            self.tasks = self.create_publisher(String, 'tasks', 1)
            self.own = self.create_publisher(String, '~/own', 1)

    def main():
        rclpy.init()
        rclpy.spin(Robot(sys.argv[1]))

    main()
"""


@pytest.mark.parametrize(
    ("written", "name"),
    [("'robot'", "/robot"), ("f'robot_{number}'", "/robot_<number>"), ("number", "/<number>"),
     ("'robot_' + str(number)", "/robot_<str(number)>"), ("f'{number}_robot'", "/<number>_robot")],
)  # fmt: skip
def test_a_node_whose_name_is_computed_is_not_called_like_its_program(written, name):
    found = graph({"p/robot.py": NODE.format(written)})
    assert [node.name for node in found.nodes] == [name]
    assert published(found) == {
        ("/tasks", "literal"), (f"{name}/own", "partly" if "<" in name else "literal")
    }  # fmt: skip


def test_a_node_that_a_foreign_class_names_is_not_called_like_its_program():
    text = """
        #include <far/far.hpp>
        int main(int argc, char** argv) {
          rclcpp::init(argc, argv);
          auto node = std::make_shared<far::Node>();
          auto pub = rclcpp::create_publisher<std_msgs::msg::String>(node, "tasks", 1);
        }
    """
    assert [node.name for node in graph({"p/robot.cpp": text}).nodes] == ["/<robot>"]


@pytest.mark.parametrize("name", ["f'{1}_{EnvironmentVariable(\"A\").perform(None)}'", "'t_' + far()", "far()"])
def test_a_start_whose_name_is_computed_is_not_called_like_its_program(tmp_path, name):
    found = start(tmp_path, f"Node(package='talk', executable='talker', name={name})")
    (node,) = found.nodes
    assert node.uncertain and "<" in node.name


@pytest.mark.parametrize(
    ("inner", "name"),
    [("r", "/r"), ("s", "/<s_or_r>")],
)
def test_an_argument_that_an_included_file_may_have_declared(tmp_path, inner, name):
    """Either the included file declares it, or this one does."""
    after = "DeclareLaunchArgument('ns', default_value='r'), Node(package='talk', executable='talker', "
    after += "name=LaunchConfiguration('ns'))"
    found = start(tmp_path, f"{INCLUDED}, {after}", b=f"DeclareLaunchArgument('ns', default_value='{inner}')")
    assert [node.name for node in found.nodes] == [name]


def test_an_argument_that_is_passed_is_sure_whoever_may_have_declared_it(tmp_path):
    passed = "IncludeLaunchDescription([ThisLaunchFileDir(), '/c.launch.py'], launch_arguments={'ns': 'q'}.items())"
    declared = "DeclareLaunchArgument('ns', default_value='{}')"
    started = "Node(package='talk', executable='talker', name=LaunchConfiguration('ns'))"
    found = start(
        tmp_path, f"{INCLUDED}, {passed}", b=declared.format("r"), c=f"{declared.format('s')}, {started}"
    )
    assert [node.name for node in found.nodes] == ["/q"]


def test_one_of_several_starts_that_may_be_under_one_name(tmp_path):
    """What several launch files may start alike is told once, at the first of them."""
    hidden = "GroupAction([PushRosNamespace('r'), TALKER], condition=NEVER)"
    other = "GroupAction([PushRosNamespace('s'), TALKER], condition=NEVER)"
    found = start(tmp_path, hidden, launch="", b=hidden, c=other)
    assert [(node.name, node.launches) for node in found.nodes] == [
        ("/r/t", ("talk/launch/a.launch.py",)), ("/s/t", ("talk/launch/c.launch.py",)),
    ]  # fmt: skip
