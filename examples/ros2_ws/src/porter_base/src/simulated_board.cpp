// Copyright 2026 The rosimpact authors
// SPDX-License-Identifier: Apache-2.0

#include <string>

#include <pluginlib/class_list_macros.hpp>

#include "porter_base/motor_board.hpp"

namespace porter_base
{

class SimulatedBoard : public MotorBoard
{
public:
  bool open(const std::string & /*device*/) override {return true;}
  void command(const Wheels & wheels) override {wheels_ = wheels;}
  Wheels measured() override {return wheels_;}

private:
  Wheels wheels_;
};

}  // namespace porter_base

PLUGINLIB_EXPORT_CLASS(porter_base::SimulatedBoard, porter_base::MotorBoard)
