"""Crashes of callbacks whose node is set up by code that is not here, or cannot be set up."""

from harness_workspaces import needs_clang, write_workspace
from rosimpact.impact.analysis.values import explore_values
from rosimpact.impact.values.outcomes import Bounds, Reaction

DEVICE = """
#include <ros/ros.h>
#include <std_msgs/Float64.h>
#include <std_msgs/Int32.h>
#include <vendor/device.h>
class Machine {{
 public:
  Machine() {{
    if (!device_.open()) throw std::runtime_error("no device");
    {more}
    pub_ = nh_.advertise<std_msgs::Int32>("out", 1);
    sub_ = nh_.subscribe("in", 1, &Machine::onLevel, this);
  }}
  void onLevel(const std_msgs::Float64::ConstPtr &msg) {{
    std_msgs::Int32 out;
    {work}
    pub_.publish(out);
  }}
  ros::NodeHandle nh_;
  ros::Publisher pub_;
  ros::Subscriber sub_;
  vendor::Device device_;
  int share_ = 1;
}};
int main(int argc, char **argv) {{ ros::init(argc, argv, "machine"); Machine machine; ros::spin(); }}
"""


def explore(root, source, ros=1, **bounds):
    root = write_workspace(root, ros, {"src/machine.cpp": source}, "src/machine.cpp")
    answer = explore_values(root, publishers=False, jobs=1, bounds=Bounds(**bounds))
    (one,) = answer.report.callbacks
    return one, {each.crash.value for each in one.examples if each.crash is not None}


@needs_clang
def test_a_device_that_answers_is_none_that_prevents_the_crash(tmp_path):
    """There is no callback without it."""
    one, crashes = explore(tmp_path / "ws", DEVICE.format(more="", work="out.data = static_cast<int>(msg->data);"))
    assert not one.reason and crashes == {"float that no integer can hold"}


@needs_clang
def test_what_the_device_says_may_prevent_it(tmp_path):
    more = "if (device_.count() == 3) share_ = 0;"
    one, crashes = explore(tmp_path / "ws", DEVICE.format(more=more, work="out.data = 100 / share_;"))
    assert not one.reason and not crashes
    assert any("unless what is not known prevents it" in each for each in one.unknown)


PLUGIN = """
#include <rclcpp/rclcpp.hpp>
#include <std_msgs/msg/int32.hpp>
using std_msgs::msg::Int32;
class Plugin {
 public:
  void configure(const std::weak_ptr<rclcpp::Node> &parent) { node_ = parent.lock(); }
  __attribute__((always_inline)) bool start() {
    if (wanted_) {
      sub_ = node_->create_subscription<Int32>("a", 1, [this](const Int32::SharedPtr msg) { last_ = *msg; });
    }
    RCLCPP_INFO(node_->get_logger(), "started");
    return true;
  }
  Int32 get() const { return last_; }
  std::shared_ptr<rclcpp::Node> node_;
  rclcpp::Subscription<Int32>::SharedPtr sub_;
  Int32 last_;
  bool wanted_ = false;
};
"""


@needs_clang
def test_a_node_that_fails_before_it_subscribes_says_nothing_of_the_callback(tmp_path):
    one, crashes = explore(tmp_path / "ws", PLUGIN, 2)
    assert not crashes and Reaction.CRASH not in one.counts
    assert all("before the callback begins" in each or "no way" in each for each in (*one.unknown, one.reason) if each)


MANY = """
#include <ros/ros.h>
#include <std_msgs/Int32MultiArray.h>
#include <std_msgs/Int32.h>
ros::Publisher pub;
void onNumbers(const std_msgs::Int32MultiArray::ConstPtr &msg) {
  std_msgs::Int32 out;
  if (msg->data.size() < 3) return;
  assert(msg->data[0] != 7);
  for (int number : msg->data) {
    if (number > 100) pub.publish(out);
    if (number > 1000) pub.publish(out);
  }
}
int main(int argc, char **argv) {
  ros::init(argc, argv, "machine");
  ros::NodeHandle nh;
  pub = nh.advertise<std_msgs::Int32>("out", 1);
  ros::Subscriber sub = nh.subscribe("numbers", 1, onNumbers);
  ros::spin();
}
"""


@needs_clang
def test_a_crash_is_not_lost_where_ways_are_many(tmp_path):
    """Ways that end in a failed check are followed first."""
    one, crashes = explore(tmp_path / "ws", MANY, paths=6)
    assert one.left and crashes == {"failed assertion"}
