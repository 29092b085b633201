#include <opencv2/imgcodecs.hpp>
#include <ros/ros.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "calibration");
  cv::Mat depth = cv::imread(argv[1], cv::IMREAD_ANYDEPTH);
  return depth.empty() ? 1 : 0;
}
