"""Names by what gives them: a branch that a launch opens, a reference that is passed on, a variable of a header."""

import pytest
from joining import ends, graph, graph_on_disk, manifest

SETUP = """
    from setuptools import setup
    setup(name="scout", version="1", packages=["scout"], entry_points={"console_scripts": ["scout = scout.scout:main"]})
"""
SCOUT = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import Empty

    class Scout(Node):
        def __init__(self):
            super().__init__("scout")
            self.declare_parameter("kind", "a")
            self.declare_parameter("far", False)
            self.topic = None
            self.kind = self.get_parameter("kind").value
            far = self.get_parameter("far").value
            if self.kind == "a":
                self.topic = "of_a"
            elif self.kind == "b":
                self.topic = "of_b"
            else:
                self.get_logger().error("no such kind")
            self.one = self.create_publisher(Empty, self.topic, 1)
            name = "near"
            if far:
                name = "far"
            self.other = self.create_publisher(Empty, name, 1)

    def main():
        rclpy.init()
        rclpy.spin(Scout())
"""


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        # Nothing is decided; what is None at first is no name.
        ("", {"/of_a", "/of_b", "/near", "/far"}),
        ('<param name="kind" value="b"/>', {"/of_b", "/near", "/far"}),
        ('<param name="kind" value="a"/><param name="far" value="true"/>', {"/of_a", "/far"}),
        ('<param name="kind" value="c"/><param name="far" value="false"/>', {"", "/near"}),
    ],
)
def test_a_variable_has_the_value_of_the_branch_that_the_launch_opens(tmp_path, given, expected):
    files = {
        "scout/package.xml": manifest("scout", "ament_python"),
        "scout/setup.py": SETUP,
        "scout/scout/__init__.py": "",
        "scout/scout/scout.py": SCOUT,
        "scout/launch/scout.launch.xml": f'<launch><node pkg="scout" exec="scout">{given}</node></launch>\n',
    }
    found = graph_on_disk(tmp_path, files, "scout/launch/scout.launch.xml")
    assert {one.topic for one in found.endpoints if not one.implied} == expected


CAMERA = """
    #include <rclcpp/rclcpp.hpp>
    class Parameters {
     public:
      rclcpp::ParameterValue set(const std::string & name, rclcpp::ParameterValue initial) {
        rclcpp::ParameterValue result(initial);
        try {
          if (!node_->has_parameter(name)) result = node_->declare_parameter(name, initial);
          else result = node_->get_parameter(name).get_parameter_value();
        } catch (const std::exception & e) {
          return initial;
        }
        return result;
      }
      rclcpp::Node * node_;
    };
    class Camera : public rclcpp::Node {
     public:
      Camera() : Node("camera") {
        parameters_ = std::make_shared<Parameters>(this);
        READ
        info_ = create_publisher<std_msgs::msg::Empty>("/" + name_ + "/info", 1);
      }
      template <class T>
      void read(T & variable, const std::string & name, const T & value) {
        variable = parameters_->set(name, rclcpp::ParameterValue(value)).get<T>();
      }
      void ask(std::string & variable) { variable = find_camera(); }
      std::string name_ = "camera", other_;
      std::shared_ptr<Parameters> parameters_;
    };
    int main() { rclcpp::spin(std::make_shared<Camera>()); }
"""


@pytest.mark.parametrize(
    ("read", "expected"),
    [
        ("", [("/camera/info", "literal")]),
        ('read<std::string>(other_, "other", "b"); read<std::string>(name_, "name", "a");', [("/a/info", "default")]),
        # Beside what is not known the name is one that may be replaced.
        ("ask(name_);", [("/<name_>/info", "partly"), ("/camera/info", "partly")]),
    ],
)
def test_what_a_function_writes_into_its_reference_takes_the_place_of_the_beginning(read, expected):
    found = graph({"cam/camera.cpp": CAMERA.replace("READ", read)})
    names = {(one.topic, one.how, "catch" in one.only_if) for one in found.endpoints if one.role == "publisher"}
    assert sorted((topic, how) for topic, how, thrown in names if not thrown) == expected


def test_a_publisher_of_a_parameter_callback_has_the_name_that_is_being_set():
    grid = """
        #include <rclcpp/rclcpp.hpp>
        struct Map { std::string topic; };
        class Grid : public rclcpp::Node {
          rcl_interfaces::msg::SetParametersResult set(const std::vector<rclcpp::Parameter> & parameters) {
            for (const auto & one : parameters) {
              if (one.get_name() == "topic") {
                map_.topic = one.as_string();
                pub_ = create_publisher<std_msgs::msg::Empty>(map_.topic, 1);
              }
            }
          }
         public:
          Grid() : Node("grid") {
            declare_parameter<std::string>("topic", "map");
            get_parameter("topic", map_.topic);
            sub_ = create_subscription<std_msgs::msg::Empty>(map_.topic, 1, [](std_msgs::msg::Empty::SharedPtr) {});
            set_ = add_on_set_parameters_callback(std::bind(&Grid::set, this, std::placeholders::_1));
          }
          Map map_;
        };
        int main() { rclcpp::spin(std::make_shared<Grid>()); }
    """
    found = graph({"grid/grid.cpp": grid})
    assert ends(found, "publisher") == {("grid/grid", "?", "std_msgs/Empty")}
    assert ends(found, "subscriber") == {("grid/grid", "/map", "std_msgs/Empty")}


HEADER = """
    #pragma once
    #include <ros/ros.h>
    boost::shared_ptr<ros::NodeHandle> nh;
    class Fix {
     public:
      void send() { static ros::Publisher pub = nh->advertise<std_msgs::Empty>("fix", 1); }
    };
