"""Which parameter of ROS 1's server a name means: relative to the node's namespace, private, global, or to a handle."""

import pytest
from joining import graph, graph_on_disk, manifest

PYTHON = """
    #!/usr/bin/env python3
    import rospy
    from std_msgs.msg import Empty
    rospy.init_node("a")
    value = rospy.get_param("{name}", "fallback")
    rospy.Publisher("/" + value, Empty, queue_size=1)
"""
CPP = """
    #include <ros/ros.h>
    int main(int argc, char** argv) {{
      ros::init(argc, argv, "a");
      {handle}
      std::string value = "fallback";
      {read}
      ros::NodeHandle out;
      ros::Publisher pub = out.advertise<std_msgs::Empty>("/" + value, 1);
      ros::spin();
    }}
"""
PRIVATE = '<node {node}><param name="x" value="found"/></node>'
PRIVATE_BELOW = '<node {node}><param name="s/x" value="found"/></node>'
IN_NAMESPACE = '<param name="/robot/x" value="found"/><node {node}/>'
IN_GROUP = '<group ns="robot"><param name="x" value="found"/></group><node {node}/>'
IN_FILE = '<rosparam ns="robot">{{x: found}}</rosparam><node {node}/>'
GLOBAL = '<param name="x" value="found"/><node {node}/>'


def find_topic(folder, source, text, launch):
    """The topic of a node `/robot/a` that a launch file starts."""
    node = 'pkg="p" type="{}" name="a" ns="robot"'.format("a.py" if source.endswith(".py") else "a")
    files = {
        "p/package.xml": manifest("p", "catkin"),
        "p/CMakeLists.txt": (
            "project(p)\ncatkin_package()\nadd_executable(a src/a.cpp)\n" if source.endswith(".cpp")
            else "project(p)\ncatkin_package()\ncatkin_install_python(PROGRAMS scripts/a.py)\n"
        ),
        source: text,
        "p/launch/a.launch": f"<launch>{launch.format(node=node)}</launch>",
    }  # fmt: skip
    found = graph_on_disk(folder, files, "p/launch/a.launch")
    names = [(one.topic, one.how) for one in found.endpoints if one.role == "publisher" and not one.implied]
    return names[0] if len(names) == 1 else names


@pytest.mark.parametrize(("name", "launch", "topic"), [
    ("~x", PRIVATE, "/found"),
    ("x", PRIVATE, "/fallback"),
    ("/x", PRIVATE, "/fallback"),
    ("a/x", PRIVATE, "/found"),
    ("/robot/a/x", PRIVATE, "/found"),
    ("x", IN_NAMESPACE, "/found"),
    ("x", IN_GROUP, "/found"),
    ("x", IN_FILE, "/found"),
    ("~x", IN_GROUP, "/fallback"),
    ("/x", IN_GROUP, "/fallback"),
    ("/robot/x", IN_GROUP, "/found"),
    ("/x", GLOBAL, "/found"),
    ("x", GLOBAL, "/fallback"),
])  # fmt: skip
def test_a_name_in_python(tmp_path, name, launch, topic):
    found = find_topic(tmp_path, "p/scripts/a.py", PYTHON.format(name=name), launch)
    assert found == (topic, "launch" if topic == "/found" else "default")


