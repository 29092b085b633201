#include <string>
#include <vector>

#include <costmap_2d/costmap_2d_ros.h>
#include <nav_core/base_local_planner.h>
#include <pluginlib/class_list_macros.h>
#include <tf2_ros/buffer.h>

namespace follower
{
class Follower : public nav_core::BaseLocalPlanner
{
public:
  void initialize(std::string name, tf2_ros::Buffer * tf, costmap_2d::Costmap2DROS * costmap) override {}
  bool computeVelocityCommands(geometry_msgs::Twist & command) override { return true; }
  bool isGoalReached() override { return false; }
  bool setPlan(const std::vector<geometry_msgs::PoseStamped> & plan) override { return true; }
};
}  // namespace follower

PLUGINLIB_EXPORT_CLASS(follower::Follower, nav_core::BaseLocalPlanner)
