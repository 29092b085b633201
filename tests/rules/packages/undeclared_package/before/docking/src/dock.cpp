#include <Eigen/Geometry>
#include <rclcpp/rclcpp.hpp>
#include <tf2_eigen/tf2_eigen.hpp>

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  const auto pose = tf2::toMsg(Eigen::Affine3d::Identity());
  RCLCPP_INFO(rclcpp::get_logger("docking"), "dock at %.2f", pose.position.x);
  return 0;
}
