"""A parameter that a launch takes from the default of a launch argument: what it closes may still be opened."""

import pytest
from joining import graph_on_disk, manifest

NODE = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import Empty

    class Rig(Node):
        def __init__(self):
            super().__init__("rig")
            self.declare_parameter("debug", False)
            self.debug = self.get_parameter("debug").value
            if self.debug:
                self.create_subscription(Empty, "target", self.hear, 1)
            self.create_publisher(Empty, "found", 1)

        def hear(self, message):
            pass

    def main():
        rclpy.init()
        rclpy.spin(Rig())

    if __name__ == "__main__":
        main()
"""
LAUNCH = """
    from launch import LaunchDescription
    from launch.actions import DeclareLaunchArgument, OpaqueFunction
    from launch.substitutions import LaunchConfiguration
    from launch_ros.actions import Node

    def make(context):
        given = context.launch_configurations["debug"] == "true"
        return [Node(package="rig", executable="rig.py", parameters=[{"debug": GIVEN}])]

    def generate_launch_description():
        return LaunchDescription([
            DeclareLaunchArgument("debug", default_value="false"),
            OpaqueFunction(function=make),
        ])
"""


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ("LaunchConfiguration('debug')", {("/target", "this.debug"), ("/found", "")}),
        ("given", {("/target", "this.debug"), ("/found", "")}),
        ("False", {("/found", "")}),  # nobody who starts it changes that
        ("True", {("/target", ""), ("/found", "")}),
    ],
)
def test_a_branch_that_the_default_of_an_argument_closes(tmp_path, given, expected):
    files = {
        "rig/package.xml": manifest("rig", "ament_cmake"),
        "rig/CMakeLists.txt": """
            cmake_minimum_required(VERSION 3.8)
            project(rig)
            find_package(ament_cmake REQUIRED)
            install(PROGRAMS scripts/rig.py DESTINATION lib/rig)
            install(DIRECTORY launch DESTINATION share/rig)
            ament_package()
        """,
        "rig/scripts/rig.py": NODE,
        "rig/launch/rig.launch.py": LAUNCH.replace("GIVEN", given),
    }
    found = graph_on_disk(tmp_path, files, "rig/launch/rig.launch.py")
    assert {(one.topic, one.only_if) for one in found.endpoints if not one.implied} == expected
