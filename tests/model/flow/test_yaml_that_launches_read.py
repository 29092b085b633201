"""Launch files of Python that read a value of a YAML file by themselves."""

import pytest
from joining import graph_on_disk, manifest

LAUNCH = """
    import os
    import yaml
    from ament_index_python.packages import get_package_share_directory
    from launch import LaunchDescription
    from launch.actions import OpaqueFunction
    from launch_ros.actions import Node

    def start(context, *_, **kwargs):
        return [Node(package="p", executable="a", namespace=kwargs["space"])]

    def generate_launch_description():
        path = os.path.join(get_package_share_directory("p"), "config", "{file}")
        space = "plain"
        with open(path, "r") as f:
            data = yaml.load(f, Loader=yaml.FullLoader)
            space = {value}
        return LaunchDescription([OpaqueFunction(function=start, kwargs={{"space": space}})])
"""
CODE = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import String
    class A(Node):
        def __init__(self):
            super().__init__("a")
            self.create_publisher(String, "out", 1)
    def main():
        rclpy.init()
        rclpy.spin(A())
"""


@pytest.mark.parametrize(("file", "value", "expected"), [
    ("names.yaml", 'data["namespace"]', {("/simple/out", "literal")}),
    ("names.yaml", 'data["namespace"] + "/deep"', {("/simple/deep/out", "literal")}),
    ("names.yaml", 'f"x{data["robots"]["number"]}"'.replace('"robots"', "'robots'").replace('"number"', "'number'"),
     {("/x4/out", "literal")}),
    # What is not there, or is no text, is not known.
    ("names.yaml", 'data["robots"]', {("partly",)}),
    ("names.yaml", 'data["none"]', {("partly",)}),
    ("absent.yaml", 'data["namespace"]', {("partly",)}),
])  # fmt: skip
def test_a_namespace_of_a_yaml_file(tmp_path, file, value, expected):
    files = {
        "p/package.xml": manifest("p", "ament_python"),
        "p/setup.py": """
            from setuptools import setup
            setup(name="p", packages=["p"], entry_points={"console_scripts": ["a = p.a:main"]})
        """,
        "p/p/__init__.py": "",
        "p/p/a.py": CODE,
        "p/config/names.yaml": "namespace: /simple\nrobots: {number: 4}\n",
        "p/launch/a.launch.py": LAUNCH.format(file=file, value=value),
    }
    found = graph_on_disk(tmp_path, files, "p/launch/a.launch.py")
    published = {(one.topic, one.how) for one in found.endpoints if one.role == "publisher" and not one.implied}
    assert published == expected or {(how,) for _, how in published} == expected
