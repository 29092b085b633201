"""`rosimpact values` on a workspace: what callbacks handle and crash on, what publishers send, and replays."""

import json
import shutil
from pathlib import Path

import pytest
from ir_programs import needs_clang
from rosimpact.impact.cli.app import app
from rosimpact.impact.values import survey
from typer.testing import CliRunner

LAMP = Path(__file__).parents[2] / "examples" / "lamp"


def run(*arguments: str) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, ["values", *arguments, "--quiet", "--jobs", "1"])
    return result.exit_code, result.stdout, result.stderr


@pytest.fixture(scope="module")
def answer():
    status, out, err = run(str(LAMP), "--replay", "--format", "json", "--seconds", "120")
    assert status == 0, err
    return json.loads(out)


def find(answer, name):
    return next(one for one in answer["callbacks"] if one["callback"] == name)


@needs_clang
def test_the_values_of_a_switch(answer):
    lamp = find(answer, "LampNode::onLamp")
    assert (lamp["reason"], lamp["unknown"], lamp["left"]) == ("", {}, 0)
    value = next(one for one in lamp["fields"] if one["field"] == "value")
    assert value["sets"]["handled"]["text"] == "OFF, GREEN, ORANGE"
    assert value["sets"]["log-only"]["spans"] == [[3, 255]] and value["sets"]["crash"]["text"] == "ORANGE"
    assert value["unhandled_surely"]["spans"] == [[3, 255]]
    assert not value["sets"]["handled"]["relational"]


@needs_clang
def test_each_reaction_has_an_example_that_a_replay_shows(answer):
    lamp = find(answer, "LampNode::onLamp")
    assert {one["result"] for one in lamp["examples"]} == {"handled", "log-only", "crash"}
    assert all(one["confirmed"] for one in lamp["examples"]), lamp["examples"]
    crash = next(one for one in lamp["examples"] if one["result"] == "crash")
    assert (crash["crash"], crash["path"], crash["line"]) == ("division by zero", "src/lamp/src/lamp_node.cpp", 21)
    assert (crash["values"]["msg.value"], crash["values"]["msg.period"]) == (2, 0)


@needs_clang
def test_what_is_sent_is_held_against_what_is_handled(answer):
    rows = {(one["rule"], one["topic"], one["field"], one["values"]) for one in answer["mismatches"]}
    assert rows == {
        ("crashing-value", "/lamp", "value", "ORANGE"), ("unhandled-value", "/lamp", "value", "RED"),
        ("impossible-branch", "/lamp", "value", "OFF"),
    }  # fmt: skip
    senders = [one["publisher"] for one in answer["mismatches"] if one["rule"] != "impossible-branch"]
    places = {(place["path"], place["line"]) for one in senders for place in one["places"]}
    assert places == {("src/lamp/scripts/sender.py", 20)}


def test_a_python_callback_and_what_it_sends(tmp_path):
    shutil.copytree(LAMP, tmp_path / "ws")
    (tmp_path / "ws/src/lamp/src/lamp_node.cpp").unlink()
    status, out, err = run(str(tmp_path / "ws"), "--replay", "--format", "json")
    assert status == 0, err
    (sender,) = json.loads(out)["callbacks"]
    assert sender["sent"][0]["fields"]["value"]["spans"] == [[1, 3]]
    assert sender["sent"][0]["fields"]["period"]["text"] == "0"
    assert all(one["confirmed"] for one in sender["examples"]) and sender["examples"]


def test_text_and_narrowing():
    status, out, _ = run(str(LAMP), "--callback", "on_state", "--no-publishers")
    assert status == 0
    assert "Sender.on_state  /state  std_msgs/Int32  src/lamp/scripts/sender.py:12\n" in out
    assert "1 callback, 1 explored to a verdict; 0 can crash" in out
    assert "within texts of 8 bytes, arrays of 3 elements, loops of 8 rounds" in out


def test_what_is_not_there_is_said(tmp_path):
    status, _, err = run(str(LAMP), "--topic", "/nothing")
    assert status == 2 and "--topic /nothing: no such callback" in err
    status, _, err = run(str(LAMP), "--kind", "thread")
    assert status == 2 and "--kind thread: is none of subscriber, service, timer, action" in err
    status, _, err = run(str(tmp_path / "none"))
    assert status == 2 and "is no folder" in err


