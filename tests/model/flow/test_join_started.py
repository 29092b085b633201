"""Nodes that the build makes of classes, and how launch files find them."""

from textwrap import dedent

import pytest
from joining import ends, graph, graph_on_disk, joined, manifest

COMPONENTS = {
    "eyes/package.xml": manifest("eyes", "ament_cmake"),
    "eyes/CMakeLists.txt": """
        cmake_minimum_required(VERSION 3.16)
        project(eyes)
        find_package(ament_cmake REQUIRED)
        find_package(rclcpp_components REQUIRED)
        add_library(parts SHARED src/parts.cpp)
        rclcpp_components_register_node(parts PLUGIN "eyes::Left" EXECUTABLE left_eye)
        rclcpp_components_register_nodes(parts "eyes::Right")
        ament_package()
    """,
    "eyes/src/parts.cpp": """
        #include <rclcpp/rclcpp.hpp>
        namespace eyes {
        class Left : public rclcpp::Node {
         public:
          explicit Left(const rclcpp::NodeOptions& o) : Node("left", o) {
            pub_ = create_publisher<sensor_msgs::msg::Image>("image", 1);
          }
          rclcpp::Publisher<sensor_msgs::msg::Image>::SharedPtr pub_;
        };
        class Right : public rclcpp::Node {
         public:
          explicit Right(const rclcpp::NodeOptions& o) : Node("right", o) {
            pub_ = create_publisher<sensor_msgs::msg::Image>("image", 1);
          }
          rclcpp::Publisher<sensor_msgs::msg::Image>::SharedPtr pub_;
        };
        }
        #include <rclcpp_components/register_node_macro.hpp>
        RCLCPP_COMPONENTS_REGISTER_NODE(eyes::Left)
        RCLCPP_COMPONENTS_REGISTER_NODE(eyes::Right)
    """,
}
COMPOSED = """
    <launch>
      <node_container pkg="rclcpp_components" exec="component_container" name="box" namespace="">
        <composable_node pkg="eyes" plugin="eyes::{cls}" name="a"/>
      </node_container>
    </launch>
"""
NODELETS = {
    "arm/package.xml": manifest("arm", "catkin"),
    "arm/CMakeLists.txt": """
        cmake_minimum_required(VERSION 3.0)
        project(arm)
        find_package(catkin REQUIRED COMPONENTS nodelet roscpp)
        catkin_package()
        add_library(arm src/reach.cpp)
    """,
    "arm/nodelets.xml": """
        <library path="lib/libarm">
          <class name="arm/reach" type="arm::Reach" base_class_type="nodelet::Nodelet"/>
        </library>
    """,
    "arm/src/reach.cpp": """
        namespace arm {
        class Reach : public nodelet::Nodelet {
          void onInit() { pub_ = getPrivateNodeHandle().advertise<std_msgs::Bool>("far", 1); }
          ros::Publisher pub_;
        };
        }
        PLUGINLIB_EXPORT_CLASS(arm::Reach, nodelet::Nodelet)
    """,
    "other/package.xml": manifest("other", "catkin"),
    "other/CMakeLists.txt": """
        cmake_minimum_required(VERSION 3.0)
        project(other)
        find_package(catkin REQUIRED COMPONENTS nodelet roscpp)
        catkin_package()
        add_library(other src/reach.cpp)
    """,
    "other/src/reach.cpp": """
        class Reach : public nodelet::Nodelet {
          void onInit() { pub_ = getNodeHandle().advertise<std_msgs::Bool>("wrong", 1); }
          ros::Publisher pub_;
        };
        PLUGINLIB_EXPORT_CLASS(Reach, nodelet::Nodelet)
    """,
}


def test_a_component_with_an_executable_of_its_own_is_one_node(tmp_path):
    found = graph_on_disk(tmp_path, COMPONENTS)
    assert [(node.id, node.kind, node.executable, node.plugin) for node in found.nodes] == [
        ("eyes/eyes::Right", "component", "", "eyes::Right"),
        ("eyes/left_eye", "component", "left_eye", "eyes::Left"),
    ]
    assert {node for node, _, _ in ends(found, "publisher")} == {"eyes/left_eye", "eyes/eyes::Right"}


