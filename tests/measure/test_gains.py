"""What a plan of lighter messages gains: how messages are filled, what is printed beside the plan; no node is run."""

import json
from pathlib import Path

import pytest
from rosimpact.edges.console import UserError
from rosimpact.impact.measure import contents, gains, run
from rosimpact.impact.measure.intervals import NetworkResult
from rosimpact.impact.measure.results import ResultsFile
from rosimpact.impact.measure.run import ONE_CLOCK, make_header
from rosimpact.impact.model.fields.report import FieldAt, PublisherFields
from rosimpact.impact.prune.session import prepare

FLEET = Path(__file__).parents[2] / "examples" / "fleet"


def make_publisher(sets: str, lengths: dict[str, int], unknown: str = "", line: int = 1) -> PublisherFields:
    places = tuple(FieldAt(field, "talk.py", line) for field in sets.split())
    return PublisherFields("talk", "talk.py", line, places, unknown, tuple(lengths.items()))


@pytest.fixture
def own(tmp_path):
    package = tmp_path / "own_msgs"
    (package / "msg").mkdir(parents=True)
    (package / "package.xml").write_text(
        '<package format="2"><name>own_msgs</name><version>1.0.0</version><description>d</description>'
        '<maintainer email="a@b.org">m</maintainer><license>MIT</license></package>'
    )
    (package / "msg/Point.msg").write_text("float64 x\nstring name\n")
    (package / "msg/Sweep.msg").write_text("string robot\nfloat32[] ranges\nstring[] notes\nPoint[] points\n")
    return tmp_path


# What publishers set, and the lengths that they write; what is given with --length; bytes of robot, ranges, notes and
# points, each with its count; what is told.
FILLED = {
    "lengths that are written": (
        [make_publisher("robot ranges", {"robot": 6, "ranges": 720})], {}, (4 + 6, 4 + 4 * 720, 4, 4),
        "as talk.py:1 fills it: robot 6, ranges 720"),
    "set, and no length written": (
        [make_publisher("robot ranges", {"robot": 6})], {}, (4 + 6, 4 + 4 * 10, 4, 4),
        "of a length that is not known, taken as 10: ranges"),
    "elements that are added": (
        [make_publisher("points[].x", {})], {}, (4, 4, 4, 4 + 10 * (8 + 4)), "taken as 10: points"),
    "texts in elements": (
        [make_publisher("points points[].name", {"points": 2, "points[].name": 5})], {}, (4, 4, 4, 4 + 2 * 17),
        "points 2, points[].name 5"),
    "the longest of two": (
        [make_publisher("robot", {"robot": 6}), make_publisher("robot", {"robot": 8}, line=2)], {}, (4 + 8, 4, 4, 4),
        "as talk.py:1, talk.py:2 fills it: robot 8"),
    "not all that it sets is known": (
        [make_publisher("robot", {"robot": 6}, "it is given to `fill`")], {},
        (4 + 6, 4 + 40, 4 + 10 * 14, 4 + 10 * (8 + 14)), "taken as 10: ranges, notes, notes[], points, points[].name"),
    "lengths that the user gives": (
        [make_publisher("robot ranges", {"robot": 6, "ranges": 720})], {"ranges": 5, "notes": 1},
        (4 + 6, 4 + 20, 4 + 4, 4), "as talk.py:1 fills it: robot 6"),
    "nobody publishes it": ([], {"ranges": 5}, (4, 4 + 20, 4, 4), "empty, since no --length is given: robot, notes"),
}  # fmt: skip


@pytest.mark.parametrize("case", FILLED)
def test_a_message_is_filled_as_its_publishers_fill_it(own, case):
    publishers, lengths, sizes, told = FILLED[case]
    filling = contents.MessageFilling(lengths, publishers=publishers)
    found = contents.make_real_messages("own_msgs/Sweep", ["ranges"], own, filling, 1)
    assert found.messages[0, "full"].bytes == 20 + sum(sizes)
    assert found.messages[0, "pruned"].bytes == 20 + sizes[1]
    assert told in "; ".join(found.notes)


def test_the_lengths_that_code_writes(tmp_path):
    rows = {
        (one.topic, each.line): dict(each.lengths) for one in prepare(FLEET).report.topics for each in one.publishers
    }
    assert rows["/report", 52] == {"header.frame_id": 4, "driver": 6, "diagnosis": 2000}  # resize(2000)
    assert rows["/archive", 20] == {"driver": 7, "stops": 1, "stops[].place.label": 4}
    assert rows["/alarm", 25] == {"driver": 3}


