"""The message-flow graph as text, JSON, GraphML, DOT and Mermaid."""

import json
import re
import shutil
import subprocess
from pathlib import Path
from xml.etree import ElementTree

import jsonschema
import networkx
import pytest
from msgspec import structs
from robot import DRIVER, robot
from rosimpact.impact.model.flow.connections import format_guards
from rosimpact.impact.model.flow.graph import GuardAt
from rosimpact.impact.model.flow.select import NothingSelected
from rosimpact.impact.report.graph import draw
from rosimpact.impact.report.graph.dot import quote_text
from rosimpact.impact.report.graph.json import render_schema
from rosimpact.impact.report.graph.mermaid import MOST, ROOM, escape_label
from rosimpact.impact.report.style import PLAIN

ROOT = Path(__file__).parents[2]
NOW = robot()
OTHER = DRIVER.replace("if (ready_) ", "").replace("rclcpp::SensorDataQoS()", "10").replace('"calibrate"', '"tune"')
BEFORE = robot(driver=OTHER)


def test_text():
    text = draw(NOW, "text")
    assert text.startswith("3 nodes, 2 topics, 1 service\n")
    lines = text.splitlines()
    scan = lines[lines.index("topic /scan  sensor_msgs/LaserScan") :][:4]
    assert scan == [
        "topic /scan  sensor_msgs/LaserScan",
        "  publishes   /driver  driver/driver.cpp:5  [best_effort]",
        "      publish at driver/driver.cpp:6  when ready_; on timer 100ms",
        "  subscribes  /planner  planner/planner.cpp:5  [→ Planner::onScan]",
    ]
    assert "service /calibrate  std_srvs/Trigger" in lines
    assert "8 of 9 API calls resolved; 3 files read" in text
    assert lines[-1].startswith("  planner/planner.cpp:7:  publisher name `unknown()`: ")


def test_text_beside_a_base():
    lines = draw(NOW, "text", BEFORE).splitlines()
    place = lines.index("~ publishes   /driver  driver/driver.cpp:5  [changed: QoS, guards; best_effort]")
    assert lines[place + 1 : place + 5] == [
        "    - QoS 10",
        "    + QoS rclcpp::SensorDataQoS()",
        "    - publish at driver/driver.cpp:6  on timer 100ms",
        "    + publish at driver/driver.cpp:6  when ready_; on timer 100ms",
    ]
    assert "+ serves      /driver  driver/driver.cpp:7  [→ Driver::calibrate]" in lines
    assert "- serves      /driver  driver/driver.cpp:7  [→ Driver::calibrate]" in lines
    assert any(line.startswith("  subscribes  /mover") for line in lines)


def guarded(*conditions):
    """The driver, with conditions around its publish statement; those that begin with ! are early returns."""
    lines = [f"if ({one[1:]}) return;" if one[0] == "!" else f"if ({one})" for one in conditions]
    return DRIVER.replace("if (ready_) pub_", " ".join([*lines, "pub_"]))


CHAIN = [f"!code_ == {number} && state_machine_.last_transition() != Transition::kind_{number}" for number in range(8)]


def test_conditions_are_cut_to_those_nearest_to_the_statement():
    graph = robot(driver=guarded(*CHAIN, "code_ == 8"))
    (line,) = (line for line in draw(graph, "text").splitlines() if "publish at driver" in line)
    last = "not (code_ == 7 && state_machine_.last_transition() != Transition::kind_7)"
    assert line.endswith(f"  when {last} and code_ == 8 and 7 more (--all); on timer 100ms")
    (line,) = (line for line in draw(graph, "text", everything=True).splitlines() if "publish at driver" in line)
    assert line.count("not (") == 8
    assert "more (--all)" not in line


