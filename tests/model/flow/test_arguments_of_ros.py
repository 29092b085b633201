"""What ROS adds to the command line of a program that a launch file starts."""

import pytest
from joining import graph_on_disk, manifest


def name_started(tmp_path, files, launch):
    """The names of publishers of what a launch file starts, `?` for those that are not known, with how they are."""
    found = graph_on_disk(tmp_path, files, launch)
    return {(one.topic or "?", one.how) for one in found.endpoints if one.role == "publisher" and not one.implied}


ROSPY = """
    #!/usr/bin/env python3
    import sys
    import rospy
    from std_msgs.msg import Empty
    if __name__ == "__main__":
        argv = {argv}
        {body}
        rospy.init_node("plant")
        rospy.Publisher("drone" + number + "/go", Empty, queue_size=1)
"""
CHOSEN = "number = '0' if len(argv) <= 1 else str(argv[1])"


# roslaunch gives `__name:=plant` and `__log:=` behind the arguments, which rospy.myargv() leaves out.
@pytest.mark.parametrize(("argv", "body", "arguments", "expected"), [
    ("sys.argv", CHOSEN, "", {("/drone0/go", "partly"), ("/drone<number>/go", "partly")}),
    ("sys.argv", "number = sys.argv[1]", "", {("/drone<number>/go", "partly")}),
    ("sys.argv[1:]", "number = argv[0]", "", {("/drone<number>/go", "partly")}),
    ("sys.argv", "number = sys.argv[1]", "4", {("/drone4/go", "given")}),
    ("sys.argv[1:]", "number = argv[0]", "4 5", {("/drone4/go", "given")}),
    ("rospy.myargv()", CHOSEN, "", {("/drone0/go", "literal")}),
    ("rospy.myargv()", CHOSEN, "4", {("/drone4/go", "given"), ("/drone0/go", "literal")}),
])  # fmt: skip
def test_what_stands_behind_the_arguments_in_rospy_is_no_name(tmp_path, argv, body, arguments, expected):
    files = {
        "p/package.xml": manifest("p", "catkin"),
        "p/CMakeLists.txt": "project(p)\ncatkin_package()\ncatkin_install_python(PROGRAMS scripts/plant.py)\n",
        "p/scripts/plant.py": ROSPY.format(argv=argv, body=body),
        "p/a.launch": f'<launch><node pkg="p" type="plant.py" name="plant" args="{arguments}"/></launch>',
    }
    found = name_started(tmp_path, files, "p/a.launch")
    assert found & expected == expected
    assert {name for name, how in found if how in ("literal", "given")} == {
        name for name, how in expected if how in ("literal", "given")
    }


CPP = """
    #include <{head}>
    int main(int argc, char ** argv) {{
      {begin}
      std::string name = "/plain";
      if ({asked}) {{ name = argv[1]; }}
      {publish}
    }}
"""
ROSCPP = {
    "head": "ros/ros.h", "begin": 'ros::init(argc, argv, "a"); ros::NodeHandle nh;',
    "publish": "auto pub = nh.advertise<std_msgs::Empty>(name, 1);",
}  # fmt: skip
RCLCPP = {
    "head": "rclcpp/rclcpp.hpp",
    "begin": 'rclcpp::init(argc, argv); auto node = std::make_shared<rclcpp::Node>("a");',
    "publish": "auto pub = node->create_publisher<std_msgs::msg::Empty>(name, 1);",
}


# ros::init takes what is ROS's out of argc and argv; rclcpp::init leaves `--ros-args` and what follows it.
@pytest.mark.parametrize(("written", "asked", "arguments", "expected"), [
    (ROSCPP, "argc > 1", "", {"/plain"}),
    (ROSCPP, "argc > 1", "/given", {"/given"}),
    (RCLCPP, "argc > 1", "", set()),
    (RCLCPP, "argc >= 2", "", set()),
    (RCLCPP, "argc > 1", "/given", {"/given"}),
    (RCLCPP, "argc == 1", "", {"/plain"}),
    (RCLCPP, "argc > 8", "/given", {"/plain", "/given"}),
])  # fmt: skip
def test_how_many_arguments_a_program_of_cpp_has(tmp_path, written, asked, arguments, expected):
    one = written is ROSCPP
    files = {
        "p/package.xml": manifest("p", "catkin" if one else "ament_cmake"),
        "p/CMakeLists.txt": f"project(p)\nadd_executable(a src/a.cpp)\n{'catkin' if one else 'ament'}_package()",
        "p/src/a.cpp": CPP.format(asked=asked, **written),
        "p/launch/a.launch.xml" if not one else "p/launch/a.launch": (
            f'<launch><node pkg="p" {"type" if one else "exec"}="a" name="a" args="{arguments}"/></launch>'
        ),
    }
    found = name_started(tmp_path, files, "p/launch/a.launch" if one else "p/launch/a.launch.xml")
    assert {name for name, how in found if how in ("literal", "given")} == expected


DESK = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import Empty

    class Desk(Node):
        def __init__(self):
            super().__init__("desk")
            self.declare_parameter("said", "/default")
            self.create_publisher(Empty, self.get_parameter("said").value, 1)

    def main():
        rclpy.init()
        rclpy.spin(Desk())
"""
STARTED = """
    from launch import LaunchDescription
    from launch_ros.actions import Node

    def generate_launch_description():
        given = ask()
        return LaunchDescription([Node(package="desk", executable="desk", ros_arguments=[GIVEN])])
"""


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ("'-p', 'said:=/a'", {("/a", "launch")}),
        ("'-p', 'said:=/' + given", {("/<ask()>", "partly")}),
        ("'-p', 'other:=' + given", {("/default", "default")}),
    ],
)
def test_a_parameter_among_the_arguments_may_be_known_in_part(tmp_path, given, expected):
    files = {
        "desk/package.xml": manifest("desk", "ament_python"),
        "desk/setup.py": """
            from setuptools import setup
            setup(name="desk", packages=["desk"], entry_points={"console_scripts": ["desk = desk.desk:main"]})
        """,
        "desk/desk/__init__.py": "",
        "desk/desk/desk.py": DESK,
        "desk/launch/desk.launch.py": STARTED.replace("GIVEN", given),
    }
    assert name_started(tmp_path, files, "desk/launch/desk.launch.py") == expected
