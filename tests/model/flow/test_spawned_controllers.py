"""Controllers of ROS 1 are known by what a launch file loads onto the parameter server and names to a spawner."""

import pytest
from joining import ends, graph_on_disk, manifest

CODE = """
    #include <controller_interface/controller.h>
    #include <hardware_interface/joint_command_interface.h>
    #include <pluginlib/class_list_macros.hpp>
    #include <ros/node_handle.h>
    #include <std_msgs/Float64.h>
    namespace arms {
    class Position : public controller_interface::Controller<hardware_interface::PositionJointInterface> {
     public:
      bool init(hardware_interface::PositionJointInterface * hw, ros::NodeHandle & n) override {
        sub_ = n.subscribe<std_msgs::Float64>("command", 1, &Position::commandCB, this);
        return true;
      }
      void commandCB(const std_msgs::Float64ConstPtr & message) { command_ = message->data; }
      ros::Subscriber sub_;
      double command_;
    };
    class State : public controller_interface::Controller<hardware_interface::JointStateInterface> {
     public:
      bool init(hardware_interface::JointStateInterface * hw, ros::NodeHandle & root_nh,
                ros::NodeHandle & controller_nh) {
        pub_ = root_nh.advertise<std_msgs::Float64>("joint_states", 4);
        own_ = controller_nh.advertise<std_msgs::Float64>("rate", 4);
        return true;
      }
      ros::Publisher pub_, own_;
    };
    class Other {
     public:
      bool init(ros::NodeHandle & n) {
        pub_ = n.advertise<std_msgs::Float64>("other", 4);
        return true;
      }
      ros::Publisher pub_;
    };
    }
    PLUGINLIB_EXPORT_CLASS(arms::Position, controller_interface::ControllerBase)
    PLUGINLIB_EXPORT_CLASS(arms::State, controller_interface::ControllerBase)
    PLUGINLIB_EXPORT_CLASS(arms::Other, arms::Base)
"""
PLUGINS = """
    <library path="lib/libarms">
      <class name="arms/Position" type="arms::Position" base_class_type="controller_interface::ControllerBase"/>
      <class name="arms/State" type="arms::State" base_class_type="controller_interface::ControllerBase"/>
      <class name="arms/Other" type="arms::Other" base_class_type="arms::Base"/>
    </library>
"""
BUILD = """
    project(arms)
    find_package(catkin REQUIRED COMPONENTS controller_interface roscpp)
    catkin_package()
    add_library(arms arms.cpp)
"""
PARAMETERS = """
    joint_state_controller: {type: arms/State, publish_rate: 50}
    shoulder: {type: arms/Position, joint: shoulder}
    elbow: {type: arms/Position, joint: elbow}
    wrist: {type: others/Position, joint: wrist}
"""
LAUNCH = """
    <launch>
      <group ns="NAMESPACE">
        <rosparam command="load" file="$(find arms)/config/arms.yaml"/>
        SPAWNER
      </group>
    </launch>
"""
SPAWNER = '<node name="spawn" pkg="controller_manager" type="spawner" args="ARGS"/>'


def make_graph(root, spawner: str, namespace: str = "left"):
    files = {
        "arms/package.xml": manifest("arms", "catkin").replace(
            "<export>", '<export><controller_interface plugin="${prefix}/plugins.xml"/>'
        ),
        "arms/CMakeLists.txt": BUILD,
        "arms/arms.cpp": CODE,
        "arms/plugins.xml": PLUGINS,
        "arms/config/arms.yaml": PARAMETERS,
        "arms/launch/arms.launch": LAUNCH.replace("NAMESPACE", namespace).replace("SPAWNER", spawner),
    }
    return graph_on_disk(root, files)


@pytest.mark.parametrize(
    "arguments",
    ["joint_state_controller shoulder", "--timeout 60 --stopped joint_state_controller shoulder __log:=x"],
)
def test_each_controller_has_its_endpoints_in_its_own_namespace(tmp_path, arguments):
    found = make_graph(tmp_path, SPAWNER.replace("ARGS", arguments))
    assert {row for row in ends(found, "publisher") if row[0].startswith("/")} == {
        ("/left/joint_state_controller", "/left/joint_states", "std_msgs/Float64"),
        ("/left/joint_state_controller", "/left/joint_state_controller/rate", "std_msgs/Float64"),
    }
    assert ends(found, "subscriber") == {("/left/shoulder", "/left/shoulder/command", "std_msgs/Float64")}
    assert {node.started for node in found.nodes if node.name} == {"arms/launch/arms.launch:4"}


@pytest.mark.parametrize(
    ("spawner", "controllers"),
    [
        (SPAWNER.replace("ARGS", "shoulder elbow"), {"/left/shoulder", "/left/elbow"}),
        (SPAWNER.replace('"spawner"', '"controller_manager"').replace("ARGS", "spawn elbow"), {"/left/elbow"}),
        (SPAWNER.replace("ARGS", "--namespace=/left elbow").replace("<node", '<node ns="/tools"'), {"/left/elbow"}),
        # What is of another package, has no type there, is not spawned, or by another program.
        (SPAWNER.replace("ARGS", "wrist finger"), set()),
        (SPAWNER.replace("ARGS", "elbow").replace("<node", '<node ns="/tools"'), set()),
        (SPAWNER.replace('"spawner"', '"controller_manager"').replace("ARGS", "unload elbow"), set()),
        (SPAWNER.replace('"controller_manager"', '"my_manager"').replace("ARGS", "elbow"), set()),
        ("", set()),
    ],
)
def test_what_a_launch_file_spawns(tmp_path, spawner, controllers):
    rows = ends(make_graph(tmp_path, spawner), "subscriber")
    assert {node for node, topic, _ in rows if topic != "?" and node.startswith("/")} == controllers


def test_the_handle_that_another_plugin_is_given_is_not_known(tmp_path):
    found = make_graph(tmp_path, SPAWNER.replace("ARGS", "elbow"))
    assert {topic for node, topic, _ in ends(found, "publisher") if "Other" in node} == {"?"}
