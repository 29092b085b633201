"""What the methods of other classes write into an object is as it is in the objects of these classes."""

import pytest
from joining import graph, manifest

PARTS = """
    #pragma once
    #include <rclcpp/rclcpp.hpp>
    #include <std_msgs/msg/empty.hpp>
    struct Config {
      std::string name = "";
      std::string suffix = "/raw";
    };
    class Sender {
    public:
      explicit Sender(std::shared_ptr<rclcpp::Node> node) : node_(node) {}
      void setup(const Config & config) {
        config_ = config;
        pub_ = node_->create_publisher<std_msgs::msg::Empty>(config_.name + config_.suffix, 1);
      }
    private:
      Config config_;
      std::shared_ptr<rclcpp::Node> node_;
      rclcpp::Publisher<std_msgs::msg::Empty>::SharedPtr pub_;
    };
    class Part {
    public:
      Part(const std::string & name, std::shared_ptr<rclcpp::Node> node) : node_(node), name_(name) {}
      std::string getName() { return name_; }
    protected:
      std::shared_ptr<rclcpp::Node> node_;
      std::string name_;
    };
    class Camera : public Part {
    public:
      Camera(const std::string & name, std::shared_ptr<rclcpp::Node> node) : Part(name, node), sender_(node) {
        Config config;
        WRITES
        sender_.setup(config);
      }
    private:
      Sender sender_;
    };
    class Clock : public Part {
    public:
      Clock(const std::string & name, std::shared_ptr<rclcpp::Node> node) : Part(name, node) {}
    };
"""
MAIN = """
    #include "parts.hpp"
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      auto node = std::make_shared<rclcpp::Node>("driver");
      auto clock = std::make_unique<Clock>("clock", node);
      MAKES
      rclcpp::spin(node);
    }
"""
CAMERA = 'auto camera = std::make_unique<Camera>("left", node);'


def list_certain(writes: str, makes: str) -> set[str]:
    files = {
        "p/package.xml": manifest("p", "ament_cmake"),
        "p/parts.hpp": PARTS.replace("WRITES", writes),
        "p/driver.cpp": MAIN.replace("MAKES", makes),
    }
    return {
        e.topic for e in graph(files).endpoints
        if e.role == "publisher" and not e.implied and e.how not in ("partly", "unresolved") and not e.only_if
    }  # fmt: skip


@pytest.mark.parametrize(
    ("makes", "expected"),
    [
        (CAMERA, {"/left/raw"}),
        (f'{CAMERA} auto other = std::make_unique<Camera>("right", node);', {"/left/raw", "/right/raw"}),
        ("", set()),  # no other name stands for that of a camera which nobody makes
    ],
)
def test_a_name_that_is_written_into_a_configuration(makes, expected):
    assert list_certain('config.name = "/" + getName();', makes) == expected


@pytest.mark.parametrize(
    ("writes", "expected"),
    [
        ('config.name = "cam";', {"/cam/raw"}),  # never what it is declared with
        ('config.name = "cam"; config.suffix = "/rect";', {"/cam/rect"}),
        ("", {"/raw"}),  # what it is declared with, where nothing takes its place
    ],
)
def test_what_each_maker_replaces_is_never_what_it_is_declared_with(writes, expected):
    assert list_certain(writes, CAMERA) == expected


def test_what_only_some_makers_replace_may_be_what_it_is_declared_with():
    assert list_certain('if (node->has_parameter("x")) { config.name = "cam"; }', CAMERA) != {"/cam/raw"}
