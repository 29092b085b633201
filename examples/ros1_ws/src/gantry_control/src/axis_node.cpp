// Copyright 2026 The rosimpact authors
// SPDX-License-Identifier: Apache-2.0

#include <gantry_msgs/AxisState.h>
#include <ros/ros.h>
#include <std_msgs/Float64.h>

#include "gantry_control/axis.h"

int main(int argc, char** argv)
{
  ros::init(argc, argv, "axis");
  ros::NodeHandle node;
  ros::NodeHandle settings("~");
  gantry_control::Axis axis(settings.param("length", 1.8), settings.param("speed", 0.6));

  ros::Publisher arrivals = node.advertise<std_msgs::Float64>("arrived", 5);
  axis.arrived.connect(
      [&arrivals](double position)
      {
        std_msgs::Float64 message;
        message.data = position;
        arrivals.publish(message);
      });
  ros::Publisher states = node.advertise<gantry_msgs::AxisState>("axis_state", 10);
  ros::Subscriber goals = node.subscribe<std_msgs::Float64>(
      "axis_goal", 5, [&axis](const std_msgs::Float64ConstPtr& goal) { axis.goTo(goal->data); });

  ros::Rate rate(50.0);
  while (ros::ok())
  {
    ros::spinOnce();
    axis.step(rate.expectedCycleTime().toSec());
    gantry_msgs::AxisState state;
    state.header.stamp = ros::Time::now();
    state.position = axis.position();
    state.velocity = axis.velocity();
    state.at_limit = axis.atLimit();
    states.publish(state);
    rate.sleep();
  }
  return 0;
}
