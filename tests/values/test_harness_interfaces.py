"""Headers of messages: what is generated, and that it compiles in both forms."""

import pytest
from harness_workspaces import needs_clang, write_workspace
from rosimpact.impact.analysis.session import open_tree
from rosimpact.impact.facts.interface import extract
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.flow.workspace import link_for_flow
from rosimpact.impact.values.harness.facade import find_facade, list_folders
from rosimpact.impact.values.harness.interfaces import KnownInterfaces, list_constants, write_headers
from rosimpact.impact.values.harness.toolchain import find_clang, run_compiler


class _Package:
    def __init__(self, name, interfaces):
        self.name = name
        self.linked = self
        self.interfaces = [_File(path, text) for path, text in interfaces.items()]


class _File:
    def __init__(self, path, text):
        self.path = path
        self.name = path.rpartition("/")[2].partition(".")[0]
        self.definition = extract(text.encode(), path.rpartition(".")[2])


class _Workspace:
    def __init__(self, ros, packages=()):
        self.ros, self.packages = ros, packages

    def __iter__(self):
        return iter(self.packages)


def make(ros, interfaces=None):
    return KnownInterfaces(_Workspace(ros, [_Package("own", interfaces)] if interfaces else []))


@pytest.mark.parametrize(
    "ros, header, key",
    [
        (1, "geometry_msgs/Twist.h", "geometry_msgs/msg/Twist"),
        (1, "std_srvs/SetBool.h", "std_srvs/srv/SetBool"),
        (1, "std_srvs/SetBoolRequest.h", "std_srvs/srv/SetBool"),
        (1, "move_base_msgs/MoveBaseActionGoal.h", "move_base_msgs/msg/MoveBaseActionGoal"),
        (1, "geometry_msgs/Nothing.h", ""),
        (2, "sensor_msgs/msg/laser_scan.hpp", "sensor_msgs/msg/LaserScan"),
        (2, "sensor_msgs/msg/detail/laser_scan__struct.hpp", "sensor_msgs/msg/LaserScan"),
        (2, "std_srvs/srv/set_bool.hpp", "std_srvs/srv/SetBool"),
        (2, "example_interfaces/action/fibonacci.hpp", "example_interfaces/action/Fibonacci"),
        (2, "sensor_msgs/msg/laser_scan.h", ""),
    ],
)
def test_header_is_of_an_interface(ros, header, key):
    assert make(ros).find_key_of_header(header) == key


OWN = {
    "msg/Motor.msg": 'int8 LOW=-128\nuint64 BIG=18446744073709551615\nstring NAME=it\'s "it"\nfloat32 HALF=0.5\n'
    'bool on\nbyte raw\nchar letter\nwstring wide\nfloat64 gain 1.5\nstring label "none"\nint32[3] fixed [1, 2, 3]\n'
    "uint8[] open\nint16[<=4] some\nOther[] others\nbuiltin_interfaces/Time stamp\nstring<=5 brief\nbool[] flags\n",
    "msg/Other.msg": "geometry_msgs/Point at\nfloat64 class_size\n",
    "srv/Ask.srv": "string question\n---\nint32 answer\n",
    "action/Move.action": "int32 goal_x\n---\nbool done\n---\nfloat32 progress\n",
}
USE2 = """
#include <own/msg/motor.hpp>
#include <own/srv/ask.hpp>
#include <own/action/move.hpp>
static_assert(own::msg::Motor::LOW == -128 && own::msg::Motor::BIG == 18446744073709551615ull);
int main() {
  auto made = std::make_shared<own::msg::Motor>();
  own::msg::Motor::ConstSharedPtr constant = made;
  own::msg::Motor::UniquePtr own_one(new own::msg::Motor());
  std::array<int32_t, 3> &fixed = made->fixed;
  made->some.push_back(1); made->open.resize(2); made->others.emplace_back().at.x = 1.0; made->flags.push_back(true);
  made->wide = u"x";
  own::msg::Motor::_gain_type gain = made->gain;
  own::srv::Ask::Request request; own::action::Move::Goal goal; own::action::Move::Feedback feedback;
  ri::fill(*made, "msg"); ri::send(*made, "msg");
  int sizes = static_cast<int>(request.question.size()) + goal.goal_x + (feedback.progress > 0);
  return fixed[0] + static_cast<int>(gain) + sizes +
         (*constant == *own_one);
}
"""
USE1 = """
#include <own/Motor.h>
#include <own/Ask.h>
#include <own/MoveAction.h>
static_assert(own::Motor::LOW == -128);
int main() {
  own::MotorPtr made(new own::Motor()); own::MotorConstPtr constant = made; own::Motor::ConstPtr other = constant;
  boost::array<int32_t, 3> &fixed = made->fixed; int8_t raw = made->raw;
  own::Ask ask; ask.request.question = own::Motor::NAME; own::AskRequest request = ask.request;
  own::MoveActionGoal goal; goal.goal.goal_x = 1; goal.goal_id.id = "a"; goal.header.stamp = ros::Time(1, 2);
  ri::fill(*made, "msg"); ri::send(*made, "msg");
  return fixed[0] + raw + static_cast<int>(request.question.size()) + (*other == *made);
}
"""


