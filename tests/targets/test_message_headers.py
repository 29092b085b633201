"""Types of C++ that are made from interfaces, and the headers that define them."""

import pytest
from rosimpact.impact.targets.providers.message_headers import parse_type


@pytest.mark.parametrize(
    ("written", "type_", "header"),
    [
        ("nav_msgs::msg::Path", "nav_msgs::msg::Path", "nav_msgs/msg/path.hpp"),
        ("nav_msgs::msg::Path::SharedPtr", "nav_msgs::msg::Path", "nav_msgs/msg/path.hpp"),
        ("nav_msgs::srv::GetMap_Request", "nav_msgs::srv::GetMap", "nav_msgs/srv/get_map.hpp"),
        ("arm::action::Reach_SendGoal_Response", "arm::action::Reach", "arm/action/reach.hpp"),
        ("geometry_msgs::msg::Pose2D", "geometry_msgs::msg::Pose2D", "geometry_msgs/msg/pose2_d.hpp"),
        ("nav_msgs::PathConstPtr", "nav_msgs::Path", "nav_msgs/Path.h"),
        ("visualization_msgs::Marker::ARROW", "visualization_msgs::Marker", "visualization_msgs/Marker.h"),
        ("nav_msgs::GetMapRequest", "nav_msgs::GetMapRequest", "nav_msgs/GetMapRequest.h"),
    ],
)
def test_the_type_that_a_name_begins_with(written, type_, header):
    found = parse_type(written)
    assert found is not None
    assert (found.name, found.headers[0]) == (type_, header)


@pytest.mark.parametrize("written", ["tf2_ros::Buffer", "nav_msgs::msg::detail::Path", "nav_msgs::msg", "cv::Mat"])
def test_other_names(written):
    assert parse_type(written) is None
