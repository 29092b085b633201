"""A workspace of two nodes on disk, one of them started in a namespace that is not known."""

from pathlib import Path

MANIFEST = """<package format="3"><name>ferry</name><version>1.0.0</version><description>x</description>
<maintainer email="a@b.org">a</maintainer><license>MIT</license><exec_depend>rclpy</exec_depend>
<export><build_type>ament_python</build_type></export></package>
"""
SETUP = """from setuptools import setup
setup(name="ferry", packages=["ferry"],
      entry_points={"console_scripts": ["helm = ferry.helm:main", "ramp = ferry.ramp:main"]})
"""
HELM = """import rclpy
from action_tutorials_interfaces.action import Fibonacci
from rclpy.action import ActionServer
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import Bool, Float32, String
from std_srvs.srv import Trigger


class Helm(Node):
    def __init__(self):
        super().__init__("helm")
        speed = self.declare_parameter("speed", 2.5)
        self.declare_parameter("piers", ["north", "south"])
        self.declare_parameter("captain", self.ask())
        profile = QoSProfile(depth=3, reliability=ReliabilityPolicy.BEST_EFFORT)
        self.course = self.create_publisher(Float32, "course", profile)
        self.note = self.create_publisher(String, input(), 10)
        self.create_subscription(Bool, "~/horn", self.on_horn, 10)
        self.create_subscription(Bool, self.declare_parameter("bell", "bell").value, self.on_horn, 10)
        self.create_service(Trigger, "/harbour/call", self.on_call)
        self.dock = ActionServer(self, Fibonacci, "dock", self.on_dock)
        if speed.value > 2.0:
            self.blast = self.create_publisher(Bool, "blast", 10)


def main():
    rclpy.init()
    rclpy.spin(Helm())
"""
RAMP = """import rclpy
from rclpy.node import Node
from std_msgs.msg import Float32
from std_srvs.srv import Trigger


class Ramp(Node):
    def __init__(self):
        super().__init__("ramp")
        self.create_subscription(Float32, "course", self.on_course, 10)
        self.call = self.create_client(Trigger, "/harbour/call")


def main():
    rclpy.init()
    rclpy.spin(Ramp())
"""
LAUNCH = """<launch>
  <node pkg="ferry" exec="helm"/>
  <node pkg="ferry" exec="ramp" namespace="$(env SHIP)"/>
</launch>
"""


def write_ferry(root: Path) -> Path:
    """The workspace, written below a folder."""
    files = {
        "package.xml": MANIFEST, "setup.py": SETUP, "ferry/__init__.py": "", "ferry/helm.py": HELM,
        "ferry/ramp.py": RAMP, "launch/ferry.launch.xml": LAUNCH,
    }  # fmt: skip
    for name, text in files.items():
        path = root / "ferry" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return root
