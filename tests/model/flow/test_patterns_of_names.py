"""Calls whose name is known in part: what it matches, and how they are counted."""

import pytest
from joining import graph

CODE = """
    import os
    import sys
    import rospy
    from std_msgs.msg import Empty

    def ask():
        return input()

    if __name__ == "__main__":
        rospy.init_node("n")
        robot = sys.argv[1]
        count = int(sys.argv[2])
        for i in range(count):
            {0}
"""
MADE = "rospy.Publisher({}, Empty, queue_size=1)"


def count_calls(name):
    found = graph({"p/n.py": CODE.format(MADE.format(name))}, ros=1).coverage
    return found.calls, found.resolved, found.in_part, [one.pattern for one in found.unresolved if one.pattern]


@pytest.mark.parametrize(("name", "pattern"), [
    ('"/" + robot + "/odom"', "/*/odom"),
    ('robot + "/odom"', "/*/odom"),
    ('"/%s/cmd" % os.environ["ROBOT"]', "/*/cmd"),
    ('os.getenv("ROBOT") + "/cmd"', "/*/cmd"),
    ('"/robot_%d/cmd" % i', "/robot_*/cmd"),
    ('f"fleet/{robot}{i}"', "fleet/**"),
    ('f"{ask()}/cmd/{robot}"', "/*/cmd/*"),
])  # fmt: skip
def test_a_name_of_which_a_segment_is_known(name, pattern):
    assert count_calls(name) == (1, 0, 1, [pattern])


@pytest.mark.parametrize(("name", "pattern"), [
    ("robot", []), ('"/" + robot', []), ("ask()", []),
    ('"/robot_%d" % i', ["/robot_*"]), ('robot + "_odom"', ["/*_odom"]),
])  # fmt: skip
def test_a_name_of_which_no_segment_is_known_is_not_counted(name, pattern):
    assert count_calls(name) == (1, 0, 0, pattern)


@pytest.mark.parametrize("name", ['"odom"', '"/robot/odom"'])
def test_a_name_that_is_known_has_none_either(name):
    assert count_calls(name) == (1, 1, 0, [])


def test_a_variable_of_the_environment_is_called_by_its_name():
    found = graph({"p/n.py": CODE.format(MADE.format('"/" + os.environ["ROBOT"] + "/cmd"'))}, ros=1)
    assert [one.topic for one in found.endpoints if not one.implied] == ["/<$ROBOT>/cmd"]


def test_a_call_with_several_names_has_a_pattern_where_each_has():
    code = CODE.format("name = robot + '/a' if count else robot + '/b'\n            " + MADE.format("name"))
    assert [one.pattern for one in graph({"p/n.py": code}, ros=1).coverage.unresolved] == ["/*/a or /*/b"]
    code = CODE.format("name = 'a/' + robot if count else 'b/' + robot\n            " + MADE.format("name"))
    assert [one.pattern for one in graph({"p/n.py": code}, ros=1).coverage.unresolved] == ["a/* or b/*"]
    code = CODE.format("name = robot + '/a' if count else robot\n            " + MADE.format("name"))
    assert [one.pattern for one in graph({"p/n.py": code}, ros=1).coverage.unresolved] == [""]
