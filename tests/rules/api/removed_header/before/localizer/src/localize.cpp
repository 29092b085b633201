#include <rclcpp/rclcpp.hpp>
#include <tf2_geometry_msgs/tf2_geometry_msgs.h>

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  geometry_msgs::msg::PoseStamped in, out;
  tf2::doTransform(in, out, geometry_msgs::msg::TransformStamped());
  return 0;
}
