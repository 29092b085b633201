"""A repository whose every commit is a known kind of change: what `rosimpact logic` says of each."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import NamedTuple

import pygit2
import pytest
from rosimpact.impact.facts.store import Store
from rosimpact.impact.logic.history import CommitHistory
from rosimpact.impact.logic.repository import Logic, LogicCoverage, Range, read, select
from rosimpact.impact.report.logic import render_json, render_text, trim_common_ends
from rosimpact.impact.report.timeline import render

Tree = dict[str, str]

ROS1 = "<package><name>{}</name><version>1.0.0</version><buildtool_depend>catkin</buildtool_depend></package>"
ROS2 = "<package format='3'><name>{}</name><export><build_type>ament_cmake</build_type></export></package>"

TALKER = """#include <ros/ros.h>
#include <std_msgs/String.h>

class Talker
{
public:
  Talker(ros::NodeHandle nh)
  {
    pub_ = nh.advertise<std_msgs::String>("chatter", 10);
    sub_ = nh.subscribe("input", 1, &Talker::onInput, this);
    timer_ = nh.createTimer(ros::Duration(0.5), &Talker::onTimer, this);
  }

private:
  void onInput(const std_msgs::String::ConstPtr& msg)
  {
    if (enabled_)
    {
      pub_.publish(*msg);
    }
    count_++;
  }

  void onTimer(const ros::TimerEvent&)
  {
    std_msgs::String beat;
    if (count_ > 3)
      pub_.publish(beat);
  }

  ros::Publisher pub_;
  ros::Subscriber sub_;
  ros::Timer timer_;
  bool enabled_ = true;
  int count_ = 0;
};

int main(int argc, char** argv)
{
  ros::init(argc, argv, "talker");
  ros::NodeHandle nh;
  Talker talker(nh);
  ros::spin();
}
"""

LISTENER = """#!/usr/bin/env python
import rospy
from std_msgs.msg import String

def heard(msg):
    print(msg)

if __name__ == "__main__":
    rospy.init_node("listener")
    rospy.Subscriber("chatter", String, heard)
    rospy.Subscriber("state", String, heard)
    rospy.spin()
"""

WATCH = """#!/usr/bin/env python
import rospy
from std_msgs.msg import String

class Watch:
    def __init__(self):
        self.pub = rospy.Publisher("state", String, queue_size=5)
        self.level = 0
        self.quiet = False

    def run(self):
        rate = rospy.Rate(10)
        while not rospy.is_shutdown():
            if self.level > 2:
                self.pub.publish(String("high"))
            rate.sleep()

if __name__ == "__main__":
    rospy.init_node("watch")
    Watch().run()
"""

CAMERA = """#include "rclcpp/rclcpp.hpp"
#include "std_msgs/msg/string.hpp"

class Camera : public rclcpp::Node
{
public:
  Camera() : Node("camera")
  {
    pub_ = create_publisher<std_msgs::msg::String>("frames", rclcpp::QoS(10));
    timer_ = create_wall_timer(std::chrono::milliseconds(100), [this]() { grab(); });
  }

  void grab()
  {
    std_msgs::msg::String frame;
    if (!open_) {
      return;
    }
    pub_->publish(frame);
  }

private:
  rclcpp::Publisher<std_msgs::msg::String>::SharedPtr pub_;
  rclcpp::TimerBase::SharedPtr timer_;
  bool open_ = false;
  int mode_ = 0;
};

