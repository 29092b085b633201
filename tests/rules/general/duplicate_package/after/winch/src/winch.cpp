#include <rclcpp/rclcpp.hpp>

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  rclcpp::spin(rclcpp::Node::make_shared("winch"));
  return 0;
}
