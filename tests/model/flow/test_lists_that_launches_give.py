"""Names from what a launch gives below a prefix, from mappings, and from lists of mappings; turns of loops."""

import pytest
from joining import ends, graph, graph_on_disk, manifest

ROS2 = """
    #include <rclcpp/rclcpp.hpp>
    class Mux : public rclcpp::Node {
     public:
      Mux() : Node("mux", rclcpp::NodeOptions().automatically_declare_parameters_from_overrides(true)) {
        HERE
      }
      void hear(const std::string & name) { create_subscription<std_msgs::msg::Empty>(name, 1, nullptr); }
    };
    int main(int c, char** v) { rclcpp::init(c, v); rclcpp::spin(std::make_shared<Mux>()); }
"""
ROS1 = """
    #include <ros/ros.h>
    void heard(const std_msgs::Empty::ConstPtr&) {}
    int main(int argc, char** argv) {
      ros::init(argc, argv, "mux");
      ros::NodeHandle nh, own("~");
      XmlRpc::XmlRpcValue list;
      HERE
    }
"""
RCLPY = """
    import rclpy
    from rclpy.node import Node
    from std_msgs.msg import Empty

    class Mux(Node):
        def __init__(self):
            super().__init__("mux", automatically_declare_parameters_from_overrides=True)
            HERE

    def main():
        rclpy.spin(Mux())
"""
ROSPY = """
    import rospy
    from std_msgs.msg import Empty

    rospy.init_node("mux")
    HERE
"""
GIVEN = """
    topics:
      joy: {topic: joy_vel, priority: 1}
      nav: {topic: nav_vel}
    locks:
      pause: {priority: 5}
      stop: {topic: stopped}
    outs: {left: l_out, right: r_out}
    inputs:
      - {name: joy, topic: joy_vel}
      - name: nav
        topic: nav_vel
"""
PREFIXES = 'auto found = list_parameters({"topics"}, 10); for (const auto & each : found.prefixes) '
READ = "{ std::string topic; get_parameter(each + \".topic\", topic); hear(topic); }"  # fmt: skip
IN_ROS2 = [
    (PREFIXES + READ, {"/joy_vel", "/nav_vel"}),
    (PREFIXES + 'hear(each + "_x");', {"?"}),  # no name of ROS has a dot
    (PREFIXES.replace("topics", "locks") + READ, {"/stopped"}),  # the other is not given a topic
    (PREFIXES.replace("topics", "nothing") + READ, {"?"}),
    ('std::map<std::string, std::string> map; get_parameters("outs", map); for (auto & one : map) hear(one.second);',
     {"/l_out", "/r_out"}),
    ('std::map<std::string, rclcpp::Parameter> map; get_parameters("outs", map); '
     'for (auto & [key, value] : map) hear(key + "/" + value.as_string());', {"/left/l_out", "/right/r_out"}),
    ('std::map<std::string, std::string> map; get_parameters(file(), map); for (auto & one : map) hear(one.second);',
     {"?"}),
]  # fmt: skip
SAY = "{ subs.push_back(nh.subscribe(TEXT, 1, heard)); }"
IN_ROS1 = [
    ('own.getParam("inputs", list); for (int i = 0; i < list.size(); ++i) { std::string topic = list[i]["topic"]; '
     + SAY.replace("TEXT", "topic") + " }", {"/joy_vel", "/nav_vel"}),
    ('own.getParam("inputs", list); for (int i = 0; i < list.size(); ++i) '
     + SAY.replace("TEXT", 'static_cast<std::string>(list[i]["name"]) + "/" + std::string(list[i]["topic"])'),
     {"/joy/joy_vel", "/nav/nav_vel"}),
    ('own.getParam("topics", list); for (auto it = list.begin(); it != list.end(); ++it) { std::string topic = '
     'it->second["topic"]; ' + SAY.replace("TEXT", 'it->first + "/" + topic') + " }", {"/joy/joy_vel", "/nav/nav_vel"}),
    ('own.getParam("topics", list); for (auto & one : list) ' + SAY.replace("TEXT", "one.first"), {"/joy", "/nav"}),
    ('own.getParam("nothing", list); for (auto & one : list) ' + SAY.replace("TEXT", "one.first"), {"?"}),
    # Which of two places is meant.
    ('own.getParam("inputs", list); for (int i = 0; i < list.size(); ++i) for (int j = 0; j < list.size(); ++j) '
     + SAY.replace("TEXT", 'std::string(list[i]["name"]) + std::string(list[j]["name"])'), {"?"}),
]  # fmt: skip
IN_RCLPY = [
    ('for value in self.get_parameters_by_prefix("outs").values(): self.create_publisher(Empty, value.value, 1)',
     {"/l_out", "/r_out"}),
    ('for name, value in self.get_parameters_by_prefix("outs").items(): '
     'self.create_publisher(Empty, name + "/" + value.value, 1)', {"/left/l_out", "/right/r_out"}),
]  # fmt: skip
IN_ROSPY = [
    ('for one in rospy.get_param("~inputs"): rospy.Publisher(one["name"] + "/" + one["topic"], Empty)',
     {"/joy/joy_vel", "/nav/nav_vel"}),
    ('for name, one in rospy.get_param("~topics", {}).items(): rospy.Publisher(name + "/" + one["topic"], Empty)',
     {"/joy/joy_vel", "/nav/nav_vel"}),
    ('for name in rospy.get_param("~outs"): rospy.Publisher(name, Empty)', {"/left", "/right"}),
    ('for name in rospy.get_param("~nothing", {}): rospy.Publisher(name, Empty)', {"?"}),
]  # fmt: skip


