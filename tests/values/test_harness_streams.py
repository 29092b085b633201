"""Callbacks that print through the standard streams, and sources that use headers which others bring along."""

from harness_workspaces import Prepared, needs_compiler, write_workspace
from rosimpact.impact.values.ir.explore import explore
from rosimpact.impact.values.outcomes import Bounds, CrashKind, Reaction

NODE = """
#include <iostream>
#include <ros/ros.h>
#include <std_msgs/Int32.h>

class Node {
 public:
  Node() {
    std::cout << "made" << std::endl << std::flush;
    pub_ = nh_.advertise<std_msgs::Int32>("out", 1);
    sub_ = nh_.subscribe("in", 1, &Node::onNumber, this);
  }
  void onNumber(const std_msgs::Int32::ConstPtr &msg) {
    std::ostringstream words;
    words << std::setw(2);
    std::vector<int> parts(3);
    std::copy(parts.begin(), parts.end(), std::ostream_iterator<int>(words, ", "));
    report(msg->data / 2.0);
    if (msg->data > 5) {
      std_msgs::Int32 out;
      out.data = 100 / (msg->data - 6);  // divide
      pub_.publish(out);
    }
  }
  void onPrint(const std_msgs::Int32::ConstPtr &msg) {
    std::cout << msg->data / 2.0 << std::endl;
    if (msg->data > 5) {
      std_msgs::Int32 out;
      out.data = 100 / (msg->data - 6);
      pub_.publish(out);
    }
  }
  void report(double) {}
 private:
  ros::NodeHandle nh_;
  ros::Publisher pub_;
  ros::Subscriber sub_, print_ = nh_.subscribe("print", 1, &Node::onPrint, this);
};

int main(int argc, char **argv) {
  ros::init(argc, argv, "node");
  Node node;
  ros::spin();
}
"""


@needs_compiler
def test_a_line_on_the_console_is_a_line_in_a_log(tmp_path):
    root = write_workspace(tmp_path / "ws", 1, {"src/node.cpp": NODE}, "src/node.cpp")
    prepared = Prepared(root, tmp_path, ("subscriber",))
    assert {one.reason for one in prepared.all} == {""}
    one = prepared.by_name["onPrint"]
    found = explore(one.ir_texts, one.entry, Bounds(seconds=10), one.is_workspace_file)
    assert {path.result for path in found.paths} == {Reaction.HANDLED, Reaction.LOG_ONLY, Reaction.CRASH}
    assert {path.crash for path in found.paths} == {None, CrashKind.DIVISION}
    prepared.session.close()
