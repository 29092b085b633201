"""The report for a terminal, as a person reads it."""

import io
import subprocess
import sys

import pytest
from rosimpact.impact.analysis.report import AnalysisCoverage, ReportedTarget, locate_subject, measure
from rosimpact.impact.report import text
from rosimpact.impact.report.style import PLAIN, choose_style
from rosimpact.impact.rules.rule import Finding

TEAM = """\
targets humble (2026-08-22, ubuntu jammy), jazzy (2026-08-22, ubuntu noble), rolling (2026-08-22, ubuntu noble), \
robot (humble, 2026-08-22, ubuntu jammy): rosimpact.toml

package localizer · src/localizer

error[removed-header] jazzy, rolling: `tf2_geometry_msgs/tf2_geometry_msgs.h` is gone in tf2_geometry_msgs \
0.36.2 (jazzy), 0.41.0 (rolling)
  → src/localizer/src/node.cpp:2:11
  2 | #include <tf2_geometry_msgs/tf2_geometry_msgs.h>
    |           ^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^^
  help: include `tf2_geometry_msgs/tf2_geometry_msgs.hpp`, present on every target asked for

warning[undeclared-package] all targets: `cv_bridge` is included and not declared
  → src/localizer/src/node.cpp:3:11
  3 | #include <cv_bridge/cv_bridge.h>
    |           ^^^^^^^^^
  help: add `<depend>cv_bridge</depend>` to `src/localizer/package.xml`

package planner · src/planner

error[library-version] robot: `find_package(OpenCV 4.6)` asks for more than opencv 4.5.4
  → src/planner/CMakeLists.txt:2:14
  2 | find_package(OpenCV 4.6 REQUIRED)
    |              ^^^^^^
  help: ask for `4.5`, which every target asked for has

                    humble  jazzy  rolling  robot
  localizer         ! 1     ✗ 1    ✗ 1      ! 1
  planner           ·       ·      ·        ✗ 1
  3 other packages  ·       ·      ·        ·

2 errors, 1 warning, 1 note (shown with --notes) · 5 packages, 40 of 41 files read, unresolved: 3 includes, 1 topic \
· 0.42 s
"""


def test_team(team):
    assert text.render(team) == TEAM


def test_further_packages_of_a_cause_are_named(team):
    more = [each._replace(also=tuple("abcdef")) for each in team.findings]
    told = text.render(team._replace(findings=more))
    assert told.count("  and in 6 other packages: a, b, c, d, e, ...\n") == 3
    wrong = next(each for each in more if each.severity == "error")
    one = text.render(team._replace(findings=[wrong._replace(also=("dock",))]))
    assert "  and in 1 other package: dock\n" in one


def test_ascii_where_the_stream_is_ascii(team):
    style = choose_style(io.TextIOWrapper(io.BytesIO(), encoding="ascii"))
    assert text.render(team, style).isascii()


def test_quiet(quiet):
    assert text.render(quiet).splitlines()[1:] == [
        "",
        "nothing found · 5 packages, 40 of 41 files read, unresolved: 3 includes, 1 topic · 0.42 s",
    ]


def last(report, **style):
    return text.render(report, PLAIN._replace(**style)).splitlines()[-1]


def test_the_last_line_tells_what_is_not_shown(team):
    first, *rest = team.findings
    report = team._replace(
        findings=(first._replace(new=False), *rest), base="v1.0", suppressed=(first,), known=(first,)
    )
    assert last(report).startswith("2 errors, 1 warning, 1 older · 1 suppressed · 1 in the baseline · 5 packages")
    assert "(new against v1.0)" in text.render(report).splitlines()[0]


@pytest.mark.parametrize(
    ("changes", "start"),
    [
        ({"coverage": AnalysisCoverage()}, "nothing was analysed · 0 packages"),
        ({"failure": "`x` is no folder\nof yours"}, "failed: `x` is no folder\\nof yours · "),
        ({"coverage": AnalysisCoverage(1, 3, 3)}, "nothing found · 1 package, all of 3 files read · "),
    ],
)
def test_summary(quiet, changes, start):
    assert last(quiet._replace(**changes)).startswith(start)


