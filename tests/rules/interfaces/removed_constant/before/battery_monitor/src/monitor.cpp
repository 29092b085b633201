#include <battery_msgs/msg/battery.hpp>
#include <rclcpp/rclcpp.hpp>

void on_battery(const battery_msgs::msg::Battery & battery)
{
  RCLCPP_INFO(rclcpp::get_logger("monitor"), "%d", battery.state == battery_msgs::msg::Battery::FULL);
}

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  auto node = rclcpp::Node::make_shared("monitor");
  auto battery = node->create_subscription<battery_msgs::msg::Battery>("battery", 10, on_battery);
  rclcpp::spin(node);
  return 0;
}
