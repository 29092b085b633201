"""Lists that are filtered, and loops that leave elements out: which of the names there are is known where the condition
is decided, and depends on it elsewhere."""

import pytest
from joining import graph

WATCH = """
import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool

NODES = {"one": {"topic": "/one", "fresh": 1}, "two": {"topic": "/two"}}
ROWS = [{"topic": "/one", "kind": "cam"}, {"topic": "/two", "kind": "imu"}]
NAMES = ["/one", "/two", "skip"]


class Watch:
    def __init__(self, node, topics):
        self.node = node
        self.topics = list(topics)

    def attach(self):
        for topic in self.topics:
            self.node.create_subscription(Bool, topic, print, 1)


def main():
    rclpy.init()
    node = Node("watch")
    BODY


main()
"""


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        (
            'Watch(node, [each["topic"] for each in NODES.values() if "fresh" in each]).attach()',
            {("/one", '"fresh" in each'), ("/two", '"fresh" in each')},
        ),
        (
            'chosen = [each["topic"] for each in NODES.values() if "fresh" in each]\n    Watch(node, chosen).attach()',
            {("/one", '"fresh" in each'), ("/two", '"fresh" in each')},
        ),
        ("chosen = [each for each in NAMES]\n    Watch(node, chosen).attach()",
         {("/one", ""), ("/two", ""), ("/skip", "")}),
        (
            "rows = [row for row in ROWS if row.get('on')]\n    for row in rows:\n"
            "        node.create_subscription(Bool, row['topic'], print, 1)",
            {("/one", "row.get('on')"), ("/two", "row.get('on')")},
        ),
        (
            "for row in ROWS:\n        if row['kind'] != wanted:\n            continue\n"
            "        node.create_subscription(Bool, row['topic'], print, 1)",
            {("/one", "!(row['kind'] != wanted)"), ("/two", "!(row['kind'] != wanted)")},
        ),
        # Decided for each element.
        (
            "subs = [node.create_subscription(Bool, each, print, 1) for each in NAMES if each.startswith('/')]",
            {("/one", ""), ("/two", "")},
        ),
        (
            "for each in NAMES:\n        if each == 'skip':\n            continue\n"
            "        node.create_subscription(Bool, each, print, 1)",
            {("/one", ""), ("/two", "")},
        ),
        (
            "for each in NAMES:\n        if each in left_out():\n            continue\n"
            "        node.create_subscription(Bool, each, print, 1)",
            {(name, "!(each in left_out())") for name in ("/one", "/two", "/skip")},
        ),
        (
            "for each in NAMES:\n        if each in node.left_out:\n            continue\n"
            "        node.create_subscription(Bool, each, print, 1)",
            {(name, "!(each in node.left_out)") for name in ("/one", "/two", "/skip")},
        ),
        # What is there already is not made again.
        (
            "subs = {}\n    for each in NAMES:\n        if each in subs:\n            continue\n"
            "        subs[each] = node.create_subscription(Bool, each, print, 1)",
            {("/one", ""), ("/two", ""), ("/skip", "")},
        ),
    ],
)  # fmt: skip
def test_which_elements_there_are(body, expected):
    found = graph({"p/watch.py": WATCH.replace("BODY", body)})
    made = {(one.topic, one.only_if) for one in found.endpoints if one.role == "subscriber"}
    assert made - {("", "something calls `Watch.attach`")} == expected
