"""The time limit of a callback holds for all ways to it together, and within what takes long by itself."""

import pytest
import z3
from harness_workspaces import Prepared, needs_clang, write_workspace
from rosimpact.impact.values import survey
from rosimpact.impact.values.ir import executor
from rosimpact.impact.values.ir.terms import count_trailing_zeros
from rosimpact.impact.values.outcomes import Bounds, CallbackPath, Exploration, Reaction

SOURCE = """
#include <ros/ros.h>
#include <std_msgs/UInt8MultiArray.h>
static const unsigned short table[256] = {{{table}}};
ros::Publisher pub;
void onBytes(const std_msgs::UInt8MultiArray::ConstPtr &msg) {{
  unsigned short sum = 0xFFFF;
  for (int round = 0; round < 8; ++round)
    for (unsigned char byte : msg->data) sum = (sum >> 8) ^ table[(sum ^ byte) & 0xFF];
  if (sum == 7) pub.publish(*msg);
}}
int main(int argc, char **argv) {{
  ros::init(argc, argv, "machine");
  ros::NodeHandle nh;
  pub = nh.advertise<std_msgs::UInt8MultiArray>("out", 1);
  ros::Subscriber sub = nh.subscribe("bytes", 1, onBytes);
  ros::spin();
}}
"""


class TickingClock:
    """A clock on which each look takes a hundredth of a second."""

    def __init__(self):
        self.now = 0.0

    def monotonic(self):
        self.now += 0.01
        return self.now


@needs_clang
def test_the_clock_is_looked_at_between_instructions(tmp_path, monkeypatch):
    """Few instructions, each of which may take long."""
    table = ", ".join(str(number * 40503 % 65521) for number in range(256))
    root = write_workspace(tmp_path / "ws", 1, {"src/machine.cpp": SOURCE.format(table=table)}, "src/machine.cpp")
    found = Prepared(root, tmp_path / "harness", ("subscriber",), Bounds()).by_name["onBytes"]
    monkeypatch.setattr(executor, "time", TickingClock())
    seen = survey._explore_entries(found, Bounds(seconds=0.5))
    assert seen.instructions < 500 and "time limit" in {one.reason for one in seen.paths}


@pytest.mark.parametrize("needed, asked", [((1.0, 2.0), [15.0, 19.0]), ((15.0, 5.0), [15.0, 5.0]), ((21.0,), [15.0])])
def test_all_entries_of_a_callback_share_its_time(monkeypatch, needed, asked):
    given, left = [], list(needed)

    def explore(texts, entry, bounds, is_workspace_file):
        given.append(bounds.seconds)
        path = CallbackPath(Reaction.UNKNOWN, (), reason="nothing is known")
        return Exploration(paths=[path], bounds=bounds, seconds=left.pop(0))

    class Entry:
        name, way = "bare", "bare"

    class Found:
        entry, way, others, ir_texts, is_workspace_file = "built", "built", (Entry(),), (), None

    monkeypatch.setattr(survey, "explore", explore)
    survey._explore_entries(Found(), Bounds(seconds=20.0))
    assert given == asked


def test_parts_that_a_term_has_often_are_looked_at_once():
    term = z3.BitVec("x", 64) * 8
    for place in range(60):
        term = z3.If(z3.BitVec("x", 64) == place, term, term + 16)
    assert count_trailing_zeros(term) == 3  # which takes for ever otherwise
    left = right = z3.BitVec("x", 64) * 8
    for place in range(60):
        x = z3.BitVec("x", 64)
        left, right = z3.If(x == place, left, right), z3.If(x == place + 100, right, left)
    assert count_trailing_zeros(z3.If(x == 5, left, right)) == 3


def test_a_long_chain_of_choices_is_looked_at_to_its_end():
    place = z3.BitVec("x", 64)
    term = z3.BitVecVal(4, 64)
    for number in range(3000):
        term = z3.If(place == number, z3.BitVecVal(8 * number, 64), term)
    assert count_trailing_zeros(term) == 2
