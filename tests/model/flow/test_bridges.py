"""Bridges to Gazebo: what launch files and YAML files tell them to carry."""

import pytest
from joining import ends, graph_on_disk, manifest, write
from rosimpact.impact.analysis.session import open_tree
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.flow.launch_changes import compare_launches
from rosimpact.impact.model.flow.workspace import get_flow, link_for_flow

CONFIG = """
    - topic_name: "imu"
      ros_type_name: "sensor_msgs/msg/Imu"
      gz_type_name: "gz.msgs.IMU"
      direction: GZ_TO_ROS
    - ros_topic_name: "/cmd_vel"
      gz_topic_name: "/model/r/cmd_vel"
      ros_type_name: "geometry_msgs/msg/Twist"
      gz_type_name: "gz.msgs.Twist"
      direction: ROS_TO_GZ
    - gz_topic_name: "/chat"
      ros_type_name: "std_msgs/msg/String"
      gz_type_name: "gz.msgs.StringMsg"
    - service_name: "/world/w/control"
      ros_type_name: "ros_gz_interfaces/srv/ControlWorld"
      gz_req_type_name: "gz.msgs.WorldControl"
      gz_rep_type_name: "gz.msgs.Boolean"
    # what a bridge refuses
    - topic_name: "/nothing"
      ros_type_name: "std_msgs/msg/String"
      direction: SIDEWAYS
    - ros_type_name: "std_msgs/msg/String"
    - topic_name: "/clock"
      ros_type_name: "rosgraph_msgs/msg/clock"
    - just text
"""
LISTED = {
    ("publisher", "/imu", "sensor_msgs/Imu", 1),
    ("subscriber", "/cmd_vel", "geometry_msgs/Twist", 5),
    ("publisher", "/chat", "std_msgs/String", 10),
    ("subscriber", "/chat", "std_msgs/String", 10),
    ("server", "/world/w/control", "ros_gz_interfaces/ControlWorld", 13),
}
HEAD = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, ExecuteProcess, GroupAction, IncludeLaunchDescription
from launch.conditions import IfCondition
from launch.substitutions import EnvironmentVariable, LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import ComposableNodeContainer, Node, PushRosNamespace
from launch_ros.descriptions import ComposableNode
from launch_ros.substitutions import FindPackageShare
from ros_gz_bridge.actions import RosGzBridge
CONFIG = PathJoinSubstitution([FindPackageShare('sim'), 'config', 'bridge.yaml'])

def bridge(*arguments, **more):
    return Node(package='ros_gz_bridge', executable='parameter_bridge', arguments=[*arguments], **more)

