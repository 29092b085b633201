"""Names that `.format()` makes of a text that a variable is."""

import pytest
from joining import graph


@pytest.mark.parametrize(("body", "expected"), [
    ("name = TEMPLATE.format(number=3)", {"/obj_3/pose"}),
    ("name = TEMPLATE.format(number=int(3))", {"/obj_3/pose"}),
    ("name = TEMPLATE.format(number=int(self.get_parameter('number').value))", {"/obj_7/pose"}),
    ("name = '/obj_{}/{}'\n            name = name.format(3, 'pose')", {"/obj_3/pose"}),
    ("name = '/{1}/{0}'\n            name = name.format('a', 'b')", {"/b/a"}),
    ("name = TEMPLATE.format(number=ask())", {"/obj_<ask>/pose"}),
    # What it is not given, or what may be anything.
    ("name = TEMPLATE.format(3)", {"?"}),
    ("name = TEMPLATE.format(**ask())", {"?"}),
    ("name = ask().format(3)", {"?"}),
    ("name = '/obj_{0.x}'\n            name = name.format(3)", {"?"}),
])  # fmt: skip
def test_a_format_with_a_name(body, expected):
    text = f"""
        import rclpy
        from rclpy.node import Node
        from std_msgs.msg import String
        TEMPLATE = "/obj_{{number}}/pose"
        class Robot(Node):
            def __init__(self):
                super().__init__("robot")
                self.declare_parameter("number", 7)
                {body.replace(chr(10) + "            ", chr(10) + " " * 16)}
                self.create_publisher(String, name, 1)
        rclpy.init()
        rclpy.spin(Robot())
    """
    found = graph({"p/robot.py": text})
    names = {one.topic or "?" for one in found.endpoints if one.role == "publisher" and not one.implied}
    assert names
    assert names <= expected
