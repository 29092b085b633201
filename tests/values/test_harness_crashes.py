"""Each kind of crash, of a callback that is compiled as it is, shown by a native replay with its kind and line."""

import pytest
from harness_workspaces import Prepared, double, needs_compiler, text, write_workspace
from rosimpact.impact.values.harness.replay import classify_crash, is_confirmed
from rosimpact.impact.values.outcomes import NOWHERE, CodeLine, CrashKind, Reaction, Witness

NODE = """
#include <ros/ros.h>
#include <std_msgs/Bool.h>
#include <std_msgs/Float64.h>
#include <std_msgs/Int32.h>
#include <std_msgs/String.h>
#include <std_msgs/UInt8.h>
#include <sensor_msgs/LaserScan.h>
#include <geometry_msgs/Twist.h>
#include <cassert>

class Machine {
 public:
  explicit Machine(ros::NodeHandle &nh) {
    pub_ = nh.advertise<std_msgs::Int32>("out", 1);
    subs_.push_back(nh.subscribe("a", 1, &Machine::onAssert, this));
    subs_.push_back(nh.subscribe("b", 1, &Machine::onIndex, this));
    subs_.push_back(nh.subscribe("c", 1, &Machine::onEmpty, this));
    subs_.push_back(nh.subscribe("d", 1, &Machine::onDivide, this));
    subs_.push_back(nh.subscribe("e", 1, &Machine::onNull, this));
    subs_.push_back(nh.subscribe("f", 1, &Machine::onDangling, this));
    subs_.push_back(nh.subscribe("g", 1, &Machine::onFloat, this));
    subs_.push_back(nh.subscribe("h", 1, &Machine::onOverflow, this));
    subs_.push_back(nh.subscribe("i", 1, &Machine::onShift, this));
    subs_.push_back(nh.subscribe("j", 1, &Machine::onStoi, this));
    subs_.push_back(nh.subscribe("k", 1, &Machine::onEndless, this));
    subs_.push_back(nh.subscribe("l", 1, &Machine::onReturn, this));
    subs_.push_back(nh.subscribe("m", 1, &Machine::onAbort, this));
    subs_.push_back(nh.subscribe("n", 1, &Machine::onAt, this));
    subs_.push_back(nh.subscribe("o", 1, &Machine::onBeyond, this));
    subs_.push_back(nh.subscribe<std_msgs::String>("p", 1, boost::bind(&Machine::onCaught, this, _1)));
    subs_.push_back(nh.subscribe("q", 1, &Machine::onState, this));
  }

 private:
  void onAssert(const std_msgs::UInt8::ConstPtr &msg) {
    assert(msg->data < 3);  // ASSERTION
    send(msg->data);
  }
  void onIndex(const std_msgs::UInt8 &msg) {
    int table[4] = {1, 2, 3, 4};
    send(table[msg.data]);  // INDEX
  }
  void onEmpty(const sensor_msgs::LaserScan::ConstPtr &msg) {
    if (msg->ranges.front() < 1.0f) send(1);  // EMPTY
  }
  void onDivide(const std_msgs::Int32ConstPtr &msg) {
    send(1000 / msg->data);  // DIVISION
  }
  void onNull(const std_msgs::Bool::ConstPtr &msg) {
    if (msg->data) send(last_->data);  // NULL
  }
  void onDangling(const std_msgs::Bool::ConstPtr &msg) {
    int *value = new int(5);
    if (msg->data) delete value;
    send(*value);  // DANGLING
  }
  void onFloat(const geometry_msgs::Twist::ConstPtr &msg) {
    double v = msg->linear.x;
    if (v > 1.0) v = 1.0;
    if (v < -1.0) v = -1.0;
    send(static_cast<int>(v * 100));  // FLOAT_TO_INTEGER
  }
  void onOverflow(const std_msgs::Int32::ConstPtr &msg) {
    send(msg->data * 1000);  // OVERFLOW
  }
  void onShift(const std_msgs::UInt8::ConstPtr &msg) {
    send(1 << msg->data);  // SHIFT
  }
  void onStoi(const std_msgs::String::ConstPtr &msg) {
    send(std::stoi(msg->data));  // EXCEPTION
  }
  void onEndless(const std_msgs::Int32::ConstPtr &msg) {
    volatile int left = msg->data;
    while (left != 0) {
      if (left > 0) left = left - 1;  // ENDLESS
    }
    send(left);
  }
  int pick(int value) {
    if (value < 10) return value;
  }  // end
  void onReturn(const std_msgs::Int32::ConstPtr &msg) { send(pick(msg->data)); }
  void onAbort(const std_msgs::Bool::ConstPtr &msg) {
    if (msg->data) abort();  // ABORT
  }
  void onAt(const sensor_msgs::LaserScan::ConstPtr &msg) {
    send(static_cast<int>(msg->ranges.at(2) > 1.0f));  // AT
  }
  void onBeyond(const sensor_msgs::LaserScan::ConstPtr &msg) {
    for (size_t i = 0; i <= msg->ranges.size(); ++i) total_ += msg->ranges[i];  // BEYOND
    send(1);
  }
  void onCaught(const std_msgs::String::ConstPtr &msg) {
    try {
      send(std::stoi(msg->data));
    } catch (const std::invalid_argument &error) {
      ROS_WARN_STREAM("no number: " << error.what());
    }
  }
  void onState(const std_msgs::Bool::ConstPtr &msg) {
    if (!enabled_) return;
    enabled_ = msg->data;
    send(count_);
  }
  void send(int value) {
    std_msgs::Int32 out;
    out.data = value;
    pub_.publish(out);
  }

  ros::Publisher pub_;
  std::vector<ros::Subscriber> subs_;
  std_msgs::Int32::ConstPtr last_;
  bool enabled_ = false;
  int count_ = 7;
  float total_ = 0;
};

int main(int argc, char **argv) {
  ros::init(argc, argv, "machine");
  ros::NodeHandle nh;
  Machine machine(nh);
  ros::spin();
}
"""
PATH = "machine/src/machine.cpp"


