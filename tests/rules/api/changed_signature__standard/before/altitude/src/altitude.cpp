#include <cmath>
#include <memory>

#include <ros/ros.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "altitude");
  auto node = std::make_unique<ros::NodeHandle>();
  double altitude = 0.0;
  node->getParam("altitude", altitude);
  return isnan(altitude) ? 1 : 0;
}
