from ament_index_python.packages import get_package_share_directory
from launch import LaunchDescription
from launch_ros.actions import Node


def generate_launch_description():
    parameters = get_package_share_directory('rover_bringup') + '/config/drive.yaml'
    return LaunchDescription([
        Node(package='nav2_controller', executable='controller_server', parameters=[parameters]),
        Node(
            package='nav2_behaviors',
            executable='behavior_server',
            name='recoveries',
            parameters=[parameters, {'local_costmap_topic': 'local_costmap/costmap_raw'}],
        ),
    ])
