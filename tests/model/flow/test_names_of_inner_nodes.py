"""Nodes that their options, the class of a base or another node name; and strings and calls of several lines."""

import pytest
from joining import ends, graph, graph_on_disk, manifest

MAP = """
    #include <rclcpp/rclcpp.hpp>
    #include <std_msgs/msg/bool.hpp>
    using std_msgs::msg::Bool;
    class Drawer {
    public:
      explicit Drawer(const rclcpp::Node::WeakPtr & parent) {
        auto node = parent.lock();
        pub_ = node->create_publisher<Bool>("drawn", 1);
      }
      rclcpp::Publisher<Bool>::SharedPtr pub_;
    };
    class Map : public rclcpp::Node {
    public:
      explicit Map(const std::string & name) : Map(name, "/", name) {}
      Map(const std::string & name, const std::string & above, const std::string & space)
      : Node(name, "", rclcpp::NodeOptions().arguments({
          "--ros-args", "-r", std::string("__ns:=") + SPACE, "-r", name + ":" + std::string("__node:=") + name})) {
        pub_ = create_publisher<Bool>("cells", 1);
      }
      void begin() { drawer_ = std::make_unique<Drawer>(shared_from_this()); }
      rclcpp::Publisher<Bool>::SharedPtr pub_;
      std::unique_ptr<Drawer> drawer_;
    };
    class Server : public rclcpp::Node {
    public:
      Server() : Node("server") {
        map_ = std::make_shared<Map>("far", std::string{get_namespace()}, "far");
        map_->begin();
        pub_ = create_publisher<Bool>("served", 1);
      }
      std::shared_ptr<Map> map_;
      rclcpp::Publisher<Bool>::SharedPtr pub_;
    };
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      rclcpp::spin(std::make_shared<Server>());
    }
"""


@pytest.mark.parametrize(("space", "given", "expected"), [
    ('above + "/" + space', "", {("/far/far", "/far/cells"), ("/far/far", "/far/drawn")}),
    ('above + "/" + space', "/robot", {("/robot/far/far", "/robot/far/cells"), ("/robot/far/far", "/robot/far/drawn")}),
    ('"/all"', "/robot", {("/all/far", "/all/cells"), ("/all/far", "/all/drawn")}),
    ("find_space(above)", "", {("/<namespace>/far", "/<namespace>/cells"), ("/<namespace>/far", "/<namespace>/drawn")}),
])  # fmt: skip
def test_the_options_of_an_inner_node_put_it_into_a_namespace(tmp_path, space, given, expected):
    files = {
        "map/package.xml": manifest("map", "ament_cmake"),
        "map/CMakeLists.txt": (
            "cmake_minimum_required(VERSION 3.16)\nproject(map)\nfind_package(ament_cmake REQUIRED)\n"
            "find_package(rclcpp REQUIRED)\nadd_executable(server server.cpp)\nament_package()\n"
        ),
        "map/server.cpp": MAP.replace("SPACE", space),
        "map/launch/map.launch.xml": f'<launch><node pkg="map" exec="server" name="it" namespace="{given}"/></launch>',
    }
    found = graph_on_disk(tmp_path, files, "map/launch/map.launch.xml")
    told = {(node, topic) for node, topic, _ in ends(found, "publisher")}
    assert told == expected | {(f"{given}/it", f"{given}/served")}


HELPED = MAP.replace("    class Map :", """
    std::string add(const std::string & above, const std::string & inner) {
      if (!above.empty() && above.back() == '/') {
        return above + inner;
      }
      return above + "/" + inner;
    }
    rclcpp::NodeOptions make_options(const std::string & name, const std::string & above) {
      std::vector<std::string> arguments{"--ros-args"};
      replace(arguments, "-r", "__ns:=" + add(above, name));
      replace(arguments, "-r", name + ":" + "__node:=" + name);
      return rclcpp::NodeOptions().arguments(arguments);
    }
    class Map :""").replace("""rclcpp::NodeOptions().arguments({
          "--ros-args", "-r", std::string("__ns:=") + SPACE, "-r", name + ":" + std::string("__node:=") + name})""",
    "make_options(name, above)")  # fmt: skip


