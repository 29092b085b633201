"""Conditions on parameters that nothing known gives a value: each branch depends on them."""

import pytest
from joining import graph

RIG = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool


class Rig(Node):
    def __init__(self):
        super().__init__("rig")
        self.declare_parameter("number"DEFAULT)
        number = self.get_parameter("number").value
        if number < 1:
            raise ValueError("number")
        if number == 2:
            self.create_subscription(Bool, "two", print, 1)
        else:
            self.create_subscription(Bool, "other", print, 1)
        self.create_subscription(Bool, "all", print, 1)


rclpy.init()
rclpy.spin(Rig())
"""


@pytest.mark.parametrize(
    ("default", "expected"),
    [
        ("", {("/two", "number == 2"), ("/other", "!(number == 2)"), ("/all", "")}),
        (", 1", {("/two", "number == 2"), ("/other", ""), ("/all", "")}),
        (", 2", {("/two", ""), ("/other", "!(number == 2)"), ("/all", "")}),
    ],
)
def test_both_branches_depend_on_a_parameter_without_a_value(default, expected):
    found = graph({"p/rig.py": RIG.replace("DEFAULT", default)})
    assert {(one.topic, one.only_if) for one in found.endpoints if one.role == "subscriber"} == expected
