"""`rosimpact graph --observed`: a running system beside the sources."""

import json
import sqlite3
import sys
from textwrap import dedent

import ferry
import pytest
import yaml
from rosimpact.impact.analysis.observed import read_observation
from rosimpact.impact.cli.app import app
from rosimpact.impact.model.flow.observed import SeenEndpoint
from typer.testing import CliRunner

ROS2 = """
    /helm
      Subscribers:
        /bell: std_msgs/msg/Bool
        /helm/horn: std_msgs/msg/Bool
        /parameter_events: rcl_interfaces/msg/ParameterEvent
      Publishers:
        /course: std_msgs/msg/Float32
        /rosout: rcl_interfaces/msg/Log
        /log: std_msgs/msg/String
      Service Servers:
        /harbour/call: std_srvs/srv/Trigger
        /helm/get_parameters: rcl_interfaces/srv/GetParameters
      Service Clients:

      Action Servers:
        /dock: action_tutorials_interfaces/action/Fibonacci
      Action Clients:

    /aurora/ramp
      Subscribers:
        /aurora/course: std_msgs/msg/Float32
      Publishers:

      Service Servers:

      Service Clients:
        /harbour/call: std_srvs/srv/Trigger
      Action Servers:

      Action Clients:

"""
ROS1 = """
    --------------------------------------------------------------------------------
    Node [/mover]
    Publications:
     * /dock/feedback [pier_msgs/DockActionFeedback]
     * /dock/result [pier_msgs/DockActionResult]
     * /dock/status [actionlib_msgs/GoalStatusArray]
     * /pose [pier_msgs/Pose]
     * /rosout [rosgraph_msgs/Log]

    Subscriptions:
     * /dock/cancel [actionlib_msgs/GoalID]
     * /dock/goal [unknown type]

    Services:
     * /mover/get_loggers
     * /reset

    contacting node http://pier:40001/ ...
    Pid: 12
    Connections:
     * topic: /rosout
        * to: /rosout

    --------------------------------------------------------------------------------
    Node [/quiet]
    Publications: None

    Subscriptions: None

    Services: None

"""


@pytest.fixture(scope="module")
def ws(tmp_path_factory):
    return ferry.write_ferry(tmp_path_factory.mktemp("ws"))


@pytest.fixture
def observe(ws, tmp_path):
    def run(text: str, *arguments: object, name: str = "seen.txt") -> tuple[int, str, str]:
        (tmp_path / name).write_text(dedent(text), encoding="utf-8")
        result = CliRunner().invoke(app, ["graph", str(ws), "--observed", str(tmp_path / name), *map(str, arguments)])
        return result.exit_code, result.stdout, result.stderr

    return run


def list_rows(out: str) -> set[tuple[str, str, str, str]]:
    return {(row["state"], row["node"], row["role"], row["name"]) for row in json.loads(out)["endpoints"]}


def test_a_system_that_is_as_the_sources_say(observe):
    code, out, _ = observe(ROS2, "-f", "json")
    assert code == 0
    assert list_rows(out) == {
        ("matches", "/helm", "publisher", "/course"),
        ("may match", "/helm", "publisher", "/log"),
        ("not seen", "/helm", "publisher", "/blast"),
        ("matches", "/helm", "subscriber", "/bell"),
        ("matches", "/helm", "subscriber", "/helm/horn"),
        ("matches", "/helm", "server", "/harbour/call"),
        ("matches", "/helm", "action server", "/dock"),
        ("matches", "/aurora/ramp", "subscriber", "/aurora/course"),
        ("matches", "/aurora/ramp", "client", "/harbour/call"),
    }
    found = json.loads(out)
    assert (found["differs"], found["not_started"], found["others"]) == (False, [], [])


@pytest.mark.parametrize(
    ("old", "new", "row"),
    [
        ("/course: std_msgs/msg/Float32\n        /rosout", "/course: std_msgs/msg/Float64\n        /rosout",
         ("other type", "/helm", "publisher", "/course")),
        ("/bell: std", "/bells: std", ("not in the sources", "/helm", "subscriber", "/bells")),
        ("        /dock: action_tutorials_interfaces/action/Fibonacci\n", "",
         ("not seen", "/helm", "action server", "/dock")),
    ],
)  # fmt: skip
def test_what_differs(observe, old, new, row):
    assert ROS2.count(old) == 1
    code, out, _ = observe(ROS2.replace(old, new), "-f", "json")
    assert code == 1
    assert row in list_rows(out)


