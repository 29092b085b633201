"""`rosimpact graph --format nodl`: the interface of each node."""

import re

import ferry
import pytest
import yaml
from rosimpact.impact.cli.app import app
from rosimpact.impact.facts.nodl import extract
from rosimpact.impact.model.flow.graph import Qos
from rosimpact.impact.report.graph.nodl import make_parameter, make_qos
from typer.testing import CliRunner

KEEP_10 = {"history": "KEEP_LAST", "depth": 10, "reliability": "RELIABLE", "durability": "VOLATILE"}


@pytest.fixture(scope="module")
def ws(tmp_path_factory):
    return ferry.write_ferry(tmp_path_factory.mktemp("ws"))


def run(*arguments: object) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, ["graph", "-f", "nodl", *map(str, arguments)])
    return result.exit_code, result.stdout, result.stderr


def test_a_document_has_what_the_code_makes_under_the_names_that_it_gives(ws):
    code, out, _ = run(ws, "--node", "helm")
    assert code == 0
    assert yaml.safe_load(out) == {
        "nodl_version": 2,
        "parameters": {
            "bell": {"type": "string", "default_value": "bell"},
            "piers": {"type": "string_array", "default_value": ["north", "south"]},
            "speed": {"type": "double", "default_value": 2.5},
        },
        "publishers": [
            {"name": "blast", "type": "std_msgs/msg/Bool", "qos": KEEP_10, "description": "only if speed.value > 2.0"},
            {"name": "course", "type": "std_msgs/msg/Float32", "qos": {
                "history": "KEEP_LAST", "depth": 3, "reliability": "BEST_EFFORT", "durability": "VOLATILE"}},
        ],
        "subscriptions": [
            {"name": "bell", "type": "std_msgs/msg/Bool", "qos": KEEP_10,
             "description": "the name is the default of a parameter"},
            {"name": "~/horn", "type": "std_msgs/msg/Bool", "qos": KEEP_10},
        ],
        "service_servers": [{"name": "/harbour/call", "type": "std_srvs/srv/Trigger"}],
        "action_servers": [{"name": "dock", "type": "action_tutorials_interfaces/action/Fibonacci"}],
    }  # fmt: skip


def test_what_is_left_out_is_told_in_comments(ws):
    comments = [line for line in run(ws, "--node", "helm")[1].splitlines() if line.startswith("#")]
    assert comments[0] == "# helm of ferry"
    assert len(comments) == 3
    assert re.search(r"Left out: parameter captain at ferry/ferry/helm\.py:15: its type is not known", comments[1])
    assert re.search(r"Left out: publisher of std_msgs/String at ferry/ferry/helm\.py:18: ", comments[2])


def test_all_nodes_are_documents_of_one_stream_or_files_of_a_folder(ws, tmp_path):
    code, out, _ = run(ws)
    assert code == 0
    documents = list(yaml.safe_load_all(out))
    assert [sorted(each)[0] for each in documents] == ["action_servers", "nodl_version"]
    assert run(ws, "-o", tmp_path / "made") == (0, "", "")
    files = sorted(path.relative_to(tmp_path).as_posix() for path in tmp_path.rglob("*.yaml"))
    assert files == ["made/ferry/helm.nodl.yaml", "made/ferry/ramp.nodl.yaml"]
    assert yaml.safe_load((tmp_path / files[1]).read_text()) == documents[1]


def test_with_a_launch_file_names_are_those_of_the_system(ws):
    out = run(ws, "--launch", "ferry.launch.xml")[1]
    ramp, helm = yaml.safe_load_all(out)
    assert [each["name"] for each in helm["publishers"]] == ["/blast", "/course"]
    assert "subscriptions" not in ramp
    assert "its name is known in part (/<$SHIP>/course)" in out
    assert [each["name"] for each in ramp["service_clients"]] == ["/harbour/call"]


@pytest.mark.parametrize("arguments", [["--base", "HEAD"], ["--topic", "course"], ["--around", "/course"]])
def test_parts_of_interfaces_are_refused(ws, arguments):
    code, _, err = run(ws, *arguments)
    assert code == 2
    assert "whole interfaces" in err


