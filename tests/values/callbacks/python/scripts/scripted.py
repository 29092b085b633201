#!/usr/bin/env python3
"""Callbacks of rospy: what Python raises, what is caught, state, a match, a node whose parameters are not known."""

import rospy
from sensor_msgs.msg import JointState, LaserScan
from std_msgs.msg import Float64, Int32, String, UInt8

CODES = {"on": 1, "off": 0}


class Scripted:
    def __init__(self):
        self.pub = rospy.Publisher("out", Int32, queue_size=1)
        self.limit = 10
        if rospy.get_param("~careful", False):
            self.limit = 5
        self.names = []
        for name in rospy.get_param("~names", []):
            self.names.append(name)
        self.on = False
        rospy.Subscriber("index", UInt8, self.on_index)
        rospy.Subscriber("key", String, self.on_key)
        rospy.Subscriber("number", String, self.on_number)
        rospy.Subscriber("caught", String, self.on_caught)
        rospy.Subscriber("ratio", Int32, self.on_ratio)
        rospy.Subscriber("speed", Float64, self.on_speed)
        rospy.Subscriber("first", LaserScan, self.on_first)
        rospy.Subscriber("joints", JointState, self.on_joints)
        rospy.Subscriber("switch", UInt8, self.on_switch)
        rospy.Subscriber("checked", Int32, self.on_checked)
        rospy.Subscriber("limited", Int32, self.on_limited)

    def on_index(self, msg):
        self.pub.publish([3, 5, 7][msg.data])  # on_index INDEX

    def on_key(self, msg):
        self.pub.publish(CODES[msg.data])  # on_key EXCEPTION

    def on_number(self, msg):
        self.pub.publish(int(msg.data))  # on_number EXCEPTION

    def on_caught(self, msg):
        try:
            value = int(msg.data)
        except ValueError as error:
            rospy.logwarn("no number: %s", error)
            return
        self.pub.publish(value)

    def on_ratio(self, msg):
        self.pub.publish(100 // msg.data)  # on_ratio DIVISION

    def on_speed(self, msg):
        if msg.data < 0:
            return
        self.pub.publish(int(msg.data))  # on_speed FLOAT_TO_INTEGER

    def on_first(self, msg):
        if msg.ranges[0] < 1.0:  # on_first INDEX
            self.pub.publish(1)

    def on_joints(self, msg):
        for name, position in zip(msg.name, msg.position):  # noqa: B905
            if name == "arm" and position > 0.0:
                self.pub.publish(1)

    def on_switch(self, msg):
        if msg.data == 1 and not self.on:
            self.on = True
            self.pub.publish(1)
        elif msg.data == 0:
            self.on = False

    def on_checked(self, msg):
        assert msg.data < 100  # on_checked ASSERTION
        self.pub.publish(msg.data)

    def on_limited(self, msg):
        if msg.data > self.limit:
            rospy.logwarn("too much")
            return
        self.pub.publish(msg.data)


if __name__ == "__main__":
    rospy.init_node("scripted")
    Scripted()
    rospy.spin()
