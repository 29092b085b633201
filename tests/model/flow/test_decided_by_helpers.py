"""Conditions that a helper of the code decides: what it gives back is worked out like what stands in the condition."""

import pytest
from joining import graph_on_disk, manifest

MONITOR = """
    import rclpy
    from nav_msgs.msg import Path
    from rclpy.node import Node

    class Monitor(Node):
        def __init__(self):
            super().__init__("monitor")
            self.declare_parameter("listen", True)
            self.declare_parameter("mode", "real")
            self.listen = self._flag("listen")
            simulated = self.get_parameter("mode").value == "sim"
            if self._flag("listen"):
                self.create_subscription(Path, "/asked", print, 1)
            if self.listen:
                self.create_subscription(Path, "/kept", print, 1)
            if simulated:
                self.create_subscription(Path, "/simulated", print, 1)
            if not simulated and self._flag("listen"):
                self.create_subscription(Path, "/real", print, 1)

        def _flag(self, name):
            return self._convert(self.get_parameter(name).value)

        def _convert(self, value):
            if isinstance(value, bool):
                return value
            return str(value).strip().lower() in ("1", "true", "yes")

    def main():
        rclpy.init()
        rclpy.spin(Monitor())
"""
LAUNCH = """
    from launch import LaunchDescription
    from launch_ros.actions import Node

    def generate_launch_description():
        return LaunchDescription([Node(package="rig", executable="monitor", parameters=[SETTINGS])])
"""


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ('{"listen": False}', set()),
        ('{"listen": True, "mode": "real"}', {"/asked", "/kept", "/real"}),
        ('{"listen": True, "mode": "sim"}', {"/asked", "/kept", "/simulated"}),
        ('{"listen": False, "mode": "sim"}', {"/simulated"}),
        ('{"listen": "yes", "mode": "real"}', {"/asked", "/kept", "/real"}),
    ],
)
def test_a_branch_that_a_helper_closes_is_not_there(tmp_path, settings, expected):
    files = {
        "rig/package.xml": manifest("rig", "ament_python"),
        "rig/setup.py": """
            from setuptools import setup
            setup(name="rig", packages=["rig"],
                  entry_points={"console_scripts": ["monitor = rig.monitor:main"]})
        """,
        "rig/rig/__init__.py": "",
        "rig/rig/monitor.py": MONITOR,
        "rig/launch/rig.launch.py": LAUNCH.replace("SETTINGS", settings),
    }
    found = graph_on_disk(tmp_path, files, "rig/launch/rig.launch.py")
    names = {one.topic for one in found.endpoints if not one.implied and not one.only_if}
    assert names - ({"/real", "/simulated"} if "mode" not in settings else set()) == expected
