"""Bases of Python classes whose constructors are called by the name of the class: `Node.__init__(self, name)`."""

import pytest
from joining import graph


def list_published(text):
    """Names of nodes and what they publish."""
    found = graph({"p/robot.py": text})
    names = {one.id: one.name for one in found.nodes}
    return {(names[e.node], e.topic) for e in found.endpoints if e.role == "publisher" and not e.implied}


HEAD = """
    import threading
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import String
"""
MAIN = """
    def main():
        rclpy.init()
        rclpy.spin(Robot())
    main()
"""


@pytest.mark.parametrize(("bases", "calls", "expected"), [
    ("Node", "Node.__init__(self, 'robot')", "/robot"),
    ("Node", "Node.__init__(self, node_name='robot')", "/robot"),
    ("threading.Thread, Node", "super().__init__()\n            Node.__init__(self, name)", "/given"),
    ("threading.Thread, Node", "threading.Thread.__init__(self)\n            Node.__init__(self, name)", "/given"),
    ("Node", "super().__init__('robot')", "/robot"),
    ("Node", "super(Robot, self).__init__('robot')", "/robot"),
])  # fmt: skip
def test_the_name_of_a_node_stands_behind_self(bases, calls, expected):
    text = f"""{HEAD}
    class Robot({bases}):
        def __init__(self, name="given"):
            {calls}
            self.create_publisher(String, "~/out", 1)
{MAIN}"""
    assert list_published(text) == {(expected, f"{expected}/out")}


@pytest.mark.parametrize("call", ["Base.__init__(self, 'one', 'left')", "super().__init__('one', 'left')"])
def test_a_base_of_the_code_is_given_what_stands_behind_self(call):
    text = f"""{HEAD}
    class Base(Node):
        def __init__(self, name, side):
            Node.__init__(self, name)
            self.create_publisher(String, side + "/out", 1)
    class Robot(Base):
        def __init__(self):
            {call}
{MAIN}"""
    assert list_published(text) == {("/one", "/left/out")}


def test_of_two_bases_each_is_given_its_own():
    text = f"""{HEAD}
    class Left:
        def __init__(self, side):
            self.left = self.create_publisher(String, side + "/l", 1)
    class Right:
        def __init__(self, side):
            self.right = self.create_publisher(String, side + "/r", 1)
    class Robot(Node, Left, Right):
        def __init__(self):
            Node.__init__(self, "robot")
            Left.__init__(self, "a")
            Right.__init__(self, "b")
{MAIN}"""
    assert list_published(text) == {("/robot", "/a/l"), ("/robot", "/b/r")}


def test_a_constructor_of_a_class_that_is_no_base_is_no_own_one():
    text = f"""{HEAD}
    class Other:
        def __init__(self, node, side):
            self.out = node.create_publisher(String, side + "/out", 1)
    class Robot(Node):
        def __init__(self):
            super().__init__("robot")
            self.other = Other(self, "a")
{MAIN}"""
    assert list_published(text) == {("/robot", "/a/out")}
