#include <moveit/robot_model/robot_model.h>
#include <rclcpp/rclcpp.hpp>

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  moveit::core::RobotModelConstPtr model;
  return model ? 0 : 1;
}
