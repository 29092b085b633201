"""`rosimpact measure`: options, what is refused, what is missing; nothing here runs a node."""

import pytest
from rosimpact.edges.console import UserError
from rosimpact.impact.measure import contents, namespaces, ros1, run
from rosimpact.impact.measure.plan import (
    Conditions,
    NetworkCell,
    NetworkPlan,
    format_link,
    parse_link,
    parse_numbers,
)
from rosimpact.impact.targets.surface.store import load_shipped


@pytest.mark.parametrize(
    ("text", "rate"), [("100mbit", 10**8), ("1gbit", 10**9), ("500kbit", 500_000), ("1.5mbit", 1_500_000), ("none", 0)]
)
def test_links(text, rate):
    assert parse_link(text) == rate
    assert parse_link(format_link(rate)) == rate


@pytest.mark.parametrize("text", ["", "100", "fast", "0mbit", "-1mbit", "100mbit; rm", "9999999mbit"])
def test_links_that_are_none(text):
    with pytest.raises(UserError, match="--link"):
        parse_link(text)


def test_numbers_are_kept_in_order_and_once():
    assert parse_numbers("fields", ["50", "25", "50"]) == (50, 25)
    assert parse_numbers("rates", ["0.5"], whole=False) == (0.5,)


def test_the_whole_matrix_in_order():
    plan = NetworkPlan(conditions=Conditions(), publishers=(1,), fields=(25, 50, 100), rates=(50, 100, 200))
    cells = plan.list_cells()
    assert len(cells) == 18 and len(list(plan.list_runs())) == 54
    assert [cell.variant for cell in cells[:2]] == ["full", "pruned"]
    assert plan.estimate_seconds(54) < 15 * 60
    assert cells[0] == NetworkCell(1, 25, 50, "full")


def test_without_a_pruned_message():
    plan = NetworkPlan(conditions=Conditions(keep=0), publishers=(1,), fields=(25,), rates=(50,))
    assert [cell.variant for cell in plan.list_cells()] == ["full"]


REFUSED = [
    (["--publishers", "0"], "--publishers 0: has to be from"),
    (["--publishers", "two"], "--publishers two: not a number"),
    (["--rates", "-5"], "--rates -5: has to be from"),
    (["--fields", "25,1e9"], "--fields 1e9: not a number"),
    (["--link", "100"], "--link 100: not a rate"),
    (["--loopback", "--link", "100mbit"], "loopback has no link to limit"),
    (["--keep", "26"], "more than the 25 fields"),
    (["--keep", "a,b"], "names of fields go with --message"),
    (["--seconds", "0"], "--seconds 0: has to be from"),
    (["--seconds", "nan"], "--seconds nan: has to be from"),
    (["--fields", "10000", "--field-bytes", "1000000"], "a message of more than"),
    (["--nodes", "zenoh"], "--nodes zenoh: unknown"),
    (["--format", "html"], "--format html: unknown"),
    (["--length", "a=1"], "name it with --message"),
    (["--message", "Scan"], "write package/Type"),
    (["--message", "sensor_msgs/LaserScan", "--fields", "5"], "--fields: is the size of synthetic messages"),
    (["--message", "sensor_msgs/LaserScan", "--length", "ranges"], "write FIELD=NUMBER"),
    (["--message", "sensor_msgs/LaserScan", "--length", "range=5"], "lengths can be given for header.frame_id, ranges"),
    (["--message", "sensor_msgs/LaserScan", "--keep", "rangs"], "did you mean `ranges`?"),
    (["--message", "no_such_msgs/Type"], "no definition is known"),
    (["--message", "sensor_msgs/LaserScan", "--bag", "none.bag"], "no such file or folder"),
    (["--message", "sensor_msgs/PointCloud2", "--length", "data=999999999"], "give smaller lengths"),
    (["--output", "/dev/null/x"], "cannot be written"),
]  # fmt: skip


@pytest.mark.parametrize(("options", "said"), REFUSED)
def test_what_is_refused(say, tmp_path, monkeypatch, options, said):
    monkeypatch.chdir(tmp_path)
    found = say("measure", "network", *options)
    assert found.status == 2
    assert said in found.err and "Traceback" not in found.err
    assert list(tmp_path.iterdir()) == []


def test_everything_that_is_missing_is_said_at_once(say, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(namespaces, "_list_lacking_capabilities", lambda: ["CAP_NET_ADMIN"])
    monkeypatch.setattr(namespaces, "find_program", lambda name: "" if name == "tc" else f"/usr/sbin/{name}")
    monkeypatch.setattr(ros1, "_list_prefixes", lambda: [tmp_path / "usr"])
    monkeypatch.setattr(ros1, "find_program", lambda name: "" if name == "cmake" else name)
    said = say("measure", "network")
    assert said.status == 2
    for part in (
        "root, or CAP_NET_ADMIN", "--loopback", "tc: apt-get install -y iproute2",
        "apt-get install -y libroscpp-dev python3-gencpp python3-rosmaster cmake",
    ):  # fmt: skip
        assert part in said.err
    said = say("measure", "network", "--loopback", "--nodes", "rospy")
    assert "python3-rospy python3-std-msgs python3-genpy" in said.err and "root" not in said.err
    assert list(tmp_path.iterdir()) == []


def test_dds_names_its_package(monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    with pytest.raises(UserError, match="pip install cyclonedds"):
        run.check_needs(Conditions(nodes="dds", network="loopback"))


def test_showing_what_is_not_there(say, tmp_path):
    said = say("measure", "show", tmp_path / "none.jsonl")
    assert said.status == 2 and "holds no results" in said.err


def test_a_real_message_of_a_workspace(tmp_path):
    package = tmp_path / "src/own_msgs"
    (package / "msg").mkdir(parents=True)
    (package / "package.xml").write_text(
        '<package format="2"><name>own_msgs</name><version>1.0.0</version><description>d</description>'
        '<maintainer email="a@b.org">m</maintainer><license>MIT</license></package>'
    )
    (package / "msg/Sweep.msg").write_text("std_msgs/Header header\nfloat32[] ranges\nfloat32[] intensities\n")
    lengths = {"ranges": 10, "intensities": 10, "header.frame_id": 4}
    filling = contents.MessageFilling(lengths)
    made, notes, _ = contents.make_real_messages("own_msgs/Sweep", ["ranges", "header.stamp"], tmp_path, filling, 1)
    # Header: 4 + 8 + 4 + 4; each array: 4 + 40; the sample's head: 20.
    assert made[0, "full"].bytes == 20 + 20 + 44 + 44
    assert made[0, "pruned"].bytes == 20 + 8 + 44
    assert notes == []
    assert contents.compute_digest(made) != contents.compute_digest({(0, "full"): made[0, "full"]})


@pytest.mark.parametrize(("ros", "seq"), [(1, True), (2, False)])
def test_released_definitions_are_of_the_nodes_generation(tmp_path, ros, seq):
    assert load_shipped().find_history("std_msgs", ros) is not None
    filling = contents.MessageFilling({"frame_id": 1})
    made = contents.make_real_messages("std_msgs/Header", [], tmp_path, filling, ros).messages
    names = [field.name for field in made[0, "full"].schema.list_fields()]
    assert ("seq" in names) is seq
    assert (0, "pruned") not in made
