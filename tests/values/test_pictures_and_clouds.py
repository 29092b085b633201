"""What libraries of images and clouds do with a message: encodings that are not known, sizes that do not fit, fields
that are not there, and nothing where all is right."""

from __future__ import annotations

import functools
from pathlib import Path

import pytest
from harness_workspaces import needs_compiler, write_workspace
from rosimpact.impact.analysis.values import explore_values
from rosimpact.impact.values.answers import CallbackAnswer
from rosimpact.impact.values.outcomes import Bounds, CrashKind, Reaction

ROS1 = """
#include <ros/ros.h>
#include <cv_bridge/cv_bridge.h>
#include <opencv2/imgproc/imgproc.hpp>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/image_encodings.h>
#include <sensor_msgs/point_cloud2_iterator.h>
#include <std_msgs/Int32.h>
namespace enc = sensor_msgs::image_encodings;
ros::Publisher out;
cv::Mat last;
void send(int value) { std_msgs::Int32 sent; sent.data = value; out.publish(sent); }
void onCaught(const sensor_msgs::ImageConstPtr &msg) {
  cv_bridge::CvImagePtr got;
  try {
    got = cv_bridge::toCvCopy(msg, enc::BGR8);  // onCaught
  } catch (cv_bridge::Exception &e) {
    ROS_ERROR("cv_bridge exception: %s", e.what());
    return;
  }
  send(got->image.rows);
}
void onOwn(const sensor_msgs::ImageConstPtr &msg) {
  try {
    cv_bridge::CvImageConstPtr got = cv_bridge::toCvShare(msg);  // onOwn
    send(got->image.cols);
  } catch (cv_bridge::Exception &e) {
    ROS_ERROR("cv_bridge exception: %s", e.what());
  }
}
void onPassed(const sensor_msgs::ImageConstPtr &msg) {
  send(cv_bridge::toCvShare(msg, "mono16")->image.rows);  // onPassed
}
void onDepth(const sensor_msgs::ImageConstPtr &msg) {
  if (enc::isColor(msg->encoding)) { ROS_WARN("no depth"); return; }
  send(enc::bitDepth(msg->encoding));  // onDepth
}
void onKept(const sensor_msgs::ImageConstPtr &msg) {
  if (last.empty()) return;
  send(100 / last.cols);
}
void onStored(const sensor_msgs::ImageConstPtr &msg) {
  try { last = cv_bridge::toCvCopy(msg)->image; } catch (std::exception &) { return; }
}
void onCloud(const sensor_msgs::PointCloud2ConstPtr &msg) {
  sensor_msgs::PointCloud2ConstIterator<uint8_t> x(*msg, "x");  // onCloud.throws
  if (msg->data.empty()) return;
  send(*x);  // onCloud.reads
}
void onChecked(const sensor_msgs::PointCloud2ConstPtr &msg) {
  if (msg->fields.size() != 1 || msg->fields[0].name != "x" || msg->fields[0].offset != 0) return;
  if (msg->point_step != 1) return;
  int sum = 0;
  for (sensor_msgs::PointCloud2ConstIterator<uint8_t> x(*msg, "x"); x != x.end(); ++x) sum += *x;
  send(sum);
}
void onCount(const sensor_msgs::PointCloud2ConstPtr &msg) {
  sensor_msgs::PointCloud2 copy = *msg;
  sensor_msgs::PointCloud2Modifier modifier(copy);
  send(modifier.size());  // onCount
}
int main(int argc, char **argv) {
  ros::init(argc, argv, "machine");
  ros::NodeHandle nh;
  out = nh.advertise<std_msgs::Int32>("out", 1);
  ros::Subscriber a = nh.subscribe("caught", 1, onCaught);
  ros::Subscriber b = nh.subscribe("own", 1, onOwn);
  ros::Subscriber c = nh.subscribe("passed", 1, onPassed);
  ros::Subscriber d = nh.subscribe("depth", 1, onDepth);
  ros::Subscriber e = nh.subscribe("cloud", 1, onCloud);
  ros::Subscriber f = nh.subscribe("checked", 1, onChecked);
  ros::Subscriber g = nh.subscribe("count", 1, onCount);
  ros::Subscriber h = nh.subscribe("kept", 1, onKept);
  ros::Subscriber i = nh.subscribe("stored", 1, onStored);
  ros::spin();
}
"""


@pytest.fixture(scope="module")
def ros1(tmp_path_factory) -> Path:
    return write_workspace(tmp_path_factory.mktemp("pictures"), 1, {"src/node.cpp": ROS1}, "src/node.cpp")


@functools.cache
def explore(root: Path) -> dict[str, CallbackAnswer]:
    """The callbacks of a workspace with replays, by the last part of their names."""
    answer = explore_values(root, bounds=Bounds(seconds=120.0), replays=True, publishers=False, jobs=1)
    return {one.callback.rpartition("::")[2]: one for one in answer.report.callbacks}