@pytest.fixture(scope="module")
def prepared(tmp_path_factory):
    root = write_workspace(tmp_path_factory.mktemp("ws"), 1, {"src/machine.cpp": NODE}, "src/machine.cpp")
    return Prepared(root, tmp_path_factory.mktemp("built"), ("subscriber",))


@needs_compiler
def test_all_callbacks_compile(prepared):
    assert [one.callback for one in prepared.all if one.reason] == []
    assert len(prepared.all) == 17
    assert {one.way for one in prepared.all} == {"built"}
    one = prepared.by_name["onFloat"]
    assert (one.topic, one.message_type, one.node) == ("/f".replace("f", "g"), "geometry_msgs/Twist", "machine/machine")
    assert f"define void @{one.entry}(" in one.ir_texts[0].replace("dso_local ", "")


@needs_compiler
@pytest.mark.parametrize(
    "name, values, kind, mark",
    [
        ("onAssert", {"msg.data": 3}, CrashKind.ASSERTION, "ASSERTION"),
        ("onIndex", {"msg.data": 4}, CrashKind.INDEX, "INDEX"),
        ("onEmpty", {"msg.ranges.size": 0}, CrashKind.EMPTY, "EMPTY"),
        ("onDivide", {"msg.data": 0}, CrashKind.DIVISION, "DIVISION"),
        ("onNull", {"msg.data": 1}, CrashKind.NULL, "NULL"),
        ("onDangling", {"msg.data": 1}, CrashKind.DANGLING, "DANGLING"),
        ("onFloat", {"msg.linear.x": double(float("nan"))}, CrashKind.FLOAT_TO_INTEGER, "FLOAT_TO_INTEGER"),
        ("onOverflow", {"msg.data": 2**31 - 1}, CrashKind.OVERFLOW, "OVERFLOW"),
        ("onShift", {"msg.data": 40}, CrashKind.SHIFT, "SHIFT"),
        ("onStoi", text("msg.data", "x"), CrashKind.EXCEPTION, "EXCEPTION"),
        ("onEndless", {"msg.data": 2**32 - 1}, CrashKind.ENDLESS, "ENDLESS"),
        ("onAbort", {"msg.data": 1}, CrashKind.ABORT, "ABORT"),
        ("onAt", {"msg.ranges.size": 2}, CrashKind.EXCEPTION, "AT"),
        ("onBeyond", {"msg.ranges.size": 1}, CrashKind.INDEX, "BEYOND"),
    ],
)
def test_crash_is_shown_with_kind_and_line(prepared, name, values, kind, mark):
    shown = prepared.replay(name, values)
    line = prepared.find_line(PATH, mark)
    assert (shown.result, shown.crash) == (Reaction.CRASH, kind), shown
    if kind is CrashKind.ENDLESS:
        # Stopped anywhere in the loop, or at what it looks at.
        assert shown.place.path == PATH and line - 2 <= shown.place.line <= line + 1
        return
    assert shown.place == CodeLine(PATH, line)
    assert is_confirmed(Witness(values, Reaction.CRASH, kind, CodeLine(PATH, line)), shown)
    assert not is_confirmed(Witness(values, Reaction.CRASH, kind, CodeLine(PATH, line + 1)), shown)
    assert not is_confirmed(Witness(values, Reaction.HANDLED, None, CodeLine("", 0)), shown)


