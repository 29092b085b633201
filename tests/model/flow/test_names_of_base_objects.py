"""A base class is given its name by each object that is made, not by objects of other derived classes."""

import pytest
from joining import graph, manifest

PARTS = """
    #pragma once
    #include <rclcpp/rclcpp.hpp>
    #include <std_msgs/msg/empty.hpp>
    class Part {
    public:
      Part(const std::string & name, std::shared_ptr<rclcpp::Node> node) : node_(node), name_(name) {}
      std::string getName() { return name_; }
      std::shared_ptr<rclcpp::Node> getNode() { return node_; }
    private:
      std::shared_ptr<rclcpp::Node> node_;
      std::string name_;
    };
    class Inner : public Part {
    public:
      Inner(const std::string & name, std::shared_ptr<rclcpp::Node> node) : Part(name, node) {}
      void setup() { pub_ = getNode()->create_publisher<std_msgs::msg::Empty>(getName() + "/found", 1); }
      rclcpp::Publisher<std_msgs::msg::Empty>::SharedPtr pub_;
    };
    class Outer : public Part {
    public:
      Outer(const std::string & name, std::shared_ptr<rclcpp::Node> node) : Part(name, node) {
        inner_ = std::make_unique<Inner>(GIVEN, getNode());
        inner_->setup();
      }
      std::unique_ptr<Inner> inner_;
    };
    class Clock : public Part {
    public:
      Clock(const std::string & name, std::shared_ptr<rclcpp::Node> node) : Part(name, node) {
        pub_ = getNode()->create_publisher<std_msgs::msg::Empty>(getName() + "/ticks", 1);
      }
      rclcpp::Publisher<std_msgs::msg::Empty>::SharedPtr pub_;
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


def list_certain(given: str, makes: str) -> set[str]:
    files = {
        "p/package.xml": manifest("p", "ament_cmake"),
        "p/parts.hpp": PARTS.replace("GIVEN", given),
        "p/driver.cpp": MAIN.replace("MAKES", makes),
    }
    found = graph(files)
    return {
        e.topic for e in found.endpoints
        if e.role == "publisher" and not e.implied and e.how not in ("partly", "unresolved") and not e.only_if
    }  # fmt: skip


@pytest.mark.parametrize(
    "given, named", [("getName()", ""), ('getName() + "_inner"', "_inner"), ("name", ""), ('"fixed"', "fixed")]
)
def test_an_object_that_hands_its_own_name_on_to_another_of_the_same_base(given: str, named: str):
    outer = 'auto outer = std::make_unique<Outer>("nn", node);'
    whole = named if named == "fixed" else f"nn{named}"
    assert list_certain(given, outer) == {"/clock/ticks", f"/{whole}/found"}


def test_each_of_several_outer_objects_gives_its_own():
    outer = 'auto a = std::make_unique<Outer>("left", node); auto b = std::make_unique<Outer>("right", node);'
    assert list_certain("getName()", outer) == {"/clock/ticks", "/left/found", "/right/found"}


def test_where_nobody_is_seen_to_make_the_outer_object_no_other_name_stands_for_it():
    assert list_certain("getName()", "") == {"/clock/ticks"}
