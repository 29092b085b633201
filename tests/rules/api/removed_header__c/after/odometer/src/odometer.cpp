#include <memory>

#include "odometer/odometer.hpp"

odometer::Odometer::Odometer()
: Node("odometer"), publisher_(create_publisher<nav_msgs::msg::Odometry>("odom", 10))
{
}

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<odometer::Odometer>());
  rclcpp::shutdown();
}