def test_what_a_workspace_publishes(tmp_path):
    assert {one.line for one in gains.list_publishers(FLEET, "fleet_msgs/Track")} == {65}
    assert gains.list_publishers(FLEET, "fleet_msgs/None") == ()
    assert gains.list_publishers(tmp_path, "fleet_msgs/Track") == ()


@pytest.fixture
def measured(monkeypatch):
    """Runs nothing: each cell takes as long, and drops as much, as its message has bytes."""
    asked = []

    def record(plan, messages, output, progress):
        asked.append(plan)
        file = ResultsFile(output, make_header(plan.conditions, ONE_CLOCK))
        for repetition, cell in plan.list_runs():
            size = messages[cell.fields, cell.variant].bytes
            drops = {f"dropped{part}_percent": size / 1000 for part in ("", "_publisher", "_subscriber")}
            latency = {f"latency_{name}_ms": size / 100 + repetition for name in ("mean", "p50", "p95", "p99", "max")}
            file.add(NetworkResult(
                repetition=repetition, publishers=1, fields=0, rate=cell.rate, variant=cell.variant, bytes=size,
                offered_mbit=8e-6 * size * cell.rate, published=100, arrived=100, delivered=100, late_percent=0,
                achieved_rate=cell.rate, waited_ms=0, **drops, **latency,
            ))  # fmt: skip
        return file

    monkeypatch.setattr(gains, "run_network", record)
    monkeypatch.setattr(gains, "check_needs", lambda conditions: None)
    monkeypatch.setattr(gains, "_prepare_nodes", lambda conditions, ready: None)
    return asked


def test_what_the_plan_gains_stands_beside_it(say, measured):
    said = say("prune", FLEET, "--measure", "--quiet", "--repeat", "2", "--seconds", "3", "--link", "54mbit")
    assert said.status == 0, said.err
    assert {plan.conditions.message for plan in measured} == {"fleet_msgs/Report", "fleet_msgs/Track"}
    assert {(plan.conditions.seconds, plan.conditions.link, plan.repeat) for plan in measured} == {(3, 54_000_000, 2)}
    lines = [line.strip() for line in said.out.split("\n")]
    at = lines.index("/track  fleet_msgs/Track  → fleet_msgs/TrackLight")
    assert lines[at + 4].startswith("measured  /track  at 50 Hz, as src/fleet_eye/src/eye.cpp:65 fills it: vehicle 5;")
    # 20, a text of 5, two arrays of 10 float64, a text of 10.
    full, pruned = 20 + 9 + 2 * 84 + 14, 20 + 9 + 84
    assert lines[at + 5 : at + 10] == [
        f"bytes  {full} B become {pruned} B",
        f"sent  {4e-4 * full:.2f} Mbit/s become {4e-4 * pruned:.2f} Mbit/s",
        f"latency mean  {full / 100 + 0.5:.2f} ±6.35 ms become {pruned / 100 + 0.5:.2f} ±6.35 ms",
        f"latency p95  {full / 100 + 0.5:.2f} ±6.35 ms become {pruned / 100 + 0.5:.2f} ±6.35 ms",
        f"dropped  {full / 1000:.1f} ±0.0 % become {pruned / 1000:.1f} ±0.0 %",
    ]
    assert "roscpp, three network namespaces, links of 54mbit, queues of 10, 3 s after 1 s of warm-up" in said.out


def test_what_the_plan_gains_as_json(say, measured, tmp_path):
    given = ("prune", FLEET, "--topic", "/track", "--measure", "--loopback", "--rate", "20", "--results", tmp_path)
    said = say(*given, "--format", "json", "--quiet")
    assert said.status == 0, said.err
    (plan,) = json.loads(said.out)["plans"]
    (gain,) = plan["gains"]
    assert (gain["topic"], gain["rate"], gain["failure"]) == ("/track", 20, "")
    assert gain["full"]["bytes"] > gain["pruned"]["bytes"] > 20
    assert {"mean", "low", "high"} == set(gain["full"]["latency"]["p95"]) == set(gain["pruned"]["dropped"])
    assert gain["header"]["conditions"]["network"] == "loopback"
    assert [path.name for path in tmp_path.iterdir()] == ["track.jsonl"]
    assert "gains" not in json.loads(say("prune", FLEET, "--format", "json", "--quiet").out)["plans"][0]


