#pragma once

#include <rclcpp/rclcpp.hpp>

#include <planner_parameters.hpp>

namespace planner
{
double speed(const Params & params);
}
