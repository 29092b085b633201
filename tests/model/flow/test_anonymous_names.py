"""Nodes of ROS 1 whose name ends in what is made up at every start: the name is not stated as certain."""

import pytest
from joining import graph, graph_on_disk, manifest

PYTHON = """
    import rospy
    from std_msgs.msg import Empty
    ANON = True
    rospy.init_node({given})
    pub = rospy.Publisher("~x", Empty)
"""
CPP = """
    #include <ros/ros.h>
    int main(int argc, char ** argv) {{
      ros::init(argc, argv, {given});
      ros::NodeHandle nh("~");
      ros::Publisher pub = nh.advertise<std_msgs::Empty>("x", 1);
    }}
"""
OPEN = ("/n_<anonymous>", "/n_<anonymous>/x", "partly")
KNOWN = ("/n", "/n/x", "literal")


@pytest.mark.parametrize(("name", "code", "given", "expected"), [
    ("n.py", PYTHON, '"n"', KNOWN),
    ("n.py", PYTHON, '"n", anonymous=True', OPEN),
    ("n.py", PYTHON, '"n", anonymous=False', KNOWN),
    ("n.py", PYTHON, '"n", None, True', OPEN),
    ("n.py", PYTHON, '"n", anonymous=ANON', OPEN),
    # What is not known may be.
    ("n.py", PYTHON, '"n", anonymous=rospy.get_param("~many")', OPEN),
    ("n.cpp", CPP, '"n"', KNOWN),
    ("n.cpp", CPP, '"n", ros::init_options::AnonymousName', OPEN),
    ("n.cpp", CPP, '"n", ros::init_options::NoRosout | ros::init_options::AnonymousName', OPEN),
    ("n.cpp", CPP, '"n", ros::init_options::NoSigintHandler', KNOWN),
])  # fmt: skip
def test_the_name_in_the_code(name, code, given, expected):
    found = graph({f"p/{name}": code.format(given=given)}, ros=1)
    names = {node.id: node.name for node in found.nodes}
    told = {(names[one.node], one.topic, one.how) for one in found.endpoints if not one.implied}
    assert told == {expected}


@pytest.mark.parametrize(("name", "expected"), [
    ("it", ("/it/x", "literal")), ("$(anon it)", ("/it_<anonymous>/x", "partly")),
])  # fmt: skip
def test_a_launch_file_names_it(tmp_path, name, expected):
    files = {
        "p/package.xml": manifest("p", "catkin"),
        "p/CMakeLists.txt": (
            "cmake_minimum_required(VERSION 3.0)\nproject(p)\nfind_package(catkin REQUIRED COMPONENTS roscpp)\n"
            "catkin_package()\nadd_executable(n n.cpp)\n"
        ),
        "p/n.cpp": CPP.format(given='"n", ros::init_options::AnonymousName'),
        "p/launch/p.launch": f'<launch><node pkg="p" type="n" name="{name}"/></launch>',
    }
    found = graph_on_disk(tmp_path, files, "p/launch/p.launch")
    made = [one for one in found.endpoints if not one.implied]
    assert [(one.topic, one.how) for one in made] == [expected]
