// Copyright 2026 The rosimpact authors
// SPDX-License-Identifier: Apache-2.0

#ifndef GANTRY_CONTROL_AXIS_H
#define GANTRY_CONTROL_AXIS_H

#include <boost/signal.hpp>

namespace gantry_control
{

/// The carriage: moves towards its goal with limited speed and stops at the ends of the rail.
class Axis
{
public:
  /// length in metres, speed in m/s.
  Axis(double length, double speed);

  void goTo(double position);

  /// Moves on by some seconds.
  void step(double seconds);

  double position() const { return position_; }
  double velocity() const { return velocity_; }
  bool atLimit() const;

  /// Called with the position when the carriage has reached its goal.
  boost::signal<void(double)> arrived;

private:
  double length_;
  double speed_;
  double position_;
  double velocity_;
  double goal_;
};

}  // namespace gantry_control

#endif