def test_without_clang_python_is_explored_all_the_same(monkeypatch):
    monkeypatch.setattr("rosimpact.impact.values.harness.session.find_clang", lambda: "")
    status, out, _ = run(str(LAMP), "--no-publishers")
    assert status == 0 and "install clang" in out.replace("apt install", "install")
    assert "2 callbacks, 1 explored to a verdict" in out


def test_a_workspace_whose_own_folder_is_a_python_package(tmp_path):
    shutil.copytree(LAMP, tmp_path / "ws")
    (tmp_path / "ws/src/lamp/src/lamp_node.cpp").unlink()
    for folder in ("", "src/", "src/lamp/", "src/lamp/scripts/"):
        (tmp_path / f"ws/{folder}__init__.py").touch()
    status, out, err = run(str(tmp_path / "ws"), "--format", "json")
    assert status == 0, err
    assert [(one["callback"], one["reason"]) for one in json.loads(out)["callbacks"]] == [("Sender.on_state", "")]


def test_a_fault_of_the_explorer_costs_one_callback(tmp_path, monkeypatch):
    shutil.copytree(LAMP, tmp_path / "ws")
    (tmp_path / "ws/src/lamp/src/lamp_node.cpp").unlink()

    def fail(*_: object, **__: object):
        raise AttributeError("made for this test")

    monkeypatch.setattr(survey, "evaluate", fail)
    status, out, err = run(str(tmp_path / "ws"), "--format", "json")
    assert status == 0, err
    (sender,) = json.loads(out)["callbacks"]
    assert "made for this test" in sender["reason"] and "fault of rosimpact" in sender["reason"]

FOLLOWER = """
#include <ros/ros.h>
#include <std_msgs/Int32.h>
class Follower {
 public:
  int side;
  int seen;
  void onSide(const std_msgs::Int32& m) { Follower::side = m.data; }
  void onSeen(const std_msgs::Int32& m) { seen = m.data; }
  void steer(ros::Publisher& pub) {
    std_msgs::Int32 out;
    out.data = Follower::side;
    pub.publish(out);
  }
};
int main(int argc, char** argv) {
  ros::init(argc, argv, "follower");
  ros::NodeHandle n;
  Follower one;
  ros::Subscriber a = n.subscribe("side", 1, &Follower::onSide, &one);
  ros::Subscriber b = n.subscribe("seen", 1, &Follower::onSeen, &one);
  ros::Publisher pub = n.advertise<std_msgs::Int32>("wheel", 1);
  while (ros::ok()) { ros::spinOnce(); one.steer(pub); }
}
"""


@needs_clang
def test_a_member_of_an_object_of_main_that_another_method_reads(tmp_path):
    shutil.copytree(LAMP, tmp_path / "ws")
    (tmp_path / "ws/src/lamp/scripts/sender.py").unlink()
    (tmp_path / "ws/src/lamp/src/lamp_node.cpp").write_text(FOLLOWER)
    status, out, err = run(str(tmp_path / "ws"), "--format", "json", "--no-publishers")
    assert status == 0, err
    counts = {one["callback"]: one["ways"] for one in json.loads(out)["callbacks"]}
    assert set(counts["Follower::onSide"]) == {"handled"} and set(counts["Follower::onSeen"]) == {"ignored"}

PACED = """
#include <ros/ros.h>
#include <std_msgs/Int32.h>
class Pacer {
 public:
  explicit Pacer(ros::NodeHandle& n) : last_(ros::Time::now()) {
    pub_ = n.advertise<std_msgs::Int32>("wheel", 1);
    sub_ = n.subscribe("side", 1, &Pacer::onSide, this);
  }
  void onSide(const std_msgs::Int32& m) {
    const ros::Time now = ros::Time::now();
    if (now.sec - last_.sec < 2) return;
    pub_.publish(m);
  }
 private:
  ros::Time last_;
  ros::Publisher pub_;
  ros::Subscriber sub_;
};
int main(int argc, char** argv) {
  ros::init(argc, argv, "pacer");
  ros::NodeHandle n;
  Pacer pacer(n);
  ros::spin();
}
"""


@needs_clang
def test_time_goes_on_between_two_calls(tmp_path):
    shutil.copytree(LAMP, tmp_path / "ws")
    (tmp_path / "ws/src/lamp/scripts/sender.py").unlink()
    (tmp_path / "ws/src/lamp/src/lamp_node.cpp").write_text(PACED)
    status, out, err = run(str(tmp_path / "ws"), "--format", "json", "--no-publishers")
    assert status == 0, err
    (pacer,) = json.loads(out)["callbacks"]
    assert set(pacer["ways"]) == {"handled", "ignored"}