def list_crashes(one: CallbackAnswer) -> set[tuple[CrashKind, int, bool | None]]:
    return {(each.crash, each.place.line, each.confirmed) for each in one.examples if each.crash is not None}


def find_line(text: str, mark: str) -> int:
    return next(number for number, line in enumerate(text.splitlines(), 1) if line.endswith(f"// {mark}"))


@needs_compiler
@pytest.mark.parametrize(
    ("name", "crashes", "reactions"),
    [
        # An empty image is not converted by OpenCV, `8U` has no number of channels: what they throw is not caught.
        ("onCaught", {(CrashKind.EXCEPTION, "onCaught")}, {Reaction.HANDLED, Reaction.LOG_ONLY}),
        ("onOwn", {(CrashKind.EXCEPTION, "onOwn")}, {Reaction.HANDLED, Reaction.LOG_ONLY}),
        ("onPassed", {(CrashKind.EXCEPTION, "onPassed")}, {Reaction.HANDLED}),
        ("onDepth", {(CrashKind.EXCEPTION, "onDepth")}, {Reaction.HANDLED, Reaction.LOG_ONLY}),
        (
            "onCloud",
            {(CrashKind.EXCEPTION, "onCloud.throws"), (CrashKind.INDEX, "onCloud.reads")},
            {Reaction.HANDLED, Reaction.IGNORED},
        ),
        ("onChecked", set(), {Reaction.HANDLED, Reaction.IGNORED}),
        ("onCount", {(CrashKind.DIVISION, "onCount")}, {Reaction.HANDLED}),
    ],
)
def test_what_a_library_throws_is_a_crash_where_it_is_called(ros1, name, crashes, reactions):
    one = explore(ros1)[name]
    assert one.reason == ""
    assert list_crashes(one) == {(kind, find_line(ROS1, mark), True) for kind, mark in crashes}
    assert reactions == {each for each, count in one.counts.items() if count} - {Reaction.CRASH, Reaction.UNKNOWN}


@needs_compiler
def test_an_image_that_another_callback_keeps_is_any(ros1):
    one = explore(ros1)["onKept"]
    assert one.counts.get(Reaction.HANDLED) and one.counts.get(Reaction.IGNORED)


@needs_compiler
def test_an_image_that_is_kept_is_not_said_to_be_ignored(ros1):
    one = explore(ros1)["onStored"]
    assert one.counts.get(Reaction.UNKNOWN) or one.counts.get(Reaction.HANDLED)


PYTHON = """#!/usr/bin/env python3
import rospy
from cv_bridge import CvBridge, CvBridgeError
from sensor_msgs.msg import Image
from std_msgs.msg import Int32


class Watcher:
    def __init__(self):
        self.bridge = CvBridge()
        self.pub = rospy.Publisher("height", Int32, queue_size=1)
        rospy.Subscriber("plain", Image, self.on_plain)
        rospy.Subscriber("guarded", Image, self.on_guarded)
        rospy.Subscriber("checked", Image, self.on_checked)

    def on_plain(self, msg):
        image = self.bridge.imgmsg_to_cv2(msg, "bgr8")  # on_plain
        self.pub.publish(msg.height)

    def on_guarded(self, msg):
        try:
            image = self.bridge.imgmsg_to_cv2(msg, "bgr8")
        except CvBridgeError as error:
            rospy.logerr(error)
            return
        self.pub.publish(msg.height)

    def on_checked(self, msg):
        if msg.encoding != "mono8":
            return
        image = self.bridge.imgmsg_to_cv2(msg)
        self.pub.publish(msg.height)


rospy.init_node("watcher")
Watcher()
rospy.spin()
"""


@pytest.mark.parametrize(
    ("name", "crashes", "reactions"),
    [
        ("on_plain", {CrashKind.EXCEPTION}, {Reaction.HANDLED}),
        ("on_guarded", set(), {Reaction.HANDLED, Reaction.LOG_ONLY}),
        ("on_checked", set(), {Reaction.HANDLED, Reaction.IGNORED}),
    ],
)
def test_an_encoding_that_cv_bridge_does_not_know_in_python(tmp_path, name, crashes, reactions):
    root = write_workspace(tmp_path, 1, {"scripts/watcher.py": PYTHON}, "src/none.cpp")
    answer = explore_values(root, callbacks=(name,), replays=True, publishers=False, jobs=1)
    (one,) = answer.report.callbacks
    assert one.reason == ""
    assert list_crashes(one) == {(kind, find_line(PYTHON.replace("#", "//"), name), True) for kind in crashes}
    assert {each for each, count in one.counts.items() if count} - {Reaction.CRASH, Reaction.UNKNOWN} == reactions
