#include <opencv2/imgproc.hpp>
#include <ros/ros.h>

#ifdef OLD_OPENCV
static const int TO_GRAY = CV_BGR2GRAY;
#else
static const int TO_GRAY = cv::COLOR_BGR2GRAY;
#endif

int main(int argc, char** argv)
{
  ros::init(argc, argv, "tracker");
  return TO_GRAY;
}
