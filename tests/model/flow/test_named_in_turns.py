"""Parameters that loops declare, and members that they set, under names that are put together in each turn."""

import pytest
from joining import graph, graph_on_disk, manifest

NODE = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool

DEFAULTS = {"out_topic": "/out", "in_topic": "/in", "rate": 3.0, "on": False}


class Base(Node):
    def load_all(self):
        for name, value in DEFAULTS.items():
            setattr(self, name, value)


class Talker(BASE):
    def __init__(self):
        super().__init__("talker")
        BODY
METHODS


class Other(Node):
    def __init__(self):
        super().__init__("other")
        for name, value in {"out_topic": "/of_other"}.items():
            setattr(self, name, value)


def main():
    rclpy.init()
    rclpy.spin(Talker())
    rclpy.spin(Other())


main()
"""


METHODS = {
    "declare_all": """
    def declare_all(self):
        for name, value in DEFAULTS.items():
            self.declare_parameter(name, value)
""",
    "read_all": """
    def read_all(self):
        for name in DEFAULTS:
            setattr(self, name, self.get_parameter(name).value)
""",
    "read_one": """
    def read_one(self, name, default):
        self.declare_parameter(name + "_topic", default)
        setattr(self, name, self.get_parameter(name + "_topic").value)
""",
}


def write_node(body: str, base: str = "Node") -> str:
    """A program whose node does something when it is made, with the methods that it calls then."""
    methods = "".join(text for name, text in METHODS.items() if name in body)
    return NODE.replace("METHODS", methods).replace("BASE", base).replace("BODY", body.replace("\n", "\n        "))


def list_made(body: str, base: str = "Node") -> set[tuple[str, str, str]]:
    """Name, how it is known and condition of each publisher; `?` for a call whose name is not known, or not alone."""
    found = graph({"p/talker.py": write_node(body, base)})
    made = [one for one in found.endpoints if one.role == "publisher" and not one.implied]
    lost = {("?", "", "")} if any(one.what == "publisher name" for one in found.coverage.unresolved) else set()
    return {(one.topic, one.how, one.only_if) for one in made if one.topic} | lost


PUB = "self.create_publisher(Bool, {}, 1)"
OUT = PUB.format("self.out_topic")


@pytest.mark.parametrize(("body", "expected"), [
    # By parameters of a dictionary of defaults, of the methods of the class itself.
    (f"self.declare_all()\nself.read_all()\n{OUT}", {("/out", "default", "")}),
    (f"for name, value in DEFAULTS.items():\n    setattr(self, name, value)\n{OUT}", {("/out", "literal", "")}),
    (f"for name, value in DEFAULTS.items():\n    setattr(self, '_' + name, value)\n{PUB.format('self._in_topic')}",
     {("/in", "literal", "")}),
    (f"for name, value in [('a', '/a'), ('b', '/b')]:\n    setattr(self, f'{{name}}_out', value)\n"
     f"{PUB.format('self.b_out')}", {("/b", "literal", "")}),
    (f"self.declare_parameter('out_topic', '/o')\nfor name in ['out_topic', 'rate']:\n"
     f"    setattr(self, name, self.get_parameter(name).value)\nself.out_topic = str(self.out_topic)\n{OUT}",
     {("/o", "default", "")}),
    (f"for name, value in {{**DEFAULTS, 'x': 1}}.items():\n    setattr(self, name, value)\n{OUT}", {("?", "", "")}),
    # Through a method that is called with each.
    (f"self.read_one('front', '/f')\nself.read_one('rear', '/r')\n{PUB.format('self.front')}",
     {("/f", "default", "")}),
    (f"setattr(self, 'alone', '/alone')\n{PUB.format('self.alone')}", {("/alone", "literal", "")}),
    # Turns in which it is not come to, and those of which that is not known.
    (f"for name, value in DEFAULTS.items():\n    if name != 'out_topic':\n        setattr(self, name, value)\n{OUT}",
     {("?", "", "")}),
    (f"for name, value in DEFAULTS.items():\n    if name == 'out_topic':\n        setattr(self, name, value)\n{OUT}",
     {("/out", "literal", "")}),
    (f"for name, value in DEFAULTS.items():\n    if ask(name):\n        setattr(self, name, value)\n{OUT}",
     {("/out", "literal", "ask(name)")}),
    # What is not known stays so.
    (f"for name, value in ask():\n    setattr(self, name, value)\n{OUT}", {("?", "", "")}),
    (f"setattr(self.peer, 'out_topic', '/peer')\n{OUT}", {("?", "", "")}),
    (f"for name in DEFAULTS:\n    setattr(self, name, ask(name))\n{OUT}", {("?", "", "")}),
])  # fmt: skip
def test_members_set_by_name(body, expected):
    assert list_made(body) == expected


def test_members_that_a_base_sets():
    assert list_made(f"self.load_all()\n{OUT}", "Base") == {("/out", "literal", "")}


CAMERAS = "cameras = [('front', '/f'), ('left', '/l'), ('right', '/r')]\n"
DECLARE = "for name, topic in cameras:\n    self.declare_parameter(f'{name}.topic', topic)\n"
READ = "for name, _ in cameras:\n    topic = self.get_parameter(f'{name}.topic').value\n    "
ALL = {("/f", "default", ""), ("/l", "default", ""), ("/r", "default", "")}


@pytest.mark.parametrize(("body", "expected"), [
    (CAMERAS + DECLARE + READ + PUB.format("topic"), ALL),
    (CAMERAS + "for name, topic in cameras:\n    self.declare_parameter(name + '.topic', topic)\n"
     + READ + PUB.format("topic"), ALL),
    # One is declared by itself.
    ("cameras = [('front', 0), ('left', 0)]\nself.declare_parameter('front.topic', '/f')\n"
     + READ + PUB.format("topic"),
     {("/f", "default", ""), ("?", "", "")}),
    # Each in its turn.
    (CAMERAS + DECLARE + READ + PUB.format("name + topic"),
     {("/front/f", "default", ""), ("/left/l", "default", ""), ("/right/r", "default", "")}),
    # A turn whose name is not known is told beside the others.
    ("for topic in ['/a', ask()]:\n    " + PUB.format("topic"), {("/a", "literal", ""), ("?", "", "")}),
    ("for topic in ['/a', ask()]:\n    if topic == 'x':\n        continue\n    " + PUB.format("topic"),
     {("/a", "literal", ""), ("?", "", "")}),
    ("for name, topic in [('a', '/a'), ('b', ask())]:\n    if name == 'b':\n        continue\n    "
     + PUB.format("topic"),
     {("/a", "literal", "")}),
    ("for topic in ['/a', '/b']:\n    " + PUB.format("topic"), {("/a", "literal", ""), ("/b", "literal", "")}),
])  # fmt: skip
def test_parameters_declared_in_turns(body, expected):
    assert list_made(body) == expected


LAUNCH = """
    from launch import LaunchDescription
    from launch_ros.actions import Node

    def generate_launch_description():
        return LaunchDescription([Node(package="p", executable="talker", parameters=[PARAMETERS])])
