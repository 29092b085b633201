"""Reports to render: a small team's workspace, one without findings, one full of hostile text."""

import pytest
from rosimpact.impact.analysis.findings import merge_diagnostics
from rosimpact.impact.analysis.report import AnalysisCoverage, Report, ReportedPackage, ReportedTarget, SourceLines
from rosimpact.impact.model.cmake.build import At
from rosimpact.impact.rules.fix_actions import Edit
from rosimpact.impact.rules.rule import Diagnostic, Rule
from rosimpact.impact.rules.severity import Doubt
from rosimpact.impact.rules.text import Text

FILES = {
    "src/localizer/src/node.cpp": b"""#include <rclcpp/rclcpp.hpp>
#include <tf2_geometry_msgs/tf2_geometry_msgs.h>
#include <cv_bridge/cv_bridge.h>

int main(int argc, char ** argv)
{
\trclcpp::init(argc, argv);
}
""",
    "src/localizer/package.xml": (
        b'<package format="3">\r\n  <depend>rclcpp</depend>\r\n  <depend>tf2</depend>\r\n</package>\r\n'
    ),
    "src/planner/CMakeLists.txt": b"cmake_minimum_required(VERSION 3.5)\nfind_package(OpenCV 4.6 REQUIRED)\n",
}

NAMES = ("humble", "jazzy", "rolling", "robot")
PLATFORMS = {"humble": "ubuntu jammy", "jazzy": "ubuntu noble", "rolling": "ubuntu noble", "robot": "ubuntu jammy"}

RULES = {
    name: Rule(
        name,
        family,
        severity,
        lambda: iter(()),
        f"{name}: {short}.\n\nWhat it does\n    {what}\n",
        texts={"": Text("{message}[[ {version}]]", "{help}")},
    )
    for name, family, severity, short, what in (
        ("removed-header", "api", "error", "an included header is gone on a target", "Reports `#include` lines."),
        ("undeclared-package", "packages", "error", "a package is used and not declared", "Reports uses."),
        ("library-version", "versions", "error", "a platform's library is too old", "Compares versions."),
        ("unused-dependency", "packages", "note", "a dependency is declared and not used", "Reports leftovers."),
    )
}


def said(at, subject, message, help="", package="", doubts=(), fix=(), version="") -> Diagnostic:
    data = {"message": message, "help": help, "version": version}
    return Diagnostic(at, subject, package, data, doubts=doubts, fix=fix)


def team_hits():
    node, manifest = "src/localizer/src/node.cpp", "src/localizer/package.xml"
    header = "tf2_geometry_msgs/tf2_geometry_msgs.h"
    for target, version in (("jazzy", "0.36.2"), ("rolling", "0.41.0")):
        yield (
            "removed-header",
            target,
            said(
                At(node, 2, 11),
                header,
                f"`{header}` is gone in tf2_geometry_msgs",
                f"include `{header}pp`, present on every target asked for",
                "localizer",
                version=version,
            ),
        )
    declare = (Edit(manifest, 49, 49, "\r\n  <depend>cv_bridge</depend>"),)
    for target in NAMES:
        yield (
            "undeclared-package",
            target,
            said(
                At(node, 3, 11),
                "cv_bridge",
                "`cv_bridge` is included and not declared",
                "add `<depend>cv_bridge</depend>` to `src/localizer/package.xml`",
                "localizer",
                (Doubt.LATE,),
                declare,
            ),
        )
    yield (
        "library-version",
        "robot",
        said(
            At("src/planner/CMakeLists.txt", 2, 14),
            "OpenCV",
            "`find_package(OpenCV 4.6)` asks for more than opencv 4.5.4",
            "ask for `4.5`, which every target asked for has",
            "planner",
        ),
    )
    yield "unused-dependency", "", said(At(manifest, 3, 11), "tf2", "`tf2` is declared and not used", "", "localizer")


def report_of(hits, files, names=NAMES, **changes) -> Report:
    sources = SourceLines(files.get)
    findings = merge_diagnostics(hits, targets=names, rules=RULES, line_text=sources.read_line)
    targets = tuple(
        ReportedTarget(name, "humble" if name == "robot" else name, "2026-08-22", PLATFORMS[name], "rosimpact.toml")
        for name in names
    )
    packages = tuple(ReportedPackage(name, f"src/{name}") for name in ("driver", "localizer", "msgs", "planner", "ui"))
    report = Report(
        version="0.1.0",
        data="2026-08-22",
        targets=targets,
        findings=tuple(findings),
        coverage=AnalysisCoverage(5, 41, 40, {"include": 3, "topic": 1}),
        packages=packages,
        rules=lambda: tuple(RULES.values()),
        seconds=0.42,
        excerpt=sources.read_excerpt,
    )
    return report._replace(**changes)


@pytest.fixture
def team() -> Report:
    """Five packages on four targets: an error on two, an error on one, a warning and a note on all."""
    return report_of(team_hits(), FILES)


@pytest.fixture
def quiet() -> Report:
    """The same workspace with nothing to say."""
    return report_of((), FILES)


PAYLOAD = "</script><script>window.hacked=1</script><img src=x onerror=window.hacked=1>`|](javascript:x)"


@pytest.fixture
def hostile() -> Report:
    """Paths, names and code that try to get out of every format: markup, line ends, escapes, bytes of no encoding."""
    path = f"src/{PAYLOAD}/a b:c,%0A::error::x\n::warning::y\x1b[2J\u202e\udcff.cpp"
    files = {path: f"// {PAYLOAD} \u2028 {{{{data}}}}\x1b]0;x\x07\t{PAYLOAD}\n".encode()}
    hits = [
        (
            "removed-header",
            "",
            said(At(path, 1, 4), PAYLOAD, f"{PAYLOAD}\n::error::z @team #1", f"{PAYLOAD} {{{{data}}}}", PAYLOAD),
        )
    ]
    return report_of(hits, files, root=PAYLOAD, base=PAYLOAD, failure="")


@pytest.fixture
def large() -> Report:
    """Five thousand findings in two hundred packages."""
    line = b"#include <some_package/some_header.hpp>  // a line of ordinary length\n"
    files = {f"src/p{number}/a.cpp": line * 30 for number in range(200)}
    hits = []
    for index in range(5000):
        package, header = f"p{index % 200}", f"h{index}.hpp"
        hit = said(At(f"src/{package}/a.cpp", index // 200 + 1, 11), header, f"`{header}` is gone", "", package)
        hits.append((list(RULES)[index % 4], NAMES[index % 3], hit))
    return report_of(hits, files)
