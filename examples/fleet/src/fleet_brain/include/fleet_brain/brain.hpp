#ifndef FLEET_BRAIN_BRAIN_HPP
#define FLEET_BRAIN_BRAIN_HPP

#include <ros/ros.h>

#include <fleet_msgs/Report.h>
#include <fleet_msgs/Track.h>
#include <std_msgs/String.h>

namespace fleet_brain
{
/// Decides by the reports of the vehicles, and says what it decided.
class Brain
{
public:
  Brain();

private:
  void onReport(const fleet_msgs::Report::ConstPtr & report);
  void onSpare(const fleet_msgs::Report & report);
  void onTrack(const fleet_msgs::TrackConstPtr & track);
  void say(const std::string & text);

  ros::NodeHandle nh_;
  ros::Subscriber report_sub_;
  ros::Subscriber spare_sub_;
  ros::Subscriber track_sub_;
  ros::Publisher said_pub_;
  fleet_msgs::Track last_;
};
}  // namespace fleet_brain

#endif  // FLEET_BRAIN_BRAIN_HPP
