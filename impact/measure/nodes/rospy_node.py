"""A measuring node of rospy: `python3 -m nodes.rospy_node publish|subscribe NAME=VALUE...`, run by the system's Python.

rospy drops in two places: a publisher's queue, when the thread that sends is busy, and what a subscriber reads at once
beyond the length of its queue. Arrivals are seen where the bytes that were read are cut into messages.
"""

import importlib
import struct
import sys

from .node_loop import NodeLoop, read_contents

_HEAD = struct.Struct("<QqI")
_LENGTH = struct.Struct("<I")


def main(arguments):
    """Runs a node until the runner ends it."""
    rospy = importlib.import_module("rospy")
    sample = importlib.import_module("rosimpact_measure.msg").Sample
    loop = NodeLoop(arguments)
    queue, topic = loop.get_number("queue"), loop.options["topic"]
    if loop.role == "publish":
        rospy.init_node("measure", anonymous=True, disable_signals=True, disable_rosout=True)
        messages = [_make_sample(sample, data, loop) for data in read_contents(loop.options["contents"])]
        publisher = rospy.Publisher(topic, sample, queue_size=queue)

        def send(number, sent):
            message = messages[number % len(messages)]
            message.number, message.sent = number, sent
            publisher.publish(message)

        loop.publish(lambda: publisher.get_num_connections() > 0, send)
    else:
        _note_arrivals(loop)
        rospy.init_node("measure", anonymous=True, disable_signals=True, disable_rosout=True)
        rospy.Subscriber(
            topic, sample, lambda message: loop.note_callback(message.publisher, message.number, message.sent),
            queue_size=queue, buff_size=1 << 24,
        )  # fmt: skip
        loop.wait_until_idle()
        loop.finish()


def _make_sample(sample, data, loop):
    message = sample()
    message.deserialize(_HEAD.pack(0, 0, loop.get_number("index")) + data)
    return message


def _note_arrivals(loop):
    """Notes each message that is read from a connection, before rospy drops what is too much for the queue."""
    module = importlib.import_module("rospy.impl.tcpros_base")
    original = module.deserialize_messages

    def read_messages(buffer, *further, **named):
        data, at = buffer.getbuffer(), 0
        end = buffer.tell()
        while at + 4 <= end:
            (size,) = _LENGTH.unpack_from(data, at)
            if at + 4 + size > end:
                break
            number, sent, publisher = _HEAD.unpack_from(data, at + 4)
            loop.note_arrival(publisher, number, sent)
            at += 4 + size
        del data
        return original(buffer, *further, **named)

    vars(module)["deserialize_messages"] = read_messages


if __name__ == "__main__":
    main(sys.argv[1:])
