"""Callbacks of rclcpp: lambdas, binds, members, services, timers, transforms, own messages, several sources, and
headers that are not on the machine."""

import pytest
from harness_workspaces import Prepared, double, needs_compiler, text, write_workspace
from rosimpact.impact.values.outcomes import CodeLine, CrashKind, Reaction

HEADER = """
#pragma once
#include <rclcpp/rclcpp.hpp>
#include <machine/msg/motor_state.hpp>
#include <std_msgs/msg/string.hpp>
#include <std_srvs/srv/set_bool.hpp>
#include <geometry_msgs/msg/pose_stamped.hpp>
#include <nav_msgs/msg/odometry.hpp>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>
#include <vendor_motor/driver.hpp>
namespace machine {
class Driver : public rclcpp::Node {
 public:
  explicit Driver(const rclcpp::NodeOptions & options);
 private:
  void on_state(const machine::msg::MotorState::SharedPtr msg);
  void on_name(std_msgs::msg::String::UniquePtr msg);
  void on_pose(const geometry_msgs::msg::PoseStamped & msg);
  void on_tick();
  void on_command(const std_msgs::msg::String::ConstSharedPtr msg);
  rclcpp::Publisher<std_msgs::msg::String>::SharedPtr out_;
  std::vector<rclcpp::SubscriptionBase::SharedPtr> subscriptions_;
  rclcpp::Service<std_srvs::srv::SetBool>::SharedPtr service_;
  rclcpp::TimerBase::SharedPtr timer_;
  std::shared_ptr<tf2_ros::Buffer> buffer_;
  std::shared_ptr<tf2_ros::TransformListener> listener_;
  vendor_motor::Driver driver_{"can0"};
  int limit_{3};
  std::array<int, 4> table_{{1, 2, 3, 4}};
  std::optional<int> last_;
};
int parse(const std::string & text);
}
"""
NODE = """
#include "machine/driver.hpp"
using std::placeholders::_1;
namespace machine {
Driver::Driver(const rclcpp::NodeOptions & options) : Node("driver", options) {
  limit_ = declare_parameter("limit", 3);
  out_ = create_publisher<std_msgs::msg::String>("out", 10);
  buffer_ = std::make_shared<tf2_ros::Buffer>(get_clock());
  listener_ = std::make_shared<tf2_ros::TransformListener>(*buffer_);
  subscriptions_.push_back(create_subscription<machine::msg::MotorState>(
    "state", 10, std::bind(&Driver::on_state, this, _1)));
  subscriptions_.push_back(create_subscription<std_msgs::msg::String>(
    "name", 10, std::bind(&Driver::on_name, this, _1)));
  subscriptions_.push_back(create_subscription<geometry_msgs::msg::PoseStamped>(
    "pose", 10, std::bind(&Driver::on_pose, this, _1)));
  subscriptions_.push_back(create_subscription<std_msgs::msg::String>(
    "command", 10, std::bind(&Driver::on_command, this, _1)));
  auto on_odometry = [this](nav_msgs::msg::Odometry::SharedPtr msg) -> void {
    int level = static_cast<int>(msg->twist.twist.linear.x);  // FLOAT
    if (level > limit_) { RCLCPP_WARN(get_logger(), "too fast: %d", level); return; }
    table_.at(level) = 1;  // AT
    std_msgs::msg::String sent;
    sent.data = "ok";
    out_->publish(sent);
  };
  subscriptions_.push_back(create_subscription<nav_msgs::msg::Odometry>("odom", rclcpp::SensorDataQoS(), on_odometry));
  service_ = create_service<std_srvs::srv::SetBool>("enable",
    [this](const std::shared_ptr<std_srvs::srv::SetBool::Request> request,
           std::shared_ptr<std_srvs::srv::SetBool::Response> response) {
      response->success = request->data;
    });
  timer_ = create_wall_timer(std::chrono::milliseconds(100), std::bind(&Driver::on_tick, this));
}
void Driver::on_state(const machine::msg::MotorState::SharedPtr msg) {
  switch (msg->mode) {
    case machine::msg::MotorState::IDLE: break;
    case machine::msg::MotorState::RUN: last_ = msg->current[5]; break;
    default: RCLCPP_ERROR_STREAM(get_logger(), "mode " << static_cast<int>(msg->mode));
  }
}
void Driver::on_name(std_msgs::msg::String::UniquePtr msg) {
  if (msg->data != "left") return;
  driver_.select(msg->data);
}
void Driver::on_pose(const geometry_msgs::msg::PoseStamped & msg) {
  try {
    auto found = buffer_->lookupTransform("map", msg.header.frame_id, tf2::TimePointZero);
    geometry_msgs::msg::PoseStamped moved;
    tf2::doTransform(msg, moved, found);
    std_msgs::msg::String sent;
    sent.data = moved.header.frame_id;
    out_->publish(sent);
  } catch (const tf2::TransformException & error) {
    RCLCPP_WARN(get_logger(), "%s", error.what());
  }
}
void Driver::on_tick() {
  std_msgs::msg::String sent;
  sent.data = std::to_string(last_.value());  // TICK
  out_->publish(sent);
}
void Driver::on_command(const std_msgs::msg::String::ConstSharedPtr msg) {
  limit_ = parse(msg->data);
}
}
int main(int argc, char ** argv) {
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<machine::Driver>(rclcpp::NodeOptions()));
  rclcpp::shutdown();
}
"""
PARSE = """
#include "machine/driver.hpp"
namespace machine {
int parse(const std::string & text) {
  return std::stoi(text);  // PARSE
}
}
"""
STATE = "uint8 IDLE=0\nuint8 RUN=1\nuint8 mode\nint32[] current\nstring<=4 name\nfloat32[<=2] pair\n"
FILES = {"src/driver.cpp": NODE, "src/parse.cpp": PARSE, "include/machine/driver.hpp": HEADER}
PATH = "machine/src/driver.cpp"