@pytest.mark.parametrize(
    "launch, topic",
    [
        ('<launch><node pkg="eyes" exec="left_eye" name="x" namespace="y"/></launch>', "/y/image"),
        (COMPOSED.format(cls="Left"), "/image"),
        (COMPOSED.format(cls="Right"), "/image"),
    ],
)
def test_launch_files_start_components(tmp_path, launch, topic):
    found = graph_on_disk(tmp_path, {**COMPONENTS, "eyes/launch/a.launch.xml": launch}, "eyes/launch/a.launch.xml")
    assert {t for _, t, _ in ends(found, "publisher")} == {topic}
    assert not [one for one in found.coverage.unresolved if one.what == "started node"]


def test_a_component_without_an_executable_is_none_that_a_launch_file_could_start(tmp_path):
    launch = '<launch><node pkg="eyes" exec="right" name="x"/></launch>'
    found = graph_on_disk(tmp_path, {**COMPONENTS, "eyes/launch/a.launch.xml": launch}, "eyes/launch/a.launch.xml")
    assert [one.written for one in found.coverage.unresolved] == ["right"]


@pytest.mark.parametrize("name", ["arm/reach", "arm/Reach"])
def test_launch_files_load_nodelets(tmp_path, name):
    """Under the name of the plugin description, and under the usual one where there is none."""
    launch = f"""
        <launch>
          <node pkg="nodelet" type="nodelet" name="box" args="manager"/>
          <node pkg="nodelet" type="nodelet" name="x" args="load {name} box"/>
        </launch>
    """
    files = {**NODELETS, "arm/launch/a.launch": launch}
    if name == "arm/Reach":
        del files["arm/nodelets.xml"]
    found = graph_on_disk(tmp_path, {path: dedent(text) for path, text in files.items()}, "arm/launch/a.launch")
    assert ends(found, "publisher") == {("/x", "/x/far", "std_msgs/Bool")}


FILTER = """
    namespace est {
    template <class T>
    class Filter : public rclcpp::Node {
     public:
      explicit Filter(const rclcpp::NodeOptions& o) : rclcpp::Node("filter", o) {
        pub_ = create_publisher<nav_msgs::msg::Odometry>("filtered", 1);
      }
      rclcpp::Publisher<nav_msgs::msg::Odometry>::SharedPtr pub_;
    };
    template class Filter<Ekf>;
    using EkfNode = Filter<Ekf>;
    }
"""


@pytest.mark.parametrize(
    "made",
    [
        "std::make_shared<est::EkfNode>(options)",
        "std::make_shared<est::Filter<est::Ekf>>(options)",
        "std::shared_ptr<est::EkfNode>(new est::EkfNode(options))",
    ],
)
def test_a_program_runs_what_it_makes_by_another_name(made):
    main = "#include <est/filter.hpp>\n"
    main += f"int main(int c, char** v) {{ rclcpp::NodeOptions options; auto filter = {made}; rclcpp::spin(filter); }}"
    join = joined({"est/include/est/filter.hpp": FILTER, "est/src/main.cpp": main, "est/src/other.cpp": OTHER})
    assert ends(join.build(), "publisher") == {("est/main", "/filtered", "nav_msgs/Odometry")}
    (one,) = (one for one in join.list_running() if one.program.executable == "main")
    assert "est::est::Filter" in one.classes


OTHER = "int main(int c, char** v) { rclcpp::init(c, v); }"


@pytest.mark.parametrize("name", ["est::EkfNode", "est::Filter<est::Ekf>"])
def test_components_are_registered_by_other_names(name):
    files = {"est/src/filter.cpp": f"{dedent(FILTER)}\nRCLCPP_COMPONENTS_REGISTER_NODE({name})\n"}
    found = graph(files)
    assert [(node.kind, node.plugin, node.name) for node in found.nodes] == [("component", name, "/filter")]
    assert ends(found, "publisher") == {(f"est/{name}", "/filtered", "nav_msgs/Odometry")}
