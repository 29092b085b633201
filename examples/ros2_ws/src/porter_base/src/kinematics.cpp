// Copyright 2026 The rosimpact authors
// SPDX-License-Identifier: Apache-2.0

#include "porter_base/kinematics.hpp"

#include <cmath>
#include <stdexcept>

namespace porter_base
{

Kinematics::Kinematics(double wheel_radius, double track)
: wheel_radius_(wheel_radius), track_(track)
{
  if (wheel_radius <= 0.0 || track <= 0.0) {
    throw std::invalid_argument("wheel radius and track must be positive");
  }
}

Wheels Kinematics::wheels(const geometry_msgs::msg::Twist & command) const
{
  const double turn = command.angular.z * track_ / 2.0;
  return {(command.linear.x - turn) / wheel_radius_, (command.linear.x + turn) / wheel_radius_};
}

geometry_msgs::msg::Twist Kinematics::twist(const Wheels & wheels) const
{
  geometry_msgs::msg::Twist result;
  result.linear.x = (wheels.right + wheels.left) * wheel_radius_ / 2.0;
  result.angular.z = (wheels.right - wheels.left) * wheel_radius_ / track_;
  return result;
}

Pose Kinematics::moved(const Pose & from, const Wheels & wheels, double seconds) const
{
  const auto speed = twist(wheels);
  // Second order: the heading in the middle of the step.
  const double middle = from.heading + speed.angular.z * seconds / 2.0;
  return {
    from.x + speed.linear.x * seconds * std::cos(middle),
    from.y + speed.linear.x * seconds * std::sin(middle),
    from.heading + speed.angular.z * seconds};
}

}  // namespace porter_base
