#include "base_link/base_link.h"

#include <ros/ros.h>

BaseLink::BaseLink(const urdf::Model& model) : link_(model.getLink("base_link")) {}

int main(int argc, char** argv)
{
  ros::init(argc, argv, "base_link");
  const double seconds = 0.5;
  const boost::posix_time::time_duration period = boost::posix_time::milliseconds(static_cast<int>(1000.0 * seconds));
  urdf::Model model;
  model.initParam("robot_description");
  BaseLink link(model);
  ROS_INFO("every %s", boost::posix_time::to_simple_string(period).c_str());
  return 0;
}
