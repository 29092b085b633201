from launch import LaunchDescription
from launch.actions import IncludeLaunchDescription
from launch.launch_description_sources import PythonLaunchDescriptionSource
from launch.substitutions import PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare


def generate_launch_description():
    navigation = PathJoinSubstitution([FindPackageShare('nav2_bringup'), 'launch', 'rviz_launch.py'])
    return LaunchDescription([
        Node(package='controller_manager', executable='spawner', arguments=['arm_controller']),
        IncludeLaunchDescription(PythonLaunchDescriptionSource(navigation), launch_arguments={'namespace': 'arm'}.items()),
    ])