@pytest.mark.parametrize(
    ("condition", "shown"),
    [
        (lambda mode: [f"!mode_ == {mode}", *CHAIN, "code_ == 8"], "when not (mode_ == {}) and "),
        (lambda mode: [" || ".join([*(f"code_ == Code::number_{one}" for one in range(9)), mode])], " || {};"),
    ],
)
def test_of_conditions_that_are_cut_those_that_differ_stay(condition, shown):
    now, before = (robot(driver=guarded(*condition(mode))) for mode in ("FAST", "SLOW"))
    gone, new = (line for line in draw(now, "text", before).splitlines() if "publish at driver" in line)
    assert shown.format("SLOW") in gone
    assert shown.format("FAST") in new
    assert len(max(gone, new, key=len)) < 200


def test_of_a_statement_that_many_ways_lead_to_the_ways_that_differ_are_said():
    def driver(guard):
        return DRIVER.replace("if (ready_) pub_->publish(scan_);", "send();").replace(
            "void calibrate",
            f"void send() {{ pub_->publish(scan_); }} void again() {{ if ({guard}) send(); }} void calibrate",
        ).replace("server_ =", "other_ = create_wall_timer(1s, [this]() { again(); }); server_ =")  # fmt: skip

    lines = draw(robot(driver=driver("late_")), "text", robot(driver=driver("early_"))).splitlines()
    place = next(number for number, line in enumerate(lines) if line.startswith("~ "))
    assert lines[place + 1 : place + 4] == [
        "      publish at driver/driver.cpp:9  on timer 100ms, timer 1s; 2 ways lead there",
        "        - when early_; on timer 1s",
        "        + when late_; on timer 1s",
    ]


def test_in_text_nodes_that_run_the_same_code_stand_together():
    driver = "driver/driver"
    (twin,) = (structs.replace(node, id="driver/twin", name="/twin") for node in NOW.nodes if node.id == driver)
    both = structs.replace(
        NOW,
        nodes=(*NOW.nodes, twin),
        endpoints=(*NOW.endpoints, *(structs.replace(e, node=twin.id) for e in NOW.endpoints if e.node == driver)),
        publishes=(*NOW.publishes, *(structs.replace(p, node=twin.id) for p in NOW.publishes if p.node == driver)),
    )
    text = draw(both, "text")
    assert "  publishes   /driver, /twin  driver/driver.cpp:5  [best_effort]\n" in text
    assert text.count("publish at driver/driver.cpp:6") == 1


def test_nodes_without_edges_are_named_in_text():
    lone = structs.replace(NOW.nodes[0], id="lone/lone", name="/lone")
    assert "\n1 node with none of these: /lone\n" in draw(structs.replace(NOW, nodes=(*NOW.nodes, lone)), "text")


def test_nodes_whose_names_are_not_known_are_said_apart_in_text():
    lone, lost = (structs.replace(NOW.nodes[0], id=f"{name}/{name}", name=f"/{name}") for name in ("lone", "lost"))
    unnamed = structs.replace(NOW.endpoints[0], node="lost/lost", topic="", how="unresolved")
    graph = structs.replace(NOW, nodes=(*NOW.nodes, lone, lost), endpoints=(*NOW.endpoints, unnamed))
    text = draw(graph, "text")
    assert "\n1 node that talks under names that are not known: /lost\n\n1 node with none of these: /lone\n" in text


def test_the_answer_to_a_question_lists_what_is_not_resolved_where_it_looked():
    assert "planner/planner.cpp:7:  publisher name" in draw(NOW, "text", topics=["scan"])
    text = draw(NOW, "text", nodes=["driver"], topics=["scan"])
    assert "planner/planner.cpp:7" not in text
    assert text.endswith("  1 is not resolved; --all lists it\n")


NARROW = PLAIN._replace(width=60)
LONG = "a_package_with_a_long_name/a_package_with_a_long_name/a_module_with_a_rather_long_name.cpp"


def test_text_keeps_within_a_narrow_terminal_and_loses_nothing_but_folders():
    long = {"path": LONG, "line": 5}
    graph = structs.replace(
        NOW,
        endpoints=tuple(structs.replace(each, **long) for each in NOW.endpoints),
        publishes=tuple(
            structs.replace(
                each, guards=(GuardAt("if", " && ".join(f"ready_{n}" for n in range(30)), LONG, 5),), **long
            )
            for each in NOW.publishes
        ),
    )
    text = draw(graph, "text", style=NARROW)
    assert max(map(len, text.splitlines())) <= 60
    words = set(draw(graph, "text").split()) - {f"{LONG}:5"}
    assert words <= set(text.split())
    assert "      .../a_module_with_a_rather_long_name.cpp:5\n" in text
    assert "/..." not in draw(graph, "text"), "in a file or a pipe nothing is shortened"


