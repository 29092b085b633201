"""Names in a list that is the default of a parameter, which a launch may set otherwise."""

import pytest
from joining import graph, graph_on_disk, manifest

PYTHON = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool

KNOWN = {"/x": 1, "/y": 2}


class Mux(Node):
    def __init__(self):
        super().__init__("mux")
        self.declare_parameter("inputs", ["/a", "/b"])
        BODY

    def make(self, name):
        self.create_publisher(Bool, name, 1)


def main():
    rclpy.init()
    rclpy.spin(Mux())


main()
"""
READ = 'self.get_parameter("inputs").value'
A_B, X_Y = {("/a", "default"), ("/b", "default")}, {("/x", "default"), ("/y", "default")}
IN_PYTHON = [
    (f"for name in {READ}:\n    self.make(name)", A_B),
    (f"names = {READ}\nfor name in names:\n    self.make(name)", A_B),
    (f"self.names = list({READ})\nfor name in self.names:\n    self.make(name)", A_B),
    ('for name in self.get_parameter("inputs").get_parameter_value().string_array_value:\n    self.make(name)', A_B),
    (f"names = {READ}\nfor place in range(len(names)):\n    self.make(names[place])", A_B),
    (f"self.make({READ}[1])", {("/b", "default")}),
    ('for name in self.declare_parameter("own", list(KNOWN.keys())).value:\n    self.make(name)', X_Y),
    ('for name in self.declare_parameter("own", []).value:\n    self.make(name)', set()),
    ('for name in self.declare_parameter("own", rclpy.find()).value:\n    self.make(name)', set()),
    # Of a list to which something is added it is known what it begins with alone.
    (f"names = {READ}\nnames += rclpy.find()\nfor name in names:\n    self.make(name)", set()),
    (f"names = {READ} if rclpy.ok() else rclpy.find()\nfor name in names:\n    self.make(name)", set()),
]


@pytest.mark.parametrize(("body", "expected"), IN_PYTHON)
def test_in_python(body, expected):
    found = graph({"p/mux.py": PYTHON.replace("BODY", body.replace("\n", "\n        "))})
    made = [e for e in found.endpoints if e.role == "publisher" and not e.implied]
    assert {(e.topic, e.how) for e in made if e.how not in ("partly", "unresolved")} == expected


CPP = """
    #include <rclcpp/rclcpp.hpp>
    class Mux : public rclcpp::Node {
     public:
      Mux() : Node("mux") {
        declare_parameter("inputs", std::vector<std::string>{"/a", "/b"});
        HERE
      }
      void make(const std::string & name) { create_publisher<std_msgs::msg::Bool>(name, 1); }
      std::vector<std::string> names_;
    };
    int main(int c, char** v) { rclcpp::init(c, v); rclcpp::spin(std::make_shared<Mux>()); }
"""
WALK = "for (const auto & name : names_) make(name);"
IN_CPP = [
    (f'names_ = get_parameter("inputs").as_string_array(); {WALK}', A_B),
    (f'get_parameter("inputs", names_); {WALK}', A_B),
    (
        'auto all = get_parameter("inputs").as_string_array(); for (size_t i = 0; i < all.size(); ++i) make(all[i]);',
        A_B,
    ),
    ('for (auto & name : declare_parameter<std::vector<std::string>>("own", {"/x", "/y"})) make(name);', X_Y),
    ('for (auto & name : declare_parameter<std::vector<std::string>>("own", find())) make(name);', set()),
    (f'get_parameter("inputs", names_); names_ = find(); {WALK}', set()),
    (f'get_parameter("inputs", names_); names_.erase(names_.begin()); {WALK}', set()),
]


@pytest.mark.parametrize(("body", "expected"), IN_CPP)
def test_in_cpp(body, expected):
    found = graph({"p/mux.cpp": CPP.replace("HERE", body)})
    made = [e for e in found.endpoints if e.role == "publisher" and not e.implied]
    assert {(e.topic, e.how) for e in made if e.how not in ("partly", "unresolved")} == expected


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ("other: 1", A_B),
        ("inputs: [/given]", {("/given", "launch")}),
        ("inputs: [/given, /more]", {("/given", "launch"), ("/more", "launch")}),
    ],
)
def test_with_a_launch(tmp_path, given, expected):
    launch = (
        '<launch><node pkg="mux" exec="mux" name="mux"><param from="$(find-pkg-share mux)/mux.yaml"/></node></launch>'
    )
    files = {
        "mux/package.xml": manifest("mux", "ament_cmake"),
        "mux/CMakeLists.txt": "project(mux)\nadd_executable(mux mux.cpp)\nament_package()\n",
        "mux/mux.cpp": CPP.replace("HERE", f'names_ = get_parameter("inputs").as_string_array(); {WALK}'),
        "mux/mux.launch.xml": launch,
        "mux/mux.yaml": f"mux:\n  ros__parameters:\n    {given}\n",
    }
    found = graph_on_disk(tmp_path, files)
    made = [e for e in found.endpoints if e.role == "publisher" and not e.implied]
    assert {(e.topic, e.how) for e in made} == expected
