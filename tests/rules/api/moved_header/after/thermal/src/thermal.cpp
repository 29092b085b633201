#include <cv_bridge/cv_bridge.hpp>
#include <rclcpp/rclcpp.hpp>

void on_image(const sensor_msgs::msg::Image::ConstSharedPtr & image) { cv_bridge::toCvShare(image, "mono8"); }

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  return 0;
}
