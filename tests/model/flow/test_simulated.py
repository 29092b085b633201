"""Plugins of Gazebo Classic in descriptions of robots and worlds."""

import pytest
from joining import graph_on_disk, manifest

ROBOT = """
    <robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
      <gazebo>
        <plugin filename="libgazebo_ros_diff_drive.so" name="{name}">
          <ros>
            <namespace>{namespace}</namespace>
            <remapping>{remapping}</remapping>
          </ros>
        </plugin>
      </gazebo>
    </robot>
"""
ODOM, TWIST = "nav_msgs/Odometry", "geometry_msgs/Twist"


def start(tmp_path, files, launch="", build="ament_cmake"):
    base = {
        "bot/package.xml": manifest("bot", build),
        "bot/CMakeLists.txt": "cmake_minimum_required(VERSION 3.16)\nproject(bot)\n",
    }
    return graph_on_disk(tmp_path, {**base, **files}, launch)


def rows(found):
    return {(one.role, one.topic, one.type, one.how, one.line) for one in found.endpoints}


@pytest.mark.parametrize(
    ("name", "namespace", "remapping", "node", "topics"),
    [
        ("drive", "", "", "/drive",
         {("publisher", "/odom", ODOM, "launch", 3), ("subscriber", "/cmd_vel", TWIST, "launch", 3)}),
        ("drive", "/demo", "cmd_vel:=cmd_demo", "/demo/drive",
         {("publisher", "/demo/odom", ODOM, "launch", 3), ("subscriber", "/demo/cmd_demo", TWIST, "launch", 6)}),
        ("drive", "demo", "/demo/odom:=/odom/wheels", "/demo/drive",
         {("publisher", "/odom/wheels", ODOM, "launch", 6), ("subscriber", "/demo/cmd_vel", TWIST, "launch", 3)}),
        ("drive", "$(arg ns)", "cmd_vel:=/${prefix}/cmd", "/<ns>/drive",
         {("publisher", "/<ns>/odom", ODOM, "partly", 3), ("subscriber", "/<prefix>/cmd", TWIST, "partly", 6)}),
        ("${name}", "", "", "/<name>",
         {("publisher", "/odom", ODOM, "launch", 3), ("subscriber", "/cmd_vel", TWIST, "launch", 3)}),
        ("drive", "", "cmd vel", "/drive",
         {("publisher", "/odom", ODOM, "launch", 3), ("subscriber", "/cmd_vel", TWIST, "launch", 3)}),
        ("drive", "", "cmd_vel:=1bad", "/drive", {("publisher", "/odom", ODOM, "launch", 3)}),
    ],
)  # fmt: skip
def test_names_of_a_plugin(tmp_path, name, namespace, remapping, node, topics):
    text = ROBOT.format(name=name, namespace=namespace, remapping=remapping)
    found = start(tmp_path, {"bot/urdf/bot.urdf.xacro": text})
    assert rows(found) == topics
    assert [(one.id, one.kind, one.plugin, one.path) for one in found.nodes] == [
        (node, "plugin", "libgazebo_ros_diff_drive.so", "bot/urdf/bot.urdf.xacro")
    ]
    assert {one.only_if for one in found.endpoints} == {"Gazebo loads it, below no other namespace"}
    assert all(one.uncertain for one in found.nodes)


def test_private_names_are_below_the_plugin(tmp_path):
    text = """
        <sdf version="1.6"><model name="m"><link name="l"><sensor name="s" type="ray">
          <plugin name="lidar" filename="libgazebo_ros_ray_sensor.so">
            <ros><remapping>~/out:=scan</remapping></ros>
          </plugin>
          <plugin name="imu" filename="libgazebo_ros_imu_sensor.so"/>
        </sensor></link></model></sdf>
    """
    found = start(tmp_path, {"bot/models/m/model.sdf": text})
    assert {(one.node, one.topic, one.type) for one in found.endpoints} == {
        ("/lidar", "/scan", ""), ("/imu", "/imu/out", "sensor_msgs/Imu"),
    }  # fmt: skip


@pytest.mark.parametrize(
    ("path", "library", "build"),
    [
        ("bot/urdf/bot.urdf", "libmine.so", "ament_cmake"),
        ("bot/urdf/bot.urdf", "gz-sim-diff-drive-system", "ament_cmake"),
        ("bot/test/bot.urdf", "libgazebo_ros_diff_drive.so", "ament_cmake"),
        ("bot/notes/bot.txt", "libgazebo_ros_diff_drive.so", "ament_cmake"),
        # the libraries have the same names in ROS 1
        ("bot/urdf/bot.urdf", "libgazebo_ros_diff_drive.so", "catkin"),
    ],
)
def test_plugins_of_which_nothing_is_known(tmp_path, path, library, build):
    text = ROBOT.format(name="drive", namespace="", remapping="").replace("libgazebo_ros_diff_drive.so", library)
    assert start(tmp_path, {path: text}, build=build).endpoints == ()


def test_what_a_launch_file_loads_is_not_known(tmp_path):
    text = ROBOT.format(name="drive", namespace="", remapping="")
    files = {"bot/urdf/bot.urdf": text, "bot/launch/a.launch.xml": "<launch/>"}
    assert start(tmp_path, files, "bot/launch/a.launch.xml").endpoints == ()
