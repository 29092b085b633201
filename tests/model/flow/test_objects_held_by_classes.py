"""Objects of classes with inherited constructors, and of templates that a class holds."""

import pytest
from joining import graph

HEAD = """
    #include <rclcpp/rclcpp.hpp>
    using String = std_msgs::msg::String;
"""
PART = """
    class Part {
     public:
      Part(rclcpp::Node * node, std::string name) : node_(node), name_(std::move(name)) {}
      void start() { pub_ = node_->create_publisher<String>(name_ + "/out", 1); }
     protected:
      rclcpp::Node * node_;
      std::string name_;
      rclcpp::Publisher<String>::SharedPtr pub_;
    };
"""
MAIN = """
    int main(int argc, char ** argv) { rclcpp::init(argc, argv); rclcpp::spin(std::make_shared<Robot>()); }
"""


def list_published(*parts):
    """(name of the node, topic) of the publishers of a program in C++."""
    found = graph({"p/robot.cpp": "".join((HEAD, *parts, MAIN))})
    names = {node.id: node.name for node in found.nodes}
    made = [one for one in found.endpoints if one.role == "publisher" and not one.implied]
    assert {one.only_if for one in made} == {""}
    return {(names[one.node], one.topic or "?") for one in made}


@pytest.mark.parametrize(("derived", "expected"), [
    ("class Wheel : public Part { public: using Part::Part; };", {("/robot", "/left/out"), ("/robot", "/right/out")}),
    ("class Wheel : public Part { public: Wheel(rclcpp::Node * node, std::string) : Part(node, \"own\") {} };",
     {("/robot", "/own/out")}),
])  # fmt: skip
def test_a_class_may_inherit_the_constructors_of_its_base(derived, expected):
    robot = """
    class Robot : public rclcpp::Node {
     public:
      Robot() : Node("robot") {
        left_ = std::make_unique<Wheel>(this, "left");
        right_ = std::make_unique<Wheel>(this, "right");
        left_->start();
        right_->start();
      }
      std::unique_ptr<Wheel> left_, right_;
    };
    """
    assert list_published(PART, derived, robot) == expected


def test_a_node_may_inherit_the_constructors_of_the_framework():
    base = """
    class Base : public rclcpp::Node {
     public:
      using rclcpp::Node::Node;
      void start() { pub_ = create_publisher<String>("out", 1); }
      rclcpp::Publisher<String>::SharedPtr pub_;
    };
    class Robot : public Base {
     public:
      Robot() : Base("robot") { start(); }
    };
    """
    assert list_published(base) == {("/<robot>", "/out")}


def test_an_object_of_a_template_is_given_what_its_member_is():
    port = """
    template <typename M> class Port {
     public:
      Port(rclcpp::Node & node, const std::string & name) { pub_ = node.create_publisher<M>(name + "/port", 1); }
      typename rclcpp::Publisher<M>::SharedPtr pub_;
    };
    class Robot : public rclcpp::Node {
     public:
      Robot() : Node("robot"), left_(*this, "left"), right_(*this, "right") {}
      Port<String> left_, right_;
    };
    """
    assert list_published(port) == {("/robot", "/left/port"), ("/robot", "/right/port")}
