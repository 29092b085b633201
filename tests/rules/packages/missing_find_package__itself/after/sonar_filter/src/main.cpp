#include <rclcpp/rclcpp.hpp>

#include "sonar_filter/filter.hpp"

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  return filtered(1.0) > 0.0 ? 0 : 1;
}