def list_names(root, files, build, program):
    ros2 = build != "catkin"
    given = "\n".join(("mux:", "  ros__parameters:", GIVEN)) if ros2 else GIVEN
    file = '<param from="$(find-pkg-share mux)/mux.yaml"/>'
    load = file if ros2 else '<rosparam command="load" file="$(find mux)/mux.yaml"/>'
    start = f'exec="{program}"' if ros2 else f'type="{program}"'
    path = "mux/launch/mux.launch.xml" if ros2 else "mux/launch/mux.launch"
    written = {
        **files, path: f'<launch><node pkg="mux" {start} name="mux">{load}</node></launch>',
        "mux/mux.yaml": given, "mux/package.xml": manifest("mux", build),
    }  # fmt: skip
    found = graph_on_disk(root, written, path)
    assert all(one.how == "launch" for one in found.endpoints if one.topic and not one.implied)
    return {one.topic or "?" for one in found.endpoints if not one.implied}


BUILT = "project(mux)\nadd_executable(mux mux.cpp)\n"


@pytest.mark.parametrize(("body", "names"), IN_ROS2)
def test_in_rclcpp(tmp_path, body, names):
    files = {"mux/CMakeLists.txt": BUILT + "ament_package()\n", "mux/mux.cpp": ROS2.replace("HERE", body)}
    assert list_names(tmp_path, files, "ament_cmake", "mux") == names


@pytest.mark.parametrize(("body", "names"), IN_ROS1)
def test_in_roscpp(tmp_path, body, names):
    files = {"mux/CMakeLists.txt": BUILT + "catkin_package()\n", "mux/mux.cpp": ROS1.replace("HERE", body)}
    assert list_names(tmp_path, files, "catkin", "mux") == names


@pytest.mark.parametrize(("body", "names"), IN_RCLPY)
def test_in_rclpy(tmp_path, body, names):
    files = {
        "mux/setup.py": "from setuptools import setup\nsetup(name='mux', packages=['mux'], "
        "entry_points={'console_scripts': ['mux = mux.node:main']})\n",
        "mux/mux/__init__.py": "", "mux/mux/node.py": RCLPY.replace("HERE", body),
    }  # fmt: skip
    assert list_names(tmp_path, files, "ament_python", "mux") == names


@pytest.mark.parametrize(("body", "names"), IN_ROSPY)
def test_in_rospy(tmp_path, body, names):
    files = {"mux/CMakeLists.txt": "project(mux)\ncatkin_package()\n", "mux/mux.py": ROSPY.replace("HERE", body)}
    assert list_names(tmp_path, files, "catkin", "mux.py") == names


LOOPS = [
    # Each turn has its own key and topic.
    ('for one in [{"ns": "a", "topic": "x"}, {"ns": "b", "topic": "y"}]: say(one["ns"] + "/" + one["topic"])',
     {"/a/x", "/b/y"}),
    ('rows = {"a": "x", "b": "y"}\nfor key, value in rows.items(): say(key + "/" + value)', {"/a/x", "/b/y"}),
    ('rows = {"a": "x", "b": "y"}\nfor key in rows: say(key + "/" + rows[key])', {"/a/x", "/b/y"}),
    ('for one in [{"ns": "a", "topic": "x"}, {"ns": "b", "topic": "y"}]: both(one["ns"], one["topic"])',
     {"/a/x", "/b/y"}),
    # Of two loops every turn of the one meets every turn of the other.
    ('for one in ["a", "b"]:\n    for other in ["x", "y"]: say(one + "/" + other)', {"/a/x", "/a/y", "/b/x", "/b/y"}),
    ('for one in ["a", "b"]:\n    for other in ["a", "b"]: say(one + "/" + other)', {"/a/a", "/a/b", "/b/a", "/b/b"}),
]  # fmt: skip


@pytest.mark.parametrize(("body", "names"), LOOPS)
def test_parts_of_a_name_are_of_one_turn(body, names):
    lines = [
        "import rospy", "from std_msgs.msg import Empty", "rospy.init_node('n')",
        "def say(name): rospy.Publisher(name, Empty)", "def both(ns, topic): say(ns + '/' + topic)", body,
    ]  # fmt: skip
    found = graph({"p/n.py": "\n".join(lines)}, ros=1)
    assert {topic for _, topic, _ in ends(found, "publisher")} == names
