#include <ros/ros.h>

#include <arm_msgs/JointGoal.h>

int main(int argc, char ** argv)
{
  ros::init(argc, argv, "arm");
  ros::NodeHandle node;
  ros::Publisher goals = node.advertise<arm_msgs::JointGoal>("goal", 1);
  ros::spin();
  return 0;
}