def test_a_node_that_is_not_there(ws):
    code, _, err = run(ws, "--node", "halm")
    assert (code, "`halm`: no node of this name" in err) == (2, True)


def test_nodes_of_ros_1_are_refused(tmp_path):
    package = tmp_path / "old"
    package.mkdir()
    (package / "package.xml").write_text(
        ferry.MANIFEST.replace("ament_python", "catkin").replace("rclpy", "rospy").replace(">ferry<", ">old<")
    )
    (package / "CMakeLists.txt").write_text("project(old)\nfind_package(catkin REQUIRED)\ncatkin_package()\n")
    (package / "talk.py").write_text(
        "import rospy\nfrom std_msgs.msg import String\nrospy.init_node('talk')\n"
        "rospy.Publisher('chatter', String, queue_size=1)\nrospy.spin()\n"
    )
    code, _, err = run(tmp_path)
    assert (code, "workspace of ROS 1" in err) == (2, True)


@pytest.mark.parametrize(
    ("qos", "written"),
    [
        (Qos(), {"history": "SYSTEM_DEFAULT", "reliability": "SYSTEM_DEFAULT"}),
        (Qos(reliability="reliable", history="keep_last"), {"history": "SYSTEM_DEFAULT", "reliability": "RELIABLE"}),
        (Qos("reliable", "transient_local", "keep_last", 0, 0.5, "manual_by_topic", 1.0), {
            "history": "SYSTEM_DEFAULT", "reliability": "RELIABLE", "durability": "TRANSIENT_LOCAL",
            "liveliness": "MANUAL_BY_TOPIC", "deadline_ns": 500_000_000,
            "liveliness_lease_duration_ns": 1_000_000_000}),
        (Qos("best_available", "", "keep_all", 7), {"history": "KEEP_ALL", "reliability": "BEST_AVAILABLE"}),
    ],
)  # fmt: skip
def test_quality_of_service(qos, written):
    assert make_qos(qos) == written


@pytest.mark.parametrize(
    ("default", "made"),
    [
        ("true", {"type": "bool", "default_value": True}),
        ("False", {"type": "bool", "default_value": False}),
        ("-3", {"type": "int", "default_value": -3}),
        ("1.5f", {"type": "double", "default_value": 1.5}),
        ('"a b"', {"type": "string", "default_value": "a b"}),
        ('rclcpp::ParameterValue(std::string("x"))', {"type": "string", "default_value": "x"}),
        ("rclcpp::ParameterType::PARAMETER_INTEGER_ARRAY", {"type": "int_array"}),
        ("Parameter.Type.DOUBLE", {"type": "double"}),
        ("std::vector<double>()", {"type": "double_array", "default_value": []}),
        ('std::vector<std::string>("b", "a")', {"type": "string_array", "default_value": ["b", "a"]}),
        ("{1, 2}", {"type": "int_array", "default_value": [1, 2]}),
        ("{1, 2.5}", None),
        ("std::vector<Wheel>()", None),
        ("wheels_", None),
        ("", None),
    ],
)
def test_parameters(default, made):
    assert make_parameter(default) == made


@pytest.mark.parametrize(
    ("text", "version", "endpoints", "problems"),
    [
        ("nodl_version: 2\npublishers:\n  - {name: a, type: b/B}\n", 2, [("publishers", "a", "b/B", 3)], 0),
        ("nodl_version: 2\npublishers:\n  - {name: a}\n  - 5\n", 2, [], 2),
        ("nodl_version: two\npublishers: 5\n", 0, [], 0),
        ("nodl_version: 2\nservice_clients:\n- name: [\n", 2, [], 2),
        ("", 0, [], 0),
        ("[1, 2]", 0, [], 0),
    ],
)
def test_reading(text, version, endpoints, problems):
    found = extract(text.encode())
    assert found.version == version
    assert [(one.section, one.name, one.type, one.line) for one in found.endpoints] == endpoints
    assert len(found.problems) == problems
