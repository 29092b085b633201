#include <ros/ros.h>
#include <opencv2/core.hpp>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "weed_finder");
  cv::Mat field(480, 640, CV_8UC3);
  ROS_INFO("%d", field.rows);
  return 0;
}
