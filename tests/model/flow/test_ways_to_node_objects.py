"""On which of several nodes of a program a call is made, by the way that leads to it and the object it stands in."""

import pytest
from joining import graph

CPP = """
    #include <rclcpp/rclcpp.hpp>
    #include <std_msgs/msg/bool.hpp>
    using std_msgs::msg::Bool;
    class Wheel {
    public:
      explicit Wheel(std::shared_ptr<rclcpp::Node> & nh) : nh_(nh) { pub_ = nh_->create_publisher<Bool>("~/turn", 1); }
      std::shared_ptr<rclcpp::Node> nh_;
      rclcpp::Publisher<Bool>::SharedPtr pub_;
    };
    class Part {
    public:
      explicit Part(rclcpp::Node * node) : node_(node) {}
      rclcpp::Node * node_;
      rclcpp::Publisher<Bool>::SharedPtr pub_;
    };
    class Arm : public Part {
    public:
      explicit Arm(rclcpp::Node * node) : Part(node) { pub_ = node_->create_publisher<Bool>("~/arm", 1); }
    };
    class Leg : public Part {
    public:
      explicit Leg(rclcpp::Node * node) : Part(node) { pub_ = node_->create_publisher<Bool>("~/leg", 1); }
    };
    class First : public rclcpp::Node {
    public:
      First() : Node("first") {
        nh_ = std::shared_ptr<::rclcpp::Node>(this, [](::rclcpp::Node *) {});
        arm_ = std::make_unique<Arm>(this);
      }
      std::shared_ptr<rclcpp::Node> nh_;
      std::unique_ptr<Arm> arm_;
    };
    class Second : public rclcpp::Node {
    public:
      Second() : Node("second") {
        nh_ = std::shared_ptr<::rclcpp::Node>(this, [](::rclcpp::Node *) {});
        wheel_ = std::make_unique<Wheel>(nh_);
        leg_ = std::make_unique<Leg>(this);
      }
      std::shared_ptr<rclcpp::Node> nh_;
      std::unique_ptr<Wheel> wheel_;
      std::unique_ptr<Leg> leg_;
    };
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      auto first = std::make_shared<First>();
      auto second = std::make_shared<Second>();
      rclcpp::spin(first);
    }
"""
PYTHON = """
import rclpy
from rclpy.action import ActionClient
from rclpy.node import Node
from std_msgs.msg import Bool


class Mover:
    def __init__(self, node):
        self.node = node
        self.client = ActionClient(node=self.node, action_type=Bool, action_name="move")


class Picker(Node):
    def __init__(self):
        super().__init__("picker")
        self.mover = Mover(node=self)


class Mission(Node):
    def __init__(self):
        super().__init__("mission")
        self.picker = Picker()


def add(node, name):
    return node.create_publisher(Bool, name, 1)


def main():
    rclpy.init()
    MAIN


main()
"""


def list_made(files: dict[str, str]) -> set[tuple[str, str]]:
    found = graph(files)
    names = {node.id: node.name for node in found.nodes}
    made = [one for one in found.endpoints if one.role in ("publisher", "action client") and not one.implied]
    return {(names[one.node], one.topic) for one in made if not one.only_if}


def test_a_handle_that_is_made_of_the_node_itself_and_a_base_that_keeps_one():
    assert list_made({"p/robot.cpp": CPP}) == {
        ("/first", "/first/arm"), ("/second", "/second/turn"), ("/second", "/second/leg"),
    }  # fmt: skip


@pytest.mark.parametrize(
    ("main", "expected"),
    [
        ("rclpy.spin(Mission())", {("/picker", "/move")}),
        (
            'one = Node("one")\n    two = Node("two", namespace="deep")\n    add(one, "a")\n    add(two, "b")',
            {("/one", "/a"), ("/deep/two", "/deep/b")},
        ),
        (
            'one = Node("one")\n    two = Node("two")\n    add(one, "a")\n    add(two, "a")\n    add(two, "b")',
            {("/one", "/a"), ("/two", "/a"), ("/two", "/b")},
        ),
    ],
)
def test_each_node_has_what_it_is_given_with(main, expected):
    assert list_made({"p/main.py": PYTHON.replace("MAIN", main)}) == expected
