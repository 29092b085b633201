"""Parameters, files and arguments that a launch gives and that nobody knows: what hangs on them does so, and a command
that starts a node is a start like any other."""

import pytest
from joining import graph_on_disk, manifest

FILES = {
    "rig/package.xml": manifest("rig", "ament_cmake"),
    "rig/CMakeLists.txt": """
        cmake_minimum_required(VERSION 3.8)
        project(rig)
        find_package(ament_cmake REQUIRED)
        install(PROGRAMS rig.py DESTINATION lib/${PROJECT_NAME})
        install(DIRECTORY launch config DESTINATION share/${PROJECT_NAME})
        ament_package()
    """,
    "rig/rig.py": """
        import rclpy
        from rclpy.node import Node
        from std_msgs.msg import Empty

        class Rig(Node):
            def __init__(self):
                super().__init__("rig")
                self.declare_parameter("debug", False)
                if self.get_parameter("debug").value:
                    self.create_publisher(Empty, "traces", 1)
                else:
                    self.create_publisher(Empty, "counts", 1)
                self.create_publisher(Empty, "state", 1)

        def main():
            rclpy.init()
            rclpy.spin(Rig())

        if __name__ == "__main__":
            main()
    """,
    "rig/config/slow.yaml": "rig: {ros__parameters: {debug: false}}",
}
LAUNCH = """
    import os
    from ament_index_python.packages import get_package_share_directory
    from launch import LaunchDescription
    from launch.actions import DeclareLaunchArgument, ExecuteProcess
    from launch.substitutions import IfElseSubstitution, LaunchConfiguration, PythonExpression
    from launch_ros.actions import Node

    SHARE = get_package_share_directory("rig")
    FAST = bool(os.environ.get("FAST"))

    def rig(**given):
        return Node(package="rig", executable="rig.py", **given)

    def generate_launch_description():
        return LaunchDescription([DeclareLaunchArgument("one"), STARTED])
"""
KNOWN = {("/counts", ""), ("/state", "")}


def launch(tmp_path, started):
    files = {**FILES, "rig/launch/rig.launch.py": LAUNCH.replace("STARTED", started)}
    found = graph_on_disk(tmp_path, files, "rig/launch/rig.launch.py")
    return {(one.topic, one.only_if) for one in found.endpoints if one.role == "publisher" and not one.implied}


@pytest.mark.parametrize(
    "given",
    [
        'parameters=[{"debug": LaunchConfiguration("one")}]',
        'parameters=[{"debug": FAST}]',
        'parameters=[{"debug": True if FAST else False}]',
        'parameters=[{"debug": PythonExpression(["\'", LaunchConfiguration("one"), "\' == \'a\'"])}]',
        'parameters=[{"debug": IfElseSubstitution(LaunchConfiguration("one"), "true", "false")}]',
        'parameters=[LaunchConfiguration("one")]',
        'parameters=[os.path.join(SHARE, "config", os.environ["ROBOT"] + ".yaml")]',
        'arguments=["--ros-args", "-p", ["debug:=", LaunchConfiguration("one")]]',
        'arguments=["--ros-args", "-p", "debug:=true" if FAST else "debug:=false"]',
        'arguments=["--ros-args", "--params-file", LaunchConfiguration("one")]',
    ],
)
def test_both_branches_depend_on_what_a_launch_gives_that_is_not_known(tmp_path, given):
    assert {topic for topic, only_if in launch(tmp_path, f"rig({given})") if only_if} == {"/traces", "/counts"}


@pytest.mark.parametrize(
    "given",
    [
        'parameters=[{"debug": False}]',
        'parameters=[os.path.join(SHARE, "config", "slow.yaml")]',
        'parameters=[LaunchConfiguration("one"), {"debug": False}]',
        'arguments=["--ros-args", "-p", "debug:=false"]',
    ],
)
def test_a_branch_that_is_known_depends_on_nothing(tmp_path, given):
    assert launch(tmp_path, f"rig({given})") == KNOWN


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ('["state:=", LaunchConfiguration("one")]', "/<one>"),
        ('"state:=a" if FAST else "state:=b"', "/<a_or_b>"),
        ('"rig:state:=a"', "/a"),
        ('"other:state:=a"', "/state"),
        ('"rig:__ns:=/up"', "/up/state"),
        ('"other:__ns:=/up"', "/state"),
        ('"__ns:=/up"', "/up/state"),
    ],
)
def test_rules_for_names_of_one_node_and_of_all(tmp_path, given, expected):
    assert expected in {topic for topic, _ in launch(tmp_path, f'rig(arguments=["--ros-args", "-r", {given}])')}


