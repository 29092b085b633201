"""Compiling has a time limit of its own, whatever time the exploration has."""

import sys

import pytest
from harness_workspaces import Prepared, needs_clang, write_workspace
from rosimpact.impact.values.harness.toolchain import CompilerTime
from rosimpact.impact.values.outcomes import Bounds

SOURCE = """
#include <ros/ros.h>
#include <std_msgs/Int32.h>
#include <vendor/driver.h>
vendor::Driver driver;
void onLevel(const std_msgs::Int32::ConstPtr &msg) { driver.start(vendor::FAST, msg->data); }
int main(int argc, char **argv) {
  ros::init(argc, argv, "machine");
  ros::NodeHandle nh;
  ros::Subscriber sub = nh.subscribe("level", 1, onLevel);
  ros::spin();
}
"""


def test_a_compiler_that_does_not_end_is_stopped(tmp_path):
    time = CompilerTime(0.5)
    run = time.run([sys.executable, "-c", "while True: pass"], tmp_path)
    assert run.status == -1 and run.errors.endswith("was stopped for its time")
    assert time.is_over and time.describe() == "compiling took more than 0.5 s (1 runs of the compiler)"


def test_runs_are_added_up(tmp_path):
    time = CompilerTime(1000)
    for rounds in (1, 2):
        assert time.run([sys.executable, "-c", "print('x')"], tmp_path).out == "x\n"
        assert time.rounds == rounds and 0 < time.used < 1000 and not time.is_over


@needs_clang
@pytest.mark.parametrize("compiling, expected", [(0.001, "compiling took more than 0.001 s"), (500, "")])
def test_a_source_that_needs_many_rounds(tmp_path, compiling, expected):
    root = write_workspace(tmp_path / "ws", 1, {"src/machine.cpp": SOURCE}, "src/machine.cpp")
    found = Prepared(root, tmp_path / "harness", ("subscriber",), Bounds(compiling=compiling)).by_name["onLevel"]
    assert found.reason.startswith(expected) and bool(found.reason) == bool(expected)
    assert found.compiled_in > 0 and (found.rounds == 1 if expected else found.rounds > 3)


NODES = """
#include <rclcpp/rclcpp.hpp>
#include <std_msgs/msg/int32.hpp>
#include "machine/shared.hpp"
class {name} : public rclcpp::Node {{
 public:
  {name}() : rclcpp::Node("node") {{
    sub_ = create_subscription<std_msgs::msg::Int32>("a", 1, [this](const std_msgs::msg::Int32::SharedPtr msg) {{
      set_level(msg->data);
    }});
  }}
  rclcpp::Subscription<std_msgs::msg::Int32>::SharedPtr sub_;
}};
int main(int argc, char **argv) {{ rclcpp::init(argc, argv); rclcpp::spin(std::make_shared<{name}>()); }}
"""
SHARED = """#pragma once
#include <vendor/version.hpp>
#include <vendor/driver.hpp>
#if VENDOR_VERSION_GTE(2, 0)
#error "too new"
#endif
inline void set_level(int level) {
  vendor::Info info = vendor::ask().latest().info;
  vendor::Mode mode = info.mode(3).other();
  vendor::start(vendor::FAST, level, mode);
}
"""


@needs_clang
def test_what_a_shared_header_lacks_is_found_out_once(tmp_path):
    """Several rounds for the first source that includes it, one for each other."""
    files = {f"src/{name}.cpp": NODES.format(name=name) for name in ("One", "Two")}
    files["include/machine/shared.hpp"] = SHARED
    root = write_workspace(tmp_path / "ws", 2, files, "src/One.cpp src/Two.cpp")
    found = Prepared(root, tmp_path / "harness", ("subscriber",), Bounds()).all
    assert [one.reason for one in found] == ["", ""]
    assert found[0].rounds > 3 and found[1].rounds == 1