@needs_compiler
def test_end_of_a_function_that_returns_nothing(prepared):
    shown = prepared.replay("onReturn", {"msg.data": 10})
    assert (shown.result, shown.crash, shown.place.path) == (Reaction.CRASH, CrashKind.UNREACHABLE, PATH)


@needs_compiler
@pytest.mark.parametrize(
    "name, values, result, logs",
    [
        ("onAssert", {"msg.data": 2}, Reaction.HANDLED, ()),
        ("onCaught", text("msg.data", "x"), Reaction.LOG_ONLY, ("warn",)),
        ("onCaught", text("msg.data", "12"), Reaction.HANDLED, ()),
        ("onState", {"msg.data": 1}, Reaction.IGNORED, ()),
        ("onState", {"msg.data": 1, "this.enabled_": 1}, Reaction.HANDLED, ()),
        ("onNull", {"msg.data": 0}, Reaction.IGNORED, ()),
    ],
)
def test_what_follows_is_shown(prepared, name, values, result, logs):
    shown = prepared.replay(name, values)
    assert (shown.result, shown.logs) == (result, logs), shown


@needs_compiler
def test_what_is_sent_is_shown(prepared):
    shown = prepared.replay("onDivide", {"msg.data": 2**32 - 8})  # -8
    assert [(one.kind, one.name) for one in shown.effects] == [("publish", "pub_")]
    assert [(one.publisher, one.values, one.kinds) for one in shown.sent] == [
        ("pub_", {"data": 2**32 - 125}, {"data": ("integer", 32, True)})
    ]


@needs_compiler
def test_many_witnesses_are_replayed_together(prepared):
    callback = prepared.by_name["onAssert"]
    witnesses = [Witness({"msg.data": value}, Reaction.HANDLED, None, CodeLine("", 0)) for value in range(6)]
    shown = callback.replay(witnesses)
    assert [one.result for one in shown] == [Reaction.HANDLED] * 3 + [Reaction.CRASH] * 3


def test_loop_is_where_a_trace_has_a_line(tmp_path):
    trace = "    #0 0x1 in print (/x/replay+0x1)\n    #1 0x2 in on_alarm /x/native.cpp:65:3\n    #2 0x3 in spin {}\n"
    bare = trace.format(f"{tmp_path}/a.cpp") + f"    #3 0x4 in call {tmp_path}/b.cpp:9:1\n"
    named = trace.format(f"{tmp_path}/a.cpp:7:5")
    assert classify_crash(bare + named, True, tmp_path)[1] == CodeLine("a.cpp", 7)
    assert classify_crash(bare, True, tmp_path)[1] == CodeLine("a.cpp", 0)
    assert classify_crash(f"{tmp_path}/a.cpp", True, tmp_path)[1] == NOWHERE
