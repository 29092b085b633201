"""What a search of the text finds of calls that nothing understood."""

import pytest
from joining import graph_on_disk, manifest

NODE = """
    #include <rclcpp/rclcpp.hpp>
    class Ship : public rclcpp::Node {
     public:
      Ship() : Node("ship") {
        HERE
      }
      template <class T> void create_publisher_of(const std::string & name) { create_publisher<T>(name, 1); }
      void advertise(int) {}
    };
    int main(int c, char** v) { rclcpp::init(c, v); rclcpp::spin(std::make_shared<Ship>()); }
"""
CASES = [
    ('create_publisher<std_msgs::msg::Empty>("a", 1);', []),
    ('create_publisher<std_msgs::msg::Empty>(find(), 1);', []),  # that is not resolved, and told beside it
    ('declare_parameter("a", 1);', []),
    ('// thing.advertise("a");', []),
    ('auto text = "thing.advertise(a)";', []),
    ("advertise(3);", []),  # a function of its own
    ("#define X thing.advertise(3)", []),
    ('thing.advertise("a");', ["advertise"]),
    ('auto p = Factory::create_publisher<std_msgs::msg::Empty>(thing, "a");', ["create_publisher"]),
    ('return thing.advertise("a");', ["advertise"]),
]


def make_files(written: str) -> dict[str, str]:
    cmake = "project(ship)\nadd_executable(ship src/ship.cpp)\nament_package()\n"
    return {
        "ship/package.xml": manifest("ship", "ament_cmake"),
        "ship/CMakeLists.txt": cmake,
        "ship/src/ship.cpp": NODE.replace("HERE", written),
    }


@pytest.mark.parametrize(("written", "missed"), CASES)
def test_cpp(tmp_path, written, missed):
    coverage = graph_on_disk(tmp_path, make_files(written)).coverage
    found = [(one.written, one.path, one.line) for one in coverage.missed]
    assert found == [(name, "ship/src/ship.cpp", 5) for name in missed]


def test_python_and_counts(tmp_path):
    python = '''
        import rclpy
        from rclpy.node import Node

        class Ship(Node):
            """create_publisher(None, "a", 1)"""

            def create_timer(self, period):
                pass

            def fill(self):
                self.create_timer(3)
                self.create_publisher(None, "a", 1)
                thing.create_subscription(None, "b", 1)  # thing.create_client()
    '''
    files = {**make_files('thing.advertise("a");'), "boat/package.xml": manifest("boat", "ament_python")}
    coverage = graph_on_disk(tmp_path, {**files, "boat/boat/ship.py": python}).coverage
    counts = {one.package: (one.found, one.understood) for one in coverage.by_text}
    assert counts["boat"][0] - counts["boat"][1] == len([one for one in coverage.missed if one.path.startswith("boat")])
    assert counts["ship"] == (2, 1)


def test_services_of_the_interfaces_of_a_node(tmp_path):
    written = """
        rclcpp::create_client<std_srvs::srv::Trigger>(base, graph, services, "ask", qos, group);
        rclcpp::create_service<std_srvs::srv::Trigger>(base, services, "serve", [](int) {}, qos, group);
    """
    found = graph_on_disk(tmp_path, make_files(written))
    services = {(one.role, one.topic) for one in found.endpoints if one.role != "publisher"}
    assert services == {("client", "/ask"), ("server", "/serve")}
    assert not found.coverage.missed


@pytest.mark.parametrize(
    ("written", "missed"),
    [
        ('make = self.create_publisher\nmake(None, "a", 1)', []),
        ('make = self.create_publisher\nshort = lambda name: make(None, name, 1)\nshort("a")', []),
        ("make = self.create_publisher", ["create_publisher"]),
        ('make = self.create_publisher if short else self.create_client\nmake(None, "a")',
         ["create_publisher", "create_client"]),
        ("hand_on(partial(self.create_timer, 3))", ["create_timer"]),
        ("self.make = self.create_publisher", ["create_publisher"]),
        ("hand_on(self.create_publisher)", ["create_publisher"]),
        ("hand_on(self.create)", []),
    ],
)
def test_methods_that_are_handed_on(tmp_path, written, missed):
    lines = written.replace("\n", "\n                ")
    python = f"""
        import rclpy
        from rclpy.node import Node

        class Ship(Node):
            def fill(self):
                {lines}
    """
    files = {"boat/package.xml": manifest("boat", "ament_python"), "boat/boat/ship.py": python}
    coverage = graph_on_disk(tmp_path, files).coverage
    assert [one.written for one in coverage.missed] == missed


@pytest.mark.parametrize(("build", "missed", "unresolved"), [("ament_cmake", ["advertise"], 0), ("catkin", [], 1)])
def test_objects_of_classes_that_are_not_here(tmp_path, build, missed, unresolved):
    """In a workspace of ROS 2 they are none of roscpp's."""
    files = make_files('other::Handle thing; thing.advertise<other::Load>("a");')
    files["ship/package.xml"] = manifest("ship", build)
    if build == "catkin":
        files["ship/CMakeLists.txt"] = files["ship/CMakeLists.txt"].replace("ament_package", "catkin_package")
    coverage = graph_on_disk(tmp_path, files).coverage
    assert [one.written for one in coverage.missed] == missed
    assert len([one for one in coverage.unresolved if one.what == "call"]) == unresolved
