// Copyright 2026 The rosimpact authors
// SPDX-License-Identifier: Apache-2.0

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>

#include <cv_bridge/cv_bridge.h>
#include <message_filters/subscriber.hpp>
#include <message_filters/time_synchronizer.hpp>
#include <opencv2/core.hpp>
#include <porter_msgs/msg/dock_marker_array.hpp>
#include <rclcpp/rclcpp.hpp>
#include <rclcpp_components/register_node_macro.hpp>
#include <sensor_msgs/image_encodings.hpp>
#include <sensor_msgs/msg/camera_info.hpp>
#include <sensor_msgs/msg/image.hpp>

#include "porter_vision/marker_detector.hpp"

namespace porter_vision
{

class MarkerNode : public rclcpp::Node
{
public:
  explicit MarkerNode(const rclcpp::NodeOptions & options)
  : Node("dock_markers", options),
    detector_(declare_parameter("marker_side", 0.12)),
    synchronizer_(image_, info_, 10)
  {
    markers_ = create_publisher<porter_msgs::msg::DockMarkerArray>("dock_markers", 10);
    synchronizer_.registerCallback(&MarkerNode::look, this);
    image_.subscribe(this, "image");
    info_.subscribe(this, "camera_info");
  }

private:
  void look(
    const sensor_msgs::msg::Image::ConstSharedPtr & image,
    const sensor_msgs::msg::CameraInfo::ConstSharedPtr & info)
  {
    cv_bridge::CvImageConstPtr grey;
    try {
      grey = cv_bridge::toCvShare(image, sensor_msgs::image_encodings::MONO8);
    } catch (const cv_bridge::Exception & error) {
      RCLCPP_WARN(get_logger(), "image skipped: %s", error.what());
      return;
    }
    const cv::Matx33d camera(info->k.data());

    porter_msgs::msg::DockMarkerArray result;
    result.header = image->header;
    for (const auto & marker : detector_.detect(grey->image, camera, info->d)) {
      porter_msgs::msg::DockMarker message;
      message.id = marker.id;
      for (std::size_t i = 0; i < marker.corners.size(); ++i) {
        message.corners[i].x = marker.corners[i].x;
        message.corners[i].y = marker.corners[i].y;
      }
      message.pose.position.x = marker.position[0];
      message.pose.position.y = marker.position[1];
      message.pose.position.z = marker.position[2];
      const double angle = cv::norm(marker.rotation);
      const double scale = angle > 1e-9 ? std::sin(angle / 2.0) / angle : 0.0;
      message.pose.orientation.x = marker.rotation[0] * scale;
      message.pose.orientation.y = marker.rotation[1] * scale;
      message.pose.orientation.z = marker.rotation[2] * scale;
      message.pose.orientation.w = std::cos(angle / 2.0);
      result.markers.push_back(message);
    }
    markers_->publish(result);
  }

  MarkerDetector detector_;
  message_filters::Subscriber<sensor_msgs::msg::Image> image_;
  message_filters::Subscriber<sensor_msgs::msg::CameraInfo> info_;
  message_filters::TimeSynchronizer<sensor_msgs::msg::Image, sensor_msgs::msg::CameraInfo> synchronizer_;
  rclcpp::Publisher<porter_msgs::msg::DockMarkerArray>::SharedPtr markers_;
};

}  // namespace porter_vision

RCLCPP_COMPONENTS_REGISTER_NODE(porter_vision::MarkerNode)
