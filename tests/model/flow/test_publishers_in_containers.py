"""Publish statements on publishers that stand in lists and dictionaries, and that loops and defaults hand on."""

import pytest
from joining import graph

PYTHON = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool


class Talker(Node):
    def __init__(self):
        super().__init__("talker")
        self.a = self.create_publisher(Bool, "/a", 1)
        self.b = self.create_publisher(Bool, "/b", 1)
        self.c = self.create_publisher(Bool, "/c", 1)
        self.named = {"x": self.create_publisher(Bool, "/x", 1), "y": self.create_publisher(Bool, "/y", 1)}
        self.held = []
        kept = self.create_publisher(Bool, "/kept", 1)
        self.held.append(kept)

    def send(self, message, publisher):
        publisher.publish(message)

    def tell(self):
        BODY


def main():
    rclpy.init()
    node = Talker()
    node.tell()
    rclpy.spin(node)


main()
"""
CASES = [
    ("for pub, value in [(self.a, True), (self.b, False)]:\n    pub.publish(Bool(data=value))", {"/a", "/b"}),
    ("for value, pub in ((True, self.a), (False, self.c)):\n    pub.publish(Bool(data=value))", {"/a", "/c"}),
    ("for pub in (self.a, self.b):\n    pub.publish(Bool())", {"/a", "/b"}),
    ("for name, pub in self.named.items():\n    pub.publish(Bool())", {"/x", "/y"}),
    ("for pub in self.named.values():\n    pub.publish(Bool())", {"/x", "/y"}),
    ("for pub in self.held:\n    pub.publish(Bool())", {"/kept"}),
    ("for place, pub in zip(range(1), self.held):\n    self.send(Bool(), pub)", {"/kept"}),
    ("hear = lambda message, to=self.b: to.publish(message)\nhear(Bool())", {"/b"}),
    ("pub = self.c\nself.create_subscription(Bool, '/in', lambda message, to=pub: to.publish(message), 1)", {"/c"}),
    ("for pub in self.unknown():\n    pub.publish(Bool())", set()),
]


@pytest.mark.parametrize(("body", "expected"), CASES)
def test_in_python(body, expected):
    found = graph({"p/talker.py": PYTHON.replace("BODY", body.replace("\n", "\n        "))})
    topics = {e.topic: e.path for e in found.endpoints if e.role == "publisher" and not e.implied}
    assert {one.topic for one in found.publishes if one.topic in topics} == expected
    lost = [one for one in found.coverage.unresolved if one.what == "publish" and one.written != "publisher"]
    assert bool(lost) == (not expected)
