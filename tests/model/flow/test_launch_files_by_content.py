"""Launch files that only their content shows to be such: wherever a package keeps them, they name what they start."""

import pytest
from joining import graph_on_disk, manifest

FILES = {
    "rig/package.xml": manifest("rig", "ament_python"),
    "rig/resource/rig": "",
    "rig/setup.cfg": "",
    "rig/setup.py": """
        from setuptools import setup
        setup(name="rig", version="1.0.0", packages=["rig"], entry_points={"console_scripts": ["rig = rig.rig:main"]},
              data_files=[("share/rig/launch", ["PLACE"])])
    """,
    "rig/rig/__init__.py": "",
    "rig/rig/rig.py": """
        import rclpy
        from rclpy.node import Node
        from std_msgs.msg import Empty

        class Rig(Node):
            def __init__(self):
                super().__init__("rig")
                self.create_publisher(Empty, "state", 1)

        def main():
            rclpy.init()
            rclpy.spin(Rig())
    """,
}
LAUNCH = """
    from launch import LaunchDescription
    from launch_ros.actions import Node

    def ENTRY():
        return LaunchDescription([Node(package="rig", executable="rig", name="crane", namespace="up")])
"""


@pytest.mark.parametrize(
    ("place", "entry", "expected"),
    [
        ("scripts/start.py", "generate_launch_description", {("/up/crane", "/up/state")}),
        ("launch/start.py", "generate_launch_description", {("/up/crane", "/up/state")}),
        ("scripts/start.py", "make_description", {("/rig", "/state")}),
        ("test/start.py", "generate_launch_description", {("/rig", "/state")}),
    ],
)
def test_what_a_file_defines_makes_it_a_launch_file(tmp_path, place, entry, expected):
    files = {name: text.replace("PLACE", place) for name, text in FILES.items()}
    found = graph_on_disk(tmp_path, {**files, f"rig/{place}": LAUNCH.replace("ENTRY", entry)})
    names = {node.id: node.name for node in found.nodes}
    ends = {(names[one.node], one.topic) for one in found.endpoints if one.role == "publisher" and not one.implied}
    assert ends == expected
