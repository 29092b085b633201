#include <ros/ros.h>

int main(int argc, char ** argv)
{
  ros::init(argc, argv, "gripper");
  ros::NodeHandle node;
  ros::spin();
}