def test_what_is_not_certain_in_the_sources_makes_no_difference(observe):
    code, out, _ = observe(ROS2.replace("        /bell: std_msgs/msg/Bool\n", ""))
    assert code == 0
    assert "- subscribes  /bell" in out
    assert "[not seen; its name is known by the default of a parameter]" in out
    assert "[not seen; only if speed.value > 2.0]" in out


def test_nodes_of_one_side_alone(observe):
    code, out, _ = observe("/gulls\n  Publishers:\n    /cry: std_msgs/msg/String\n  Subscribers:\n")
    assert code == 0
    assert "2 nodes of the sources not seen: /<$SHIP>/ramp, /helm" in out
    assert "1 node seen that the sources do not start: /gulls" in out


def test_text_names_the_place(observe):
    code, out, _ = observe(ROS2.replace("/course: std_msgs/msg/Float32\n        /rosout", "/rosout"))
    assert code == 1
    assert "  - publishes   /course  std_msgs/Float32  ferry/ferry/helm.py:17  [not seen]\n" in out
    assert out.endswith("1 seen, and of a type for which the sources have a name that is not known\n")


def test_ros_1(tmp_path):
    file = tmp_path / "info"
    file.write_text(dedent(ROS1))
    seen = read_observation(file)
    assert set(seen.endpoints) == {
        SeenEndpoint("/mover", "action server", "/dock", "pier_msgs/Dock"),
        SeenEndpoint("/mover", "publisher", "/pose", "pier_msgs/Pose"),
        SeenEndpoint("/mover", "publisher", "/rosout", "rosgraph_msgs/Log"),
        SeenEndpoint("/mover", "server", "/mover/get_loggers", ""),
        SeenEndpoint("/mover", "server", "/reset", ""),
    }
    told = {"publisher", "subscriber", "server", "action server", "action client"}
    assert seen.roles == {"/mover": told, "/quiet": told}


DUMP = {
    "nodes": [
        {"name": "/helm", "publishers": [{"name": "/course", "type": "std_msgs/msg/Float32"}],
         "service_servers": [{"name": "/harbour/call", "request_type": {"name": "std_srvs/srv/Trigger"}}],
         "action_servers": [
             {"name": "/dock", "send_goal": {"request_type": {"name": "pier_msgs/action/Dock_SendGoal"}}}],
         "subscriptions": [{"name": "/bell", "type": {"name": "std_msgs/msg/Bool", "hash": {"version": 1}}}]},
    ],
}  # fmt: skip


@pytest.mark.parametrize(
    "make",
    [
        json.dumps,
        lambda dump: json.dumps(dump["nodes"]),
        lambda dump: "nodes:\n" + "".join(f"- {json.dumps(node)}\n" for node in dump["nodes"]) + "---\n",
        lambda dump: "".join(yaml.safe_dump(node) + "---\n" for node in dump["nodes"]),
    ],
)
def test_dumps(tmp_path, make):
    file = tmp_path / "dump"
    file.write_text(make(DUMP))
    seen = read_observation(file)
    assert set(seen.endpoints) == {
        SeenEndpoint("/helm", "publisher", "/course", "std_msgs/Float32"),
        SeenEndpoint("/helm", "server", "/harbour/call", "std_srvs/Trigger"),
        SeenEndpoint("/helm", "action server", "/dock", "pier_msgs/Dock"),
        SeenEndpoint("/helm", "subscriber", "/bell", "std_msgs/Bool"),
    }
    assert seen.roles == {"/helm": {"publisher", "server", "action server", "subscriber"}}


METADATA = """
    rosbag2_bagfile_information:
      version: 5
      storage_identifier: sqlite3
      topics_with_message_count:
        - topic_metadata: {name: /course, type: std_msgs/msg/Float32, serialization_format: cdr}
          message_count: 4
"""
COURSE = (SeenEndpoint("", "publisher", "/course", "std_msgs/Float32"),)


def test_metadata_of_a_bag(observe, tmp_path):
    code, out, _ = observe(METADATA, name="metadata.yaml")
    assert code == 0
    assert out == (
        "published by a node that the file does not name\n"
        "    publishes   /course  std_msgs/Float32  ferry/ferry/helm.py:17\n\n"
        "node /helm\n"
        "  - publishes   /blast  std_msgs/Bool  ferry/ferry/helm.py:24  [not seen; a recording need not have it]\n\n"
        "endpoints: 1 seen and in the sources, 1 in the sources and not seen\n"
    )
    assert read_observation(tmp_path).endpoints == COURSE


