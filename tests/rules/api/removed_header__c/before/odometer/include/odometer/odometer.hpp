#pragma once

#include <rclcpp/rclcpp.hpp>

#include <nav_msgs/msg/odometry.h>

namespace odometer
{
class Odometer : public rclcpp::Node
{
public:
  Odometer();

private:
  rclcpp::Publisher<nav_msgs::msg::Odometry>::SharedPtr publisher_;
};
}
