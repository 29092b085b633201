#include <ros/ros.h>
#include <tf2_geometry_msgs/tf2_geometry_msgs.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "gripper");
  geometry_msgs::PoseStamped pose;
  tf2::Stamped<tf2::Transform> grasp;
  tf2::fromMsg(pose, grasp);
  return 0;
}
