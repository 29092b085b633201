"""Nodes inside of a program that the launch file does not rename, since their options say otherwise."""

import pytest
from joining import ends, graph_on_disk, manifest

BUILD = """
    cmake_minimum_required(VERSION 3.16)
    project(p)
    find_package(ament_cmake REQUIRED)
    find_package(rclcpp REQUIRED)
    add_executable(server server.cpp)
    ament_package()
"""
CODE = """
    #include <rclcpp/rclcpp.hpp>
    using std_msgs::msg::Bool;
    class Server : public rclcpp::Node {
    public:
      Server() : Node("server") {
        INSIDE
        pub_ = inner_->create_publisher<Bool>("~/x", 1);
        own_ = create_publisher<Bool>("y", 1);
      }
      rclcpp::Publisher<Bool>::SharedPtr pub_, own_;
      rclcpp::Node::SharedPtr inner_, other_;
    };
    int main(int argc, char ** argv) { rclcpp::init(argc, argv); rclcpp::spin(std::make_shared<Server>()); }
"""
INNER = """
    class Inner : public rclcpp::Node {
    public:
      Inner(const std::string & name, const rclcpp::NodeOptions & options) : Node(name, options) {
        pub_ = create_publisher<Bool>("~/x", 1);
      }
      rclcpp::Publisher<Bool>::SharedPtr pub_;
    };
"""
LAUNCH = '<launch><node pkg="p" exec="server" name="it" namespace="robot"/></launch>'
ALONE = "rclcpp::NodeOptions().use_global_arguments(false)"
OUTER = ("/robot/it", "/robot/y")
RENAMED = ("/robot/it", "/robot/it/x")


def list_publishers(root, inside: str, launch: str = LAUNCH, more: str = "") -> set[tuple[str, str]]:
    files = {
        "p/package.xml": manifest("p", "ament_cmake"), "p/CMakeLists.txt": BUILD, "p/launch/p.launch.xml": launch,
        "p/server.cpp": CODE.replace("INSIDE", inside).replace("    class Server", f"{more}    class Server"),
    }  # fmt: skip
    return {(node, topic) for node, topic, _ in ends(graph_on_disk(root, files, "p/launch/p.launch.xml"), "publisher")}


@pytest.mark.parametrize(("inside", "expected"), [
    # What a launch file gives is for all nodes of the program.
    ('inner_ = std::make_shared<rclcpp::Node>("inner");', RENAMED),
    ('inner_ = std::make_shared<rclcpp::Node>("inner", rclcpp::NodeOptions().use_global_arguments(true));', RENAMED),
    (f'inner_ = std::make_shared<rclcpp::Node>("inner", {ALONE});', ("/inner", "/inner/x")),
    (f'inner_ = rclcpp::Node::make_shared("inner", "space", {ALONE});', ("/space/inner", "/space/inner/x")),
    ('rclcpp::NodeOptions options; options.use_global_arguments(false);'
     'inner_ = std::make_shared<rclcpp::Node>("inner", options);', ("/inner", "/inner/x")),
    ('rclcpp::NodeOptions options; options.arguments({"--ros-args", "-r", "__node:=other", "-r", "__ns:=/up"});'
     'inner_ = std::make_shared<rclcpp::Node>("inner", options);', ("/up/other", "/up/other/x")),
    ('auto options = rclcpp::NodeOptions().arguments({"--ros-args", "-r", "__node:=other"});'
     'inner_ = std::make_shared<rclcpp::Node>("inner", options);', ("/robot/other", "/robot/other/x")),
    ('inner_ = std::make_shared<rclcpp::Node>("_", rclcpp::NodeOptions().arguments({"-r", "__node:=inner"}));',
     ("/robot/inner", "/robot/inner/x")),
    # Its own remappings come before those of the launch.
    ('inner_ = std::make_shared<rclcpp::Node>("i", rclcpp::NodeOptions().arguments({"--ros-args", "-r", "~/x:=/z"}));',
     ("/robot/it", "/z")),
])  # fmt: skip
def test_the_options_of_an_inner_node_come_before_the_launch(tmp_path, inside, expected):
    assert list_publishers(tmp_path, inside) == {OUTER, expected}


def test_each_object_of_a_class_has_its_options(tmp_path):
    inside = f"""
        inner_ = std::make_shared<Inner>("a", {ALONE});
        other_ = std::make_shared<Inner>("b", rclcpp::NodeOptions());
    """
    launch = '<launch><node pkg="p" exec="server" namespace="robot"/></launch>'
    found = list_publishers(tmp_path, inside, launch, INNER)
    assert ("/a", "/a/x") in found and ("/robot/b", "/robot/b/x") in found
    assert not {"/robot/a", "/b"} & {node for node, _ in found}


def test_options_of_python(tmp_path):
    files = {
        "p/package.xml": manifest("p", "ament_python"),
        "p/setup.py": """
            from setuptools import setup
            setup(name="p", packages=["p"], entry_points={"console_scripts": ["server = p.server:main"]})
        """,
        "p/p/__init__.py": "",
        "p/p/server.py": """
            import rclpy
            from rclpy.node import Node
            from std_msgs.msg import Bool

            class Inner(Node):
                def __init__(self, name):
                    super().__init__(name, use_global_arguments=False)
                    self.pub = self.create_publisher(Bool, "~/x", 1)

            class Outer(Node):
                def __init__(self):
                    super().__init__("outer")
                    self.inner = Inner("inner")
                    self.pub = self.create_publisher(Bool, "y", 1)

            def main():
                rclpy.init()
                rclpy.spin(Outer())
        """,
        "p/launch/p.launch.xml": LAUNCH,
    }
    found = graph_on_disk(tmp_path, files, "p/launch/p.launch.xml")
    assert {(node, topic) for node, topic, _ in ends(found, "publisher")} == {OUTER, ("/inner", "/inner/x")}
