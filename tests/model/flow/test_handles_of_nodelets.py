"""Handles of nodelets in ROS 1: those that nodelet::Nodelet gives are in the namespace of the nodelet and have its
remappings, those that are made anew have what the process of the manager has, as nodelet.cpp and roscpp do it."""

import pytest
from joining import graph_on_disk, manifest

CODE = """
    #include <nodelet/nodelet.h>
    #include <pluginlib/class_list_macros.h>
    #include <ros/ros.h>
    #include <std_msgs/Bool.h>
    namespace eye {
    HELPER
    class Eye : public nodelet::Nodelet {
      void onInit() override {
        BODY
      }
      ros::NodeHandle own_;
      ros::NodeHandle given_;
      ros::Publisher pub_;
    };
    }
    PLUGINLIB_EXPORT_CLASS(eye::Eye, nodelet::Nodelet)
"""
HELPER = """
    class Helper {
     public:
      explicit Helper(ros::NodeHandle & given) { pub_ = given.advertise<std_msgs::Bool>("seen", 1); }
      ros::Publisher pub_;
    };
"""
SEEN = '.advertise<std_msgs::Bool>("seen", 1);'
MANAGER = """
    <node pkg="nodelet" type="nodelet" name="manager" args="manager" ns="head"><remap from="seen" to="noticed"/></node>
"""
LOADED = """
    <node pkg="nodelet" type="nodelet" name="left" ns="face" args="load eye/Eye /head/manager">
      <remap from="seen" to="looked"/>
    </node>
"""
ALONE = '<node pkg="nodelet" type="nodelet" name="left" ns="face" args="standalone eye/Eye"/>'


def list_topics(tmp_path, body, launched):
    found = graph_on_disk(tmp_path, {
        "eye/package.xml": manifest("eye", "catkin").replace("<export>", '<export><nodelet plugin="plugins.xml"/>'),
        "eye/plugins.xml": """
            <library path="lib/libeye">
              <class name="eye/Eye" type="eye::Eye" base_class_type="nodelet::Nodelet"/>
            </library>
        """,
        "eye/CMakeLists.txt": """
            cmake_minimum_required(VERSION 3.0.2)
            project(eye)
            find_package(catkin REQUIRED COMPONENTS roscpp nodelet std_msgs)
            catkin_package()
            add_library(eye eye.cpp)
        """,
        "eye/eye.cpp": CODE.replace("BODY", body).replace("HELPER", HELPER if "Helper" in body else ""),
        "eye/launch/eye.launch": f"<launch>{launched}</launch>",
    }, "eye/launch/eye.launch")  # fmt: skip
    return {one.topic for one in found.endpoints if one.role == "publisher" and not one.implied}


@pytest.mark.parametrize(("body", "expected"), [
    (f"pub_ = getNodeHandle(){SEEN}", "/face/looked"),
    (f"pub_ = getPrivateNodeHandle(){SEEN}", "/face/left/seen"),
    (f"ros::NodeHandle & handle = getMTNodeHandle(); pub_ = handle{SEEN}", "/face/looked"),
    (f"given_ = getNodeHandle(); pub_ = given_{SEEN}", "/face/looked"),
    (f'ros::NodeHandle below(getNodeHandle(), "below"); pub_ = below{SEEN}', "/face/below/seen"),
    ("Helper helper(getNodeHandle());", "/face/looked"),
    # Of the process.
    (f"ros::NodeHandle handle; pub_ = handle{SEEN}", "/head/noticed"),
    (f'ros::NodeHandle handle("~"); pub_ = handle{SEEN}', "/head/manager/seen"),
    (f'ros::NodeHandle handle("below"); pub_ = handle{SEEN}', "/head/below/seen"),
    (f"pub_ = own_{SEEN}", "/head/noticed"),
    ("ros::NodeHandle handle; Helper helper(handle);", "/head/noticed"),
])  # fmt: skip
def test_the_handle_of_a_nodelet_in_a_manager(tmp_path, body, expected):
    assert list_topics(tmp_path, body, MANAGER + LOADED) == {expected}


def test_a_manager_that_is_started_elsewhere_is_known_by_its_name(tmp_path):
    assert list_topics(tmp_path, f'ros::NodeHandle handle("~"); pub_ = handle{SEEN}', LOADED) == {"/head/manager/seen"}


def test_a_manager_that_is_not_known_leaves_the_name_open(tmp_path):
    loaded = '<arg name="one"/>' + LOADED.replace("/head/manager", "$(arg one)")
    found = list_topics(tmp_path, f'ros::NodeHandle handle("~"); pub_ = handle{SEEN}', loaded)
    assert found == {"/<namespace>/<container>/seen"}


def test_a_nodelet_that_is_alone_is_its_process(tmp_path):
    body = f'ros::NodeHandle handle("~"); pub_ = handle{SEEN}'
    assert list_topics(tmp_path, body, ALONE) == {"/face/left/seen"}
