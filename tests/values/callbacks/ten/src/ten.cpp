// Ten callbacks as they occur on robots: enumerations, a clamp, texts, arrays, a division, a frame, state.
#include <cassert>
#include <cmath>
#include <string>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/Twist.h>
#include <nav_msgs/OccupancyGrid.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/LaserScan.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Int32.h>
#include <std_msgs/String.h>
#include <ten/Led.h>
#include <ten/Mode.h>
#include <ten/Rate.h>
#include <ten/Sequenced.h>

class Ten
{
public:
  explicit Ten(ros::NodeHandle &nh)
  {
    pub_ = nh.advertise<std_msgs::Int32>("out", 1);
    goal_pub_ = nh.advertise<geometry_msgs::PoseStamped>("goal_out", 1);
    led_ = nh.subscribe("led", 1, &Ten::onLed, this);
    mode_ = nh.subscribe("mode", 1, &Ten::onMode, this);
    velocity_ = nh.subscribe("velocity", 1, &Ten::onVelocity, this);
    text_ = nh.subscribe("text", 1, &Ten::onText, this);
    joints_ = nh.subscribe("joints", 1, &Ten::onJoints, this);
    rate_ = nh.subscribe("rate", 1, &Ten::onRate, this);
    goal_ = nh.subscribe("goal", 1, &Ten::onGoal, this);
    command_ = nh.subscribe("command", 1, &Ten::onCommand, this);
    scan_ = nh.subscribe("scan", 1, &Ten::onScan, this);
    map_ = nh.subscribe("map", 1, &Ten::onMap, this);
  }

private:
  void send(int value)
  {
    std_msgs::Int32 out;
    out.data = value;
    pub_.publish(out);
  }
  void onLed(const ten::Led::ConstPtr &msg)
  {
    switch (msg->value)
    {
      case ten::Led::GREEN: send(1); break;
      case ten::Led::ORANGE: send(2); break;
      case ten::Led::BLACK: send(0); break;
      default: ROS_WARN("not a color"); break;
    }
  }
  void onMode(const ten::Mode::ConstPtr &msg)
  {
    switch (msg->mode)
    {
      case ten::Mode::IDLE: send(10); break;
      case ten::Mode::RUN: send(11); break;
    }
  }
  void onVelocity(const geometry_msgs::Twist::ConstPtr &msg)
  {
    double speed = msg->linear.x;
    if (speed > limit_) speed = limit_;
    if (speed < -limit_) speed = -limit_;
    send(static_cast<int>(speed * 100));  // onVelocity FLOAT_TO_INTEGER
  }
  void onText(const std_msgs::String::ConstPtr &msg)
  {
    if (msg->data == "start") send(1);
    else if (msg->data == "stop") send(0);
    else if (msg->data.substr(0, 3) == "go ") send(std::stoi(msg->data.substr(3)));  // onText EXCEPTION
  }
  void onJoints(const sensor_msgs::JointState::ConstPtr &msg)
  {
    for (size_t i = 0; i < msg->name.size(); ++i) commands_[i] = msg->position[i];  // onJoints INDEX
    if (!msg->name.empty()) send(static_cast<int>(msg->name.size()));
  }
  void onRate(const ten::Rate::ConstPtr &msg)
  {
    if (msg->count < 0) return;
    int rate = 1000 / msg->period_ms;  // onRate DIVISION
    if (rate > 0) send(rate * (msg->count % 7));
  }
  bool isUnit(const geometry_msgs::Quaternion &q)
  {
    double norm = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    return std::fabs(norm - 1.0) < 0.1;
  }
  void onGoal(const geometry_msgs::PoseStamped::ConstPtr &msg)
  {
    if (msg->header.frame_id != "map")
    {
      ROS_WARN("another frame");
      return;
    }
    if (!isUnit(msg->pose.orientation)) return;
    goal_pub_.publish(*msg);
  }
  void onCommand(const ten::Sequenced::ConstPtr &msg)
  {
    if (msg->seq <= last_) return;
    last_ = msg->seq;
    if (!enabled_) return;
    assert(msg->mode < 3);  // onCommand ASSERTION
    send(msg->mode);
  }
  void onScan(const sensor_msgs::LaserScan::ConstPtr &msg)
  {
    float best = msg->range_max;
    for (size_t i = 0; i < msg->ranges.size(); ++i)
    {
      float range = msg->ranges[i];
      if (range < msg->range_min) continue;
      if (range < best) best = range;
    }
    float ahead = msg->ranges[msg->ranges.size() / 2];  // onScan INDEX
    if (best < 0.3f && ahead < 1.0f) send(1);
  }
  void onMap(const nav_msgs::OccupancyGrid::ConstPtr &msg)
  {
    unsigned index = 0;
    unsigned blocked = 0;
    for (unsigned i = 0; i < msg->info.height; ++i)
      for (unsigned j = 0; j < msg->info.width; ++j)
      {
        if (msg->data[index] >= 100) ++blocked;  // onMap INDEX
        ++index;
      }
    if (blocked) send(static_cast<int>(blocked));
  }

  ros::Publisher pub_, goal_pub_;
  ros::Subscriber led_, mode_, velocity_, text_, joints_, rate_, goal_, command_, scan_, map_;
  double limit_ = 0.5;
  double commands_[6] = {};
  bool enabled_ = true;
  uint32_t last_ = 0;
};

int main(int argc, char **argv)
{
  ros::init(argc, argv, "ten");
  ros::NodeHandle nh;
  Ten ten(nh);
  ros::spin();
}
