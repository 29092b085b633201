#include "fleet_brain/brain.hpp"

#include <sstream>

namespace fleet_brain
{
namespace
{

std::string describe(const fleet_msgs::Report & report)
{
  std::ostringstream text;
  text << "spare " << report.battery << " " << report.tyres[2];
  return text.str();
}
}  // namespace

Brain::Brain()
{
  said_pub_ = nh_.advertise<std_msgs::String>("said", 100);
  report_sub_ = nh_.subscribe("report", 10, &Brain::onReport, this);
  spare_sub_ = nh_.subscribe("spare_report", 10, &Brain::onSpare, this);
  track_sub_ = nh_.subscribe("track", 10, &Brain::onTrack, this);
}

void Brain::onReport(const fleet_msgs::Report::ConstPtr & report)
{
  std::ostringstream text;
  text << "report " << report->header.stamp.sec << " " << static_cast<int>(report->state) << " " << report->place.x;
  for (const auto & stop : report->stops) {
    text << " " << stop.place.x << "/" << stop.seconds;
  }
  say(text.str());
}

void Brain::onSpare(const fleet_msgs::Report & report)
{
  say(describe(report));
}

void Brain::onTrack(const fleet_msgs::TrackConstPtr & track)
{
  last_ = *track;
  std::ostringstream text;
  text << "track " << last_.vehicle << " " << last_.xs.size() << " " << last_.xs.back();
  say(text.str());
}

void Brain::say(const std::string & text)
{
  std_msgs::String said;
  said.data = text;
  said_pub_.publish(said);
}
}  // namespace fleet_brain

int main(int argc, char ** argv)
{
  ros::init(argc, argv, "brain");
  fleet_brain::Brain brain;
  ros::spin();
  return 0;
}