def test_what_has_no_place_has_no_line_for_it(quiet):
    finding = Finding("r", "error", "", "", 0, 0, "x", (), "nothing is there", "add it")
    lines = text.render(quiet._replace(findings=(finding,))).splitlines()
    assert lines[4:6] == ["error[r]: nothing is there", "  help: add it"]


def test_notes_are_shown_when_asked_for(team):
    lines = text.render(team, PLAIN._replace(severities=("error", "warning", "note")))
    assert "note[unused-dependency] all targets: `tf2` is declared and not used" in lines
    assert lines.splitlines()[-1].startswith("2 errors, 1 warning, 1 note · ")


def test_notes_about_targets_follow_the_first_line(quiet):
    target = ReportedTarget("humble", "humble", "2022-05-23", "ubuntu jammy", "--target", ("date moved to 2022-05-23",))
    assert text.render(quiet._replace(targets=(target,))).splitlines()[:2] == [
        "targets humble (2022-05-23, ubuntu jammy): --target",
        "  humble: date moved to 2022-05-23",
    ]


def test_an_equal_message_is_shown_once_with_its_places(quiet):
    findings = tuple(
        Finding("r", "error", "ui", f"src/ui/{number}.cpp", 1, 0, "x", ("jazzy",), "`x` is gone") for number in range(9)
    )
    lines = text.render(quiet._replace(findings=findings)).splitlines()
    assert lines[4:7] == [
        "error[r] jazzy: `x` is gone",
        "  → src/ui/0.cpp:1",
        "  and 8 more places: src/ui/1.cpp:1, src/ui/2.cpp:1, src/ui/3.cpp:1, src/ui/4.cpp:1, src/ui/5.cpp:1, ...",
    ]
    assert [line for line in lines if "✗" in line] == ["  ui                ·       ✗ 1    ·        ·"]
    assert lines[-1].startswith("1 error in 9 places · ")
    text_of_three = text.render(quiet._replace(findings=findings[:3]))
    assert "\n  and 2 more places: src/ui/1.cpp:1, src/ui/2.cpp:1\n" in text_of_three


def test_a_warning_has_the_places_of_its_notes(quiet):
    def make(path, severity, message="`x` will go"):
        return Finding("r", severity, "ui", path, 1, 0, "x", ("jazzy",), message)

    found = (make("a.cpp", "note"), make("b.cpp", "warning"), make("c.cpp", "note"), make("d.cpp", "note", "other"))
    lines = text.render(quiet._replace(findings=found)).splitlines()
    assert lines[4:7] == ["warning[r] jazzy: `x` will go", "  → b.cpp:1", "  and 2 more places: a.cpp:1, c.cpp:1"]
    assert lines[-1].startswith("1 warning in 3 places, 1 note (shown with --notes) · ")
    # What fails is told for itself.
    lines = text.render(quiet._replace(findings=(make("a.cpp", "error"), *found[1:3]))).splitlines()
    assert lines[-1].startswith("1 error, 1 warning in 2 places · ")


def test_each_package_has_its_own_cause(quiet):
    findings = tuple(Finding("r", "error", p, f"{p}/a.cpp", n, 0, "x", (), "`x` is gone") for p in "ab" for n in (1, 2))
    lines = text.render(quiet._replace(findings=findings)).splitlines()
    assert lines.count("error[r]: `x` is gone") == 2
    assert lines[-1].startswith("2 errors in 4 places · ")


