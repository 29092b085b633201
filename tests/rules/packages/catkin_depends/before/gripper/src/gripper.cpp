#include <ros/ros.h>
#include <tf/transform_listener.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "gripper");
  tf::TransformListener frames;
  ros::spin();
  return 0;
}
