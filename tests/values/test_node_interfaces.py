"""Callbacks of what is made for interfaces of a node (`node->get_node_topics_interface()`), not for the node itself."""

from __future__ import annotations

import functools
from pathlib import Path

import pytest
from harness_workspaces import needs_compiler, write_workspace
from rosimpact.impact.analysis.values import explore_values
from rosimpact.impact.values.answers import CallbackAnswer
from rosimpact.impact.values.outcomes import Bounds, CrashKind, Reaction

NODE = """
#include <cv_bridge/cv_bridge.hpp>
#include <rclcpp/rclcpp.hpp>
#include <sensor_msgs/image_encodings.hpp>
#include <sensor_msgs/msg/image.hpp>
#include <sensor_msgs/msg/point_cloud2.hpp>
#include <sensor_msgs/point_cloud2_iterator.hpp>
#include <std_msgs/msg/int32.hpp>
#include <std_msgs/msg/u_int8.hpp>
using std::placeholders::_1;
class Reporter {
 public:
  Reporter(rclcpp::node_interfaces::NodeTopicsInterface::SharedPtr topics,
           rclcpp::node_interfaces::NodeParametersInterface::SharedPtr parameters,
           rclcpp::node_interfaces::NodeLoggingInterface::SharedPtr logging)
  : logging_(logging), publisher_(
      rclcpp::create_publisher<std_msgs::msg::Int32, std::allocator<void>, rclcpp::Publisher<std_msgs::msg::Int32>>(
        parameters, topics, "out", 1)) {
    if (!parameters->has_parameter("limit")) parameters->declare_parameter("limit", rclcpp::ParameterValue(7));
    limit_ = parameters->get_parameter("limit").as_int();
  }
  void report(int value) {
    if (value > 100) { RCLCPP_WARN(logging_->get_logger(), "much"); return; }
    std_msgs::msg::Int32 sent;
    sent.data = value;
    publisher_->publish(sent);
  }
  rclcpp::node_interfaces::NodeLoggingInterface::SharedPtr logging_;
  rclcpp::Publisher<std_msgs::msg::Int32>::SharedPtr publisher_;
  int limit_ = 0;
};
class Machine : public rclcpp::Node {
 public:
  Machine() : Node("machine"),
    reporter_(get_node_topics_interface(), get_node_parameters_interface(), get_node_logging_interface()) {
    a_ = rclcpp::create_subscription<std_msgs::msg::UInt8>(
      get_node_topics_interface(), "level", 1, std::bind(&Machine::onLevel, this, _1));
    b_ = rclcpp::create_subscription<std_msgs::msg::UInt8>(
      *this, "rate", rclcpp::QoS(1), std::bind(&Machine::onRate, this, _1));
    e_ = subscribe<std_msgs::msg::UInt8>(
      "other", [this](const std_msgs::msg::UInt8 & msg) { reporter_.report(msg.data); });
    c_ = create_subscription<sensor_msgs::msg::Image>("image", 1, std::bind(&Machine::onImage, this, _1));
    d_ = create_subscription<sensor_msgs::msg::PointCloud2>("cloud", 1, std::bind(&Machine::onCloud, this, _1));
    second_ = rclcpp::create_timer(
      get_clock(), std::chrono::milliseconds(10), std::bind(&Machine::onSecond, this), nullptr,
      get_node_base_interface().get(), get_node_timers_interface().get());
    timer_ = rclcpp::create_wall_timer(
      std::chrono::milliseconds(10), std::bind(&Machine::onTick, this), nullptr,
      get_node_base_interface().get(), get_node_timers_interface().get());
  }
  void onLevel(const std_msgs::msg::UInt8::SharedPtr msg) { reporter_.report(msg->data); }
  void onRate(const std_msgs::msg::UInt8::SharedPtr msg) {
    reporter_.report(100 / msg->data);  // onRate
  }
  void onImage(const sensor_msgs::msg::Image::ConstSharedPtr & msg) {
    if (msg->encoding != sensor_msgs::image_encodings::MONO8) {
      RCLCPP_ERROR(get_logger(), "no mono8");
      return;
    }
    const auto image = cv_bridge::toCvShare(msg, sensor_msgs::image_encodings::MONO8);  // onImage
    reporter_.report(image->image.rows);
  }
  void onCloud(const sensor_msgs::msg::PointCloud2::ConstSharedPtr & msg) {
    sensor_msgs::msg::PointCloud2 made;
    sensor_msgs::PointCloud2Modifier modifier(made);
    modifier.setPointCloud2FieldsByString(2, "xyz", "rgb");
    modifier.resize(1);
    sensor_msgs::PointCloud2Iterator<float> x(made, "x");
    sensor_msgs::PointCloud2Iterator<uint8_t> red(made, "r");
    *x = 2.0f;
    *red = 3;
    for (const auto & field : msg->fields) if (field.name == "x") reporter_.report(made.point_step + made.data[18]);
  }
  void onTick() { reporter_.report(1); }
  void onSecond() { reporter_.report(2); }
  template <class M, class F> rclcpp::SubscriptionBase::SharedPtr subscribe(const std::string & topic, F && callback) {
    auto parameters = get_node_parameters_interface();
    auto topics = get_node_topics_interface();
    return rclcpp::create_subscription<M, F>(
      parameters, topics, topic, rclcpp::QoS(1), std::forward<F>(callback), rclcpp::SubscriptionOptions());
  }
  Reporter reporter_;
  rclcpp::SubscriptionBase::SharedPtr a_, b_, c_, d_, e_;
  rclcpp::TimerBase::SharedPtr timer_, second_;
};
int main(int argc, char ** argv) {
  rclcpp::init(argc, argv);
  auto node = std::make_shared<Machine>();
  rclcpp::spin(node->get_node_base_interface());
}
"""


@pytest.fixture(scope="module")
def root(tmp_path_factory) -> Path:
    return write_workspace(tmp_path_factory.mktemp("interfaces"), 2, {"src/node.cpp": NODE}, "src/node.cpp")


@functools.cache
def explore(root: Path) -> dict[str, CallbackAnswer]:
    """The callbacks of a workspace with replays, by the last part of their names."""
    answer = explore_values(
        root, kinds=("subscriber", "timer"), bounds=Bounds(seconds=120.0), replays=True, publishers=False, jobs=1
    )
    return {one.callback.rpartition("::")[2]: one for one in answer.report.callbacks}


@needs_compiler
@pytest.mark.parametrize(
    ("name", "crashes", "reactions"),
    [
        ("onLevel", set(), {Reaction.HANDLED, Reaction.LOG_ONLY}),
        ("onRate", {CrashKind.DIVISION}, {Reaction.HANDLED}),
        ("onImage", {CrashKind.EXCEPTION}, {Reaction.HANDLED, Reaction.LOG_ONLY}),
        ("onCloud", set(), {Reaction.HANDLED, Reaction.IGNORED}),
        ("onTick", set(), {Reaction.HANDLED}),
    ],
)
def test_what_is_made_for_an_interface_of_a_node_is_explored(root, name, crashes, reactions):
    one = explore(root)[name]
    assert one.reason == ""
    assert not [each for each in one.unknown if "does not compile" in each]
    line = next((number for number, text in enumerate(NODE.splitlines(), 1) if text.endswith(f"// {name}")), 0)
    found = {(each.crash, each.place.line, each.confirmed) for each in one.examples if each.crash is not None}
    assert found == {(kind, line, True) for kind in crashes}
    assert {each for each, count in one.counts.items() if count} - {Reaction.CRASH, Reaction.UNKNOWN} == reactions
