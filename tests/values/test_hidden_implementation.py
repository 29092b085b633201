"""State that a node has behind a pointer to its implementation: any value it may have, and what changes it is seen."""

import pytest
from harness_workspaces import needs_clang, write_workspace
from rosimpact.impact.analysis.values import explore_values
from rosimpact.impact.values.outcomes import Reaction

HEADER = """#pragma once
#include <memory>
#include <rclcpp/rclcpp.hpp>
{before}
class Lamp : public rclcpp::Node {{
 public:
  Lamp();
 private:
  {declared}
  {pointer} impl_;
}};
"""
SOURCE = """#include "lamp.hpp"
#include <std_msgs/msg/int32.hpp>
using std_msgs::msg::Int32;
struct {name} {{
  void onMode(const Int32::SharedPtr msg) {{ if (msg->data > 3) mode_ = msg->data; }}
  void onLevel(const Int32::SharedPtr msg) {{
    if (mode_ == 0) return;
    Int32 out;
    if (mode_ == 77) out.data = 100 / (msg->data - 5);
    pub_->publish(out);
  }}
  rclcpp::Subscription<Int32>::SharedPtr sub_, sub2_;
  rclcpp::Publisher<Int32>::SharedPtr pub_;
  int mode_ = 0;
}};
Lamp::Lamp() : rclcpp::Node("lamp") {{
  impl_ = {made};
  impl_->pub_ = create_publisher<Int32>("out", 1);
  impl_->sub_ = create_subscription<Int32>("mode", 1, std::bind(&{name}::onMode, {given}, std::placeholders::_1));
  impl_->sub2_ = create_subscription<Int32>("level", 1, [this](const Int32::SharedPtr msg) {{ impl_->onLevel(msg); }});
}}
int main(int argc, char **argv) {{ rclcpp::init(argc, argv); rclcpp::spin(std::make_shared<Lamp>()); }}
"""


def explore(root):
    """By topic: counts of ways, crashes by kind and what they are for, and what surely is not handled."""
    answer = explore_values(root, jobs=1, publishers=False)
    found = {}
    for one in answer.report.callbacks:
        assert (one.reason, one.unknown) == ("", {})
        crashes = {(each.crash.value, tuple(sorted(each.values.items()))) for each in one.examples if each.crash}
        found[one.topics[0]] = {way: one.counts.get(way, 0) > 0 for way in Reaction}, crashes
    return found


@needs_clang
@pytest.mark.parametrize(
    "before, declared, name, pointer, made, given",
    [
        ("", "struct Impl;", "Lamp::Impl", "Impl *", "new Impl", "impl_"),
        ("", "struct Impl;", "Lamp::Impl", "std::unique_ptr<Impl>", "std::make_unique<Impl>()", "impl_.get()"),
        ("class Inner;", "", "Inner", "std::shared_ptr<Inner>", "std::make_shared<Inner>()", "impl_"),
    ],
)  # fmt: skip
def test_state_of_an_implementation(tmp_path, before, declared, name, pointer, made, given):
    files = {
        "src/lamp.hpp": HEADER.format(before=before, declared=declared, pointer=pointer),
        "src/lamp.cpp": SOURCE.format(name=name, made=made, given=given),
    }
    found = explore(write_workspace(tmp_path / "ws", 2, files, "src/lamp.cpp"))
    ways, crashes = found["/mode"]
    assert ways[Reaction.HANDLED] and ways[Reaction.IGNORED] and not crashes
    ways, crashes = found["/level"]
    assert ways[Reaction.HANDLED] and ways[Reaction.IGNORED]
    assert ("division by zero", (("msg.data", 5), ("this.impl_.mode_", 77))) in {
        (kind, tuple(row for row in values if row[0] in ("msg.data", "this.impl_.mode_"))) for kind, values in crashes
    }


HELPER = """#pragma once
struct Meter { void reset() { factor = 1; } int factor = 1; };
"""
NODE = """#include <memory>
#include <rclcpp/rclcpp.hpp>
#include <std_msgs/msg/int32.hpp>
#include "meter.hpp"
using std_msgs::msg::Int32;
class Lamp : public rclcpp::Node {
 public:
  Lamp() : rclcpp::Node("lamp"), meter_(std::make_unique<Meter>()) {
    pub_ = create_publisher<Int32>("out", 1);
    sub_ = create_subscription<Int32>("level", 1, [this](const Int32::SharedPtr msg) {
      Int32 out;
      out.data = msg->data / meter_->factor;
      pub_->publish(out);
    });
  }
  std::unique_ptr<Meter> meter_;
  rclcpp::Publisher<Int32>::SharedPtr pub_;
  rclcpp::Subscription<Int32>::SharedPtr sub_;
};
int main(int argc, char **argv) { rclcpp::init(argc, argv); rclcpp::spin(std::make_shared<Lamp>()); }
"""


@needs_clang
def test_a_helper_of_its_own_is_no_implementation(tmp_path):
    """What a class of its own holds is what its functions set it to."""
    files = {"src/meter.hpp": HELPER, "src/node.cpp": NODE}
    found = explore(write_workspace(tmp_path / "ws", 2, files, "src/node.cpp"))
    ways, crashes = found["/level"]
    assert ways[Reaction.HANDLED] and not ways[Reaction.CRASH] and not crashes
