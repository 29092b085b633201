#include <geometry_msgs/msg/quaternion.hpp>
#include <tf2/LinearMath/Quaternion.h>
#include <tf2/utils.h>

geometry_msgs::msg::Quaternion turned(double yaw)
{
  tf2::Quaternion turn;
  turn.setRPY(0, 0, yaw);
  return tf2::toMsg(turn);
}
