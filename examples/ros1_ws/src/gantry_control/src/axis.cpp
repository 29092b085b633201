// Copyright 2026 The rosimpact authors
// SPDX-License-Identifier: Apache-2.0

#include "gantry_control/axis.h"

#include <algorithm>
#include <cmath>

namespace gantry_control
{

Axis::Axis(double length, double speed) : length_(length), speed_(speed), position_(0.0), velocity_(0.0), goal_(0.0) {}

void Axis::goTo(double position)
{
  goal_ = std::max(0.0, std::min(position, length_));
}

void Axis::step(double seconds)
{
  const double distance = goal_ - position_;
  if (distance == 0.0 || seconds <= 0.0)
  {
    velocity_ = 0.0;
    return;
  }
  if (std::fabs(distance) <= speed_ * seconds)
  {
    velocity_ = distance / seconds;
    position_ = goal_;
    arrived(position_);
    return;
  }
  velocity_ = distance > 0.0 ? speed_ : -speed_;
  position_ += velocity_ * seconds;
}

bool Axis::atLimit() const
{
  return position_ <= 0.0 || position_ >= length_;
}

}  // namespace gantry_control
