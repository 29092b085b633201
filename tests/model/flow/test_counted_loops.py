"""Names of turns of loops that count to a number which a parameter, a constant or a launch gives."""

import pytest
from joining import graph

PYTHON = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool

COUNT = 2


class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.declare_parameter("number", 3)
        self.number = self.get_parameter("number").value
        BODY

    def find(self):
        return rclpy.find()


def main():
    rclpy.init()
    rclpy.spin(Talker())


main()
"""
MAKE = 'self.create_publisher(Bool, f"/x{i}", 1)'
PYTHON_CASES = [
    (f"for i in range(COUNT):\n    {MAKE}", {("/x0", "literal"), ("/x1", "literal")}),
    (f"for i in range(self.number):\n    {MAKE}", {("/x0", "default"), ("/x1", "default"), ("/x2", "default")}),
    (f"for i in range(1, COUNT + 1):\n    {MAKE}", {("/x1", "literal"), ("/x2", "literal")}),
    (f"for i in range(2, self.number):\n    {MAKE}", {("/x2", "default")}),
    (f"self.held = [{MAKE} for i in range(COUNT)]", {("/x0", "literal"), ("/x1", "literal")}),
    (f"for i in range(self.find()):\n    {MAKE}", set()),
    (f"for i in range(COUNT if self.find() else 3):\n    {MAKE}", set()),
]


@pytest.mark.parametrize(("body", "expected"), PYTHON_CASES)
def test_python(body, expected):
    found = graph({"p/talker.py": PYTHON.replace("BODY", body.replace("\n", "\n        "))})
    made = [e for e in found.endpoints if e.role == "publisher" and not e.implied]
    assert {(e.topic, e.how) for e in made if e.how not in ("partly", "unresolved")} == expected


CPP = """
    constexpr int kCount = 2;
    class Talker : public rclcpp::Node {
     public:
      Talker() : Node("talker") {
        number_ = declare_parameter("number", 3);
        HERE
      }
      int number_;
    };
    int main(int c, char** v) { rclcpp::init(c, v); rclcpp::spin(std::make_shared<Talker>()); }
"""


@pytest.mark.parametrize(
    ("limit", "expected"),
    [
        ("i < kCount", {("/x0", "literal"), ("/x1", "literal")}),
        ("i < number_", {("/x0", "default"), ("/x1", "default"), ("/x2", "default")}),
        ("i < this->number_", {("/x0", "default"), ("/x1", "default"), ("/x2", "default")}),
        ("i <= kCount", {("/x0", "literal"), ("/x1", "literal"), ("/x2", "literal")}),
        ("i < find()", set()),
        ("i < other_", set()),
    ],
)
def test_cpp(limit, expected):
    body = f'for (int i = 0; {limit}; ++i) create_publisher<std_msgs::msg::Bool>("x" + std::to_string(i), 1);'
    found = graph({"p/talker.cpp": CPP.replace("HERE", body)})
    made = [e for e in found.endpoints if e.role == "publisher" and not e.implied]
    assert {(e.topic, e.how) for e in made if e.how not in ("partly", "unresolved")} == expected