@pytest.mark.parametrize(("handle", "read", "launch", "topic"), [
    ("ros::NodeHandle nh;", 'nh.param<std::string>("x", value, "fallback");', PRIVATE, "/fallback"),
    ("ros::NodeHandle nh;", 'nh.param<std::string>("x", value, "fallback");', IN_GROUP, "/found"),
    ("ros::NodeHandle nh;", 'nh.getParam("/x", value);', GLOBAL, "/found"),
    ('ros::NodeHandle nh("~");', 'nh.param<std::string>("x", value, "fallback");', PRIVATE, "/found"),
    ('ros::NodeHandle nh("~");', 'nh.getParam("x", value);', IN_GROUP, "/fallback"),
    ('ros::NodeHandle nh("~s");', 'nh.getParam("x", value);', PRIVATE_BELOW, "/found"),
    ('ros::NodeHandle nh("a");', 'nh.getParam("x", value);', PRIVATE, "/found"),
    ('ros::NodeHandle nh("/robot");', 'nh.getParam("x", value);', IN_GROUP, "/found"),
    ('ros::NodeHandle parent("~"); ros::NodeHandle nh(parent, "s");', 'nh.getParam("x", value);', PRIVATE_BELOW,
     "/found"),
    ("", 'ros::param::get("x", value);', PRIVATE, "/fallback"),
    ("", 'ros::param::get("~x", value);', PRIVATE, "/found"),
    ("", 'ros::param::get("x", value);', IN_GROUP, "/found"),
])  # fmt: skip
def test_a_name_in_cpp(tmp_path, handle, read, launch, topic):
    assert find_topic(tmp_path, "p/src/a.cpp", CPP.format(handle=handle, read=read), launch)[0] == topic


@pytest.mark.parametrize(("name", "expected"), [
    ("x", [("/fallback", "partly"), ("", "unresolved")]),
    ("y", ("/fallback", "default")),
])  # fmt: skip
def test_a_handle_of_an_unknown_namespace(tmp_path, name, expected):
    """It may be any: a parameter that some namespace has may be meant."""
    read = f'std::string ns; nh.getParam("ns", ns); ros::NodeHandle nh(ns); nh.getParam("{name}", value);'
    assert find_topic(tmp_path, "p/src/a.cpp", CPP.format(handle="", read=read), IN_GROUP) == expected


def test_a_node_handle_that_a_header_declares_in_a_namespace():
    """Its type is that of the only variable of that name; of two types it is not known."""
    header = """
        #include <ros/ros.h>
        namespace gps { boost::shared_ptr<ros::NodeHandle> nh; class Node { public: Node(); }; }
        %s
    """
    source = """
        #include "gps.h"
        using namespace gps;
        Node::Node() { nh->param("rate", rate["all"], 5); }
        int main(int c, char** v) {
          ros::init(c, v, "gps");
          nh.reset(new ros::NodeHandle("~"));
          Node node;
        }
    """
    found = graph({"gps/gps.h": header % "", "gps/gps.cpp": source}, 1)
    assert [(one.node, one.name, one.default) for one in found.parameters] == [("gps/gps", "rate", "5")]
    unsure = graph({"gps/gps.h": header % "namespace other { Reader nh; }", "gps/gps.cpp": source}, 1)
    assert not unsure.parameters


def test_a_helper_of_another_package_that_is_given_the_node_handle():
    source = """
        #include <ros/ros.h>
        #include <rig_common/params.h>
        int main(int c, char** v) {
          ros::init(c, v, "rig");
          ros::NodeHandle nh("~"), arm(nh, "arm");
          double speed = getParam(nh, "speed", 1.5);
          double reach = getParam(arm, "reach", 0.5);
          double other = getParam(c, "other", 0.5);
          double own = param(nh, "own");
        }
    """
    helper = "double param(ros::NodeHandle& nh, const std::string& name) { return nh.param(name + '_x', 1.0); }"
    same = helper.replace(" + '_x'", "").replace("double param", "double getParam")
    found = graph({"rig/rig.cpp": source, "rig/same.h": same}, 1)
    assert {(one.name, one.path) for one in found.parameters} >= {("speed", "rig/rig.cpp"), ("reach", "rig/rig.cpp")}
    found = graph({"rig/rig.cpp": '#include "own.h"' + source, "rig/own.h": helper.replace("'", '"')}, 1)
    assert {(one.name, one.default, one.line) for one in found.parameters if one.path == "rig/rig.cpp"} == {
        ("speed", "1.5", 7), ("reach", "0.5", 8)
    }  # fmt: skip
    assert [(one.name, one.path) for one in found.parameters if one.path != "rig/rig.cpp"] == [("own_x", "rig/own.h")]
