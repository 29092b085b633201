#include <battery_msgs/Battery.h>
#include <ros/ros.h>

void onBattery(const battery_msgs::Battery& battery) { ROS_INFO("%.1f V", battery.voltage); }

int main(int argc, char** argv)
{
  ros::init(argc, argv, "monitor");
  ros::NodeHandle node;
  ros::Subscriber battery = node.subscribe("battery", 1, onBattery);
  ros::spin();
  return 0;
}
