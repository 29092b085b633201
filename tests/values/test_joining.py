"""What programs send from their start, and what changed since a base."""

import subprocess
from pathlib import Path

import pytest
from harness_workspaces import needs_clang, write_workspace
from rosimpact.impact.analysis.values import explore_values
from rosimpact.impact.values.outcomes import Bounds

BOUNDS = Bounds(seconds=60.0)
MODE = {"Mode": "uint8 IDLE=0\nuint8 RUN=1\nuint8 STOP=2\nuint8 mode\n"}
ARM = """#include <ros/ros.h>
#include <machine/Mode.h>
#include <std_msgs/Float64.h>
class Arm
{
public:
  explicit Arm(ros::NodeHandle &nh)
  {
    pub_ = nh.advertise<std_msgs::Float64>("angle", 1);
    sub_ = nh.subscribe("mode", 1, &Arm::onMode, this);
  }
private:
  void onMode(const machine::Mode::ConstPtr &msg)
  {
    std_msgs::Float64 out;
    switch (msg->mode)
    {
      case machine::Mode::RUN: out.data = 1; break;
      case machine::Mode::STOP: out.data = 0; break;
      default: return;
    }
    pub_.publish(out);
  }
  ros::Publisher pub_;
  ros::Subscriber sub_;
};
class Sender
{
public:
  Sender() { pub_ = nh_.advertise<machine::Mode>("mode", 1); machine::Mode m; m.mode = 3; pub_.publish(m); }
  void run()
  {
    ros::Rate rate(10);
    while (nh_.ok())
    {
      machine::Mode m;
      m.mode = 4;
      pub_.publish(m);
      rate.sleep();
    }
  }
private:
  ros::NodeHandle nh_;
  ros::Publisher pub_;
};
int main(int argc, char **argv)
{
  ros::init(argc, argv, "machine");
  ros::NodeHandle nh("~");
  Arm arm(nh);
  ros::Publisher pub = nh.advertise<machine::Mode>("/mode", 1);
  int level = 0;
  nh.param("level", level, 5);
  while (ros::ok())
  {
    machine::Mode m;
    m.mode = level;
    pub.publish(m);
    ros::spinOnce();
  }
  Sender sender;
  sender.run();
}
"""


@pytest.fixture(scope="module")
def cpp_workspace(tmp_path_factory) -> Path:
    text = ARM.replace('nh.subscribe("mode"', 'nh.subscribe("/mode"')
    return write_workspace(tmp_path_factory.mktemp("joined"), 1, {"src/arm.cpp": text}, "src/arm.cpp", MODE)


@needs_clang
def test_loops_constructors_methods_and_parameters_of_main_are_followed(cpp_workspace):
    answer = explore_values(cpp_workspace, bounds=BOUNDS)
    rows = {(one.kind, one.field, one.values, one.severity) for one in answer.mismatches}
    assert rows == {("unhandled-value", "mode", value, "warning") for value in ("3", "4", "5")}
    lines = ARM.splitlines()
    assert all("pub" in lines[one.sender.places[0].line - 1] for one in answer.mismatches if one.sender)


@needs_clang
def test_a_loop_of_main_never_tells_that_a_value_is_not_sent(cpp_workspace):
    answer = explore_values(cpp_workspace, bounds=BOUNDS)
    sent = [field for one in answer.others for through in one.sent for field in through.fields]
    assert sent and not any(one.is_known for one in sent)
    assert not [one for one in answer.mismatches if one.kind == "impossible-branch"]


SPEAKER = """#!/usr/bin/env python3
import rospy
from std_msgs.msg import Int32

rospy.init_node("speaker")
publisher = rospy.Publisher("level", Int32, queue_size=1)
while not rospy.is_shutdown():
    publisher.publish(VALUE)
    rospy.sleep(1.0)
"""
LISTENER = """#!/usr/bin/env python3
import rospy
from std_msgs.msg import Bool, Int32


class Listener:
    def __init__(self):
        self.pub = rospy.Publisher("moving", Bool, queue_size=1)
        rospy.Subscriber("level", Int32, self.on_level)

    def on_level(self, msg):
        if msg.data == 1:
            self.pub.publish(True)
        elif msg.data == LAST:
            self.pub.publish(False)


rospy.init_node("listener")
Listener()
rospy.spin()
"""


def write_scripts(root: Path, value: str, last: str) -> Path:
    write_workspace(root, 1, {}, "src/none.cpp")
    folder = root / "machine/scripts"
    folder.mkdir(exist_ok=True)
    (folder / "speaker.py").write_text(SPEAKER.replace("VALUE", value))
    (folder / "listener.py").write_text(LISTENER.replace("LAST", last))
    return root


@pytest.mark.parametrize(("value", "found"), [("1", ()), ("7", ("7",)), ("len(input())", ())])
def test_the_top_of_a_script_is_followed(tmp_path, value, found):
    answer = explore_values(write_scripts(tmp_path, value, "2"), bounds=BOUNDS)
    assert tuple(one.values for one in answer.mismatches) == found


def test_a_message_of_another_type_is_not_received(tmp_path):
    root = write_scripts(tmp_path, "7", "2")
    path = root / "machine/scripts/speaker.py"
    path.write_text(path.read_text().replace("Int32", "Int64"))
    answer = explore_values(root, bounds=BOUNDS)
    assert answer.others and not answer.mismatches


def run_git(folder: Path, *arguments: str) -> None:
    command = ["git", "-c", "user.name=A", "-c", "user.email=a@example.org", *arguments]
    subprocess.run(command, cwd=folder, check=True, capture_output=True)


def test_sets_that_changed_since_a_base(tmp_path):
    root = write_scripts(tmp_path, "1", "2")
    run_git(root, "init", "-q")
    run_git(root, "add", "-A")
    run_git(root, "commit", "-qm", "before")
    same = explore_values(root, bounds=BOUNDS, base=("HEAD",))
    assert same.changes == () and same.base == "HEAD"
    write_scripts_again(root, "2", "3")
    answer = explore_values(root, bounds=BOUNDS, base=("HEAD",))
    rows = {(one.callback, one.field, one.what, one.old, one.new) for one in answer.changes}
    assert ("Listener.on_level", "data", "handled", "1..2", "1, 3") in rows
    assert ("main", "data", "sent", "1", "2") in rows
    assert {one.what for one in answer.changes} == {"handled", "ignored", "sent"}


def write_scripts_again(root: Path, value: str, last: str) -> None:
    (root / "machine/scripts/speaker.py").write_text(SPEAKER.replace("VALUE", value))
    (root / "machine/scripts/listener.py").write_text(LISTENER.replace("LAST", last))
