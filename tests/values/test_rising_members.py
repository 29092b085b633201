"""Members that are only counted up: they are never below where they began."""

import pytest
from harness_workspaces import Prepared, needs_clang, write_workspace
from rosimpact.impact.facts.flow import FlowExpr
from rosimpact.impact.values.harness.callbacks import find_least
from rosimpact.impact.values.ir.explore import explore
from rosimpact.impact.values.outcomes import Bounds, CrashKind

HIGHEST = 2**31 - 1


@pytest.mark.parametrize(
    "rows, expected",
    [
        ([("+=", "1")], HIGHEST),
        ([("+=", "1"), ("=", "0"), ("=", "4")], 0),
        ([("=", "-3"), ("+=", "2")], -3),
        ([("+=", "1"), ("-=", "1")], None),
        ([("+=", "-1")], None),
        ([("+=", "1"), ("=", None)], None),
        ([("=", "0.5")], None),
        ([], None),
    ],
)
def test_the_least_value_of_what_is_counted_up(rows, expected):
    given = [(sign, FlowExpr("number", text) if text else FlowExpr("name", "n")) for sign, text in rows]
    assert find_least(given) == expected


SOURCE = """
#include <ros/ros.h>
#include <std_msgs/Int32.h>
class Machine {
 public:
  Machine() : rising_(0), falling_(0) {
    sub_ = nh_.subscribe("level", 1, &Machine::onLevel, this);
    timer_ = nh_.createTimer(ros::Duration(1), &Machine::onTimer, this);
    pub_ = nh_.advertise<std_msgs::Int32>("out", 1);
  }
  void onLevel(const std_msgs::Int32::ConstPtr &msg) {
    std_msgs::Int32 out;
    if (msg->data == 1 && rising_ < 3) out.data = table_[rising_];  // rising
    if (msg->data == 2 && falling_ < 3) out.data = table_[falling_];  // falling
    pub_.publish(out);
  }
  void onTimer(const ros::TimerEvent &) { rising_++; falling_--; if (rising_ > 9) rising_ = 2; }
  ros::NodeHandle nh_;
  ros::Subscriber sub_;
  ros::Timer timer_;
  ros::Publisher pub_;
  int rising_, falling_;
  int table_[3] = {1, 2, 3};
};
int main(int argc, char **argv) { ros::init(argc, argv, "m"); Machine machine; ros::spin(); }
"""


@needs_clang
def test_only_what_may_fall_is_below_its_start(tmp_path):
    root = write_workspace(tmp_path / "ws", 1, {"src/machine.cpp": SOURCE}, "src/machine.cpp")
    prepared = Prepared(root, tmp_path / "harness", ("subscriber",))
    one = prepared.by_name["onLevel"]
    found = explore(one.ir_texts, one.entry, Bounds(seconds=120), one.is_workspace_file)
    crashes = {(path.crash, path.place.line) for path in found.paths if path.crash is not None}
    assert crashes == {(CrashKind.INDEX, prepared.find_line("machine/src/machine.cpp", "falling"))}
    assert {"this.rising_", "this.falling_"} <= set(found.inputs)
