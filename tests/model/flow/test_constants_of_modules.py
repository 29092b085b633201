"""What a variable of a module of Python is worth behind the module's body, which may replace it."""

import pytest
from joining import graph

CODE = """
import sys
import rclpy
from std_msgs.msg import Bool

on = True
off = False
asked = len(sys.argv) > 1
BODY


class Talker(rclpy.node.Node):
    def __init__(self):
        super().__init__("talker")
        self.create_publisher(Bool, topic, 1)

    def change(self):
        CHANGE


rclpy.init()
rclpy.spin(Talker())
"""


@pytest.mark.parametrize(("body", "change", "expected"), [
    ("topic = '/a'\nif on:\n    topic = '/b'", "", {("/b", "")}),
    ("topic = '/a'\nif off:\n    topic = '/b'", "", {("/a", "")}),
    ("topic = '/a'\nif not off:\n    topic = '/b'", "", {("/b", "")}),
    ("if on:\n    topic = '/a'\nelse:\n    topic = '/b'", "", {("/a", "")}),
    ("topic = '/a'\nif True:\n    topic = '/b'", "", {("/b", "")}),
    ("kind = 'x'\ntopic = '/a'\nif kind == 'x':\n    topic = '/b'", "", {("/b", "")}),
    ("topic = '/a'\ntopic = '/b'", "", {("/b", "")}),
    # What is not decided may be either.
    ("topic = '/a'\nif asked:\n    topic = '/b'", "", {("/a", "!asked"), ("/b", "asked")}),
    ("topic = '/a'\nif on and asked:\n    topic = '/b'", "", {("/a", "!(on and asked)"), ("/b", "on and asked")}),
    ("try:\n    import fast\n    topic = '/a'\nexcept ImportError:\n    topic = '/b'", "",
     {("/a", "!(catch (ImportError))"), ("/b", "catch (ImportError)")}),
    # A constant that something changes is none.
    ("topic = '/a'\nif on:\n    topic = '/b'", "global on\n        on = False", {("/a", "!on"), ("/b", "on")}),
    # What functions write stays beside it.
    ("topic = '/a'\nif on:\n    topic = '/b'", "global topic\n        topic = '/c'", {("/b", ""), ("/c", "")}),
])  # fmt: skip
def test_what_replaces_a_variable_of_a_module(body, change, expected):
    found = graph({"p/talker.py": CODE.replace("BODY", body).replace("CHANGE", change or "pass")})
    made = (one for one in found.endpoints if one.role == "publisher" and not one.implied)
    assert {(one.topic, one.only_if) for one in made} == expected


def test_what_is_called_in_between_sees_the_first():
    code = """
        import rclpy
        from std_msgs.msg import Bool

        def say():
            node.create_publisher(Bool, topic, 1)

        rclpy.init()
        node = rclpy.create_node("talker")
        topic = "/a"
        say()
        topic = "/b"
        say()
    """
    found = graph({"p/talker.py": code})
    assert {one.topic for one in found.endpoints if one.role == "publisher" and not one.implied} == {"/a", "/b"}
