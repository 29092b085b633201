#include <can_bridge/Frame.h>
#include <ros/ros.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "bridge");
  ros::NodeHandle node;
  ros::Publisher frames = node.advertise<can_bridge::Frame>("frames", 10);
  ros::spin();
  return 0;
}
