// Copyright 2026 The rosimpact authors
// SPDX-License-Identifier: Apache-2.0

#include <cstdint>
#include <exception>
#include <string>

#include <cv_bridge/cv_bridge.h>
#include <dynamic_reconfigure/server.h>
#include <gantry_msgs/PotatoArray.h>
#include <image_transport/image_transport.h>
#include <ros/ros.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>

#include "gantry_vision/GradingConfig.h"
#include "gantry_vision/grader.h"

class GraderNode
{
public:
  GraderNode(ros::NodeHandle& node, const std::string& empty_belt) : grader_(empty_belt), transport_(node)
  {
    server_.setCallback(
        [this](gantry_vision::GradingConfig& config, uint32_t)
        {
          limits_.threshold = config.threshold;
          limits_.smallest = config.smallest;
          limits_.greenness = config.greenness;
        });
    potatoes_ = node.advertise<gantry_msgs::PotatoArray>("potatoes", 5);
    image_ = transport_.subscribe("image", 1, &GraderNode::onImage, this);
  }

private:
  void onImage(const sensor_msgs::ImageConstPtr& image)
  {
    cv_bridge::CvImageConstPtr colour;
    try
    {
      colour = cv_bridge::toCvShare(image, sensor_msgs::image_encodings::BGR8);
    }
    catch (const cv_bridge::Exception& error)
    {
      ROS_WARN_THROTTLE(5.0, "image skipped: %s", error.what());
      return;
    }
    gantry_msgs::PotatoArray result;
    result.header = image->header;
    result.potatoes = grader_.grade(colour->image, limits_);
    potatoes_.publish(result);
  }

  gantry_vision::Grader grader_;
  gantry_vision::GradingLimits limits_;
  dynamic_reconfigure::Server<gantry_vision::GradingConfig> server_;
  image_transport::ImageTransport transport_;
  image_transport::Subscriber image_;
  ros::Publisher potatoes_;
};

int main(int argc, char** argv)
{
  ros::init(argc, argv, "grader");
  ros::NodeHandle node;
  std::string empty_belt;
  if (!ros::NodeHandle("~").getParam("empty_belt", empty_belt))
  {
    ROS_FATAL("parameter ~empty_belt is missing: the image file of the empty belt");
    return 1;
  }
  try
  {
    GraderNode grader(node, empty_belt);
    ros::spin();
  }
  catch (const std::exception& error)
  {
    ROS_FATAL("%s", error.what());
    return 1;
  }
  return 0;
}
