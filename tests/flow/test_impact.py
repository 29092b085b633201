"""What a change reaches: a chain of nodes, one edit at a time."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import jsonschema
import pytest
from rosimpact.impact.analysis.downstream import ImpactResult, compute_impact, select_effects
from rosimpact.impact.analysis.effects import NOTHING, Effect, Impact
from rosimpact.impact.facts.store import Store
from rosimpact.impact.model.flow.graph import Coverage
from rosimpact.impact.model.flow.workspace import link_for_flow
from rosimpact.impact.report import impact as impact_report
from rosimpact.impact.report.style import PLAIN
from rosimpact.impact.tree import WorkingTree

MANIFEST = """<package format="3"><name>{}</name><version>1.0.0</version><description>x</description>
<maintainer email="a@b.org">a</maintainer><license>MIT</license><buildtool_depend>{}</buildtool_depend>
<export><build_type>{}</build_type></export></package>
"""
GAUGE = """#include <rclcpp/rclcpp.hpp>
#include <tide_msgs/msg/level.hpp>
class Gauge : public rclcpp::Node {
 public:
  Gauge() : Node("gauge") {
    pub_ = create_publisher<tide_msgs::msg::Level>("level", 10);
    timer_ = create_wall_timer(std::chrono::milliseconds(100), std::bind(&Gauge::measure, this));
  }
  void measure() {
    tide_msgs::msg::Level level;
    level.metres = scaled(3.0);
    if (ready_) {
      pub_->publish(level);
    }
  }
  double scaled(double raw) { return raw * 2.0; }
  rclcpp::Publisher<tide_msgs::msg::Level>::SharedPtr pub_;
  rclcpp::TimerBase::SharedPtr timer_;
  bool ready_ = true;
};
int main(int argc, char ** argv) { rclcpp::spin(std::make_shared<Gauge>()); }
"""
WATCH = """import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool
from tide_msgs.msg import Level


class Watch(Node):
    def __init__(self):
        super().__init__('watch')
        self.alarm = self.create_publisher(Bool, 'alarm', 10)
        self.create_subscription(Level, 'level', self.on_level, 10)
        self.create_subscription(Bool, 'quiet', self.on_quiet, 10)

    def on_level(self, level):
        if level.metres > 4.0:
            self.alarm.publish(Bool(data=True))

    def on_quiet(self, quiet):
        self.get_logger().info('quiet')


def main():
    rclpy.init()
    rclpy.spin(Watch())
"""
HORN = """import rclpy
from rclpy.node import Node
from std_msgs.msg import Bool


class Horn(Node):
    def __init__(self):
        super().__init__('horn')
        self.create_subscription(Bool, 'alarm', self.on_alarm, 10)

    def on_alarm(self, alarm):
        pass


def main():
    rclpy.init()
    rclpy.spin(Horn())
"""
SETUP = """from setuptools import setup
setup(name='harbour', packages=['harbour'],
      entry_points={'console_scripts': ['watch = harbour.watch:main', 'horn = harbour.horn:main']})