def test_own_interfaces_of_ros2():
    found = write_headers(make(2, OWN), "own/msg/Motor")
    text = found["own/msg/motor.hpp"]
    assert "static constexpr int8_t LOW = static_cast<int8_t>(-128LL);" in text
    assert 'static inline const std::string NAME = "it\'s \\"it\\"";' in text
    assert "double gain{static_cast<double>(1.5)};" in text
    assert 'std::string label{"none"};' in text
    assert "::rosidl_runtime_cpp::BoundedVector<int16_t, 4> some{};" in text
    assert {"own/msg/other.hpp", "geometry_msgs/msg/point.hpp", "builtin_interfaces/msg/time.hpp"} <= found.keys()


def test_constants():
    assert list_constants(make(2, OWN), "own/msg/Motor")["LOW"] == ("int8", "-128")
    assert list_constants(make(2, OWN), "own/msg/Nothing") == {}


def test_configuration_of_dynamic_reconfigure(tmp_path):
    cfg = (
        "from dynamic_reconfigure.parameter_generator_catkin import *\ngen = ParameterGenerator()\n"
        'gen.add("max_vel", double_t, 0, "d", 0.5, 0, 1)\ngen.add("turns", int_t, 0, "d", 1, 0, 9)\n'
        'exit(gen.generate("machine", "machine", "Machine"))\n'
    )
    root = write_workspace(tmp_path, 1, {"cfg/Machine.cfg": cfg, "src/a.cpp": "int main() {}\n"}, "src/a.cpp")
    workspace = link_for_flow(open_tree(root, ""), Store(None), 1)
    text = KnownInterfaces(workspace).write_configuration("machine/MachineConfig.h")
    assert "struct MachineConfig" in text and "double max_vel{};" in text and "int turns{};" in text
    assert KnownInterfaces(workspace).write_configuration("machine/OtherConfig.h") == ""


@needs_clang
@pytest.mark.parametrize("ros, use", [(2, USE2), (1, USE1)])
def test_headers_compile(ros, use, tmp_path):
    interfaces = dict(OWN)
    if ros == 1:
        motor = "\n".join(
            line.partition(" 1.5")[0] for line in OWN["msg/Motor.msg"].split("\n")
            if "wstring" not in line and "<=" not in line and "builtin" not in line and "label" not in line
        ).replace(" [1, 2, 3]", "")  # fmt: skip
        interfaces["msg/Motor.msg"] = motor + "time stamp\nduration span\n"
    definitions = make(ros, interfaces)
    keys = ["own/msg/Motor", "own/srv/Ask", "own/msg/MoveAction" if ros == 1 else "own/action/Move"]
    for key in keys:
        for path, text in write_headers(definitions, key).items():
            at = tmp_path / path
            at.parent.mkdir(parents=True, exist_ok=True)
            at.write_text(text)
    for header in ("boost/array.hpp", "boost/shared_ptr.hpp") if ros == 1 else ():
        (tmp_path / header).parent.mkdir(exist_ok=True)
        (tmp_path / header).write_text(f"#pragma once\n#include <{find_facade(header, 1)}>\n")
    folders = [f"-I{each}" for each in (tmp_path, *list_folders(ros))]
    command = [find_clang(), "-x", "c++", "-std=gnu++17", "-fsyntax-only", f"-DRI_ROS={ros}", *folders, "-"]
    done = run_compiler(command, tmp_path, given=use)
    assert done.status == 0, done.errors


@pytest.mark.parametrize(
    "header, ros, to",
    [
        ("ros/node_handle.h", 1, "ros/ros.h"),
        ("ros/ri_time.h", 1, ""),
        ("boost/thread/mutex.hpp", 1, "boost/ri_boost.hpp"),
        ("boost/asio.hpp", 1, ""),
        ("rclcpp/node.hpp", 2, "rclcpp/rclcpp.hpp"),
        ("rclcpp_lifecycle/lifecycle_node.hpp", 2, "ri_lifecycle.hpp"),
        ("tf2_ros/transform_listener.h", 2, "ri_tf2.hpp"),
        ("vector", 2, ""),
    ],
)
def test_facades(header, ros, to):
    assert find_facade(header, ros) == to