@pytest.fixture(scope="module")
def prepared(tmp_path_factory):
    root = tmp_path_factory.mktemp("ws")
    write_workspace(root, 2, FILES, "src/driver.cpp src/parse.cpp", {"MotorState": STATE})
    return Prepared(root, tmp_path_factory.mktemp("built"), ("subscriber", "service", "timer"))


@needs_compiler
def test_all_callbacks_compile(prepared):
    assert [(one.callback, one.reason) for one in prepared.all if one.reason] == []
    assert sorted(one.kind for one in prepared.all) == ["service", *["subscriber"] * 5, "timer"]
    assert all(one.way == "built" for one in prepared.all)
    assert "vendor_motor::Driver" in prepared.by_name["on_name"].stood_for
    assert prepared.by_name["on_state"].constants == {"IDLE": ("uint8", "0"), "RUN": ("uint8", "1")}
    # The source that defines what a callback calls is compiled too.
    assert len(prepared.by_name["on_command"].ir_texts) == 2


@needs_compiler
def test_own_message_and_its_constants(prepared):
    assert prepared.replay("on_state", {"msg.mode": 0}).result is Reaction.IGNORED
    assert prepared.replay("on_state", {"msg.mode": 7}).logs == ("error",)
    shown = prepared.replay("on_state", {"msg.mode": 1, "msg.current.size": 3})
    assert (shown.result, shown.crash) == (Reaction.CRASH, CrashKind.INDEX)


@needs_compiler
def test_a_driver_that_is_not_on_the_machine_is_unknown_and_never_ignored(prepared):
    assert prepared.replay("on_name", text("msg.data", "right")).result is Reaction.IGNORED
    shown = prepared.replay("on_name", text("msg.data", "left"))
    assert (shown.result, shown.reason) == (Reaction.UNKNOWN, "vendor_motor::Driver::select")


@needs_compiler
def test_transforms_are_found_or_not(prepared):
    assert prepared.replay("on_pose", {}).logs == ("warn",)
    shown = prepared.replay("on_pose", {"~transform[0].found": 1, "~transform[0].transform.rotation.w": double(1.0)})
    assert [(one.kind, one.name) for one in shown.effects] == [("publish", "out_")]
    assert shown.sent[0].values == {"data.size": 3, "data[0]": ord("m"), "data[1]": ord("a"), "data[2]": ord("p")}


@needs_compiler
def test_lambda_parameters_and_members(prepared):
    name = next(
        each for each in prepared.by_name if each.startswith("lambda@") and prepared.by_name[each].kind == "subscriber"
    )
    nan = {"msg.twist.twist.linear.x": double(float("nan"))}
    shown = prepared.replay(name, nan)
    assert (shown.crash, shown.place) == (CrashKind.FLOAT_TO_INTEGER, CodeLine(PATH, prepared.find_line(PATH, "FLOAT")))
    # A member that another callback writes is state: by default it is 0, and the parameter's value is overwritten.
    four = {"msg.twist.twist.linear.x": double(4.0), "this.limit_": 9}
    shown = prepared.replay(name, four)
    assert (shown.crash, shown.place) == (CrashKind.EXCEPTION, CodeLine(PATH, prepared.find_line(PATH, "AT")))
    assert shown.detail.startswith("std::out_of_range")


@needs_compiler
def test_crash_in_another_source(prepared):
    shown = prepared.replay("on_command", text("msg.data", "x"))
    path = "machine/src/parse.cpp"
    assert (shown.crash, shown.place) == (CrashKind.EXCEPTION, CodeLine(path, prepared.find_line(path, "PARSE")))


@needs_compiler
def test_service_and_timer(prepared):
    service = next(one for one in prepared.all if one.kind == "service")
    shown = prepared.replay(service.callback.rpartition("::")[2], {"request.data": 1})
    assert [(one.kind, one.name) for one in shown.effects] == [("reply", "response")]
    assert shown.sent[0].values["success"] == 1
    assert prepared.replay("on_tick", {}).crash is CrashKind.EXCEPTION
