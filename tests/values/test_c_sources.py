"""Sources of C that a node calls into: they are followed as its own are."""

from harness_workspaces import Prepared, needs_clang, write_workspace
from rosimpact.impact.values.ir.explore import explore
from rosimpact.impact.values.outcomes import Bounds, CrashKind, Reaction

FILES = {
    "include/machine/scale.h": """
#pragma once
#ifdef __cplusplus
extern "C" {
#endif
struct limits { int low; int high; };
int scale(int level, const struct limits *within);
int other(int level);
#ifdef __cplusplus
}
#endif
""",
    "src/scale.c": """
#include <stdlib.h>
#include "machine/scale.h"
int scale(int level, const struct limits *within) {
  int *class = malloc(sizeof(int));
  *class = level < within->low ? within->low : level;
  int found = 100 / *class;  // divided
  free(class);
  return found;
}
""",
    "src/machine.cpp": """
#include <ros/ros.h>
#include <std_msgs/Int32.h>
#include "machine/scale.h"
ros::Publisher pub;
void onLevel(const std_msgs::Int32::ConstPtr &msg) {
  std_msgs::Int32 out;
  limits within = {-1, 9};
  out.data = scale(msg->data, &within);
  if (out.data > 50) pub.publish(out);
}
int main(int argc, char **argv) {
  ros::init(argc, argv, "machine");
  ros::NodeHandle nh;
  pub = nh.advertise<std_msgs::Int32>("out", 1);
  ros::Subscriber sub = nh.subscribe("level", 1, onLevel);
  ros::spin();
}
""",
}


@needs_clang
def test_a_function_of_c_is_followed(tmp_path):
    root = write_workspace(tmp_path / "ws", 1, FILES, "src/machine.cpp src/scale.c")
    prepared = Prepared(root, tmp_path / "harness", ("subscriber",))
    one = prepared.by_name["onLevel"]
    assert (one.reason, dict(one.left_out)) == ("", {})
    found = explore(one.ir_texts, one.entry, Bounds(seconds=120), one.is_workspace_file)
    crashes = {(path.crash, path.place.line) for path in found.paths if path.crash is not None}
    assert crashes == {(CrashKind.DIVISION, prepared.find_line("machine/src/scale.c", "divided"))}
    assert {path.result for path in found.paths} == {Reaction.CRASH, Reaction.HANDLED, Reaction.IGNORED}
