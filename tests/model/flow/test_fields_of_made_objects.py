"""Fields of classes of Python whose constructors are not written: data classes, named tuples."""

import pytest
from joining import graph


def find_names(head, body, made):
    """Names of the publishers of a node that an object is given to."""
    text = f"""
        import rclpy
        from dataclasses import dataclass
        from typing import NamedTuple
        from rclpy.node import Node
        from std_msgs.msg import String
        {head}
            out: str = "/plain"
            side: str = "/side"
        class Robot(Node):
            def __init__(self, config: Config):
                super().__init__("robot")
                self.config = config
                self.create_publisher(String, {body}, 1)
        def main():
            rclpy.init()
            rclpy.spin(Robot({made}))
        main()
    """
    found = graph({"p/robot.py": text})
    return {one.topic or "?" for one in found.endpoints if one.role == "publisher" and not one.implied}


DATA, TUPLE = "@dataclass\n        class Config:", "class Config(NamedTuple):"


@pytest.mark.parametrize("head", [DATA, TUPLE])
@pytest.mark.parametrize(("made", "out", "side"), [
    ("Config()", "/plain", "/side"),
    ("Config(out='/given')", "/given", "/side"),
    ("Config('/given')", "/given", "/side"),
    ("Config('/given', side='/left')", "/given", "/left"),
    ("Config(side='/left')", "/plain", "/left"),
    ("Config(**ask())", "?", "?"),
    ("Config(out=ask())", "?", "/side"),
])  # fmt: skip
def test_a_field_is_what_it_is_given(head, made, out, side):
    assert find_names(head, "self.config.out", made) == {out}
    assert find_names(head, "self.config.side", made) == {side}


def test_a_written_constructor_says_what_a_member_is():
    head = "class Config:\n            def __init__(self, out):\n                self.out = '/own'"
    assert find_names(head, "self.config.out", "Config(out='/given')") == {"/own"}