int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  rclcpp::spin(std::make_shared<Camera>());
}
"""

BEEPER = """#include <ros/ros.h>
#include <std_msgs/Empty.h>
int main(int argc, char** argv)
{
  ros::init(argc, argv, "beeper");
  ros::NodeHandle n;
  ros::Publisher beeps = n.advertise<std_msgs::Empty>("beeps", 1);
  ros::Rate rate(5);
  while (ros::ok())
  {
    beeps.publish(std_msgs::Empty());
    rate.sleep();
  }
}
"""

START: Tree = {
    "README": "a repository",
    "talker/package.xml": ROS1.format("talker"),
    "talker/CMakeLists.txt": "project(talker)\nadd_executable(talker src/talker.cpp)\n",
    "talker/src/talker.cpp": TALKER,
    "listener/package.xml": ROS1.format("listener"),
    "listener/scripts/listen": LISTENER,
    "watch/package.xml": ROS1.format("watch"),
    "watch/scripts/watch.py": WATCH,
    "camera/package.xml": ROS2.format("camera"),
    "camera/CMakeLists.txt": "project(camera)\nadd_executable(camera src/camera.cpp)\n",
    "camera/src/camera.cpp": CAMERA,
    "old/beeper/manifest.xml": "<package><author>A</author></package>",
    "old/beeper/CMakeLists.txt": "rosbuild_add_executable(beeper beeper.cpp)\n",
    "old/beeper/beeper.cpp": BEEPER,
}

CPP, PY, CAM, BEEP = "talker/src/talker.cpp", "watch/scripts/watch.py", "camera/src/camera.cpp", "old/beeper/beeper.cpp"


class Step(NamedTuple):
    """A commit. does: changes a tree; says: (kind, topic, what `why` holds) of every change that is expected, those
    that are mere rewordings among them."""

    name: str
    does: Callable[[Tree], None]
    says: tuple[tuple[str, str, str], ...] = ()


def put(path: str, *pairs: tuple[str, str]) -> Callable[[Tree], None]:
    """Replaces texts in a file; each must be there."""

    def change(tree: Tree) -> None:
        for old, new in pairs:
            assert old in tree[path], (path, old)
            tree[path] = tree[path].replace(old, new)

    return change


def move(old: str, new: str) -> Callable[[Tree], None]:
    def change(tree: Tree) -> None:
        for path in [path for path in tree if path == old or path.startswith(f"{old}/")]:
            tree[new + path[len(old) :]] = tree.pop(path)

    return change


def both(*changes: Callable[[Tree], None]) -> Callable[[Tree], None]:
    def change(tree: Tree) -> None:
        for one in changes:
            one(tree)

    return change


def reformat(path: str) -> Callable[[Tree], None]:
    def change(tree: Tree) -> None:
        tree[path] = tree[path].replace("\n  ", "\n      ").replace("{\n", "{  // begins\n")

    return change


STEPS = (
    # Conditions in C++
    Step(
        "ask for more",
        put(CPP, ("if (enabled_)", "if (enabled_ && msg->data.size() > 0)")),
        (("tightened", "chatter", "msg->data.size() > 0"),),
    ),
    Step(
        "ask for less",
        put(CPP, ("if (enabled_ && msg->data.size() > 0)", "if (enabled_)")),
        (("widened", "chatter", "no longer asks for"),),
    ),
    Step(
        "a lower bound",
        put(CPP, ("count_ > 3", "count_ > 1")),
        (("widened", "chatter", "`count_ > 1` was `count_ > 3`"),),
    ),
    Step("a higher bound", put(CPP, ("count_ > 1", "count_ >= 10")), (("tightened", "chatter", "count_"),)),
    Step("the other way round", put(CPP, ("count_ >= 10", "count_ < 10")), (("changed", "chatter", "count_"),)),
    Step("say it otherwise", put(CPP, ("count_ < 10", "!(10 <= count_)")), (("equivalent", "chatter", ""),)),
    Step(
        "return early",
        put(
            CPP,
            (
                "    if (enabled_)\n    {\n      pub_.publish(*msg);\n    }",
                "    if (!enabled_)\n      return;\n    pub_.publish(*msg);",
            ),
        ),
        (("equivalent", "chatter", ""),),
    ),
    # Names
    Step("rename a variable", put(CPP, ("enabled_", "active_"))),
    Step("rename a method", put(CPP, ("onInput", "inputCallback"))),
    Step("rename the class", put(CPP, ("Talker", "Speaker"))),
    Step("rename the publisher", put(CPP, ("pub_", "chatter_pub_"))),
    Step("reformat", reformat(CPP)),
    Step("a comment", put(CPP, ("#include <ros/ros.h>", "// Speaks.\n#include <ros/ros.h>"))),
    # What is moved
    Step(
        "a helper that publishes",
        put(
            CPP,
            ("chatter_pub_.publish(*msg);", "send(*msg);"),
            (
                "void inputCallback(",
                "void send(const std_msgs::String& msg)\n  {\n    chatter_pub_.publish(msg);\n  }\n\n"
                "  void inputCallback(",
            ),
        ),
    ),
    Step(
        "a condition with a name",
        put(CPP, ("if (!(10 <= count_))", "const bool few = !(10 <= count_);\n        if (few)")),
        (("equivalent", "chatter", ""),),
    ),
    Step(
        "a predicate",
        put(
            CPP,
            ("const bool few = !(10 <= count_);\n        if (few)", "if (isFew())"),
            ("void onTimer", "bool isFew() const { return count_ < 10; }\n\n      void onTimer"),
        ),
        (("equivalent", "chatter", ""),),
    ),
    Step("another file", move(CPP, "talker/src/speaker_node.cpp")),
    Step("another folder", move("talker", "robot/talker")),
    Step(
        "another name of the package",
        both(move("robot/talker", "robot/speaker"), put("robot/speaker/package.xml", ("talker", "speaker"))),
    ),
    # What makes it run, C++
    Step(
        "a faster timer",
        put("robot/speaker/src/speaker_node.cpp", ("ros::Duration(0.5)", "ros::Duration(0.1)")),
        (("trigger changed", "chatter", "ros::Duration(0.5)"),),
    ),
    Step(
        "another input",
        put("robot/speaker/src/speaker_node.cpp", ('"input"', '"words"')),
        (("trigger changed", "chatter", "`words`, was `input`"),),
    ),
    Step(
        "a longer queue",
        put("robot/speaker/src/speaker_node.cpp", ('("chatter", 10)', '("chatter", 100)')),
        (("trigger changed", "chatter", "queue `100` was `10`"),),
    ),
    Step(
        "a latch",
        put("robot/speaker/src/speaker_node.cpp", ('("chatter", 100)', '("chatter", 100, true)')),
        (("trigger changed", "chatter", "transient_local"),),
    ),
    Step(
        "another topic",
        put("robot/speaker/src/speaker_node.cpp", ('"chatter", 100', '"speech", 100')),
        (("changed", "speech", "`speech`, was `chatter`"),),
    ),
    Step(
        "one more",
        put(
            "robot/speaker/src/speaker_node.cpp",
            ("count_++;", "count_++;\n        if (count_ == 7) chatter_pub_.publish(last_);"),
        ),
        (("new", "speech", ""),),
    ),
    Step(
        "one less",
        put("robot/speaker/src/speaker_node.cpp", ("if (count_ == 7) chatter_pub_.publish(last_);", "")),
        (("gone", "speech", ""),),
    ),
    # Python
    Step(
        "python: ask for more",
        put(PY, ("if self.level > 2:", "if self.level > 2 and not self.quiet:")),
        (("tightened", "state", "self.quiet"),),
    ),
    Step(
        "python: ask for less",
        put(PY, ("self.level > 2 and not self.quiet", "self.level > 0 or not self.quiet")),
        (("widened", "state", ""),),
    ),
    Step(
        "python: say it otherwise",
        put(PY, ("self.level > 0 or not self.quiet", "not (self.level <= 0 and self.quiet)")),
        (("equivalent", "state", ""),),
    ),
    Step("python: rename", put(PY, ("level", "height"))),
    Step(
        "python: a faster loop",
        put(PY, ("rospy.Rate(10)", "rospy.Rate(50)")),
        (("trigger changed", "state", "rate 50"),),
    ),
    Step(
        "python: a shorter queue",
        put(PY, ("queue_size=5", "queue_size=1")),
        (("trigger changed", "state", "queue `1` was `5`"),),
    ),
    Step(
        "python: latched",
        put(PY, ("queue_size=1", "queue_size=1, latch=True")),
        (("trigger changed", "state", "transient_local"),),
    ),
    Step(
        "python: a timer for the loop",
        put(
            PY,
            (
                "    def run(self):\n        rate = rospy.Rate(50)\n"
                "        while not rospy.is_shutdown():\n"
                "            if not (self.height <= 0 and self.quiet):\n"
                '                self.pub.publish(String("high"))\n            rate.sleep()',
                "    def run(self, event=None):\n        if not (self.height <= 0 and self.quiet):\n"
                '            self.pub.publish(String("high"))',
            ),
            (
                "    Watch().run()",
                "    watch = Watch()\n    rospy.Timer(rospy.Duration(0.02), watch.run)\n    rospy.spin()",
            ),
        ),
        (("trigger changed", "state", "timer"),),
    ),
    # ROS 2
    Step(
        "a switch",
        put(
            CAM,
            (
                "    pub_->publish(frame);",
                "    switch (mode_) {\n      case 1:\n      case 2:\n        pub_->publish(frame);\n"
                "        break;\n      default:\n        break;\n    }",
            ),
        ),
        (("tightened", "frames", "mode_"),),
    ),
    Step(
        "a further case",
        put(CAM, ("      case 2:\n", "      case 2:\n      case 3:\n")),
        (("widened", "frames", "mode_"),),
    ),
    Step(
        "if for switch",
        put(
            CAM,
            (
                "    switch (mode_) {\n      case 1:\n      case 2:\n      case 3:\n"
                "        pub_->publish(frame);\n        break;\n      default:\n        break;\n    }",
                "    if (mode_ == 1 || mode_ == 2 || mode_ == 3) {\n      pub_->publish(frame);\n    }",
            ),
        ),
        (("equivalent", "frames", ""),),
    ),
    Step(
        "best effort",
        put(CAM, ("rclcpp::QoS(10)", "rclcpp::QoS(10).best_effort()")),
        (("trigger changed", "frames", "reliability `best_effort` was `reliable`"),),
    ),
    Step(
        "transient local",
        put(CAM, ("rclcpp::QoS(10).best_effort()", "rclcpp::QoS(10).best_effort().transient_local()")),
        (("trigger changed", "frames", "durability `transient_local` was `volatile`"),),
    ),
    Step(
        "a slower timer", put(CAM, ("milliseconds(100)", "milliseconds(500)")), (("trigger changed", "frames", "500"),)
    ),
    Step(
        "an exception",
        put(
            CAM,
            (
                "    if (!open_) {\n      return;\n    }\n",
                "    if (!open_) {\n      return;\n    }\n    try {\n      fill(frame);\n"
                "    } catch (const std::exception & e) {\n      return;\n    }\n",
            ),
        ),
        (("tightened", "frames", "std::exception"),),
    ),
    # Never again
    Step(
        "behind a return",
        put(CAM, ("      pub_->publish(frame);", "      return;\n      pub_->publish(frame);")),
        (("tightened", "frames", "never runs, it stands after return"),),
    ),
    Step(
        "reached again",
        put(CAM, ("      return;\n      pub_->publish(frame);", "      pub_->publish(frame);")),
        (("widened", "frames", "never"),),
    ),
    Step(
        "a contradiction",
        put(CAM, ("      pub_->publish(frame);", "      if (mode_ == 7) {\n        pub_->publish(frame);\n      }")),
        (
            (
                "tightened",
                "frames",
                "never runs, `(mode_ == 1 || mode_ == 2 || mode_ == 3)` and `mode_ == 7` cannot hold",
            ),
        ),
    ),
    Step(
        "no contradiction where it may be assigned",
        put(CAM, ("if (mode_ == 7)", "mode_ = next_;\n      if (mode_ == 7)")),
    ),
    Step(
        "nor is it told then",
        put(CAM, ("if (mode_ == 7)", "if (mode_ == 8)")),
        (("changed", "frames", "`mode_ == 8` was `mode_ == 7`"),),
    ),
    Step(
        "python: behind a raise",
        put(PY, ("            self.pub.publish", "            raise ValueError\n            self.pub.publish")),
        (("tightened", "state", "never runs, it stands after raise"),),
    ),
    # rosbuild
    Step("a slower loop", put(BEEP, ("rate(5)", "rate(1)")), (("trigger changed", "beeps", "rate 1"),)),
    Step(
        "out of the loop",
        put(
            BEEP,
            (
                "  while (ros::ok())\n  {\n    beeps.publish(std_msgs::Empty());\n    rate.sleep();\n  }",
                "  beeps.publish(std_msgs::Empty());\n  ros::spin();",
            ),
        ),
        (("trigger changed", "beeps", "loop"),),
    ),
    Step("from rosbuild to catkin", lambda tree: tree.update({"old/beeper/package.xml": ROS1.format("beeper")})),
    Step("text alone", lambda tree: tree.update({"README": "a repository of robots"})),
    Step(
        "the package is gone",
        lambda tree: [tree.pop(path) for path in list(tree) if path.startswith("old/")] and None,
        (("gone", "beeps", ""),),
    ),
)


def commit(repo: pygit2.Repository, tree: Tree, message: str, parents: list, seconds: int):
    index = pygit2.Index()
    for path, content in tree.items():
        blob = repo.create_blob(content.encode())
        index.add(pygit2.IndexEntry(path, blob, pygit2.enums.FileMode.BLOB))
    who = pygit2.Signature("A", "a@b.c", 1_600_000_000 + seconds, 0)
    return repo.create_commit(None, who, who, message, index.write_tree(repo), parents)


class Made(NamedTuple):
    path: str
    commits: dict[str, str]
    logic: Logic
    cache: str


@pytest.fixture(scope="module")
def made(tmp_path_factory) -> Made:
    folder = tmp_path_factory.mktemp("logic")
    repo = pygit2.init_repository(str(folder / "repo"), bare=True)
    tree = dict(START)
    last = commit(repo, tree, "start", [], 0)
    commits = {"start": str(last)}
    for number, step in enumerate(STEPS, 1):
        step.does(tree)
        last = commit(repo, tree, step.name, [last], 60 * number)
        commits[step.name] = str(last)
    # A branch with a change of its own, merged: the change is the branch's, the merge says nothing.
    side = dict(tree)
    put(CAM, ("if (!open_)", "if (!open_ || mode_ == 2)"))(side)
    branch = commit(repo, side, "on a branch", [last], 10_000)
    other = commit(repo, {**tree, "README": "more"}, "beside it", [last], 10_060)
    merge = commit(repo, {**side, "README": "more"}, "merge", [other, branch], 10_120)
    commits |= {"on a branch": str(branch), "beside it": str(other), "merge": str(merge)}
    repo.create_reference("refs/heads/main", merge)
    repo.set_head("refs/heads/main")
    cache = str(folder / "cache")
    with Store(cache) as store:
        return Made(str(folder / "repo"), commits, read(str(folder / "repo"), Range(), store), cache)


def of(made: Made, name: str) -> list[tuple[str, str, str]]:
    return [(c.kind, c.topic, c.why) for one, c in made.logic.changes if one.id == made.commits[name]]


@pytest.mark.parametrize("step", STEPS, ids=lambda step: step.name)
def test_every_commit_is_told_as_what_it_is(made: Made, step: Step) -> None:
    said = of(made, step.name)
    assert [(kind, topic) for kind, topic, _ in said] == [(kind, topic) for kind, topic, _ in step.says], said
    for (_, _, why), (_, _, wanted) in zip(said, step.says, strict=True):
        assert wanted in why


def test_there_are_enough_of_them() -> None:
    assert len(STEPS) >= 30


def test_the_first_commit_has_all_its_statements_new(made: Made) -> None:
    assert sorted((kind, topic) for kind, topic, _ in of(made, "start")) == [
        ("new", "beeps"), ("new", "chatter"), ("new", "chatter"), ("new", "frames"), ("new", "state"),
    ]  # fmt: skip


def test_a_range_knows_all_of_its_newest_commit(made: Made, tmp_path) -> None:
    with Store(tmp_path) as store:
        found = read(made.path, Range(made.commits["ask for less"], 1), store)
    assert found.coverage == LogicCoverage(1, 1, 0, 5, 5, 0, ())


def test_merges_say_nothing_and_their_branches_speak(made: Made) -> None:
    assert [kind for kind, _, _ in of(made, "on a branch")] == ["tightened"]
    assert of(made, "beside it") == of(made, "merge") == []
    assert made.commits["merge"] not in {one.id for one in made.logic.commits}


def test_subscribers_are_named(made: Made) -> None:
    (change,) = (c for one, c in made.logic.changes if one.id == made.commits["ask for more"])
    assert [(r.package, r.node, r.callback, r.path, r.line, r.topic) for r in change.reaches] == [
        ("listener", "listener/listen", "heard", "listener/scripts/listen", 5, "/chatter")
    ]
    assert (change.package, change.node, change.path) == ("talker", "talker/talker", CPP)
    assert change.old == "messages of `input`: enabled_"
    assert change.new == "messages of `input`: enabled_ && msg->data.size() > 0"


def test_subscribers_of_a_topic_that_is_left_are_named_too(made: Made) -> None:
    (change,) = (c for one, c in made.logic.changes if one.id == made.commits["another topic"])
    assert [r.package for r in change.reaches] == ["listener"]
    assert set(change.topics) == {"/chatter", "/speech"}


def test_a_second_run_reads_nothing_anew_and_says_the_same(made: Made, monkeypatch) -> None:
    monkeypatch.setattr("rosimpact.impact.logic.repository._digest_chunk", lambda *_: pytest.fail("digested anew"))
    monkeypatch.setattr("rosimpact.impact.logic.repository._compare_chunk", lambda *_: pytest.fail("compared anew"))
    with Store(made.cache) as store:
        assert read(made.path, Range(), store) == made.logic


def test_alone_and_with_others_the_same_is_said(made: Made, tmp_path) -> None:
    with Store(tmp_path) as store:
        assert read(made.path, Range(), store, jobs=1).changes == made.logic.changes


@pytest.mark.parametrize(
    ("asked", "first", "last", "number"),
    [
        (("{ask for more}..{a lower bound}",), "a lower bound", "ask for less", 2),
        (("{ask for less}", 1), "ask for less", "ask for less", 1),
        (("{return early}", 3), "return early", "the other way round", 3),
        (("{ask for less}", None, "2020-09-13T12:28:00Z"), "ask for less", "ask for less", 1),
    ],
)
def test_ranges(made: Made, tmp_path, asked, first: str, last: str, number: int) -> None:
    revisions = asked[0]
    for name, commit in made.commits.items():
        revisions = revisions.replace(f"{{{name}}}", commit)
    with Store(tmp_path) as store:
        found = read(made.path, Range(revisions, *asked[1:]), store)
    assert (len(found.commits), found.commits[0].summary, found.commits[-1].summary) == (number, first, last)
    assert found.coverage.commits == number


@pytest.mark.parametrize("since", ["yesterday", "2024-13-01", ""])
def test_a_date_that_is_none_is_refused(made: Made, since: str) -> None:
    if since:
        with pytest.raises(ValueError, match="is no date"):
            CommitHistory(made.path).list_commits(since=since)
    else:
        assert CommitHistory(made.path).list_commits(since=since)


def test_packages_are_found_at_every_commit(made: Made) -> None:
    history = CommitHistory(made.path)
    names = {name: (state.path, state.ros) for name, state in history.find_packages(made.commits["start"]).items()}
    assert names == {
        "talker": ("talker", 1), "listener": ("listener", 1), "watch": ("watch", 1), "camera": ("camera", 2),
        "beeper": ("old/beeper", 1),
    }  # fmt: skip
    later = history.find_packages(made.commits["merge"])
    assert {name: state.path for name, state in later.items() if name == "speaker"} == {"speaker": "robot/speaker"}


def test_only_a_package_or_a_topic(made: Made) -> None:
    only = select(made.logic, packages=("camera",))
    assert {change.package for _, change in only.changes} == {"camera"}
    assert {change.kind for _, change in only.changes} >= {"tightened", "widened", "trigger changed", "new"}
    assert "equivalent" not in {change.kind for _, change in only.changes}
    assert "equivalent" in {change.kind for _, change in select(made.logic, everything=True).changes}
    topics = {change.topic for _, change in select(made.logic, topics=("/chatter",)).changes}
    assert topics == {"chatter", "speech"}


LONG = [f"a_condition_that_takes_room_{n}" for n in range(9)]


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ("a && b", "a && c", ("a && b", "a && c")),
        (" && ".join([*LONG, "b"]), " && ".join([*LONG, "c"]), (f"… {LONG[-1]} && b", f"… {LONG[-1]} && c")),
        (" and ".join(["b", *LONG]), " and ".join(LONG), (f"b and {LONG[0]} and …", f"{LONG[0]} and …")),
        ("timer `1s`: " + " && ".join(LONG), "timer `2s`: " + " && ".join(LONG),
         (f"timer `1s`: {LONG[0]} && …", f"timer `2s`: {LONG[0]} && …")),
    ],
)  # fmt: skip
def test_of_long_conditions_people_are_shown_where_they_differ(old, new, said) -> None:
    assert trim_common_ends(old, new) == said


def test_text(made: Made) -> None:
    shown = render_text(select(made.logic))
    block = shown[shown.index(made.commits["ask for more"][:10]) :].split("\n\n")[0]
    assert block.split("\n")[1:] == [
        "  tightened        chatter (talker/talker)  talker/src/talker.cpp:19",
        "      only when `msg->data.size() > 0` too",
        "      - messages of `input`: enabled_",
        "      + messages of `input`: enabled_ && msg->data.size() > 0",
        "      reaches listener/listen, heard  listener/scripts/listen:5",
    ]
    assert "topics of 4 known" in shown.splitlines()[-1]


def test_json(made: Made) -> None:
    document = json.loads(render_json(select(made.logic), "1.2"))
    assert (document["schema"], document["tool"]) == (1, {"name": "rosimpact", "version": "1.2"})
    assert document["commits"] == len(STEPS) + 3
    (change,) = (one for one in document["changes"] if one["commit"] == made.commits["ask for more"])
    assert {name: change[name] for name in ("path", "line", "node", "topic", "kind", "old", "new")} == {
        "path": CPP, "line": 19, "node": "talker/talker", "topic": "chatter", "kind": "tightened",
        "old": "messages of `input`: enabled_", "new": "messages of `input`: enabled_ && msg->data.size() > 0",
    }  # fmt: skip
    assert change["date"] == "2020-09-13T12:27:40Z"
    assert change["reaches"][0]["package"] == "listener"


def test_timeline(made: Made) -> None:
    page = render(select(made.logic), "1.2")
    assert "{{" not in page
    assert page.count("<script") == 2
    assert "http:" not in page and "https:" not in page
    data = json.loads(page.partition('id="data">')[2].partition("</script>")[0])
    assert len(data["changes"]) == len(select(made.logic).changes)