def test_what_is_listed_stands_before_what_is_milder(quiet):
    errors = [Finding("r", "error", "ui", f"{n}.cpp", 1, 0, "x", ("jazzy",), "`x` is gone") for n in range(5)]
    warning = Finding("s", "warning", "ui", "0.cpp", 1, 0, "y", ("jazzy",), "`y` may go")
    lines = text.render(quiet._replace(findings=(warning, *errors))).splitlines()
    assert [line for line in lines if line.startswith(("error", "warning"))] == [
        "error[r] jazzy: `x` is gone", "warning[s] jazzy: `y` may go"]  # fmt: skip


def test_nothing_of_the_workspace_reaches_the_terminal_raw(hostile):
    output = text.render(hostile)
    assert not set(output) & set("\x1b\x07\u202e\u2028\r\udcff")
    assert not any(line.startswith("::") for line in output.splitlines())
    output.encode()


# (line, column, subject, (start, width))
POINTED = [
    ("#include <a/b.h>", 11, "a/b.h", (10, 5)),
    ("#include <a/b.h>", 10, "a/b.h", (10, 5)),
    ("find_package(foo)", 14, "bar", (13, 3)),
    ("  <depend>x</depend>", 0, "x", (10, 1)),
    ("  <depend>x</depend>", 0, "y", (0, 0)),
    ("abc", 9, "abc", (0, 0)),
    ("", 1, "x", (0, 0)),
    ("x = (1)", 5, "q", (4, 1)),
    ("a b a b", 7, "b", (6, 1)),
    ("#include <pcap.h>  // <", 10, "libpcap", (9, 8)),
    ('#include "a/b.h"', 10, "c", (9, 7)),
    ("'$(find arm)/arm.xacro' -x", 2, "arm_urdf", (1, 21)),
    ("add_executable(${PROJECT_NAME}_map map.cpp)", 16, "map", (15, 19)),
    ("a <b", 3, "q", (2, 1)),
]


@pytest.mark.parametrize(("line", "column", "subject", "expected"), POINTED)
def test_pointed(line, column, subject, expected):
    assert locate_subject(line, column, subject)[1:] == expected


@pytest.mark.parametrize(
    ("line", "column"),
    [("\tfoo(x);", 6), ("名前 = x", 6), ("e\u0301 = x", 6), ("x" * 500 + " x", 502), ("  " * 200 + "x", 401)],
)
def test_the_caret_stands_under_the_subject_whatever_is_before_it(quiet, line, column):
    finding = Finding("r", "error", "ui", "a.cpp", 1, column, "x", ("jazzy",), "m")
    report = quiet._replace(findings=(finding,), excerpt=lambda path, number: [line])
    rows = text.render(report, PLAIN._replace(width=80)).splitlines()
    caret = next(index for index, row in enumerate(rows) if set(row.strip()) == set("| ^"))
    shown, under = rows[caret - 1], rows[caret]
    offset = under.index("^")
    before = next(end for end in range(len(shown)) if measure(shown[:end]) == offset and shown[end : end + 1] == "x")
    assert shown[before] == "x"
    assert measure(shown) <= 80


class Terminal(io.StringIO):
    encoding = "UTF-8"  # type: ignore[assignment]

    def isatty(self):
        return True


@pytest.mark.parametrize(
    ("stream", "environment", "coloured"),
    [
        (Terminal(), {}, True),
        (Terminal(), {"NO_COLOR": "1"}, False),
        (Terminal(), {"TERM": "dumb"}, False),
        (io.StringIO(), {}, False),
        (io.StringIO(), {"FORCE_COLOR": "1"}, True),
    ],
)
def test_colour_only_for_a_terminal(team, monkeypatch, stream, environment, coloured):
    for name in ("NO_COLOR", "FORCE_COLOR"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("TERM", "xterm")
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    assert ("\x1b[" in text.render(team, choose_style(stream))) is coloured


def test_the_text_report_loads_nothing_heavy():
    code = "import sys, rosimpact.impact.report.text; print({'rich', 'typer', 'yaml', 'joblib'} & set(sys.modules))"
    heavy = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout
    assert heavy == "set()\n"
