#include <rclcpp/rclcpp.hpp>

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  rclcpp::executors::SingleThreadedExecutor executor;
  executor.add_node(rclcpp::Node::make_shared("sweeper"));
  executor.spin();
  return 0;
}