"""


@pytest.mark.parametrize(("body", "parameters", "expected"), [
    (CAMERAS + DECLARE + READ + PUB.format("topic"), {"front.topic": "/given"},
     {("/given", "launch"), ("/l", "default"), ("/r", "default")}),
    (f"self.declare_all()\nself.read_all()\n{OUT}", {"out_topic": "/given"}, {("/given", "launch")}),
    ("self.declare_parameter('id', rclpy.Parameter.Type.INTEGER)\n"
     "number = self.get_parameter('id').get_parameter_value().integer_value\n" + PUB.format("f'/drone_{number}/x'"),
     {"id": 3}, {("/drone_3/x", "launch")}),
    ("self.declare_parameter('id', rclpy.Parameter.Type.INTEGER)\n"
     "number = self.get_parameter('id').get_parameter_value().integer_value\n" + PUB.format("f'/drone_{number}/x'"),
     {}, {("/drone_<number>/x", "partly")}),
])  # fmt: skip
def test_what_a_launch_gives_in_turns(tmp_path, body, parameters, expected):
    setup = 'from setuptools import setup\nsetup(entry_points={"console_scripts": ["talker = p.talker:main"]})\n'
    files = {
        "p/package.xml": manifest("p", "ament_python"), "p/setup.py": setup, "p/p/__init__.py": "",
        "p/p/talker.py": write_node(body), "p/launch/all.launch.py": LAUNCH.replace("PARAMETERS", repr(parameters)),
    }  # fmt: skip
    found = graph_on_disk(tmp_path, files, "p/launch/all.launch.py")
    assert {(one.topic, one.how) for one in found.endpoints if one.role == "publisher" and not one.implied} == expected


def test_a_number_that_is_given_at_the_start_beside_what_stands_where_it_is_missing():
    body = (
        "try:\n    self.declare_parameter('id', rclpy.Parameter.Type.INTEGER)\n"
        "    number = self.get_parameter('id').get_parameter_value().integer_value\n"
        "except KeyError:\n    number = None\n" + PUB.format("f'/drone_{number}/x'")
    )
    made = list_made(body)
    assert "/drone_<number>/x" in {name for name, _, _ in made}
    assert all(how not in ("literal", "given", "launch") for _, how, _ in made)
