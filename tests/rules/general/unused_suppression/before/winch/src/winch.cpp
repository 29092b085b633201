#include <rclcpp/rclcpp.hpp>  // rosimpact: allow(removed-header)

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  rclcpp::spin(rclcpp::Node::make_shared("winch"));
  return 0;
}
