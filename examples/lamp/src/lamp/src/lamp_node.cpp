#include <ros/ros.h>
#include <lamp/Lamp.h>
#include <std_msgs/Int32.h>

class LampNode
{
public:
  explicit LampNode(ros::NodeHandle &nh)
  {
    pub_ = nh.advertise<std_msgs::Int32>("state", 1);
    sub_ = nh.subscribe("lamp", 1, &LampNode::onLamp, this);
  }

private:
  void onLamp(const lamp::Lamp::ConstPtr &msg)
  {
    std_msgs::Int32 out;
    switch (msg->value)
    {
      case lamp::Lamp::GREEN: out.data = 1; break;
      case lamp::Lamp::ORANGE: out.data = 1000 / msg->period; break;
      case lamp::Lamp::OFF: out.data = 0; break;
      default: ROS_WARN("unknown lamp %d", msg->value); return;
    }
    pub_.publish(out);
  }
  ros::Publisher pub_;
  ros::Subscriber sub_;
};

int main(int argc, char **argv)
{
  ros::init(argc, argv, "lamp_node");
  ros::NodeHandle nh;
  LampNode node(nh);
  ros::spin();
}
