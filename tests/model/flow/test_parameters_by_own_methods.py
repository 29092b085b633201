"""Parameters that a method of the code's own declares or reads, which is called like one of the framework's."""

from joining import graph, manifest
from rosimpact.impact.model.flow.graph import Graph

HANDLER = """
    #pragma once
    #include <rclcpp/rclcpp.hpp>
    class Handler {
    public:
      Handler(std::shared_ptr<rclcpp::Node> node, const std::string & name) : node_(node), name_(name) {}
      template <typename T> T getParam(const std::string & parameter) {
        T value;
        node_->get_parameter<T>(name_ + "." + parameter, value);
        return value;
      }
      std::shared_ptr<rclcpp::Node> node_;
      std::string name_;
    };
"""
STEREO = """
    #include "handler.hpp"
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      auto node = std::make_shared<rclcpp::Node>("driver");
      auto handler = std::make_unique<Handler>(node, "stereo");
      int width = handler->getParam<int>("width");
      bool align = handler->getParam<bool>("align");
      rclcpp::spin(node);
    }
"""
CAMERA = """
    #include <rclcpp/rclcpp.hpp>
    class Camera : public rclcpp::Node {
    public:
      Camera() : Node("camera") {
        getParam("general.timeout", timeout_, timeout_);
        getParam("general.rate", rate_, rate_, 1);
      }
      template <typename T> void getParam(std::string name, T given, T & value) {
        this->declare_parameter(name, rclcpp::ParameterValue(given));
        this->get_parameter(name, value);
      }
      template <typename T> void getParam(std::string name, T given, T & value, int least) {
        this->declare_parameter(name, rclcpp::ParameterValue(given));
        this->get_parameter(name, value);
      }
      int timeout_ = 5;
      double rate_ = 10.0;
    };
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      rclcpp::spin(std::make_shared<Camera>());
    }
"""


def list_parameters(found: Graph) -> set[tuple[str, str, str, int]]:
    return {(one.name, one.kind, one.path, one.line) for one in found.parameters}


def test_a_template_method_of_another_class_behind_its_prefix():
    files = {"p/package.xml": manifest("p", "ament_cmake"), "p/handler.hpp": HANDLER, "p/driver.cpp": STEREO}
    assert list_parameters(graph(files)) == {
        ("stereo.width", "read", "p/driver.cpp", 7), ("stereo.align", "read", "p/driver.cpp", 8),
    }  # fmt: skip


def test_a_template_method_with_overloads_in_a_node():
    found = list_parameters(graph({"p/package.xml": manifest("p", "ament_cmake"), "p/camera.cpp": CAMERA}))
    assert {(name, kind, line) for name, kind, _, line in found} == {
        ("general.timeout", "declared", 6), ("general.timeout", "read", 6),
        ("general.rate", "declared", 7), ("general.rate", "read", 7),
    }  # fmt: skip


def test_a_method_whose_callers_are_the_framework_s_own_calls_gives_each_once():
    files = {
        "p/package.xml": manifest("p", "ament_cmake"),
        "p/node.cpp": """
            #include <rclcpp/rclcpp.hpp>
            class Own : public rclcpp::Node {
            public:
              Own() : Node("own") { declare_parameter("rate", 5); }
              template <typename T> void declare_parameter(const std::string & name, T value) {
                rclcpp::Node::declare_parameter(name, value);
              }
            };
            int main(int argc, char ** argv) {
              rclcpp::init(argc, argv);
              rclcpp::spin(std::make_shared<Own>());
            }
        """,
    }
    assert list_parameters(graph(files)) == {("rate", "declared", "p/node.cpp", 5)}
