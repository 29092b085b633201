#!/usr/bin/env python3
"""Says how much the batteries of the vehicles have left, and sends their alarms on whole."""

import rospy
from fleet_msgs.msg import Report
from std_msgs.msg import String


class Log:
    def __init__(self):
        self.said = rospy.Publisher("said", String, queue_size=100)
        self.alarm = rospy.Publisher("alarm", Report, queue_size=10)
        self.seen = []
        rospy.Subscriber("report", Report, self.on_report)
        rospy.Subscriber("alarm", Report, self.on_alarm)

    def on_report(self, report):
        self.seen.append(report)
        last = self.seen[-1]
        self.said.publish(f"log {last.battery:.1f} {last.header.frame_id}")
        if last.battery < 98:
            alarm = Report()
            alarm.driver = "log"
            alarm.battery = last.battery
            self.alarm.publish(alarm)

    def on_alarm(self, alarm):
        _, _, text = str(alarm).partition("state:")
        self.said.publish("alarm " + text.replace("\n", "|"))


if __name__ == "__main__":
    rospy.init_node("log")
    Log()
    rospy.spin()
