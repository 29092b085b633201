#!/usr/bin/env python
# Copyright 2026 The rosimpact authors
# SPDX-License-Identifier: Apache-2.0
"""Sends the carriage to every potato that is not good, one after the other."""

from collections import deque

import rospy
from gantry_msgs.msg import Potato, PotatoArray
from std_msgs.msg import Float64


class Sorter:
    """Potatoes in, goals of the axis out."""

    def __init__(self):
        self.metres_per_pixel = rospy.get_param("~metres_per_pixel", 0.0014)
        self.waiting = deque(maxlen=50)
        self.busy = False
        self.goal = rospy.Publisher("axis_goal", Float64, queue_size=5)
        rospy.Subscriber("potatoes", PotatoArray, self.on_potatoes)
        rospy.Subscriber("arrived", Float64, self.on_arrival)

    def on_potatoes(self, message):
        """Queue what has to go."""
        for potato in message.potatoes:
            if potato.grade != Potato.GRADE_GOOD:
                self.waiting.append(potato.centre.x * self.metres_per_pixel)
        self.go_on()

    def on_arrival(self, position):
        """Take the potato out and go on."""
        rospy.loginfo("took one out at %.3f m, %d waiting", position.data, len(self.waiting))
        self.busy = False
        self.go_on()

    def go_on(self):
        """Send the carriage to the next potato."""
        if self.waiting and not self.busy:
            self.busy = True
            self.goal.publish(Float64(self.waiting.popleft()))


if __name__ == "__main__":
    rospy.init_node("sorter")
    Sorter()
    rospy.spin()
