"""Methods that a class is asked for by its name: what they declare, give and make."""

import pytest
from joining import ends, graph

HEAD = """
from dataclasses import dataclass
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

@dataclass(frozen=True)
class Config:
    limit: float
    said: str
    heard: str

    @staticmethod
    def declare(node: Node) -> None:
        node.declare_parameter("limit", 0.5)
        node.declare_parameter("said", "/said")
        node.declare_parameter("heard_name", "/heard")

    @classmethod
    def from_node(cls, node: Node) -> "Config":
        MAKE

    @staticmethod
    def open(node, name):
        node.create_publisher(String, name, 1)

class Part:
    def __init__(self, node, config: Config):
        self.pub = node.create_publisher(String, config.said, 1)

class Base(Node):
    def begin(self, name):
        self.create_publisher(String, name, 1)

class Desk(Base):
    def __init__(self):
        super().__init__("desk")
        Config.declare(self)
        self.config = Config.from_node(self)
        self.create_subscription(String, self.config.heard, self.note, 1)
        self.part = Part(self, self.config)
        Config.open(self, "/opened")
        BESIDE

    def note(self, message):
        pass

def main():
    rclpy.init()
    rclpy.spin(Desk())

main()
"""
FIELDS = """(
            limit=float(node.get_parameter("limit").value),
            said=str(
                node.get_parameter("said").value
            ),
            heard=str(node.get_parameter("heard_name").value),
        )"""


@pytest.mark.parametrize(
    "make",
    [
        f"return cls{FIELDS}",
        f"return Config{FIELDS}",
        f"config = cls{FIELDS}\n        return config",
    ],
)
def test_fields_of_what_a_method_of_the_class_makes(make):
    found = graph({"desk/desk.py": HEAD.replace("MAKE", make).replace("BESIDE", "pass")})
    # Nobody calls the method of the base, whose name is open.
    assert {topic for _, topic, _ in ends(found, "publisher")} == {"/said", "/opened", "?"}
    assert {topic for _, topic, _ in ends(found, "subscriber")} == {"/heard"}
    assert {one.name for one in found.parameters} >= {"limit", "said", "heard_name"}


def test_a_method_of_a_base_is_given_the_object():
    """`Base.begin(self, name)`: its first argument is no name."""
    text = HEAD.replace("MAKE", f"return cls{FIELDS}").replace("BESIDE", 'Base.begin(self, "/begun")')
    names = {topic for _, topic, _ in ends(graph({"desk/desk.py": text}), "publisher")}
    assert names - {"?"} == {"/said", "/opened"}