"""
FILES = {
    "tide_msgs/package.xml": MANIFEST.format("tide_msgs", "rosidl_default_generators", "ament_cmake"),
    "tide_msgs/CMakeLists.txt": "project(tide_msgs)\nrosidl_generate_interfaces(a msg/Level.msg msg/Mark.msg)\n",
    "tide_msgs/msg/Level.msg": "float64 metres\nMark mark\n",
    "tide_msgs/msg/Mark.msg": "string name\n",
    "gauge/package.xml": MANIFEST.format("gauge", "ament_cmake", "ament_cmake"),
    "gauge/CMakeLists.txt": "project(gauge)\nadd_executable(gauge src/gauge.cpp)\n",
    "gauge/src/gauge.cpp": GAUGE,
    "harbour/package.xml": MANIFEST.format("harbour", "ament_python", "ament_python"),
    "harbour/setup.py": SETUP,
    "harbour/harbour/__init__.py": "",
    "harbour/harbour/watch.py": WATCH,
    "harbour/harbour/horn.py": HORN,
}
CPP, PY = "gauge/src/gauge.cpp", "harbour/harbour/watch.py"
Between = Callable[[dict[str, str]], Impact]


@pytest.fixture
def between(tmp_path: Path) -> Between:
    """What the step from FILES to other files reaches."""

    def written(folder: Path, files: dict[str, str]) -> Path:
        for name, text in files.items():
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        return folder

    def reached(files: dict[str, str]) -> Impact:
        with Store(tmp_path / "cache") as store:
            base = link_for_flow(WorkingTree(written(tmp_path / "base", FILES)), store, 1)
            now = link_for_flow(WorkingTree(written(tmp_path / "now", files)), store, 1)
            return compute_impact(now, base)

    return reached


def edited(path: str, *pairs: tuple[str, str]) -> dict[str, str]:
    text = FILES[path]
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return {**FILES, path: text}


def said(impact: Impact) -> list[tuple]:
    """Kind, change, subject, what `why` says, and the nodes downstream with the one before."""
    return [
        (one.kind, one.change, one.subject, one.why, [(hop.came.rpartition("/")[2], hop.node.rpartition("/")[2])
                                                      for hop in one.reaches])
        for one in impact.effects
    ]  # fmt: skip


class Row(NamedTuple):
    files: dict[str, str]
    says: list[tuple]


DOWN = [("", "watch"), ("watch", "horn")]
ROWS = {
    "a field more, in a message within": Row(
        edited("tide_msgs/msg/Mark.msg", ("string name\n", "string name\nfloat64 height\n")),
        [("message", "changed", "tide_msgs/Mark", "field `height` is new (`float64`)",
          [("", "watch"), ("", "gauge"), ("watch", "horn")])],
    ),
    "a field of another type": Row(
        edited("tide_msgs/msg/Level.msg", ("float64 metres", "float32 metres")),
        [("message", "changed", "tide_msgs/Level", "field `metres` is `float32`, was `float64`",
          [("", "watch"), ("", "gauge"), ("watch", "horn")])],
    ),
    "a comment in a message": Row(edited("tide_msgs/msg/Mark.msg", ("string name", "# of the mark\nstring name")), []),
    "a condition": Row(
        edited(CPP, ("if (ready_)", "if (ready_ && level.metres > 0.0)")),
        [("condition", "tightened", "/level", "only when `level.metres > 0.0` too", DOWN)],
    ),
    "a timer": Row(
        edited(CPP, ("milliseconds(100)", "milliseconds(900)")),
        [("trigger", "trigger changed", "/level",
          "timer `std::chrono::milliseconds(900)`, was `std::chrono::milliseconds(100)`", DOWN)],
    ),
    "a callback": Row(
        edited(CPP, ("scaled(3.0)", "scaled(4.0)")),
        [("callback", "changed", "Gauge::measure", "the callback of timer `std::chrono::milliseconds(100)`", DOWN)],
    ),
    "what a callback calls": Row(
        edited(CPP, ("raw * 2.0", "raw * 3.0")),
        [("callback", "changed", "Gauge::scaled",
          "called from `Gauge::measure`, the callback of timer `std::chrono::milliseconds(100)`", DOWN)],
    ),
    "a callback in the middle of the chain": Row(
        edited(PY, ("data=True", "data=bool(level)")),
        [("callback", "changed", "Watch.on_level", "the callback of messages of `level`", [("", "horn")])],
    ),
    "a callback of which nothing goes out": Row(edited(PY, ("  self.get_logger", "  self.x = self.get_logger")), []),
    "comments, white space and what is logged": Row(
        {**edited(PY, ("info('quiet')", "info('silence')"), ("self, level):", "self, level):  # water")),
         CPP: GAUGE.replace("  level.metres", "// twice\n    RCLCPP_INFO(get_logger(), \"now\");\n      level.metres")},
        [],
    ),
    "a variable that is called otherwise throughout": Row(edited(CPP, ("ready_", "is_ready_")), []),
    "a topic of another name": Row(
        edited(CPP, ('"level"', '"water"')),
        [("condition", "changed", "/level, /water", "published on `water`, was `level`", DOWN)],
    ),
    "a subscriber that is gone": Row(
        edited("harbour/harbour/horn.py", ("        self.create_subscription(Bool, 'alarm', self.on_alarm, 10)\n", "")),
        [("topic", "removed", "/alarm", "no subscriber any more", [])],
    ),
    "another type": Row(
        edited("harbour/harbour/horn.py", ("(Bool, 'alarm'", "(Empty, 'alarm'"), ("import Bool", "import Bool, Empty")),
        [("topic", "changed", "/alarm",
          "the subscriber has another type (`std_msgs/Empty` instead of `std_msgs/Bool`)", [])],
    ),
    "another quality": Row(
        edited(PY, ("'level', self.on_level, 10", "'level', self.on_level, rclpy.qos.qos_profile_sensor_data")),
        [("topic", "changed", "/level", "the subscriber has another QoS", [("", "horn")])],
    ),
    "nothing": Row(dict(FILES), []),
    "text alone": Row({**FILES, "README.md": "more\n"}, []),
}  # fmt: skip


@pytest.mark.parametrize("row", ROWS.values(), ids=ROWS)
def test_what_each_change_reaches(row: Row, between: Between):
    assert said(between(row.files)) == row.says


@pytest.mark.parametrize("name", ["nothing", "text alone", "comments, white space and what is logged"])
def test_without_a_change_that_counts_no_graph_is_made(name: str, between: Between, monkeypatch):
    monkeypatch.setattr("rosimpact.impact.model.flow.workspace.join_code", lambda *_: pytest.fail("joined"))
    assert between(ROWS[name].files) is NOTHING


def test_the_path_is_told_hop_by_hop(between: Between):
    (effect,) = between(ROWS["a condition"].files).effects
    assert (effect.path, effect.line, effect.nodes, effect.topics) == (CPP, 13, ("gauge/gauge",), ("/level",))
    assert [(hop.name, hop.node, hop.path, hop.line) for hop in effect.reaches] == [
        ("/level", "harbour/watch", PY, 11),
        ("/alarm", "harbour/horn", "harbour/harbour/horn.py", 9),
    ]


@pytest.mark.parametrize(
    ("asked", "number"),
    [
        ({"packages": ("gauge",)}, 1), ({"packages": ("harbour",)}, 0), ({"topics": ("alarm",)}, 1),
        ({"topics": ("/quiet",)}, 0), ({"nodes": ("horn",)}, 1), ({"nodes": ("gauge/*",)}, 1),
        ({"nodes": ("mast",)}, 0),
    ],
)  # fmt: skip
def test_parts_of_it(between: Between, asked: dict, number: int):
    assert len(select_effects(between(ROWS["a condition"].files), **asked).effects) == number


def test_text_fits_a_terminal_of_eighty_columns(between: Between):
    shown = impact_report.render_text(between(ROWS["a condition"].files), style=PLAIN._replace(width=80))
    assert shown.split("\n\n")[0].splitlines() == [
        "publish conditions",
        "  tightened  /level  (/gauge)  gauge/src/gauge.cpp:13",
        "      only when `level.metres > 0.0` too",
        "      → /watch  /level  harbour/harbour/watch.py:11",
        "        → /horn  /alarm  harbour/harbour/horn.py:9",
    ]
    assert "1 publish condition changed; 2 nodes of 3 reached" in shown
    assert "7 of 7 API calls resolved" in shown
    assert max(map(len, shown.splitlines())) <= 80


def test_a_message_that_nothing_sends_is_said_to_have_no_topic(between: Between):
    files = {**edited("tide_msgs/msg/Level.msg", ("metres", "fathoms")), CPP: "int main() {}\n"}
    files[PY] = files["harbour/harbour/horn.py"] = ""
    shown = impact_report.render_text(between(files))
    assert "      no topic of it is known\n" in shown


def test_changed_functions_of_which_nothing_goes_out_are_counted(between: Between):
    found = between(ROWS["a callback of which nothing goes out"].files)
    assert impact_report.summarize(found) == (
        "no change that message flow knows of; nothing known to be sent because of 1 changed function"
    )


def test_json_is_as_its_schema_says(between: Between):
    schema = json.loads(impact_report.render_schema())
    page = Path(__file__).parents[2] / "docs/impact.schema.json"
    assert page.read_text() == impact_report.render_schema(), "rosimpact impact --schema > docs/impact.schema.json"
    impact = between(ROWS["a condition"].files)
    document = json.loads(impact_report.render_json(ImpactResult(impact, "ws", "", "main", ()), "1.2"))
    jsonschema.validate(document, schema)
    (change,) = document["changes"]
    assert (change["kind"], change["line"], len(change["reaches"])) == ("condition", 13, 2)


def test_markdown(between: Between):
    shown = impact_report.render_markdown(between(ROWS["a condition"].files))
    assert shown.splitlines()[0] == "- condition tightened `/level` `gauge/src/gauge.cpp:13`: reaches /watch, /horn"


def test_calls_that_are_not_resolved_may_be_reached_too():
    effect = Effect("publish", "changed", "/wind", "talk", "talk.cpp", 1, ("/talk",), ("/wind",), "")
    impact = Impact((effect,), (), 3, 0, Coverage(5, 3, 0, 1))
    said = "0 nodes of 3 reached; 2 API calls not resolved, and may be reached too"
    assert impact_report.summarize(impact).endswith(said)
    resolved = Impact((effect,), (), 3, 0, Coverage(5, 5, 0, 1))
    assert impact_report.summarize(resolved).endswith("0 nodes of 3 reached")
