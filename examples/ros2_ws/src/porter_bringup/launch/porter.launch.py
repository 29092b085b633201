# Copyright 2026 The rosimpact authors
# SPDX-License-Identifier: Apache-2.0

"""Everything that runs on the porter; `joystick:=true` adds the joystick."""

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.substitutions import Command, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    share = FindPackageShare("porter_bringup")
    parameters = PathJoinSubstitution([share, "config", "porter.yaml"])
    description = Command(["xacro ", PathJoinSubstitution([share, "urdf", "porter.urdf.xacro"])])
    return LaunchDescription(
        [
            DeclareLaunchArgument("joystick", default_value="false"),
            Node(
                package="robot_state_publisher",
                executable="robot_state_publisher",
                parameters=[{"robot_description": ParameterValue(description, value_type=str)}],
            ),
            Node(package="porter_base", executable="base_node", name="base", parameters=[parameters]),
            Node(package="porter_monitor", executable="battery_monitor"),
            Node(
                package="v4l2_camera",
                executable="v4l2_camera_node",
                name="camera",
                parameters=[parameters],
                remappings=[("image_raw", "camera/image"), ("camera_info", "camera/camera_info")],
            ),
            Node(
                package="porter_vision",
                executable="marker_node",
                name="dock_markers",
                parameters=[parameters],
                remappings=[("image", "camera/image"), ("camera_info", "camera/camera_info")],
            ),
            IncludeLaunchDescription(
                PathJoinSubstitution([share, "launch", "joystick.launch.xml"]),
                condition=IfCondition(LaunchConfiguration("joystick")),
            ),
        ]
    )