@pytest.mark.parametrize(
    "command",
    [
        '["ros2", "run", "rig", "rig.py", "--ros-args", "-r", "state:=health"]',
        '["ros2 run rig rig.py --ros-args -r state:=health"], shell=True',
        '["ros2 run rig rig.py ", "--ros-args -r state:=health"], shell=True',
    ],
)
def test_a_command_that_starts_a_node(tmp_path, command):
    started = launch(tmp_path, f"ExecuteProcess(cmd={command})")
    assert {topic for topic, only_if in started if not only_if} == {"/counts", "/health"}


def test_a_command_of_something_else_is_named(tmp_path):
    started = LAUNCH.replace("STARTED", 'ExecuteProcess(cmd=["ros2", "run", "a", "b"])')
    files = {**FILES, "rig/launch/rig.launch.py": started}
    found = graph_on_disk(tmp_path, files, "rig/launch/rig.launch.py")
    assert [one.what for one in found.coverage.unresolved] == ["started command"]


FILES_OF_ROS1 = {
    "cart/package.xml": manifest("cart", "catkin"),
    "cart/CMakeLists.txt": """
        cmake_minimum_required(VERSION 3.0.2)
        project(cart)
        find_package(catkin REQUIRED COMPONENTS roscpp std_msgs)
        catkin_package()
        add_executable(cart cart.cpp)
    """,
    "cart/config/slow.yaml": "debug: false",
    "cart/cart.cpp": """
        #include <ros/ros.h>
        #include <std_msgs/Empty.h>

        int main(int argc, char** argv) {
          ros::init(argc, argv, "cart");
          ros::NodeHandle handle, own("~");
          bool debug;
          own.param("debug", debug, false);
          ros::Publisher branch;
          if (debug)
            branch = handle.advertise<std_msgs::Empty>("traces", 1);
          else
            branch = handle.advertise<std_msgs::Empty>("counts", 1);
          ros::Publisher state = handle.advertise<std_msgs::Empty>("state", 1);
          ros::spin();
        }
    """,
}


@pytest.mark.parametrize(
    ("around", "inside", "depends"),
    [
        ("", '<param name="debug" value="$(arg one)"/>', True),
        ("", '<param name="debug" value="$(env FAST)"/>', True),
        ("", '<param name="debug" value="true" if="$(arg one)"/>', True),
        ("", '<rosparam command="load" file="$(arg one)"/>', True),
        ('<rosparam command="load" file="$(find cart)/config/$(arg one).yaml"/>', "", True),
        ('<rosparam command="load" ns="cart" file="$(arg one)"/>', "", True),
        ('<rosparam command="load" ns="other" file="$(arg one)"/>', "", False),
        ("", '<rosparam command="load" file="$(find cart)/config/slow.yaml"/>', False),
        ("", '<param name="debug" value="false"/>', False),
    ],
)
def test_the_same_of_ros1(tmp_path, around, inside, depends):
    started = f'<launch><arg name="one"/>{around}<node pkg="cart" type="cart" name="cart">{inside}</node></launch>'
    found = graph_on_disk(tmp_path, {**FILES_OF_ROS1, "cart/launch/cart.launch": started}, "cart/launch/cart.launch")
    conditions = {one.topic: one.only_if for one in found.endpoints if one.role == "publisher" and not one.implied}
    assert (bool(conditions["/counts"]), conditions["/state"]) == (depends, "")


@pytest.mark.parametrize(
    ("arguments", "expected"), [("state:=$(env NAME)", "/<$NAME>"), ("state:=a", "/a"), ("$(env MORE)", "/state")]
)
def test_arguments_that_rename_in_ros1(tmp_path, arguments, expected):
    started = f'<launch><node pkg="cart" type="cart" name="cart" args="{arguments}"/></launch>'
    found = graph_on_disk(tmp_path, {**FILES_OF_ROS1, "cart/launch/cart.launch": started}, "cart/launch/cart.launch")
    assert expected in {one.topic for one in found.endpoints}
