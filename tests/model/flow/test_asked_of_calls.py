"""Names that are asked of what a call gives: of several calls in one statement, each has its own."""

import pytest
from joining import ends, graph

MONITOR = """
    from std_msgs.msg import String

    class Monitor:
        def __init__(self, node, told, *, heard="/heard", said="/said", limit=0.5):
            node.create_publisher(String, said, 1)
            node.create_subscription(String, heard, told, 1)
"""
NODE = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import String
    from monitor import Monitor

    class Desk(Node):
        def __init__(self):
            super().__init__("desk")
            for name, value in (("one", "/one"), ("two", "/two"), ("limit", 0.5)):
                self.declare_parameter(name, value)
            BODY

        def note(self, message):
            pass

    def main():
        rclpy.spin(Desk())

    main()
"""


def find_names(body: str) -> set[tuple[str, str]]:
    body = body.replace("\n", "\n            ")
    found = graph({"desk/desk.py": NODE.replace("BODY", body), "desk/monitor.py": MONITOR})
    roles = ("publisher", "subscriber")
    return {(role, topic) for role in roles for node, topic, _ in ends(found, role) if node.startswith("desk/desk")}


@pytest.mark.parametrize(("first", "second"), [("one", "two"), ("two", "one")])
@pytest.mark.parametrize("apart", ["", "\n    "])
def test_each_argument_asks_for_its_own_parameter(first, second, apart):
    body = (
        f"Monitor(self, self.note, limit=self.get_parameter('limit').value, {apart}"
        f"heard=str(self.get_parameter('{first}').value), {apart}"
        f"said=self.get_parameter('{second}').get_parameter_value().string_value)"
    )
    assert find_names(body) == {("subscriber", f"/{first}"), ("publisher", f"/{second}")}


def test_what_is_asked_is_part_of_a_name():
    body = (
        "pair = (self.create_publisher(String, self.get_parameter('one').value + '/a', 1),\n"
        "        self.create_publisher(String, self.get_parameter('two').value.strip() + '/b', 1))"
    )
    assert find_names(body) == {("publisher", "/one/a"), ("publisher", "/two/b")}


def test_a_number_is_no_name_though_a_text_is_asked_for_beside_it():
    asked = "heard=self.get_parameter('one').value, said=str(self.get_parameter('limit').value)"
    body = f"Monitor(self, self.note, {asked})"
    assert find_names(body) == {("subscriber", "/one"), ("publisher", "?")}


def test_a_member_of_what_a_call_gives_is_not_what_the_call_gives():
    body = "self.create_publisher(String, self.get_parameter('one').descriptor.name.strip(), 1)"
    assert find_names(body) == {("publisher", "?")}


def test_the_callback_is_that_of_the_node():
    files = {"desk/desk.py": NODE.replace("BODY", "Monitor(self, self.note)"), "desk/monitor.py": MONITOR}
    files["desk/hall.py"] = files["desk/desk.py"].replace("Desk", "Hall").replace("desk", "hall")
    found = graph(files)
    called = {(one.node, one.callback.name) for one in found.endpoints if one.role == "subscriber" and one.callback}
    assert called == {("desk/desk.py", "Desk.note"), ("desk/hall.py", "Hall.note")}
