"""A variable that is one node after another: what is made on it is on the node that it is there."""

import pytest
from joining import graph

PYTHON = """
import rclpy
from std_srvs.srv import Empty

def ask():
    node = rclpy.create_node("first")
    node.create_client(Empty, "one")
    BODY

def main():
    rclpy.init()
    ask()

main()
"""
CPP = """
    #include <rclcpp/rclcpp.hpp>
    using std_msgs::msg::Empty;
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      auto node = std::make_shared<rclcpp::Node>("first");
      auto a = node->create_publisher<Empty>("one", 1);
      BODY
    }
"""


def find_owners(found) -> set[tuple[str, str]]:
    names = {node.id: node.name for node in found.nodes}
    return {(names[one.node], one.topic) for one in found.endpoints if not one.implied}


SECOND = "node = rclpy.create_node('second')"
FIRST_ALONE = {("/first", "/one")}


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (f"{SECOND}\nnode.create_client(Empty, 'two')", {("/second", "/two")}),
        (f"for one in many:\n    {SECOND}\n    node.create_client(Empty, 'two')", {("/second", "/two")}),
        (f"if far:\n    {SECOND}\nnode.create_client(Empty, 'two')", {("/first", "/two"), ("/second", "/two")}),
        (f"if far:\n    {SECOND}\n    while near:\n        node.create_client(Empty, 'two')", {("/second", "/two")}),
        # What comes later is there in the next turn alone.
        (f"node.create_client(Empty, 'two')\n{SECOND}", {("/first", "/two")}),
        (f"while near:\n    node.create_client(Empty, 'two')\n    {SECOND}", {("/first", "/two"), ("/second", "/two")}),
        (f"while near:\n    {SECOND}\n    node.create_client(Empty, 'two')\n    node = rclpy.create_node('third')",
         {("/second", "/two")}),
        # Functions inside are called whenever.
        (f"def inner():\n    node.create_client(Empty, 'two')\n{SECOND}\ninner()",
         {("/first", "/two"), ("/second", "/two")}),
        # So is what other names are given.
        (f"other = node\n{SECOND}\nother.create_client(Empty, 'two')", {("/first", "/two")}),
    ],
)  # fmt: skip
def test_a_node_of_python_is_the_one_that_the_variable_is_there(body, expected):
    found = graph({"p/a.py": PYTHON.replace("BODY", body.replace("\n", "\n    "))})
    assert find_owners(found) == FIRST_ALONE | expected


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ('node = std::make_shared<rclcpp::Node>("second");\nauto b = node->create_publisher<Empty>("two", 1);',
         {("/second", "/two")}),
        ('if (argc > 1) {\nnode = std::make_shared<rclcpp::Node>("second");\n}\n'
         'auto b = node->create_publisher<Empty>("two", 1);', {("/first", "/two"), ("/second", "/two")}),
    ],
)  # fmt: skip
def test_a_node_of_cpp_is_the_one_that_the_variable_is_there(body, expected):
    found = graph({"p/src/a.cpp": CPP.replace("BODY", body.replace("\n", "\n      "))})
    assert find_owners(found) == FIRST_ALONE | expected


HELD = """
import rclpy
from std_srvs.srv import Empty

class Driver:
    def __init__(self, real):
        if real:
            self.node = rclpy.create_node("inner")
            self.node.create_client(Empty, "real")
        else:
            self.node = rclpy.create_node("simulated")
            self.node.create_client(Empty, "made")
        self.node.create_client(Empty, "both")
        self.more()

    def more(self):
        self.node.create_client(Empty, "more")

def main():
    rclpy.init()
    Driver(ask())

main()
"""


def test_a_node_that_an_object_keeps_is_the_one_that_a_branch_makes():
    assert find_owners(graph({"p/a.py": HELD})) == {
        ("/inner", "/real"), ("/simulated", "/made"), ("/inner", "/both"), ("/simulated", "/both"), ("/inner", "/more"),
        ("/simulated", "/more"),
    }  # fmt: skip
