#include <angles/angles.h>
#include <rclcpp/rclcpp.hpp>

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  RCLCPP_INFO(rclcpp::get_logger("wheel"), "%f", angles::from_degrees(90.0));
  return 0;
}
