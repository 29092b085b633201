#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <ros/ros.h>

int main(int argc, char** argv)
{
  ros::init(argc, argv, "cloud");
  pcl::PointCloud<pcl::PointXYZ> cloud;
  return cloud.empty() ? 0 : 1;
}
