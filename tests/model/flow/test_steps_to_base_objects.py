"""That an object hands its own name on to what it makes is no step of its own: as much is followed as without it."""

import pytest
from joining import graph_on_disk, manifest

ZONES = """
    #include <rclcpp/rclcpp.hpp>
    #include <std_msgs/msg/empty.hpp>
    class Monitor;
    class Base {
    public:
      Base(rclcpp::Node * node, const std::string & name) : node_(node), name_(name) {}
      bool configure() {
        std::string topic;
        if (!read(topic)) {
          return false;
        }
        pub_ = node_->create_publisher<std_msgs::msg::Empty>(topic, 1);
        return true;
      }
    protected:
      bool read(std::string & topic) { return read_common(topic); }
      bool read_common(std::string & topic) {
        topic = node_->declare_parameter(name_ + ".topic", name_);
        return true;
      }
      rclcpp::Node * node_;
      std::string name_;
      rclcpp::Publisher<std_msgs::msg::Empty>::SharedPtr pub_;
    };
    class Zone : public Base {
    public:
      Zone(rclcpp::Node * node, const std::string & name) : Base(node, name) {}
    };
    class Monitor : public PARENT {
    public:
      Monitor() : PARENT("monitor") {
        std::vector<std::string> names = declare_parameter<std::vector<std::string>>("zones");
        for (std::string name : names) {
          zones_.push_back(std::make_shared<Zone>(this, name));
          zones_.back()->configure();
        }
      }
    private:
      std::vector<std::shared_ptr<Zone>> zones_;
    };
    int main(int argc, char ** argv) {
      rclcpp::init(argc, argv);
      rclcpp::spin(std::make_shared<Monitor>());
    }
"""
NAMED = "class Named : public rclcpp::Node { public: Named(const std::string & name) : Node(name) {} };\nclass Monitor;"
LAUNCH = """
    <launch>
      <node pkg="p" exec="monitor" name="monitor"><param from="$(find-pkg-share p)/config/zones.yaml"/></node>
    </launch>
"""


def list_topics(root, parent: str, zones: str) -> set[tuple[str, str]]:
    """(topic, how) of what the launch starts."""
    code = ZONES.replace("class Monitor;", NAMED) if parent == "Named" else ZONES
    files = {
        "p/package.xml": manifest("p", "ament_cmake"),
        "p/CMakeLists.txt": "project(p)\nadd_executable(monitor src/monitor.cpp)\nament_package()\n",
        "p/src/monitor.cpp": code.replace("PARENT", parent),
        "p/launch/p.launch.xml": LAUNCH,
        "p/config/zones.yaml": f"monitor:\n  ros__parameters:\n    {zones}\n",
    }
    found = graph_on_disk(root, files, "p/launch/p.launch.xml")
    return {(e.topic, e.how) for e in found.endpoints if e.role == "publisher" and not e.implied}


@pytest.mark.parametrize("parent", ["rclcpp::Node", "Named"])
def test_names_that_a_launch_gives_to_what_an_object_makes(tmp_path, parent):
    assert list_topics(tmp_path, parent, "zones: [stop]") == {("/stop", "default")}


@pytest.mark.parametrize("parent", ["rclcpp::Node", "Named"])
def test_where_the_launch_gives_none_no_name_stands_for_them(tmp_path, parent):
    assert list_topics(tmp_path, parent, "rate: 5") == {("", "unresolved")}
