"""The table of what plugins of Gazebo have, from a small repository."""

from textwrap import dedent

import pygit2
import pytest
from rosimpact.databuild.gazebo_topics import build_table
from rosimpact.databuild.git import BuildError
from rosimpact.impact.targets.gazebo_topics import GazeboTopic, load_gazebo_topics

FILES = {
    "plugins/package.xml": """
        <package format="3"><name>plugins</name><version>3.1.0</version><description>x</description>
        <maintainer email="a@b.org">a</maintainer><license>MIT</license>
        <buildtool_depend>ament_cmake</buildtool_depend><export><build_type>ament_cmake</build_type></export></package>
    """,
    "plugins/CMakeLists.txt": """
        cmake_minimum_required(VERSION 3.16)
        project(plugins)
        find_package(ament_cmake REQUIRED)
        add_library(drive SHARED src/drive.cpp)
        ament_package()
    """,
    "plugins/src/drive.cpp": """
        #include <gazebo_ros/node.hpp>
        void Drive::Load(gazebo::physics::ModelPtr model, sdf::ElementPtr sdf) {
          rclcpp::Node::SharedPtr node = gazebo_ros::Node::Get(sdf);
          odom_ = node->create_publisher<nav_msgs::msg::Odometry>("odom", 1);
          cmd_ = node->create_subscription<geometry_msgs::msg::Twist>("cmd_vel", 1, on_cmd);
          out_ = node->create_publisher<sensor_msgs::msg::LaserScan>("~/out", 1);
          clouds_ = node->create_publisher<sensor_msgs::msg::PointCloud>("~/out", 1);
          far_ = node->create_publisher<nav_msgs::msg::Odometry>(sdf->Get<std::string>("topic"), 1);
        }
    """,
}


def release(repository, tag, files):
    index = repository.index
    for path, text in files.items():
        index.add(pygit2.IndexEntry(path, repository.create_blob(dedent(text).lstrip().encode()), 0o100644))
    who = pygit2.Signature("a", "a@b.org")
    parents = [] if repository.is_empty else [repository.head.target]
    commit = repository.create_commit("HEAD", who, who, "x", index.write_tree(), parents)
    repository.create_reference(f"refs/tags/{tag}", commit)


def test_topics_of_the_newest_release(tmp_path):
    repository = pygit2.init_repository(tmp_path, bare=True)
    release(repository, "3.2.0", {**FILES, "plugins/src/drive.cpp": "int nothing;\n"})
    release(repository, "3.10.0", FILES)
    release(repository, "2.9.9", {"plugins/src/drive.cpp": "int nothing;\n"})
    table = build_table(tmp_path)
    assert table.version == "3.10.0"
    assert table.plugins == {
        "libdrive.so": (
            GazeboTopic("publisher", "odom", "nav_msgs/Odometry"), GazeboTopic("publisher", "~/out", ""),
            GazeboTopic("subscriber", "cmd_vel", "geometry_msgs/Twist"),
        )
    }  # fmt: skip


def test_a_clone_without_releases(tmp_path):
    pygit2.init_repository(tmp_path, bare=True)
    with pytest.raises(BuildError, match="no tags of releases"):
        build_table(tmp_path)


def test_the_shipped_table_has_the_drives():
    drive = load_gazebo_topics().plugins["libgazebo_ros_diff_drive.so"]
    assert [(one.role, one.name) for one in drive] == [("publisher", "odom"), ("subscriber", "cmd_vel")]
