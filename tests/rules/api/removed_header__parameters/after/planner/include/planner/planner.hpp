#pragma once

#include <rclcpp/rclcpp.hpp>

#include <planner/planner_parameters.hpp>

namespace planner
{
double speed(const Params & params);
}
