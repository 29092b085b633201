"""Names of which the code has several, one at a time: of a node, behind a key, of a caught exception, of a method that
a deriving class replaces."""

import pytest
from joining import graph

PYTHON = """
import sys
import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool

TOPICS = {"a": "/at_a", "b": "/at_b"}


class Talker(Node):
    def __init__(self, front):
        super().__init__(NAME)
        self.declare_parameter("mode", "b")
        BODY


rclpy.init()
rclpy.spin(Talker(len(sys.argv) > 1))
"""


def list_made(name: str, body: str) -> set[tuple[str, str, str, str]]:
    found = graph({"p/talker.py": PYTHON.replace("NAME", name).replace("BODY", body)})
    names = {node.id: node.name for node in found.nodes}
    made = (one for one in found.endpoints if one.role == "publisher" and not one.implied)
    return {(names[one.node], one.topic, one.how, one.only_if) for one in made}


@pytest.mark.parametrize(
    ("name", "expected"),
    [('"talker"', "/talker"), ('"front" if front else "back"', '/<front_?_"front"_:_"back">')],
)
def test_a_node_that_has_one_of_two_names_is_not_called_by_the_first(name, expected):
    made = list_made(name, 'self.create_publisher(Bool, "/out", 1)')
    assert {node for node, *_ in made} == {expected}


@pytest.mark.parametrize("key", ['self.get_parameter("mode").value', "mode"])
def test_what_is_behind_a_parameter_is_no_more_certain_than_that(key):
    body = 'mode = self.get_parameter("mode").value\n        self.create_publisher(Bool, TOPICS[KEY], 1)'
    made = list_made('"talker"', body.replace("KEY", key))
    assert all(how not in ("literal", "given", "launch") for _, _, how, _ in made)


def test_what_a_caught_exception_replaces():
    body = """
        try:
            import fast
            topic = "fast"
        except ImportError:
            topic = "slow"
        self.create_publisher(Bool, topic, 1)
"""
    assert {(topic, only_if) for _, topic, _, only_if in list_made('"talker"', body)} == {
        ("/fast", "!(catch (ImportError))"), ("/slow", "catch (ImportError)"),
    }  # fmt: skip


CPP = """
    #include <rclcpp/rclcpp.hpp>
    class Base : public KIND {
     public:
      Base() : KIND("robot") { BEGIN }
      void start() { pub_ = create_publisher<std_msgs::msg::Bool>(topic(), 1); }
      virtual std::string topic() { return "base"; }
      CallbackReturn on_configure(const State &) { configured(); return CallbackReturn::SUCCESS; }
      void configured() { pub_ = create_publisher<std_msgs::msg::Bool>("configured", 1); }
      rclcpp::PublisherBase::SharedPtr pub_;
    };
    class Derived : public Base {
     public:
      std::string topic() override { return "derived"; }
    };
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      auto node = std::make_shared<Derived>();
      MAIN
      rclcpp::spin(node);
    }
"""


@pytest.mark.parametrize(
    ("begin", "main", "kind", "expected"),
    [
        ("pub_ = create_publisher<std_msgs::msg::Bool>(topic(), 1);", "", "rclcpp::Node", {"/base"}),
        ("", "node->start();", "rclcpp::Node", {"/derived"}),
        ("", "", "rclcpp::Node", set()),
        ("", "", "rclcpp_lifecycle::LifecycleNode", {"/configured"}),
    ],
)
def test_methods_that_run(begin, main, kind, expected):
    code = CPP.replace("BEGIN", begin).replace("MAIN", main).replace("KIND", kind)
    found = graph({"p/robot.cpp": code})
    made = [one for one in found.endpoints if one.role == "publisher" and not one.implied]
    assert {one.topic for one in made if not one.only_if} == expected


def test_a_class_of_the_code_that_is_called_like_its_base_is_not_that():
    code = CPP.replace("BEGIN", "").replace("MAIN", "").replace("KIND", "nav::LifecycleNode").replace(
        "    class Base", """    namespace nav {
    class LifecycleNode : public rclcpp_lifecycle::LifecycleNode {
     public:
      explicit LifecycleNode(const std::string & name) : rclcpp_lifecycle::LifecycleNode(name) {}
    };
    }
    class Base""", 1,
    ).replace('nav::LifecycleNode("robot")', 'LifecycleNode("robot")')
    found = graph({"p/robot.cpp": code})
    made = [one for one in found.endpoints if one.role == "publisher" and not one.implied]
    assert {one.topic for one in made if not one.only_if} == {"/configured"}


MACROS = """
    #include <rclcpp/rclcpp.hpp>
    #ifdef SIMULATED
    #define TOPIC "simulated"
    #else
    #define TOPIC OTHER
    #endif
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      auto node = std::make_shared<rclcpp::Node>("robot");
      auto pub = node->create_publisher<std_msgs::msg::Bool>(TOPIC, 1);
    }
"""


@pytest.mark.parametrize(
    ("other", "expected"),
    [
        ('"real"', {("/simulated", "`TOPIC` is defined so"), ("/real", "`TOPIC` is defined so")}),
        ('"simulated"', {("/simulated", "")}),
    ],
)
def test_which_of_two_definitions_of_a_macro_holds_is_not_known(other, expected):
    found = graph({"p/robot.cpp": MACROS.replace("OTHER", other)})
    made = [one for one in found.endpoints if one.role == "publisher" and not one.implied]
    assert {(one.topic, one.only_if) for one in made} == expected
