"""`rosimpact fields` on a workspace: text, JSON, closed topics, sizes, and a recording beside it."""

import json
from pathlib import Path

import pytest
from rosimpact.impact.cli.app import app
from typer.testing import CliRunner

FLEET = Path(__file__).parents[2] / "examples" / "fleet"


def run(*arguments: str, command: str = "fields") -> tuple[int, str, str]:
    result = CliRunner().invoke(app, [command, *arguments])
    return result.exit_code, result.stdout, result.stderr


def test_text():
    status, out, _ = run(str(FLEET), "--topic", "/track")
    assert status == 0
    assert "/track  fleet_msgs/Track  4 fields" in out
    assert "    reads  vehicle, xs\n    never reads  ys, notes\n" in out
    assert "  read by nobody:  ys, notes\n  saves  98 B of 196 B in each message\n" in out


def test_json():
    status, out, _ = run(str(FLEET), "--format", "json", "--length", "100")
    assert status == 0
    topics = {one["topic"]: one for one in json.loads(out)["topics"]}
    assert topics["/track"]["unread"] == ["ys", "notes"]
    assert (topics["/track"]["bytes"], topics["/track"]["unread_bytes"]) == (4 * 4 + 200 + 1600, 8 + 100 + 800)
    (brain, _) = topics["/report"]["subscribers"]
    assert {"field": "place.x", "path": "src/fleet_brain/src/brain.cpp", "line": 29} in brain["reads"]
    (escape,) = topics["/alarm"]["subscribers"][0]["escapes"]
    assert (escape["field"], escape["reason"], escape["line"]) == ("", "printed whole", 28)
    assert topics["/said"]["open"] == ["nobody here subscribes to it, so somebody elsewhere may"]


def test_topics_that_the_user_closes(tmp_path):
    (tmp_path / "rosimpact.toml").write_text('[fields]\nclosed = ["/said"]\n')
    for more in (["--assume-closed", "/said"], ["--config", str(tmp_path / "rosimpact.toml")]):
        _, out, _ = run(str(FLEET), "--topic", "/said", *more)
        assert "read by nobody:  data" in out
        assert "may be read elsewhere" not in out


@pytest.mark.parametrize("command", ["fields", "prune"])
@pytest.mark.parametrize("option", ["--topic", "--assume-closed"])
def test_a_topic_that_is_not_there(option, command):
    status, _, err = run(str(FLEET), option, "/repotr", command=command)
    assert status == 2
    assert err == f"rosimpact: {option} /repotr: no such topic; `/report` is the nearest\n"


@pytest.fixture
def track_bag(tmp_path) -> str:
    """Eleven messages of /track in a second, of 9 + 84 + 84 + 34 bytes."""
    rosbag1 = pytest.importorskip("rosbags.rosbag1")
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC)
    store.register(get_types_from_msg((FLEET / "src/fleet_msgs/msg/Track.msg").read_text(), "fleet_msgs/msg/Track"))
    import numpy

    values = numpy.arange(10.0)
    message = store.types["fleet_msgs/msg/Track"]("truck", values, values, "n" * 30)
    with rosbag1.Writer(tmp_path / "track.bag") as writer:
        connection = writer.add_connection("/track", "fleet_msgs/msg/Track", typestore=store)
        for number in range(11):
            writer.write(connection, number * 10**8, store.serialize_ros1(message, "fleet_msgs/msg/Track"))
    return str(tmp_path / "track.bag")


def test_a_recording_says_what_that_takes(track_bag):
    status, out, _ = run(str(FLEET), "--bag", track_bag)
    assert status == 0
    assert "/track  read by nobody here:  ys, notes: 118 B of 211 B in each message, 1.2 kB/s" in out


def test_a_plan_says_what_it_saves_in_a_second(track_bag):
    status, out, _ = run(str(FLEET), "--topic", "/track", "--bag", track_bag, command="prune")
    assert status == 0
    assert "  saves  /track  118 B of 211 B in each message, 1.2 kB/s at 10 Hz\n" in out
    status, out, _ = run(str(FLEET), "--topic", "/track", "--rate", "100", "--format", "json", command="prune")
    assert status == 0
    (plan,) = json.loads(out)["plans"]
    expected = {"topic": "/track", "rate": 100.0, "full_bytes": 196.0, "saved_bytes": 98.0}
    assert plan["savings"] == [{**expected, "saved_bytes_per_second": 9800.0}]
