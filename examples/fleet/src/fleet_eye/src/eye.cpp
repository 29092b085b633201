// Tells the fleet what a vehicle does, ten times a second.
#include <ros/ros.h>

#include <fleet_msgs/Report.h>
#include <fleet_msgs/Track.h>

namespace
{
fleet_msgs::Place makePlace(double x, const std::string & label)
{
  fleet_msgs::Place place;
  place.x = x;
  place.y = 2 * x;
  place.z = 0.5;
  place.label = label;
  return place;
}
}  // namespace

class Eye
{
public:
  Eye()
  : count_(0)
  {
    report_pub_ = nh_.advertise<fleet_msgs::Report>("report", 10);
    spare_pub_ = nh_.advertise<fleet_msgs::Report>("spare_report", 10);
    track_pub_ = nh_.advertise<fleet_msgs::Track>("track", 10);
    timer_ = nh_.createTimer(ros::Duration(0.1), &Eye::onTimer, this);
  }

private:
  void onTimer(const ros::TimerEvent &)
  {
    fleet_msgs::Report report;
    report.header.stamp = ros::Time(100 + count_);
    report.header.frame_id = "yard";
    report.state = count_ % 2 ? fleet_msgs::Report::DRIVING : fleet_msgs::Report::IDLE;
    report.battery = 100.0 - count_;
    report.driver = "nobody";
    report.place = makePlace(count_, "gate");
    report.diagnosis.assign(2000, static_cast<uint8_t>(count_));
    for (int i = 0; i < count_ % 4; ++i) {
      fleet_msgs::Stop stop;
      stop.place = makePlace(i, "stop");
      stop.seconds = 10 * i;
      stop.goods.push_back("apples");
      stop.goods.push_back("pears");
      report.stops.push_back(stop);
    }
    report.tyres[2] = 2.5;
    report_pub_.publish(report);

    fleet_msgs::ReportPtr spare(new fleet_msgs::Report(report));
    spare->battery = 50.0;
    spare_pub_.publish(spare);

    fleet_msgs::Track track;
    track.vehicle = "truck";
    for (int i = 0; i < 20; ++i) {
      track.xs.push_back(i);
      track.ys.push_back(-i);
    }
    track.notes = std::string(300, 'n');
    track_pub_.publish(track);
    ++count_;
  }

  ros::NodeHandle nh_;
  ros::Publisher report_pub_;
  ros::Publisher spare_pub_;
  ros::Publisher track_pub_;
  ros::Timer timer_;
  int count_;
};

int main(int argc, char ** argv)
{
  ros::init(argc, argv, "eye");
  Eye eye;
  ros::spin();
  return 0;
}
