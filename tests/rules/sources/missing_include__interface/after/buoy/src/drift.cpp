#include "buoy/drift.hpp"
#include <nav_msgs/msg/odometry.hpp>

int main()
{
  return Drift().now.header.frame_id.empty() ? 1 : 0;
}