def generate_launch_description():
"""
SCAN = "'/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan'"


def make_files(body: str) -> dict[str, str]:
    return {
        "sim/package.xml": manifest("sim", "ament_cmake"),
        "sim/CMakeLists.txt": "cmake_minimum_required(VERSION 3.16)\nproject(sim)\n",
        "sim/config/bridge.yaml": CONFIG,
        "sim/launch/a.launch.py": f"{HEAD}    return LaunchDescription([{body}])\n",
    }


def start(tmp_path, body: str):
    return graph_on_disk(tmp_path, make_files(body), "sim/launch/a.launch.py")


def carried(found):
    return {(one.role, one.topic, one.type) for one in found.endpoints}


@pytest.mark.parametrize(
    ("argument", "expected"),
    [
        ("/scan@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan", {("publisher", "/scan", "sensor_msgs/LaserScan")}),
        ("/cmd@geometry_msgs/msg/Twist]gz.msgs.Twist", {("subscriber", "/cmd", "geometry_msgs/Twist")}),
        ("/chat@std_msgs/msg/String@ignition.msgs.StringMsg",
         {("publisher", "/chat", "std_msgs/String"), ("subscriber", "/chat", "std_msgs/String")}),
        ("chat@std_msgs/String[gz.msgs.StringMsg", {("publisher", "/chat", "std_msgs/String")}),
        ("/world/w/control@ros_gz_interfaces/srv/ControlWorld",
         {("server", "/world/w/control", "ros_gz_interfaces/ControlWorld")}),
        ("/world/w/control@ros_gz_interfaces/srv/ControlWorld@gz.msgs.WorldControl@gz.msgs.Boolean",
         {("server", "/world/w/control", "ros_gz_interfaces/ControlWorld")}),
        # what the bridge refuses
        ("/world/w/control@ros_gz_interfaces/srv/ControlWorld[gz.msgs.WorldControl", set()),
        ("/scan@sensor_msgs/msg/LaserScan", set()),
        ("/scan", set()),
        ("/clock@rosgraph_msgs/msg/clock[gz.msgs.Clock", set()),
        ("@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan", set()),
        ("/a b@sensor_msgs/msg/LaserScan[gz.msgs.LaserScan", set()),
        ("--verbose", set()),
    ],
)  # fmt: skip
def test_arguments_of_a_bridge(tmp_path, argument, expected):
    assert carried(start(tmp_path, f"bridge('{argument}')")) == expected


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (f"bridge({SCAN})", ("/ros_gz_bridge", "/scan", "launch")),
        (f"bridge({SCAN}, name='b', namespace='n')", ("/n/b", "/scan", "launch")),
        (f"bridge({SCAN}, name='b', remappings=[('/scan', '/lidar')])", ("/b", "/lidar", "launch")),
        (f"bridge({SCAN}, name='b', arguments_=1), PushRosNamespace('late')", ("/b", "/scan", "launch")),
        (f"GroupAction([PushRosNamespace('g'), bridge('own', {SCAN}, name='b')])", ("/g/b", "/scan", "launch")),
        ("PushRosNamespace('g'), bridge('own@a_msgs/msg/A[gz.msgs.A', name='b')", ("/g/b", "/g/own", "launch")),
        (f"bridge({SCAN}, '--ros-args', '-r', '/scan:=/lidar', '-p', 'a:=b', name='b')", ("/b", "/lidar", "launch")),
        ("DeclareLaunchArgument('r', default_value='r1'), "
         "bridge(['/model/', LaunchConfiguration('r'), '/odom@nav_msgs/msg/Odometry[gz.msgs.Odometry'], name='b')",
         ("/b", "/model/r1/odom", "launch")),
        ("bridge(['/model/', EnvironmentVariable('R'), '/odom@nav_msgs/msg/Odometry[gz.msgs.Odometry'], name='b')",
         ("/b", "/model/<$R>/odom", "partly")),
        (f"Node(package='ros_ign_bridge', executable='parameter_bridge', arguments=[{SCAN}])",
         ("/<parameter_bridge>", "/scan", "launch")),
        (f"ExecuteProcess(cmd=['ros2', 'run', 'ros_gz_bridge', 'parameter_bridge', {SCAN}])",
         ("/ros_gz_bridge", "/scan", "launch")),
        ("Node(package='ros_gz_image', executable='image_bridge', arguments=['/camera'])",
         ("/ros_gz_image", "/camera", "launch")),
    ],
)  # fmt: skip
def test_names_of_a_bridge_are_those_of_its_start(tmp_path, body, expected):
    found = start(tmp_path, body)
    (one,) = found.endpoints
    assert (one.node, one.topic, one.how) == expected
    assert (one.role, one.path, one.line > 0) == ("publisher", "sim/launch/a.launch.py", True)
    assert [node.id for node in found.nodes] == [one.node]
    assert not [row for row in found.coverage.unresolved if row.what == "started node"]


CONFIGURED = [
    "bridge(name='b', parameters=[{'config_file': CONFIG}])",
    "Node(package='ros_gz_bridge', executable='bridge_node', name='b', parameters=[{'config_file': CONFIG}])",
    "bridge('--ros-args', '-p', ['config_file:=', CONFIG], name='b')",
    "ComposableNodeContainer(name='c', namespace='', package='rclcpp_components', executable='component_container', "
    "composable_node_descriptions=[ComposableNode(package='ros_gz_bridge', name='b', "
    "plugin='ros_gz_bridge::RosGzBridge', "
    "parameters=[{'config_file': CONFIG}])])",
    "RosGzBridge(bridge_name='b', config_file=CONFIG)",
    "IncludeLaunchDescription(PathJoinSubstitution([FindPackageShare('ros_gz_bridge'), 'launch', "
    "'ros_gz_bridge.launch.py']), launch_arguments={'bridge_name': 'b', 'config_file': CONFIG}.items())",
]


@pytest.mark.parametrize("body", CONFIGURED)
def test_a_configuration_file_of_a_bridge(tmp_path, body):
    found = start(tmp_path, body)
    assert {(one.role, one.topic, one.type, one.line) for one in found.endpoints} == LISTED
    assert {(one.node, one.path, one.how) for one in found.endpoints} == {("/b", "sim/config/bridge.yaml", "launch")}


def test_an_element_of_xml_starts_a_bridge(tmp_path):
    files = make_files("")
    files["sim/launch/b.launch.xml"] = """
        <launch>
          <arg name="ns" default="n"/>
          <ros_gz_bridge bridge_name="b" namespace="$(var ns)" config_file="$(find-pkg-share sim)/config/bridge.yaml"/>
        </launch>
    """
    found = graph_on_disk(tmp_path, files, "sim/launch/b.launch.xml")
    assert ends(found, "publisher") == {("/n/b", "/n/imu", "sensor_msgs/Imu"), ("/n/b", "/chat", "std_msgs/String")}


def test_a_bridge_under_a_condition_may_not_be_there(tmp_path):
    found = start(tmp_path, f"bridge({SCAN}, condition=IfCondition(EnvironmentVariable('SIM')))")
    assert [node.uncertain for node in found.nodes] == [("$(env SIM)",)]


@pytest.mark.parametrize(
    "body",
    ["bridge()", "bridge(name='b', parameters=[{'config_file': EnvironmentVariable('FILE')}])",
     "bridge(name='b', parameters=[{'config_file': '/opt/bridge.yaml'}])",
     f"Node(package='other', executable='parameter_bridge', arguments=[{SCAN}])"],
)  # fmt: skip
def test_what_is_not_known_to_be_carried(tmp_path, body):
    found = start(tmp_path, body)
    assert (found.nodes, found.endpoints) == ((), ())
    assert [row.what for row in found.coverage.unresolved] == ["started node"]


def link_files(root, store, body: str, config: str = CONFIG):
    write(root, {**make_files(body), "sim/config/bridge.yaml": config})
    return link_for_flow(open_tree(root, ""), store)


def test_the_whole_system_has_the_bridge(tmp_path):
    with Store(tmp_path / ".cache") as store:
        flow = get_flow(link_files(tmp_path / "ws", store, CONFIGURED[0]))
        assert {(node.id, node.launches) for node in flow.system.nodes} == {("/b", ("sim/launch/a.launch.py",))}
        assert {(one.role, one.topic, one.type, one.line) for one in flow.system.endpoints} == LISTED
        assert flow.graph.endpoints == ()


def test_a_change_of_what_is_carried(tmp_path):
    with Store(tmp_path / ".cache") as store:
        old = link_files(tmp_path / "old", store, f"bridge({SCAN}, name='b')")
        new = link_files(tmp_path / "new", store, f"bridge({SCAN.replace('scan', 'lidar', 1)}, name='b')")
        (change,) = compare_launches(new, old).launches
    assert [carried(graph) for graph in (change.before, change.now)] == [
        {("publisher", "/scan", "sensor_msgs/LaserScan")},
        {("publisher", "/lidar", "sensor_msgs/LaserScan")},
    ]
