"""Callbacks of synchronizers: which of the messages is asked about, and that the others are of their own types."""

import pytest
from harness_workspaces import Prepared, needs_clang, write_workspace
from rosimpact.impact.analysis.session import open_tree
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.flow.workspace import link_for_flow, make_graph
from rosimpact.impact.values.harness.callbacks import list_callbacks
from rosimpact.impact.values.ir.explore import explore
from rosimpact.impact.values.outcomes import Bounds, CrashKind, Reaction

FILTERS = """
#include <ros/ros.h>
#include <message_filters/subscriber.h>
#include <message_filters/time_synchronizer.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Range.h>
#include <std_msgs/Float64.h>
class Machine {
 public:
  Machine() : joints_(nh_, "joints", 1),
              range_(nh_, "range", 1), sync_(joints_, range_, 10) {
    pub_ = nh_.advertise<std_msgs::Float64>("out", 1);
    // The callback is registered far from where the subscribers are made.
    // 1
    // 2
    // 3
    // 4
    // 5
    // 6
    // 7
    // 8
    // 9
    // 10
    // 11
    // 12
    sync_.registerCallback(boost::bind(&Machine::onBoth, this, _1, _2));
  }
  void onBoth(const sensor_msgs::JointState::ConstPtr &joints, const sensor_msgs::Range::ConstPtr &range) {
    if (range->range > 1.0f) {
      std_msgs::Float64 out;
      out.data = joints->position[0];
      pub_.publish(out);
    }
  }
  ros::NodeHandle nh_;
  ros::Publisher pub_;
  message_filters::Subscriber<sensor_msgs::JointState> joints_;
  message_filters::Subscriber<sensor_msgs::Range> range_;
  message_filters::TimeSynchronizer<sensor_msgs::JointState, sensor_msgs::Range> sync_;
};
int main(int argc, char **argv) { ros::init(argc, argv, "m"); Machine machine; ros::spin(); }
"""
PYTHON = """
import message_filters
import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan
scans = message_filters.Subscriber("scan", LaserScan)
odometry = message_filters.Subscriber("odom", Odometry)
sync = message_filters.TimeSynchronizer([scans, odometry], 10)
def on_both(scan, odom):
    pass
sync.registerCallback(on_both)
rospy.Subscriber("odom", Odometry, lambda odom: None)
"""


def list_found(root, language):
    with Store(None) as store:
        workspace = link_for_flow(open_tree(root, ""), store, 1)
        return list_callbacks(workspace, make_graph(workspace, store, code_alone=True), language)


def test_places_in_a_synchronizer(tmp_path):
    root = write_workspace(tmp_path / "ws", 1, {"scripts/both.py": PYTHON}, "src/none.cpp")
    both = "sensor_msgs/LaserScan", "nav_msgs/Odometry"
    found = [one for one in list_found(root, "python") if one.kind == "subscriber"]
    assert [(one.message_type, one.joined, one.place) for one in found] == [
        (both[0], both, 0), (both[1], both, 1), (both[1], (), 0),
    ]  # fmt: skip
    assert [one.is_filtered for one in found] == [True, True, False]


@needs_clang
@pytest.mark.parametrize("asked", ["sensor_msgs/JointState", "sensor_msgs/Range"])
def test_each_message_of_a_synchronizer_has_its_type(tmp_path, asked):

    root = write_workspace(tmp_path / "ws", 1, {"src/machine.cpp": FILTERS}, "src/machine.cpp")
    prepared = Prepared(root, tmp_path / "harness", ("subscriber",))
    (one,) = [each for each in prepared.all if each.message_type == asked]
    assert (one.reason, one.way) == ("", "built")
    found = explore(one.ir_texts, one.entry, Bounds(seconds=120), one.is_workspace_file)
    joints, range_ = ("msg", "msg2") if asked == "sensor_msgs/JointState" else ("msg1", "msg")
    assert {f"{joints}.position.size", f"{range_}.range"} <= set(found.inputs)
    assert {(path.result, path.crash) for path in found.paths} == {
        (Reaction.CRASH, CrashKind.INDEX), (Reaction.HANDLED, None), (Reaction.IGNORED, None),
    }  # fmt: skip


EITHER = """
#include <rclcpp/rclcpp.hpp>
#include <std_msgs/msg/int32.hpp>
class Machine : public rclcpp::Node {
 public:
  Machine() : rclcpp::Node("machine") {
    pub_ = create_publisher<std_msgs::msg::Int32>("out", 1);
    if (declare_parameter("first", true))
      sub_ = create_subscription<std_msgs::msg::Int32>("a", 1, [this](const std_msgs::msg::Int32 &m) { onFirst(m); });
    else
      sub_ = create_subscription<std_msgs::msg::Int32>("b", 1, [this](const std_msgs::msg::Int32 &m) { onOther(m); });
  }
  void onFirst(const std_msgs::msg::Int32 &message) { pub_->publish(message); }
  void onOther(const std_msgs::msg::Int32 &message) {
    std_msgs::msg::Int32 out;
    out.data = 100 / message.data;
    pub_->publish(out);
  }
  rclcpp::Publisher<std_msgs::msg::Int32>::SharedPtr pub_;
  rclcpp::Subscription<std_msgs::msg::Int32>::SharedPtr sub_;
};
int main(int argc, char **argv) { rclcpp::init(argc, argv); rclcpp::spin(std::make_shared<Machine>()); }
"""


@needs_clang
def test_a_callback_beside_another_is_not_taken_for_it(tmp_path):
    root = write_workspace(tmp_path / "ws", 2, {"src/machine.cpp": EITHER}, "src/machine.cpp")
    first, other = Prepared(root, tmp_path / "harness", ("subscriber",)).all
    said = [explore(one.ir_texts, one.entry, Bounds(seconds=60), one.is_workspace_file) for one in (first, other)]
    crashes = [{path.crash for path in found.paths} - {None} for found in said]
    assert crashes == [set(), {CrashKind.DIVISION}]