def test_colours_mark_what_differs():
    painted = draw(NOW, "text", BEFORE, style=PLAIN._replace(colours={"good": "32", "error": "31", "warning": "33"}))
    assert "\x1b[32m+ serves" in painted
    assert "\x1b[31m- serves" in painted
    assert "\x1b[33m~ publishes" in painted
    assert re.sub(r"\x1b\[\d*m", "", painted).split() == draw(NOW, "text", BEFORE).split()


@pytest.mark.parametrize("base", [None, BEFORE])
def test_json_is_what_its_schema_says(base):
    found = json.loads(draw(NOW, "json", base))
    jsonschema.validate(found, json.loads(render_schema()))
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
    assert (ROOT / "docs/graph.schema.json").read_text() == render_schema()
    jsonschema.Draft202012Validator.check_schema(json.loads(render_schema()))


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
    assert quote_text('a"b\nc') == '"a\\"b\\\\nc"'
    assert escape_label('a"b[c]') == "a#34;b#91;c#93;"


def test_a_part_is_compared_with_the_same_part_of_the_base():
    lines = draw(NOW, "text", BEFORE, topics=["scan"]).splitlines()
    assert [line[0] for line in lines if "publishes" in line or "serves" in line] == ["~"]


WITHOUT_PLANNER = robot(planner="")


@pytest.mark.parametrize(
    ("asked", "gone"),
    [
        ({"topics": ["scan"]}, {("/planner", "/scan")}),
        ({"nodes": ["mover"]}, {("/planner", "/plan")}),
        ({"nodes": ["planner"]}, {("/planner", "/scan"), ("/planner", "/plan"), ("/planner", "/calibrate")}),
        ({"around": "scan", "hops": 0}, {("/planner", "/scan")}),
        ({}, {("/planner", "/scan"), ("/planner", "/plan"), ("/planner", "/calibrate")}),
    ],
)
def test_who_is_gone_from_a_part_is_said(asked, gone):
    lines = draw(WITHOUT_PLANNER, "text", NOW, **asked).splitlines()
    found, name = set(), ""
    for line in lines:
        name = line.split(" ")[1] if line.startswith(("topic ", "service ")) else name
        if line.startswith("- "):
            found.add((line.split()[2], name))
        assert not line.startswith("+ "), "what the base has too is not new because the question did not find it there"
    assert found == gone


def test_what_neither_side_has_is_said():
    with pytest.raises(NothingSelected, match="nobody"):
        draw(WITHOUT_PLANNER, "text", NOW, nodes=["nobody"])


def _also(graph, topic):
    return structs.replace(graph, endpoints=(*graph.endpoints, structs.replace(graph.endpoints[0], topic=topic)))


def test_what_is_hidden_is_not_said_to_be_gone():
    both = _also(NOW, "/tf")
    assert not [line for line in draw(both, "text", both).splitlines() if line.startswith(("+ ", "- ", "~ "))]
    assert "/tf " in draw(both, "text", around="/tf", hops=0), "a name asked for is not hidden"


@pytest.mark.parametrize(
    ("old", "new", "why"),
    [
        ("rclcpp::SensorDataQoS()", "rclcpp::SensorDataQoS()", ""),
        ("10", "rclcpp::QoS(10)", ""),
        ("10", "11", "QoS"),
        ("A::b::lambda@3:7", "A::b::lambda@4:9", ""),
        ("qos_of_old()", "qos_of_new()", "QoS"),
    ],
)
def test_qos_differs_by_what_it_says(old, new, why):
    before, now = (robot(driver=DRIVER.replace("rclcpp::SensorDataQoS()", qos)) for qos in (old, new))
    assert [change["why"] for change in json.loads(draw(now, "json", before))["changes"]] == ([why] if why else [])


