from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    driver = PathJoinSubstitution([FindPackageShare('ur_robot_driver'), 'launch', 'ur_control.launch.py'])
    return LaunchDescription([
        Node(package='controller_manager', executable='spawner.py', arguments=['arm_controller']),
        IncludeLaunchDescription(PythonLaunchDescriptionSource(driver),
                                 launch_arguments={'ur_type': 'ur5e', 'use_fake_hardware': 'true'}.items()),
    ])
