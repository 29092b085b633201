"""Methods of objects that variables of Python are worth: `declare = self.declare_parameter`."""

import pytest
from joining import graph

NODE = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool


def declare_all(node):
    declare = node.declare_parameter
    declare("far", "/far")


class Talker(Node):
    def __init__(self, fast):
        super().__init__("talker")
        BODY

    def create(self, kind, name, depth):
        pass


def main():
    rclpy.init()
    rclpy.spin(Talker(rclpy.fast()))


main()
"""
CASES = [
    ("make = self.create_publisher\nmake(Bool, '/a', 1)", {("/a", "literal")}),
    ("declare = self.declare_parameter\ndeclare('p', '/b')\n"
     "self.create_publisher(Bool, self.get_parameter('p').value, 1)", {("/b", "default")}),
    ("make = self.create_publisher\ndef inner(name):\n    make(Bool, name, 1)\ninner('/c')", {("/c", "literal")}),
    ("make = self.create_publisher\nshort = lambda name: make(Bool, name, 1)\nshort('/d')", {("/d", "literal")}),
    ("declare_all(self)\nread = self.get_parameter\nself.create_publisher(Bool, read('far').value, 1)",
     {("/far", "default")}),
    # Of one that is worth something else, too, it is not known what it calls.
    ("make = self.create_publisher if fast else self.create\nmake(Bool, '/e', 1)", set()),
    ("if fast:\n    make = self.create_publisher\nelse:\n    make = self.create\nmake(Bool, '/f', 1)", set()),
    ("make = self.create\nmake(Bool, '/g', 1)", set()),
    # What is assigned later is not what was called before.
    ("make = self.create_publisher\nmake(Bool, '/h', 1)\nmake = self.create\nmake(Bool, '/i', 1)",
     {("/h", "literal")}),
]  # fmt: skip


@pytest.mark.parametrize(("body", "expected"), CASES)
def test_methods_in_variables(body, expected):
    found = graph({"p/talker.py": NODE.replace("BODY", body.replace("\n", "\n        "))})
    assert {(e.topic, e.how) for e in found.endpoints if e.role == "publisher" and not e.implied} == expected
