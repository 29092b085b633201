// Copyright 2026 The rosimpact authors
// SPDX-License-Identifier: Apache-2.0

#ifndef PORTER_BASE__MOTOR_BOARD_HPP_
#define PORTER_BASE__MOTOR_BOARD_HPP_

#include <string>

#include "porter_base/kinematics.hpp"

namespace porter_base
{

/// What turns the wheels. Implementations are pluginlib plugins.
class MotorBoard
{
public:
  virtual ~MotorBoard() = default;

  /// Opens the device; false when it does not answer.
  virtual bool open(const std::string & device) = 0;
  virtual void command(const Wheels & wheels) = 0;
  virtual Wheels measured() = 0;

protected:
  MotorBoard() = default;
};

}  // namespace porter_base

#endif  // PORTER_BASE__MOTOR_BOARD_HPP_
