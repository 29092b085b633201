"""The message-flow graph as text, JSON, GraphML, DOT and Mermaid."""

import json
from pathlib import Path

import jsonschema
import networkx
import pytest
from robot import DRIVER, robot
from rosimpact.impact.flow.drawing import draw
from rosimpact.impact.flow.drawing.dot import quoted
from rosimpact.impact.flow.drawing.json import schema
from rosimpact.impact.flow.drawing.mermaid import escaped

ROOT = Path(__file__).parents[2]
NOW = robot()
OTHER = DRIVER.replace("if (ready_) ", "").replace("rclcpp::SensorDataQoS()", "10").replace('"calibrate"', '"tune"')
BEFORE = robot(driver=OTHER)


def test_text():
    text = draw(NOW, "text")
    assert text.startswith("3 nodes, 2 topics, 1 service\n")
    lines = text.splitlines()
    scan = lines[lines.index("/scan  sensor_msgs/LaserScan") :][:4]
    assert scan == [
        "/scan  sensor_msgs/LaserScan",
        "  publishes  /driver  driver/driver.cpp:5  [best_effort]",
        "              publish at driver/driver.cpp:6  when ready_; on timer 100ms",
        "  subscribes /planner  planner/planner.cpp:5  [→ Planner::onScan]",
    ]
    assert "/calibrate (service)  std_srvs/Trigger" in lines
    assert "8 of 9 API calls resolved; 3 files read" in text
    assert lines[-1].startswith("  planner/planner.cpp:7: publisher name `unknown()`: ")


def test_text_beside_a_base():
    lines = draw(NOW, "text", BEFORE).splitlines()
    assert any(line.startswith("~ publishes  /driver") and "changed: QoS, guards" in line for line in lines)
    assert any(line.startswith("+ serves     /driver") for line in lines)
    assert any(line.startswith("- serves     /driver") for line in lines)
    assert any(line.startswith("  subscribes /mover") for line in lines)


@pytest.mark.parametrize("base", [None, BEFORE])
def test_json_is_what_its_schema_says(base):
    found = json.loads(draw(NOW, "json", base))
    jsonschema.validate(found, json.loads(schema()))
    (publish,) = [each for each in found["publishes"] if each["topic"] == "/scan"]
    assert [(guard["kind"], guard["text"]) for guard in publish["guards"]] == [("if", "ready_")]
    (subscriber,) = [each for each in found["subscribers"] if each["topic"] == "/scan"]
    assert subscriber["callback"] == {"name": "Planner::onScan", "path": "planner/planner.cpp", "line": 10}
    assert {"name": "/scan", "types": ["sensor_msgs/LaserScan"], "publishers": ["driver/driver"],
            "subscribers": ["planner/planner"]} in found["topics"]  # fmt: skip
    assert found["coverage"]["calls"] == 9
    if base is not None:
        said = {(change["change"], change["name"], change["why"]) for change in found["changes"]}
        assert said == {("changed", "/scan", "QoS, guards"), ("added", "/calibrate", ""), ("removed", "/tune", "")}


def test_the_schema_that_is_published_is_the_one_in_use():
    assert (ROOT / "docs/graph.schema.json").read_text() == schema()
    jsonschema.Draft202012Validator.check_schema(json.loads(schema()))


def test_graphml_can_be_read_again():
    found = networkx.parse_graphml(draw(NOW, "graphml", BEFORE))
    assert found.nodes["node driver/driver"]["package"] == "driver"
    ((_, _, data),) = found.in_edges("topic /scan", data=True)
    assert (data["role"], data["guards"], data["change"]) == ("publisher", "ready_", "changed")
    assert networkx.has_path(networkx.DiGraph(found), "node driver/driver", "node mover/mover")


def test_dot_and_mermaid_have_every_edge():
    dot = draw(NOW, "dot", BEFORE)
    assert '"n driver/driver" -> "topic /scan" [color="#bf8700"' in dot
    assert '"topic /scan" -> "n planner/planner";' in dot
    assert '"n planner/planner" -> "service /calibrate" [style=dashed];' in dot
    mermaid = draw(NOW, "mermaid", BEFORE).splitlines()
    assert mermaid[0] == "flowchart LR"
    assert sum("-->" in line for line in mermaid) == 4
    assert sum("-.->" in line for line in mermaid) == 3
    assert sum("linkStyle" in line for line in mermaid) == 3


def test_hostile_names_stay_names():
    assert quoted('a"b\nc') == '"a\\"b\\nc"'
    assert escaped('a"b[c]') == "a#34;b#91;c#93;"


def test_a_part_is_compared_with_the_same_part_of_the_base():
    lines = draw(NOW, "text", BEFORE, topics=["scan"]).splitlines()
    assert [line[0] for line in lines if "publishes" in line or "serves" in line] == ["~"]