"""
MAIN = """
    #include "gps.h"
    int main(int argc, char ** argv) {
      ros::init(argc, argv, "gps");
      nh.reset(new ros::NodeHandle(HANDLE));
      int rate;
      nh->param("rate", rate, 1);
      Fix fix;
      fix.send();
    }
"""


@pytest.mark.parametrize(("handles", "expected"), [
    (['"~"'], ["/gps/fix"]), ([""], ["/fix"]), (['"~"', ""], ["/gps/fix", "/fix"]),
])  # fmt: skip
def test_a_header_has_the_handle_that_whoever_includes_it_makes(handles, expected):
    mains = {f"gps/main{place}.cpp": MAIN.replace("HANDLE", one) for place, one in enumerate(handles)}
    found = graph({"gps/gps.h": HEADER, **mains}, ros=1)
    assert {(node, topic) for node, topic, _ in ends(found, "publisher")} == {
        (f"gps/main{place}", topic) for place, topic in enumerate(expected)
    }
    assert {(one.name, one.default) for one in found.parameters} == {("rate", "1")}


SCAN = """
    from arm import Arm
    arm = Arm("scan")
    arm.move()
"""
ARM = """
    import rclpy
    from rclpy.node import Node
    from std_srvs.srv import Trigger

    class Arm(Node):
        def __init__(self, name):
            super().__init__(name)

        def move(self):
            pass

        def switch(self, mode):
            self.create_client(Trigger, f"/switch_to_{mode}")
"""


def test_what_another_program_passes_to_a_method_is_not_sure_to_be_a_name_of_a_node():
    drive = SCAN.replace("scan", "drive") + '    arm.switch("navigation")\n'
    found = graph({"p/arm.py": ARM, "p/scan.py": SCAN, "p/drive.py": drive})
    assert {one.id: one.name for one in found.nodes} == {"p/scan.py": "/scan", "p/drive.py": "/drive"}
    clients = {(one.node, one.topic, one.only_if) for one in found.endpoints if one.role == "client"}
    assert ("p/drive.py", "/switch_to_navigation", "") in clients
    others = {only_if for node, _, only_if in clients if node == "p/scan.py"}
    assert others == {"something calls `Arm.switch` && something that runs passes the name"}


def test_a_launch_file_starts_a_program_by_the_name_that_it_is_installed_under(tmp_path):
    files = {
        "map/package.xml": manifest("map", "ament_cmake"),
        "map/CMakeLists.txt": (
            "cmake_minimum_required(VERSION 3.8)\nproject(map)\nfind_package(ament_cmake REQUIRED)\n"
            "install(PROGRAMS script/mapper_node.py DESTINATION lib/${PROJECT_NAME} RENAME mapper)\nament_package()\n"
        ),
        "map/script/mapper_node.py": SCOUT.replace('"scout"', '"mapper"') + "\n    if __name__ == '__main__':\n"
                                     "        main()\n",
        "map/launch/map.launch.xml": (
            '<launch><node pkg="map" exec="mapper"><param name="kind" value="a"/><remap from="of_a" to="/a"/>'
            '<param name="far" value="false"/></node></launch>\n'
        ),
    }  # fmt: skip
    found = graph_on_disk(tmp_path, files, "map/launch/map.launch.xml")
    assert {one.topic for one in found.endpoints if not one.implied} == {"/a", "/near"}


@pytest.mark.parametrize(("name", "expected"), [
    ('f"robot_{number}"', "/robot_<number>"), ("number", "/<number>"), ('"robot"', "/robot"),
])  # fmt: skip
def test_a_node_whose_name_is_not_known_has_brackets_in_it(name, expected):
    robot = f"""
        import sys
        import rclpy
        from rclpy.node import Node
        from std_msgs.msg import Empty

        class Robot(Node):
            def __init__(self, number):
                super().__init__({name})
                self.one = self.create_publisher(Empty, "~/one", 1)

        rclpy.init()
        rclpy.spin(Robot(sys.argv[1]))
    """
    found = graph({"p/robot.py": robot})
    assert ends(found, "publisher") == {("p/robot.py", f"{expected}/one", "std_msgs/Empty")}
    assert [one.name for one in found.nodes] == [expected]


COUNTED = """
    #include <ros/ros.h>
    std::string topic = "of_none";
    int main(int argc, char ** argv) {
      ros::init(argc, argv, "count");
      ros::NodeHandle nh;
      if (argc > 1) topic = std::string(argv[1]) + "/of_one";
      if (argc > 2) topic = "of_two";
      ros::Publisher pub = nh.advertise<std_msgs::Empty>(topic, 1);
    }
"""


@pytest.mark.parametrize(("args", "expected"), [
    ("a", {"/a/of_one"}), ("a b", {"/of_two"}), ("a b c", {"/of_two"}),
])  # fmt: skip
def test_how_many_arguments_a_launch_gives_decides_a_branch(tmp_path, args, expected):
    files = {
        "count/package.xml": manifest("count", "catkin"),
        "count/CMakeLists.txt": (
            "cmake_minimum_required(VERSION 3.0)\nproject(count)\nfind_package(catkin REQUIRED roscpp)\n"
            "catkin_package()\nadd_executable(count src/count.cpp)\n"
        ),
        "count/src/count.cpp": COUNTED,
        "count/launch/count.launch": f'<launch><node pkg="count" type="count" name="count" args="{args}"/></launch>\n',
    }
    found = graph_on_disk(tmp_path, files, "count/launch/count.launch")
    assert {one.topic for one in found.endpoints if one.role == "publisher" and not one.implied} == expected
