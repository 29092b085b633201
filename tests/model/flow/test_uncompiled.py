"""Sources that no target compiles belong to no node, where CMake says completely what is compiled."""

import pytest
from joining import graph_on_disk, manifest

CLASS = """
    #include "arm/base.hpp"
    class {name} : public Base {{
     public:
      explicit {name}(rclcpp::Node::SharedPtr node) : Base(node) {{}}
      void begin() override {{ pub_ = node_->create_publisher<std_msgs::msg::Empty>("{topic}", 1); }}
      rclcpp::Publisher<std_msgs::msg::Empty>::SharedPtr pub_;
    }};
    std::shared_ptr<Base> make_{topic}(rclcpp::Node::SharedPtr node) {{ return std::make_shared<{name}>(node); }}
"""
COMPONENT = """
    #include <rclcpp/rclcpp.hpp>
    class Grip : public rclcpp::Node {
     public:
      explicit Grip(const rclcpp::NodeOptions & options) : Node("grip", options) {
        pub_ = create_publisher<std_msgs::msg::Empty>("grip", 1);
      }
      rclcpp::Publisher<std_msgs::msg::Empty>::SharedPtr pub_;
    };
    RCLCPP_COMPONENTS_REGISTER_NODE(Grip)
"""
FILES = {
    "arm/package.xml": manifest("arm", "ament_cmake"),
    "arm/include/arm/base.hpp": """
        #include <rclcpp/rclcpp.hpp>
        class Base {
         public:
          explicit Base(rclcpp::Node::SharedPtr node) : node_(node) {}
          virtual void begin() = 0;
          rclcpp::Node::SharedPtr node_;
        };
        std::shared_ptr<Base> make_now(rclcpp::Node::SharedPtr node);
    """,
    "arm/src/main.cpp": """
        #include "arm/base.hpp"
        int main(int c, char ** v) {
          rclcpp::init(c, v);
          auto node = std::make_shared<rclcpp::Node>("arm");
          std::shared_ptr<Base> joint = make_now(node);
          joint->begin();
          rclcpp::spin(node);
        }
    """,
    "arm/src/now.cpp": CLASS.format(name="Now", topic="now"),
    # The class that main() does not make, of an older name and of the same.
    "arm/src/then.cpp": CLASS.format(name="Then", topic="then"),
    "arm/old/now.cpp": CLASS.format(name="Now", topic="old"),
    "arm/src/grip.cpp": COMPONENT,
}
HEAD = "cmake_minimum_required(VERSION 3.10)\nproject(arm)\nfind_package(ament_cmake REQUIRED)\n"
ALL = {"arm/src/then.cpp", "arm/old/now.cpp", "arm/src/grip.cpp"}


@pytest.mark.parametrize(
    ("cmake", "more", "names", "uncompiled"),
    [
        ("add_executable(arm src/main.cpp src/now.cpp)", {}, {"/now"}, ALL),
        ("add_executable(arm ${OWN})", {}, {"/now", "/then", "/old", "/grip"}, set()),
        ("file(GLOB OWN src/*.cpp)\nadd_executable(arm ${OWN})", {}, {"/now", "/then", "/grip"}, {"arm/old/now.cpp"}),
        ("file(GLOB UI ui/*.qrc)\nqt5_add_resources(MADE ${UI})\nadd_executable(arm src/main.cpp src/now.cpp ${MADE})",
         {}, {"/now"}, ALL),
        # What is compiled under a condition may be compiled, and what a file includes is.
        ("add_executable(arm src/main.cpp src/now.cpp)\nif(OLD)\n  target_sources(arm PRIVATE src/then.cpp)\nendif()",
         {"arm/src/now.cpp": FILES["arm/src/now.cpp"] + '    #include "grip.cpp"\n'}, {"/now", "/then", "/grip"},
         {"arm/old/now.cpp"}),
        # Somebody unknown makes targets, or another package compiles the file.
        ("add_executable(arm src/main.cpp src/now.cpp)\nown_macro(${CMAKE_SOURCE_DIR})\ninclude(${WHERE}/more.cmake)",
         {}, {"/now", "/then", "/old", "/grip"}, set()),
        ("add_executable(arm src/main.cpp src/now.cpp)", {
            "leg/package.xml": manifest("leg", "ament_cmake"),
            "leg/CMakeLists.txt": "project(leg)\nadd_library(leg SHARED ../arm/src/then.cpp)\n",
        }, {"/now", "/then"}, ALL - {"arm/src/then.cpp"}),
        # Of a folder with a build of its own nothing is known.
        ("add_executable(arm src/main.cpp src/now.cpp)", {"arm/old/CMakeLists.txt": "project(old)\n"},
         {"/now", "/old"}, ALL - {"arm/old/now.cpp"}),
    ],
)  # fmt: skip
def test_what_nothing_compiles_is_in_no_node(tmp_path, cmake, more, names, uncompiled):
    found = graph_on_disk(tmp_path, {**FILES, "arm/CMakeLists.txt": f"{HEAD}{cmake}\nament_package()\n", **more})
    assert {one.topic for one in found.endpoints if one.role == "publisher" and not one.implied} == names
    assert set(found.coverage.uncompiled) == uncompiled
