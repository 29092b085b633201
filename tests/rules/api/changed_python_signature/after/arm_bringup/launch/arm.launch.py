from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    return LaunchDescription([
        Node(package='joint_state_publisher', executable='joint_state_publisher'),
    ])
