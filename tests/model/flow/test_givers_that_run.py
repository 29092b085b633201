"""Of several that give a node to what they make, those count that the program runs; helpers of other packages."""

from joining import ends, graph, manifest

SHARED = """
    #pragma once
    #include <rclcpp/rclcpp.hpp>
    #include <std_msgs/msg/bool.hpp>
    class Reporter {
    public:
      explicit Reporter(rclcpp::Node::SharedPtr node) {
        pub_ = node->create_publisher<std_msgs::msg::Bool>("report", 1);
      }
      rclcpp::Publisher<std_msgs::msg::Bool>::SharedPtr pub_;
    };
    class Inner : public rclcpp::Node {
    public:
      Inner() : Node("inner") {}
      void begin() { reporter_ = std::make_unique<Reporter>(shared_from_this()); }
      std::unique_ptr<Reporter> reporter_;
    };
    class Outer : public rclcpp::Node {
    public:
      Outer() : Node("outer") { inner_ = std::make_shared<Inner>(); inner_->begin(); }
      std::shared_ptr<Inner> inner_;
    };
"""
PAIR = """
    #include "shared.hpp"
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      rclcpp::spin(std::make_shared<Outer>());
    }
"""
OTHER = """
    #include "shared.hpp"
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      auto node = std::make_shared<Outer>();
      Reporter reporter(node);
      rclcpp::spin(node);
    }
"""


def test_a_node_that_another_program_gives_is_none_of_this_program():
    files = {
        "p/CMakeLists.txt": """
            cmake_minimum_required(VERSION 3.16)
            project(p)
            find_package(ament_cmake REQUIRED)
            find_package(rclcpp REQUIRED)
            add_executable(pair pair.cpp)
            add_executable(other other.cpp)
            ament_package()
        """,
        "p/package.xml": manifest("p", "ament_cmake"),
        "p/shared.hpp": SHARED,
        "p/pair.cpp": PAIR,
        "p/other.cpp": OTHER,
    }
    found = graph(files)
    names = {node.id: node.name for node in found.nodes if node.executable == "pair"}
    assert {names[node] for node, topic, _ in ends(found, "publisher") if topic == "/report" and node in names} == {
        "/inner"
    }


def test_a_function_of_another_package_is_known_by_its_whole_name():
    build = """
        cmake_minimum_required(VERSION 3.16)
        project(NAME)
        find_package(ament_cmake REQUIRED)
        find_package(rclcpp REQUIRED)
        add_executable(NAME main.cpp)
        ament_package()
    """
    main = """
        #include <rclcpp/rclcpp.hpp>
        #include "tools/names.hpp"
        int main(int argc, char ** argv) {
          rclcpp::init(argc, argv);
          auto node = std::make_shared<rclcpp::Node>("asker");
          auto pub = node->create_publisher<std_msgs::msg::Bool>(tools::names::below("robot", "state"), 1);
          auto other = node->create_publisher<std_msgs::msg::Bool>(names::below("robot", "other"), 1);
          rclcpp::spin(node);
        }
    """
    names = """
        #include "tools/names.hpp"
        namespace tools::names {
        std::string below(const std::string & above, const std::string & name) { return above + "/" + name; }
        }
    """
    files = {
        "tools/CMakeLists.txt": build.replace("add_executable(NAME main.cpp)", "add_library(tools names.cpp)").replace(
            "NAME", "tools"
        ),
        "tools/package.xml": manifest("tools", "ament_cmake"),
        "tools/include/tools/names.hpp": "#include <string>\nnamespace tools::names { std::string below(A a, A b); }\n",
        "tools/names.cpp": names,
        "asker/CMakeLists.txt": build.replace("NAME", "asker"),
        "asker/package.xml": manifest("asker", "ament_cmake"),
        "asker/main.cpp": main,
    }
    found = graph(files)
    assert {topic for _, topic, _ in ends(found, "publisher")} == {"/robot/state", "?"}


def test_lists_are_those_that_the_program_itself_gives():
    shared = """
        from rclpy.node import Node
        from std_msgs.msg import Empty
        class Panel(Node):
            def __init__(self, name, topics, more=("/more",)):
                super().__init__(name)
                self.topics = topics
                for topic in self.topics:
                    self.create_publisher(Empty, topic, 1)
                for topic in more:
                    self.create_publisher(Empty, topic, 1)
    """
    program = """
        import rclpy
        from deck.panel import Panel
        def main():
            rclpy.spin(Panel(%s))
    """
    files = {
        "deck/deck/panel.py": shared, "deck/deck/__init__.py": "",
        "deck/one.py": program % "'one', ['/a', '/b']", "deck/two.py": program % "'two', ['/c'], ('/d',)",
    }  # fmt: skip
    found = {
        (node, topic) for node, topic, _ in ends(graph(files), "publisher") if node in ("deck/one.py", "deck/two.py")
    }
    assert found == {
        ("deck/one.py", "/a"), ("deck/one.py", "/b"), ("deck/one.py", "/more"),
        ("deck/two.py", "/c"), ("deck/two.py", "/d"),
    }  # fmt: skip
