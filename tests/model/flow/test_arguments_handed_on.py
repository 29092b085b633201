"""What argparse reads, handed on: to a function, to an object, and kept by it."""

import pytest
from joining import ends, graph, graph_on_disk, manifest

PROGRAM = """
    import argparse
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import String

    class Desk(Node):
        def __init__(self, options):
            super().__init__("desk")
            self.options = options
            self.create_publisher(String, options.said, 1)
            self.begin()

        def begin(self):
            self.create_publisher(String, self.options.noted, 1)
            self.create_publisher(String, self.options.open, 1)

    def read():
        parser = argparse.ArgumentParser()
        parser.add_argument("--said", default="/said")
        parser.add_argument("--noted", default="/noted")
        parser.add_argument("--open")
        return parser.parse_args()

    def run(options):
        rclpy.spin(Desk(options))

    def main():
        START

    if __name__ == "__main__":
        main()
"""


@pytest.mark.parametrize("start", ["run(read())", "options = read(); run(options)", "given = read(); Desk(given)"])
def test_arguments_that_an_object_is_given(start):
    found = graph({"desk/desk.py": PROGRAM.replace("START", start)})
    assert {topic for _, topic, _ in ends(found, "publisher")} == {"/said", "/noted", "?"}


def test_what_is_no_argument_has_no_name_of_one():
    found = graph({"desk/desk.py": PROGRAM.replace("START", "run(ask())")})
    assert {topic for _, topic, _ in ends(found, "publisher")} == {"?"}


TWO = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import String

    class Lamp(Node):
        def __init__(self):
            super().__init__("lamp")
            self.create_publisher(String, "light", 1)

    class Bell(Node):
        def __init__(self):
            super().__init__("bell")
            self.create_publisher(String, "ring", 1)

    def run_lamp():
        rclpy.spin(Lamp())

    def run_bell():
        rclpy.spin(Bell())
"""


def test_an_entry_point_starts_the_function_that_it_names(tmp_path):
    """Two programs of one module, none of which is called main."""
    files = {
        "desk/package.xml": manifest("desk", "ament_python"),
        "desk/setup.py": """
            from setuptools import setup
            setup(name="desk", packages=["desk"],
                  entry_points={"console_scripts": ["lamp = desk.both:run_lamp", "bell = desk.both:run_bell"]})
        """,
        "desk/desk/__init__.py": "",
        "desk/desk/both.py": TWO,
    }
    found = graph_on_disk(tmp_path, files)
    assert ends(found, "publisher") == {
        ("desk/lamp", "/light", "std_msgs/String"), ("desk/bell", "/ring", "std_msgs/String"),
    }  # fmt: skip
    assert not [one for one in found.endpoints if one.only_if and not one.implied]
