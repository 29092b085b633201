#include "planner/planner.hpp"

double planner::speed(const Params & params)
{
  return params.speed;
}