ODD = ("\\", "\\N", '\\"', '"]', "&amp;", "<b>x</b>", "#35;", "%%{init: {}}%%", "--> x", "{node}|[]();`", "漢字🤖")


def test_graphviz_reads_names_as_they_are():
    program = shutil.which("dot")
    if program is None:
        pytest.skip("no `dot`: install graphviz to test what it reads")
    first, *_ = NOW.endpoints
    names = [f"/{odd}" for odd in ODD]
    graph = structs.replace(NOW, endpoints=tuple(structs.replace(first, topic=name, type="") for name in names))
    read = subprocess.run([program, "-Tplain"], input=draw(graph, "dot"), capture_output=True, text=True, check=True)
    assert read.stderr == ""
    svg = subprocess.run([program, "-Tsvg"], input=draw(graph, "dot"), capture_output=True, text=True, check=True)
    shown = {text.text for text in ElementTree.fromstring(svg.stdout).iter("{http://www.w3.org/2000/svg}text")}
    assert set(names) <= shown


def test_mermaid_names_hold_nothing_that_it_would_read():
    for odd in (*ODD, "\x1b", "\u202e", "\udcff"):
        text = escape_label(odd)
        assert not re.search(r"""["'`<>{}()\[\]|;%&\\#]""", re.sub(r"#\d+;", "", text))
        assert "#27;" not in text and "#8238;" not in text


@pytest.mark.parametrize("odd", ["\\", "\x1b[2J\x07", "\udcff", "\uffff", "\u202e", '</script>"\n', "\x00"])
def test_odd_names_leave_every_format_whole(odd):
    graph = structs.replace(
        NOW,
        nodes=tuple(structs.replace(n, id=n.id + odd, name=n.name + odd) for n in NOW.nodes),
        endpoints=tuple(structs.replace(e, node=e.node + odd, topic=e.topic and e.topic + odd) for e in NOW.endpoints),
        publishes=tuple(structs.replace(p, node=p.node + odd, topic=p.topic and p.topic + odd) for p in NOW.publishes),
    )
    drawn = {name: draw(graph, name) for name in ("text", "json", "graphml", "dot", "mermaid")}
    for text in drawn.values():
        text.encode()
    assert "\x1b" not in drawn["text"] + drawn["dot"]
    assert len(drawn["text"].splitlines()) == len(draw(NOW, "text").splitlines())
    assert len(json.loads(drawn["json"])["nodes"]) == 3
    assert len(networkx.parse_graphml(drawn["graphml"])) == 6
    for line in drawn["dot"].splitlines():
        strings = re.sub(r'"(?:[^"\\]|\\.)*"', "", line)
        assert '"' not in strings, f"a string of DOT is left open: {line}"


def test_mermaid_keeps_within_its_room_and_keeps_what_differs():
    first = NOW.endpoints[0]
    many = tuple(structs.replace(first, topic=f"/{number:04}/{'x' * 200}") for number in range(MOST + 50))
    now = structs.replace(NOW, endpoints=(*many, structs.replace(first, topic="/zzz")))
    text = draw(now, "mermaid", structs.replace(NOW, endpoints=many))
    assert len(text) <= ROOM
    assert "edges are left out" in text
    assert '["/zzz"]' in text


@pytest.mark.parametrize(
    ("guards", "said"),
    [
        ([("if", "a || b")], "a || b"),
        ([("if", "a || b"), ("if", "c")], "(a || b) and c"),
        ([("if", "a or b"), ("unless", "c or d")], "(a or b) and not (c or d)"),
        ([("if", "a && b"), ("if", "c")], "a && b and c"),
        ([("if", "ordered"), ("while", "ok()")], "ordered, in while ok()"),
        ([("while", "ok()"), ("for", "a : b")], "in while ok() in for a : b"),
    ],
)
def test_guards_in_a_line_mean_what_they_mean_nested(guards, said):
    publish = structs.replace(NOW.publishes[0], guards=tuple(GuardAt(*guard, path="a.cpp", line=1) for guard in guards))
    assert format_guards(publish) == said
