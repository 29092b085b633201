// Copyright 2026 The rosimpact authors
// SPDX-License-Identifier: Apache-2.0

#ifndef PORTER_BASE__KINEMATICS_HPP_
#define PORTER_BASE__KINEMATICS_HPP_

#include <geometry_msgs/msg/twist.hpp>

namespace porter_base
{

/// Wheel speeds in rad/s, forward positive.
struct Wheels
{
  double left = 0.0;
  double right = 0.0;
};

/// Position in metres and heading in radians, in the odometry frame.
struct Pose
{
  double x = 0.0;
  double y = 0.0;
  double heading = 0.0;
};

/// Motion of a base with two driven wheels.
class Kinematics
{
public:
  /// wheel_radius and track in metres; throws std::invalid_argument unless both are positive.
  Kinematics(double wheel_radius, double track);

  Wheels wheels(const geometry_msgs::msg::Twist & command) const;
  geometry_msgs::msg::Twist twist(const Wheels & wheels) const;

  /// The pose after moving with constant wheel speeds for some seconds.
  Pose moved(const Pose & from, const Wheels & wheels, double seconds) const;

private:
  double wheel_radius_;
  double track_;
};

}  // namespace porter_base

#endif  // PORTER_BASE__KINEMATICS_HPP_
