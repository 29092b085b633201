#!/usr/bin/env python3
import rospy
from lamp.msg import Lamp
from std_msgs.msg import Int32


class Sender:
    def __init__(self):
        self.pub = rospy.Publisher("lamp", Lamp, queue_size=1)
        rospy.Subscriber("state", Int32, self.on_state)

    def on_state(self, msg):
        out = Lamp()
        if msg.data > 5:
            out.value = Lamp.RED
        elif msg.data == 2:
            out.value = Lamp.ORANGE
        else:
            out.value = Lamp.GREEN
        self.pub.publish(out)


if __name__ == "__main__":
    rospy.init_node("sender")
    Sender()
    rospy.spin()
