"""Names in a list that the parameter file of a launch gives."""

import pytest
from joining import graph_on_disk, manifest

CPP = """
    #include <rclcpp/rclcpp.hpp>
    class Mux : public rclcpp::Node {
     public:
      Mux() : Node("mux") {
        HERE
      }
      void add(const std::string & name) { create_publisher<std_msgs::msg::Empty>(name, 1); }
      std::vector<std::string> inputs_;
    };
    int main(int c, char** v) { rclcpp::init(c, v); rclcpp::spin(std::make_shared<Mux>()); }
"""
PYTHON = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import Empty

    class Mux(Node):
        def __init__(self):
            super().__init__("mux")
            HERE

    def main():
        rclpy.spin(Mux())
"""
LAUNCH = """
    <launch>
      <node pkg="mux" exec="mux" name="mux"><param from="$(find-pkg-share mux)/config/mux.yaml"/></node>
    </launch>
"""
GIVEN = "mux:\n  ros__parameters:\n    inputs: [joy, nav]\n    rates: [1, 2]\n"
DECLARED = 'declare_parameter("inputs", std::vector<std::string>{});'
IN_CPP = [
    (f'{DECLARED} for (auto name : get_parameter("inputs").as_string_array()) add(name);', {"/joy", "/nav"}),
    ('inputs_ = declare_parameter<std::vector<std::string>>("inputs"); for (auto & name : inputs_) add(name);',
     {"/joy", "/nav"}),
    (f'{DECLARED} inputs_ = get_parameter("inputs").as_string_array(); for (auto & name : inputs_) add("in/" + name);',
     {"/in/joy", "/in/nav"}),
    # What the file does not give, or gives as numbers.
    ('for (auto name : declare_parameter<std::vector<std::string>>("outputs")) add(name);', {"?"}),
    ('for (auto name : declare_parameter<std::vector<std::string>>("rates")) add(name);', {"?"}),
]  # fmt: skip
IN_PYTHON = [
    ('for name in self.declare_parameter("inputs", []).value: self.create_publisher(Empty, name, 1)', {"/joy", "/nav"}),
    ('for name in self.declare_parameter("rates", []).value: self.create_publisher(Empty, name, 1)', {"?"}),
]


def list_topics(root, files, launch):
    found = graph_on_disk(root, {**files, "mux/launch/mux.launch.xml": LAUNCH, "mux/config/mux.yaml": GIVEN}, launch)
    return {one.topic or "?" for one in found.endpoints}


@pytest.mark.parametrize(("body", "names"), IN_CPP)
def test_in_cpp(tmp_path, body, names):
    files = {
        "mux/package.xml": manifest("mux", "ament_cmake"),
        "mux/CMakeLists.txt": "project(mux)\nadd_executable(mux src/mux.cpp)\nament_package()\n",
        "mux/src/mux.cpp": CPP.replace("HERE", body),
    }
    assert list_topics(tmp_path, files, "mux/launch/mux.launch.xml") == names


@pytest.mark.parametrize(("body", "names"), IN_PYTHON)
def test_in_python(tmp_path, body, names):
    files = {
        "mux/package.xml": manifest("mux", "ament_python"),
        "mux/setup.py": "from setuptools import setup\nsetup(name='mux', packages=['mux'], "
        "entry_points={'console_scripts': ['mux = mux.node:main']})\n",
        "mux/mux/__init__.py": "",
        "mux/mux/node.py": PYTHON.replace("HERE", body),
    }
    assert list_topics(tmp_path, files, "mux/launch/mux.launch.xml") == names
