#pragma once
#include <geometry_msgs/msg/pose.hpp>
#include <nav_msgs/msg/odometry.hpp>

struct Drift
{
  geometry_msgs::msg::Point from;  // pose.hpp brings it
  nav_msgs::msg::Odometry now;
};
