#include <moveit_msgs/GetKinematicSolverInfo.h>
#include <moveit_msgs/KinematicSolverInfo.h>
#include <ros/ros.h>

int main(int argc, char ** argv)
{
  ros::init(argc, argv, "kinematics");
  ros::NodeHandle node;
  moveit_msgs::KinematicSolverInfo info;
  return info.joint_names.empty() ? 0 : 1;
}