def test_a_recording_need_not_have_all(observe):
    code, out, _ = observe(METADATA.replace("/course", "/wind"), name="metadata.yaml")
    assert code == 0
    assert "  + publishes   /wind  std_msgs/Float32  [not in the sources]\n" in out
    assert "  - publishes   /course  std_msgs/Float32" in out


def test_a_recording_of_another_type_differs(observe):
    code, out, _ = observe(METADATA.replace("Float32", "Float64"), name="metadata.yaml")
    assert code == 1
    assert "[in the sources std_msgs/Float32]" in out


def test_sqlite(tmp_path):
    file = tmp_path / "bag_0.db3"
    bag = sqlite3.connect(file)
    bag.execute("CREATE TABLE topics (id INTEGER, name TEXT, type TEXT, serialization_format TEXT)")
    bag.execute("INSERT INTO topics VALUES (1, '/course', 'std_msgs/msg/Float32', 'cdr')")
    bag.commit()
    bag.close()
    assert read_observation(file).endpoints == COURSE


def test_mcap(tmp_path):
    writer_of = pytest.importorskip("mcap.writer").Writer
    file = tmp_path / "bag_0.mcap"
    with file.open("wb") as stream:
        writer = writer_of(stream)
        writer.start()
        schema = writer.register_schema(name="std_msgs/msg/Float32", encoding="ros2msg", data=b"float32 data")
        channel = writer.register_channel(schema_id=schema, topic="/course", message_encoding="cdr")
        writer.add_message(channel_id=channel, log_time=0, data=b"", publish_time=0)
        writer.finish()
    assert read_observation(file).endpoints == COURSE


def test_bags_of_ros_1_name_nodes(tmp_path):
    rosbag1 = pytest.importorskip("rosbags.rosbag1")
    file = tmp_path / "course.bag"
    with rosbag1.Writer(file) as bag:
        connection = bag.add_connection(
            "/course", "std_msgs/msg/Float32", msgdef="float32 data\n", md5sum="0" * 32, callerid="/helm"
        )
        bag.write(connection, 0, b"\0\0\0\0")
    seen = read_observation(file)
    assert seen.endpoints == (COURSE[0]._replace(node="/helm"),)
    assert seen.roles == {"/helm": frozenset()}


@pytest.mark.parametrize(("name", "package"), [("a.mcap", "mcap"), ("a.bag", "rosbags")])
def test_a_library_that_is_missing_is_told(observe, monkeypatch, name, package):
    for module in [one for one in sys.modules if one.partition(".")[0] == package]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, package, None)
    code, _, err = observe("x", name=name)
    assert code == 2
    assert f"needs the Python package `{package}`; install it with `pip install 'rosimpact[bags]'`" in err


@pytest.mark.parametrize(
    ("text", "name", "said"),
    [
        ("", "seen.txt", "names no node; give what `ros2 node info`"),
        ("hello\n", "seen.txt", "names no node"),
        ("{", "seen.json", "cannot be read: Expecting"),
        ("nodes: " + "[" * 20_000, "seen.yaml", "cannot be read: not readable as YAML: "),
        ('{"nodes": [{"name": "/a", "publishers": ["/b"]}]}', "seen.json", "nodes are objects with a `name`"),
        ('{"nodes": 5}', "seen.json", "nodes are objects with a `name`"),
        ("nodes: [\n", "seen.yaml", "not readable as YAML"),
        ("rosbag2_bagfile_information: 5\n", "metadata.yaml", "nodes are objects"),
        ("x" * 200, "bag.db3", "cannot be read: file is not a database"),
    ],
)
def test_what_cannot_be_read(observe, text, name, said):
    code, out, err = observe(text, name=name)
    assert (code, out) == (2, "")
    assert said in err
    assert err.count("\n") == 1


@pytest.mark.parametrize("name", ["mcap", "bag"])
def test_broken_bags(observe, name):
    pytest.importorskip("mcap" if name == "mcap" else "rosbags")
    code, _, err = observe("#ROSBAG V2.0\nx" * 9, name=f"a.{name}")
    assert (code, err.count("\n")) == (2, 1)
    assert "cannot be read: " in err


def test_a_file_that_is_missing(ws, tmp_path):
    for place in (tmp_path / "none", tmp_path):
        result = CliRunner().invoke(app, ["graph", str(ws), "--observed", str(place)])
        assert result.exit_code == 2
        assert "No such file or directory; give another file" in result.stderr


@pytest.mark.parametrize("arguments", [["-f", "dot"], ["--base", "HEAD"], ["--node", "helm"]])
def test_parts_of_a_system_are_not_compared(observe, arguments):
    code, _, err = observe(ROS2, *arguments)
    assert (code, "compares a whole system" in err) == (2, True)
