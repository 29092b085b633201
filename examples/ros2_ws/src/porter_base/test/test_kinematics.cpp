// Copyright 2026 The rosimpact authors
// SPDX-License-Identifier: Apache-2.0

#include <gtest/gtest.h>

#include <stdexcept>

#include "porter_base/kinematics.hpp"

using porter_base::Kinematics;

TEST(Kinematics, ThereAndBackAgain)
{
  const Kinematics kinematics(0.08, 0.42);
  geometry_msgs::msg::Twist command;
  command.linear.x = 0.5;
  command.angular.z = -0.3;
  const auto twist = kinematics.twist(kinematics.wheels(command));
  EXPECT_NEAR(twist.linear.x, 0.5, 1e-9);
  EXPECT_NEAR(twist.angular.z, -0.3, 1e-9);
}

TEST(Kinematics, StraightAhead)
{
  const Kinematics kinematics(0.1, 0.4);
  const auto pose = kinematics.moved({}, {2.0, 2.0}, 5.0);
  EXPECT_NEAR(pose.x, 1.0, 1e-9);
  EXPECT_NEAR(pose.y, 0.0, 1e-9);
}

TEST(Kinematics, RefusesWheelsWithoutSize)
{
  EXPECT_THROW(Kinematics(0.0, 0.4), std::invalid_argument);
}