def test_messages_of_a_bag(say, measured, tmp_path):
    rosbag1 = pytest.importorskip("rosbags.rosbag1")
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC)
    store.register(get_types_from_msg((FLEET / "src/fleet_msgs/msg/Track.msg").read_text(), "fleet_msgs/msg/Track"))
    import numpy

    kind = store.types["fleet_msgs/msg/Track"]
    bag = tmp_path / "drive.bag"
    with rosbag1.Writer(bag) as writer:
        for topic, count in (("/track", 50), ("/other_track", 9)):
            connection = writer.add_connection(topic, kind.__msgtype__, typestore=store)
            row = numpy.zeros(count)
            for number in range(5):
                message = kind(vehicle="van", xs=row, ys=row, notes="nnn")
                writer.write(connection, number * 250_000_000, store.serialize_ros1(message, kind.__msgtype__))
    said = say("prune", FLEET, "--measure", "--quiet", "--bag", bag, "--format", "json")
    assert said.status == 0, said.err
    found = {gain["topic"]: gain for plan in json.loads(said.out)["plans"] for gain in plan["gains"]}
    track = found["/track"]
    assert track["notes"] == ["5 messages of /track are sent in turn"]
    assert track["rate"] == 4
    assert (track["full"]["bytes"], track["pruned"]["bytes"]) == (20 + 7 + 2 * 404 + 7, 20 + 7 + 404)
    # What the bag does not have is said, and stops nothing.
    assert "holds no message of the type fleet_msgs/Report on /report" in found["/report"]["failure"]
    text = say("prune", FLEET, "--measure", "--quiet", "--bag", bag, "--topic", "/report").out
    assert "measured  /report  not: --bag " in text


@pytest.mark.parametrize(
    ("options", "sizes", "told"),
    [
        # 20, a text of 5; two arrays of 10 float64 and a text of 10.
        ([], (20 + 9 + 2 * 84 + 14, 20 + 9 + 84), "as src/fleet_eye/src/eye.cpp:65 fills it: vehicle 5"),
        (["--length", "xs=100", "--length", "notes=0"], (20 + 9 + 804 + 84 + 4, 20 + 9 + 804), "taken as 10: ys"),
    ],
)
def test_measuring_a_message_by_its_name_fills_it_as_it_is_published(say, monkeypatch, tmp_path, options, sizes, told):
    monkeypatch.chdir(tmp_path)
    asked = {}

    def stop(plan, messages, output, progress):
        asked.update({variant: message.bytes for (_, variant), message in messages.items()})
        raise UserError("enough")

    monkeypatch.setattr(run, "run_network", stop)
    said = say("measure", "network", FLEET, "--message", "fleet_msgs/Track", "--keep", "vehicle,xs", *options)
    assert said.status == 2 and "enough" in said.err
    assert asked == {"full": sizes[0], "pruned": sizes[1]}
    assert told in said.err


def test_what_measuring_needs_is_said_before_anything_is_run(say, monkeypatch):
    def lack(conditions):
        raise UserError("the measurement needs\n  root")

    monkeypatch.setattr(gains, "check_needs", lack)
    said = say("prune", FLEET, "--measure")
    assert said.status == 2 and "the measurement needs" in said.err and said.out == ""


@pytest.mark.parametrize(
    ("options", "told"),
    [
        (["--rate", "5", "--loopback"], "--loopback: for --measure; add it"),
        (["--rate", "5", "--undo"], "--rate: stands beside the plan"),
        (["--measure", "--undo"], "--measure: stands beside the plan"),
        (["--measure", "--verify"], "--measure: stands beside the plan"),
        (["--measure", "--format", "patch"], "--measure: stands beside the plan"),
        (["--measure", "--loopback", "--link", "1mbit"], "--link: loopback has no link to limit"),
        (["--measure", "--nodes", "zenoh"], "--nodes zenoh: unknown"),
        (["--measure", "--rate", "1e9"], "--rates 1e+09: has to be from"),
    ],
)
def test_options_that_are_refused(say, options, told):
    said = say("prune", FLEET, *options)
    assert said.status == 2 and told in said.err


def test_a_full_message_takes_what_the_plan_says(measured, say):
    """Both sizes are those of the plan where all lengths are."""
    (plan,) = prepare(FLEET, topics=("/track",), length=10).plan.plans
    lengths = {name: 10 for name in ("vehicle", "xs", "ys", "notes")}
    found = contents.make_real_messages(plan.type, plan.keep, FLEET, contents.MessageFilling(lengths), 1).messages
    assert found[0, "full"].bytes - 20 == plan.full_bytes
    assert found[0, "pruned"].bytes - 20 == plan.light_bytes
