"""Under a condition that is the truth of a parameter, `bool(...)` around what it is read by changes nothing."""

from pathlib import Path

import pytest
from joining import graph_on_disk, manifest

SWITCH = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import Empty


    class Switch(Node):
        def __init__(self):
            super().__init__("switch")
            self.declare_parameter("go", False)
            READ
            if self.go:
                self.create_publisher(Empty, "on", 1)
            else:
                self.create_publisher(Empty, "off", 1)


    def main():
        rclpy.init()
        rclpy.spin(Switch())


    if __name__ == "__main__":
        main()
"""
LAUNCH = """
    from launch import LaunchDescription
    from launch_ros.actions import Node

    def generate_launch_description():
        return LaunchDescription([Node(package="p", executable="switch.py", name="switch", parameters=[{"go": GO}])])
"""
CMAKE = """
    cmake_minimum_required(VERSION 3.8)
    project(p)
    find_package(ament_cmake REQUIRED)
    install(PROGRAMS switch.py DESTINATION lib/p)
    install(DIRECTORY launch DESTINATION share/p)
    ament_package()
"""


def list_topics(root: Path, read: str, go: str = "") -> dict[str, str]:
    """Topic to only_if; go: what a launch file sets the parameter to, if one does."""
    launch = "p/launch/p.launch.py" if go else ""
    files = {"p/package.xml": manifest("p", "ament_cmake"), "p/CMakeLists.txt": CMAKE}
    files["p/switch.py"] = SWITCH.replace("READ", read)
    if launch:
        files[launch] = LAUNCH.replace("GO", go)
    found = graph_on_disk(root, files, launch)
    return {e.topic: e.only_if for e in found.endpoints if e.role == "publisher" and not e.implied}


READS = (
    'self.go = self.get_parameter("go").value',
    'self.go = bool(self.get_parameter("go").value)',
    'get = self.get_parameter; self.go = bool(get("go").value)',
)


@pytest.mark.parametrize("read", READS)
def test_what_a_default_closes_is_there_only_under_its_condition(tmp_path: Path, read: str):
    found = list_topics(tmp_path, read)
    assert found["/on"] != ""
    assert found["/off"] == ""


@pytest.mark.parametrize("read", READS)
def test_what_a_launch_sets_closes_the_other_branch(tmp_path: Path, read: str):
    assert list_topics(tmp_path / "open", read, "True") == {"/on": ""}
    assert list_topics(tmp_path / "closed", read, "False") == {"/off": ""}
