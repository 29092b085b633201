#include <Eigen/Dense>
#include <ros/ros.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "filter");
  Eigen::Matrix3d gain = Eigen::Matrix3d::Identity();
  ROS_INFO("%f", gain(0, 0));
  return 0;
}
