#include "follower/frames.hpp"

#include <rclcpp/rclcpp.hpp>

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  auto node = std::make_shared<rclcpp::Node>("follower");
  follower::Frames frames(node->get_clock());
  rclcpp::spin(node);
  rclcpp::shutdown();
  return 0;
}
