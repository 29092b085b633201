"""The parts of rospy that nodes of generated workspaces use, in one process: messages are those that genpy generates,
serialized where they are published and deserialized for each subscriber."""

import sys
from io import BytesIO

import genpy
from genpy import Duration, Time  # noqa: F401

_hearings = []
_sizes = {}
_left = [3]


def _resolve(name):
    return name if name.startswith("/") else f"/{name}"


class Publisher:
    """A publisher. data_class: of the messages, as genpy makes it."""

    def __init__(self, name, data_class, subscriber_listener=None, tcp_nodelay=False, latch=False, headers=None,
                 queue_size=None):  # fmt: skip
        self.name, self.resolved_name, self.data_class = name, _resolve(name), data_class

    def publish(self, *args, **keywords):
        """Serializes and hands over, as rospy.topics does."""
        if len(args) == 1 and not keywords and isinstance(args[0], genpy.Message):
            message = args[0]
            if message._md5sum != self.data_class._md5sum:
                raise TypeError(f"expected {self.data_class._type}, got {message._type}")
        else:
            message = self.data_class(*args, **keywords)
        message._check_types()
        out = BytesIO()
        message.serialize(out)
        data = out.getvalue()
        _sizes[self.resolved_name] = _sizes.get(self.resolved_name, 0) + len(data) + 4
        for name, class_, callback, more in list(_hearings):
            if name == self.resolved_name:
                if class_._md5sum != self.data_class._md5sum:
                    raise TypeError(f"types differ on {name}")
                callback(class_().deserialize(data), *more)

    def get_num_connections(self):
        return sum(one[0] == self.resolved_name for one in _hearings)


class Subscriber:
    """A subscriber."""

    def __init__(self, name, data_class, callback=None, callback_args=None, queue_size=None, buff_size=65536,
                 tcp_nodelay=False):  # fmt: skip
        more = () if callback_args is None else (callback_args,)
        _hearings.append((_resolve(name), data_class, callback, more))


class Rate:
    """A rate that does not wait."""

    def __init__(self, hz):
        pass

    def sleep(self):
        _left[0] -= 1


def init_node(name, **_):
    _left[0] = 3


def is_shutdown():
    return _left[0] <= 0


def spin():
    pass


def loginfo(text, *values):
    print(text % values if values else text)


def report_sizes():
    """Writes the bytes that were published on each topic."""
    for name, size in sorted(_sizes.items()):
        print(name, size, file=sys.stderr)
