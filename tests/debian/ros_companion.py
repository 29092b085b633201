"""Runs beside a node under test, in the system's Python: speaks on the topics named as arguments, hears all others.

Nodes that advertise once they have heard something, and nodes that subscribe once they are heard, then do.
"""

import sys

import rosgraph  # pyright: ignore[reportMissingImports]
import rospy  # pyright: ignore[reportMissingImports]
from std_msgs.msg import String  # pyright: ignore[reportMissingImports]


def main(topics):
    rospy.init_node("companion", disable_rosout=True)
    master = rosgraph.Master(rospy.get_name())
    publishers = [rospy.Publisher(topic, String, queue_size=1) for topic in topics]
    heard = {}
    while not rospy.is_shutdown():
        for publisher in publishers:
            publisher.publish("x")
        for topic, nodes in master.getSystemState()[0]:
            others = [node for node in nodes if node != rospy.get_name()]
            if others and topic not in heard and not topic.startswith("/rosout"):
                heard[topic] = rospy.Subscriber(topic, rospy.AnyMsg, lambda message: None)
        rospy.sleep(0.1)


if __name__ == "__main__":
    main(sys.argv[1:])