@pytest.mark.parametrize(("given", "above"), [("", ""), ("/robot", "/robot")])
def test_a_function_that_makes_the_options_of_an_inner_node_names_it(tmp_path, given, above):
    files = {
        "map/package.xml": manifest("map", "ament_cmake"),
        "map/CMakeLists.txt": (
            "cmake_minimum_required(VERSION 3.16)\nproject(map)\nfind_package(ament_cmake REQUIRED)\n"
            "find_package(rclcpp REQUIRED)\nadd_executable(server server.cpp)\nament_package()\n"
        ),
        "map/server.cpp": HELPED,
        "map/launch/map.launch.xml": f'<launch><node pkg="map" exec="server" name="it" namespace="{given}"/></launch>',
    }
    found = graph_on_disk(tmp_path, files, "map/launch/map.launch.xml")
    assert {(node, topic) for node, topic, _ in ends(found, "publisher")} == {
        (f"{above}/far/far", f"{above}/far/cells"), (f"{above}/far/far", f"{above}/far/drawn"),
        (f"{given}/it", f"{given}/served"),
    }  # fmt: skip


def test_a_node_that_a_plugin_is_given_is_not_run_by_the_plugin():
    files = {
        "p/CMakeLists.txt": """
            cmake_minimum_required(VERSION 3.16)
            project(p)
            find_package(ament_cmake REQUIRED)
            find_package(rclcpp REQUIRED)
            find_package(pluginlib REQUIRED)
            add_library(planner SHARED planner.cpp)
            ament_package()
        """,
        "p/package.xml": manifest("p", "ament_cmake"),
        "p/map.hpp": """
            #include <rclcpp/rclcpp.hpp>
            namespace p {
            class Map : public rclcpp::Node {
            public:
              Map() : Node("map") {}
              void start() { pub_ = create_publisher<std_msgs::msg::Bool>("cells", 1); }
              rclcpp::Publisher<std_msgs::msg::Bool>::SharedPtr pub_;
            };
            }
        """,
        "p/planner.cpp": """
            #include <pluginlib/class_list_macros.hpp>
            #include "map.hpp"
            namespace p {
            class Planner : public Base {
            public:
              void configure(rclcpp::Node::SharedPtr node, std::shared_ptr<p::Map> map) override {
                map->start();
                pub_ = node->create_publisher<std_msgs::msg::Bool>("planned", 1);
              }
              rclcpp::Publisher<std_msgs::msg::Bool>::SharedPtr pub_;
            };
            }
            PLUGINLIB_EXPORT_CLASS(p::Planner, Base)
        """,
    }
    found = graph(files)
    plugins = {node.id for node in found.nodes if node.kind == "plugin"}
    assert {one.topic for one in found.endpoints if one.node in plugins and not one.implied} == {"/planned"}


def test_of_several_constructors_the_one_that_makes_the_object_tells_its_members(tmp_path):
    code = MAP.replace(
        "explicit Map(const std::string & name) : Map(name, \"/\", name) {}",
        "explicit Map(const rclcpp::NodeOptions & options) : Node(\"map\", options), name_(\"map\") {}",
    ).replace(': Node(name, ""', ': name_(name), Node(name, ""').replace("SPACE", "space").replace(
        "void begin() {", "std::string name_;\n      void begin() { own_ = create_publisher<Bool>(name_ + \"_own\", 1);"
    )  # fmt: skip
    files = {
        "map/package.xml": manifest("map", "ament_cmake"),
        "map/CMakeLists.txt": (
            "cmake_minimum_required(VERSION 3.16)\nproject(map)\nfind_package(ament_cmake REQUIRED)\n"
            "find_package(rclcpp REQUIRED)\nadd_executable(server server.cpp)\nament_package()\n"
        ),
        "map/server.cpp": code,
        "map/launch/map.launch.xml": '<launch><node pkg="map" exec="server"/></launch>',
    }
    found = graph_on_disk(tmp_path, files, "map/launch/map.launch.xml")
    assert {topic for _, topic, _ in ends(found, "publisher") if topic.endswith("own")} == {"/far/far_own"}


