"""Variables of a function of Python in the methods of a class that it makes, and what stands in place of nothing."""

import pytest
from joining import graph

AROUND = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool

TOPIC = "/of_module"


def make_class(name, topic):
    class Talker(Node):
        TOPIC = "/of_class"

        def __init__(self):
            super().__init__("talker")
            self.create_publisher(Bool, WRITTEN, 1)

    return Talker


def main():
    rclpy.init()
    rclpy.spin(make_class("one", "/given")())


main()
"""


@pytest.mark.parametrize(
    ("written", "expected"),
    [("topic", {"/given"}), ('topic + "/x"', {"/given/x"}), ("TOPIC", {"/of_module"}), ("self.TOPIC", {"/of_class"})],
)
def test_variables_around_a_class(written, expected):
    found = graph({"p/talker.py": AROUND.replace("WRITTEN", written)})
    assert {e.topic for e in found.endpoints if e.role == "publisher" and not e.implied} == expected


FALLBACK = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool


class Link:
    def __init__(self, node, topic=None):
        self.topic = topic or "/own"
        node.create_publisher(Bool, self.topic, 1)


def main(fast):
    rclpy.init()
    node = Node("talker")
    MADE
    rclpy.spin(node)


main(rclpy.fast())
"""


@pytest.mark.parametrize(
    ("made", "expected"),
    [
        ("Link(node)", {("/own", "")}),
        ("Link(node, None)", {("/own", "")}),
        ('Link(node, "/given")', {("/given", "")}),
        ('Link(node, "/given" if fast else None)', {("/given", "fast"), ("/own", "!fast")}),
        ('Link(node, "/given" if fast else "")', {("/given", "fast"), ("/own", "!fast")}),
        ('Link(node, "/given")\n    Link(node)', {("/given", ""), ("/own", "")}),
    ],
)
def test_what_stands_in_place_of_nothing(made, expected):
    found = graph({"p/talker.py": FALLBACK.replace("MADE", made)})
    assert {(e.topic, e.only_if) for e in found.endpoints if e.role == "publisher" and not e.implied} == expected
