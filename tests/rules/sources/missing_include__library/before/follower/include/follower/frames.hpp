#pragma once

#include <memory>

#include <rclcpp/clock.hpp>
#include <tf2_ros/transform_listener.h>

namespace follower
{
class Frames
{
public:
  explicit Frames(rclcpp::Clock::SharedPtr clock) : buffer_(clock), listener_(buffer_) {}

private:
  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
};
}  // namespace follower