def test_a_component_is_called_what_its_base_class_calls_it():
    files = {
        "p/CMakeLists.txt": """
            cmake_minimum_required(VERSION 3.16)
            project(p)
            find_package(ament_cmake REQUIRED)
            find_package(rclcpp_components REQUIRED)
            add_library(slam SHARED slam.cpp)
            rclcpp_components_register_nodes(slam "p::AsyncSlam")
            ament_package()
        """,
        "p/package.xml": manifest("p", "ament_cmake"),
        "p/slam.cpp": """
            #include <rclcpp/rclcpp.hpp>
            namespace p {
            class Slam : public rclcpp::Node {
            public:
              explicit Slam(const rclcpp::NodeOptions & options) : Node("slam", options) {
                pub_ = create_publisher<std_msgs::msg::Bool>("~/done", 1);
              }
              rclcpp::Publisher<std_msgs::msg::Bool>::SharedPtr pub_;
            };
            class AsyncSlam : public Slam {
            public:
              explicit AsyncSlam(const rclcpp::NodeOptions & options) : Slam(options) {}
            };
            }
            RCLCPP_COMPONENTS_REGISTER_NODE(p::AsyncSlam)
        """,
    }
    found = graph(files)
    assert [node.name for node in found.nodes] == ["/slam"]
    assert {one.topic for one in found.endpoints if one.role == "publisher" and not one.implied} == {"/slam/done"}


@pytest.mark.parametrize(("method", "topic"), [
    ('std::string getName() { return "going"; }', "/going"),
    ("std::string getName() { return get_name(); }", "/guide"),
])  # fmt: skip
def test_a_method_of_the_code_is_not_the_name_of_the_node(method, topic):
    found = graph({"p/guide.cpp": f"""
        #include <rclcpp/rclcpp.hpp>
        class Guide : public rclcpp::Node {{
        public:
          Guide() : Node("guide") {{ pub_ = create_publisher<std_msgs::msg::Bool>(getName(), 1); }}
          {method}
          rclcpp::Publisher<std_msgs::msg::Bool>::SharedPtr pub_;
        }};
        int main(int argc, char ** argv) {{ rclcpp::init(argc, argv); rclcpp::spin(std::make_shared<Guide>()); }}
    """})  # fmt: skip
    assert {one.topic for one in found.endpoints if one.role == "publisher" and not one.implied} == {topic}


def test_of_several_calls_the_one_that_stands_in_the_argument_tells_the_name():
    found = graph({"p/gait.py": """
        import rclpy
        from rclpy.node import Node
        from std_msgs.msg import String

        class Gait(Node):
            def __init__(self):
                super().__init__("gait")
                self.declare_parameter("enable", True)
                self.declare_parameter("topic", "gait_command")
                if bool(self.get_parameter("enable").value):
                    self.create_subscription(
                        String,
                        str(self.get_parameter("topic").value),
                        print,
                        10,
                    )

        rclpy.init()
        rclpy.spin(Gait())
    """})  # fmt: skip
    assert {one.topic for one in found.endpoints if one.role == "subscriber"} == {"/gait_command"}


@pytest.mark.parametrize(("added", "topics"), [
    ('name.append("_metadata");', {"/map_metadata"}),
    ('if (argc > 1) name.append("_1"); name.append("_metadata");', {"/map_metadata", "/map_1_metadata"}),
    ("name.append(argv[1]);", {""}),
    ("names.append(argv[1]);", {"/map"}),
])  # fmt: skip
def test_what_is_added_to_the_end_of_a_string_belongs_to_the_name(added, topics):
    found = graph({"p/map.cpp": f"""
        #include <ros/ros.h>
        int main(int argc, char ** argv) {{
          ros::init(argc, argv, "map");
          ros::NodeHandle nh;
          std::string base = "map";
          std::string name(base), names;
          {added}
          ros::Publisher pub = nh.advertise<std_msgs::Empty>(name, 1);
        }}
    """}, ros=1)  # fmt: skip
    made = [one for one in found.endpoints if one.role == "publisher" and not one.implied]
    assert {one.topic for one in made} == topics
