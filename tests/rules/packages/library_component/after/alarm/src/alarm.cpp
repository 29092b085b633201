#include <boost/signals2.hpp>
#include <ros/ros.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "alarm");
  boost::signals2::signal<void()> raised;
  raised();
  return 0;
}
