"""What launch files start whose code is not in the workspace: possible nodes."""

import json

from joining import graph_on_disk, manifest
from rosimpact.impact.model.flow.graph import OutsideNode
from rosimpact.impact.model.flow.select import select_graph
from rosimpact.impact.report.graph import draw

NODE = """
    #include <rclcpp/rclcpp.hpp>
    class Lamp : public rclcpp::Node {
     public:
      Lamp() : Node("lamp") { create_publisher<std_msgs::msg::Empty>("lit", 1); }
    };
    int main(int c, char** v) { rclcpp::init(c, v); rclcpp::spin(std::make_shared<Lamp>()); }
"""
LAUNCH = "lamp/launch/lamp.launch.xml"
STARTS = """
    <launch>
      <arg name="who"/>
      <node pkg="lamp" exec="lamp"/>
      <node pkg="joy" exec="joy_node" name="joy" namespace="pad" if="$(env SIM)"><remap from="joy" to="sticks"/></node>
      <node pkg="$(var who)" exec="driver"/>
      <include file="$(find-pkg-share nav2_bringup)/launch/bringup.launch.py"/>
      <executable cmd="ls"/>
    </launch>
"""


def make(tmp_path, launch=LAUNCH, starts=STARTS):
    files = {
        "lamp/package.xml": manifest("lamp", "ament_cmake"),
        "lamp/CMakeLists.txt": "project(lamp)\nadd_executable(lamp lamp.cpp)\nament_package()\n",
        "lamp/lamp.cpp": NODE, LAUNCH: starts,
    }  # fmt: skip
    return graph_on_disk(tmp_path, files, launch)


FOUND = (
    OutsideNode("/pad/joy", "joy", "joy_node", "node", f"{LAUNCH}:4", ("$(env SIM)",), ("sticks",)),
    OutsideNode("/<driver>", "<who>", "driver", "node", f"{LAUNCH}:5"),
    OutsideNode("", "nav2_bringup", "launch/bringup.launch.py", "launch file", f"{LAUNCH}:6"),
)


def test_of_a_launch_file(tmp_path):
    found = make(tmp_path)
    assert found.outside == FOUND
    assert [node.name for node in found.nodes] == ["/lamp"], "they are no nodes that are known"


def test_of_the_whole_system(tmp_path):
    assert make(tmp_path, "").outside == FOUND


def test_what_is_here_is_none(tmp_path):
    assert make(tmp_path, starts='<launch><node pkg="lamp" exec="lamp"/></launch>').outside == ()


def test_a_bridge_is_a_node_that_is_known(tmp_path):
    carries = "/a@std_msgs/msg/Empty@gz.msgs.Empty"
    bridge = f'<node pkg="ros_gz_bridge" exec="parameter_bridge" args="{carries}"/>'
    found = select_graph(make(tmp_path, starts=f"<launch>{bridge}</launch>")).graph
    assert [node.package for node in found.nodes] == ["ros_gz_bridge"]
    assert found.outside == ()


def test_text_json_and_page_tell_them(tmp_path):
    found = make(tmp_path)
    text = draw(found, "text")
    assert "3 possible nodes, started by launch files, whose code is not here:" in text
    assert f"  /pad/joy  joy/joy_node  {LAUNCH}:4  [uses sticks; only if $(env SIM)]" in text
    assert f"  any of  nav2_bringup/launch/bringup.launch.py  {LAUNCH}:6" in text
    told = json.loads(draw(found, "json"))["possible_nodes"]
    assert [one["name"] for one in told] == ["/pad/joy", "/<driver>", ""]
    assert '"outside":[{"name":"/pad/joy"' in draw(found, "html").replace(", ", ",").replace(": ", ":")


def test_a_part_that_is_asked_for_has_none(tmp_path):
    assert select_graph(make(tmp_path), nodes=["lamp"]).graph.outside == ()
