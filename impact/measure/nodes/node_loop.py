"""What measuring nodes written in Python do alike: their options, schedule, records and protocol (see __init__.py).

The system's Python runs it too, without anything of rosimpact: it needs the standard library alone.
"""

import json
import os
import sys
import threading
import time
from array import array

ARRIVAL, CALLBACK = 0, 1
_MARK = "measure:"


class NodeLoop:
    """One node: its options, and what the runner asked for so far. wake: set when it asked for something."""

    def __init__(self, arguments):
        self.role = arguments[0]
        self.options = dict(argument.partition("=")[::2] for argument in arguments[1:])
        self.clock = time.CLOCK_REALTIME if self.options.get("clock") == "realtime" else time.CLOCK_MONOTONIC
        self.wake = threading.Event()
        self.start = 0
        self.ended = False
        self.arrivals = array("q")
        self.callbacks = array("q")
        self.last_arrival = 0
        threading.Thread(target=self._listen, daemon=True).start()

    def get_number(self, name):
        """An option that is a number."""
        return int(self.options[name])

    def read_time(self):
        """Nanoseconds of the clock that both sides use."""
        return time.clock_gettime_ns(self.clock)

    def say(self, text):
        """A line for the runner."""
        sys.stdout.write(_MARK + text + "\n")
        sys.stdout.flush()

    def _listen(self):
        for line in sys.stdin:
            if line.startswith("start "):
                self.start = int(line[6:])
            elif line.strip() == "end":
                self.ended = True
            self.wake.set()
        os._exit(0)

    def publish(self, is_connected, send):
        """Publishes on schedule. is_connected: whether a subscriber is there. send: publishes a message, given its
        number; the time is taken before."""
        while not is_connected():
            time.sleep(0.01)
        self.say("ready")
        while not self.start:
            self.wake.wait()
            self.wake.clear()
        start = self.start + self.get_number("offset")
        period, count, late = self.get_number("period"), self.get_number("count"), 0
        for number in range(count):
            due = start + number * period
            left = due - self.read_time()
            if left > 0:
                time.sleep(left / 1e9)
            sent = self.read_time()
            late += sent > due + period
            send(number, sent)
        self.say(json.dumps({"published": count, "late": late, "elapsed": self.read_time() - start}))
        while True:
            time.sleep(1)

    def note_arrival(self, publisher, number, sent):
        """A message came in, before the subscriber's queue."""
        self.last_arrival = self.read_time()
        self.arrivals.extend((ARRIVAL, publisher, number, sent, self.last_arrival))

    def note_callback(self, publisher, number, sent):
        """A message was given to the callback, which takes as long as it was asked to."""
        now = self.read_time()
        self.callbacks.extend((CALLBACK, publisher, number, sent, now))
        work = self.get_number("work")
        if work:
            time.sleep(work / 1e9)

    def wait_until_idle(self):
        """Returns once the runner asked for the end and nothing arrives any more."""
        self.say("ready")
        while not self.ended:
            self.wake.wait()
            self.wake.clear()
        begun = self.read_time()
        idle, longest = self.get_number("idle"), self.get_number("longest")
        while self.read_time() - max(self.last_arrival, begun) < idle and self.read_time() - begun < longest:
            time.sleep(0.02)

    def finish(self):
        """Writes what was seen and ends the process."""
        with open(self.options["output"], "wb") as file:
            file.write(self.arrivals.tobytes())
            file.write(self.callbacks.tobytes())
        self.say("done")
        os._exit(0)


def read_contents(path):
    """The messages to send, each as its bytes: a length of 32 bits before each."""
    with open(path, "rb") as file:
        data = file.read()
    found, at = [], 0
    while at < len(data):
        size = int.from_bytes(data[at : at + 4], "little")
        found.append(data[at + 4 : at + 4 + size])
        at += 4 + size
    return found
