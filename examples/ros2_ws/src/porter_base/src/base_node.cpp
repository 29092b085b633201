// Copyright 2026 The rosimpact authors
// SPDX-License-Identifier: Apache-2.0

#include <chrono>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>

#include <geometry_msgs/msg/transform_stamped.hpp>
#include <geometry_msgs/msg/twist.hpp>
#include <nav_msgs/msg/odometry.hpp>
#include <pluginlib/class_loader.hpp>
#include <porter_msgs/msg/wheel_speeds.hpp>
#include <porter_msgs/srv/set_cargo.hpp>
#include <rclcpp/rclcpp.hpp>
#include <tf2_geometry_msgs/tf2_geometry_msgs.hpp>

// The .h headers of tf2 end with Lyrical, and not every Humble has the .hpp ones yet.
#if __has_include(<tf2/LinearMath/Quaternion.hpp>)
#include <tf2/LinearMath/Quaternion.hpp>
#else
#include <tf2/LinearMath/Quaternion.h>
#endif
#if __has_include(<tf2_ros/transform_broadcaster.hpp>)
#include <tf2_ros/transform_broadcaster.hpp>
#else
#include <tf2_ros/transform_broadcaster.h>
#endif

#include "porter_base/kinematics.hpp"
#include "porter_base/motor_board.hpp"

namespace porter_base
{

class BaseNode : public rclcpp::Node
{
public:
  BaseNode()
  : Node("base"),
    kinematics_(declare_parameter("wheel_radius", 0.08), declare_parameter("track", 0.42)),
    loader_("porter_base", "porter_base::MotorBoard"),
    broadcaster_(*this)
  {
    board_ = loader_.createSharedInstance(
      declare_parameter<std::string>("board", "porter_base/SimulatedBoard"));
    const auto device = declare_parameter<std::string>("device", "/dev/ttyUSB0");
    if (!board_->open(device)) {
      RCLCPP_ERROR(get_logger(), "no motor board answers on %s", device.c_str());
    }
    odometry_ = create_publisher<nav_msgs::msg::Odometry>("odom", 10);
    speeds_ = create_publisher<porter_msgs::msg::WheelSpeeds>("wheel_speeds", rclcpp::SensorDataQoS());
    commands_ = create_subscription<geometry_msgs::msg::Twist>(
      "cmd_vel", 10, [this](geometry_msgs::msg::Twist::ConstSharedPtr command) {
        last_command_ = now();
        board_->command(kinematics_.wheels(*command));
      });
    cargo_ = create_service<porter_msgs::srv::SetCargo>(
      "set_cargo",
      [this](
        const std::shared_ptr<porter_msgs::srv::SetCargo::Request> request,
        std::shared_ptr<porter_msgs::srv::SetCargo::Response> response) {
        response->accepted = request->mass >= 0.0F && request->mass <= 25.0F;
        response->reason = response->accepted ? "" : "the porter carries 25 kg at most";
      });
    last_command_ = last_step_ = now();
    timer_ = create_wall_timer(std::chrono::milliseconds(20), [this]() {step();});
  }

private:
  void step()
  {
    const auto time = now();
    if ((time - last_command_).seconds() > 0.5) {
      board_->command(Wheels{});  // nobody steers any more
    }
    const Wheels wheels = board_->measured();
    pose_ = kinematics_.moved(pose_, wheels, (time - last_step_).seconds());
    last_step_ = time;

    tf2::Quaternion rotation;
    rotation.setRPY(0.0, 0.0, pose_.heading);

    nav_msgs::msg::Odometry odometry;
    odometry.header.stamp = time;
    odometry.header.frame_id = "odom";
    odometry.child_frame_id = "base_link";
    odometry.pose.pose.position.x = pose_.x;
    odometry.pose.pose.position.y = pose_.y;
    odometry.pose.pose.orientation = tf2::toMsg(rotation);
    odometry.twist.twist = kinematics_.twist(wheels);
    odometry_->publish(odometry);

    geometry_msgs::msg::TransformStamped transform;
    transform.header = odometry.header;
    transform.child_frame_id = odometry.child_frame_id;
    transform.transform.translation.x = pose_.x;
    transform.transform.translation.y = pose_.y;
    transform.transform.rotation = odometry.pose.pose.orientation;
    broadcaster_.sendTransform(transform);

    porter_msgs::msg::WheelSpeeds speeds;
    speeds.header.stamp = time;
    speeds.left = wheels.left;
    speeds.right = wheels.right;
    speeds_->publish(speeds);
  }

  Kinematics kinematics_;
  pluginlib::ClassLoader<MotorBoard> loader_;
  tf2_ros::TransformBroadcaster broadcaster_;
  std::shared_ptr<MotorBoard> board_;
  rclcpp::Publisher<nav_msgs::msg::Odometry>::SharedPtr odometry_;
  rclcpp::Publisher<porter_msgs::msg::WheelSpeeds>::SharedPtr speeds_;
  rclcpp::Subscription<geometry_msgs::msg::Twist>::SharedPtr commands_;
  rclcpp::Service<porter_msgs::srv::SetCargo>::SharedPtr cargo_;
  rclcpp::TimerBase::SharedPtr timer_;
  rclcpp::Time last_command_;
  rclcpp::Time last_step_;
  Pose pose_;
};

}  // namespace porter_base

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  try {
    rclcpp::spin(std::make_shared<porter_base::BaseNode>());
  } catch (const std::exception & error) {
    RCLCPP_FATAL(rclcpp::get_logger("base"), "%s", error.what());
    rclcpp::shutdown();
    return EXIT_FAILURE;
  }
  rclcpp::shutdown();
  return EXIT_SUCCESS;
}
