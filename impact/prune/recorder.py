"""Writes down what the nodes of a running ROS 1 system publish, for `prune --verify`.

It is run by the Python that has rospy, outside of rosimpact, and so it imports nothing of it. Each line of the output
is a JSON array: topic, node, bytes of the message on the wire, the message as a tree of its fields, and the time of the
arrival. Times within the run are written as "now".
"""

import importlib
import json
import sys
import time


def convert(value, start):
    """A message, or a part of it, as JSON has it."""
    if hasattr(value, "__slots__") and hasattr(value, "_type"):
        return {name: convert(getattr(value, name), start) for name in value.__slots__}
    if hasattr(value, "to_sec"):
        now = value.to_sec()
        return "now" if start - 5 <= now <= time.time() + 5 else [value.secs, value.nsecs]
    if isinstance(value, bytes):
        return list(value)
    if isinstance(value, (list, tuple)):
        return [convert(one, start) for one in value]
    if isinstance(value, float):
        return repr(value)
    return value


def main():
    """Records until it is stopped. Argument: the file to write."""
    rospy, messages = importlib.import_module("rospy"), importlib.import_module("roslib.message")
    start = time.time()
    known = set()
    with open(sys.argv[1], "w") as out:
        rospy.init_node("rosimpact_recorder", disable_rosout=True, disable_signals=False)

        def record(message, topic):
            header = message._connection_header
            cls = messages.get_message_class(header["type"])
            if cls is None:
                row = [topic, header["callerid"], len(message._buff), None, time.time()]
            else:
                tree = convert(cls().deserialize(message._buff), start)
                row = [topic, header["callerid"], len(message._buff), tree, time.time()]
            out.write(json.dumps(row) + "\n")
            out.flush()

        while not rospy.is_shutdown():
            try:
                published = rospy.get_published_topics()
            except Exception:
                break
            for topic, _ in published:
                if topic not in known and topic != "/rosout_agg":
                    known.add(topic)
                    rospy.Subscriber(topic, rospy.AnyMsg, record, callback_args=topic, queue_size=1000)
            time.sleep(0.05)


if __name__ == "__main__":
    main()
