"""The command line: every command runs, formats are what they claim, the exit status is as documented."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import jsonschema
import pytest
from rosimpact.edges.version import __version__
from rosimpact.impact.rules.rule import load_rules

ROOT = Path(__file__).parents[1]
EXAMPLES = [ROOT / "examples/ros1_ws", ROOT / "examples/ros2_ws"]
MANIFEST = """<package format="3">
  <name>a</name><version>1.0.0</version><description>d</description>
  <maintainer email="a@b.org">a</maintainer><license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <depend>libopencv-dev</depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
CMAKE = "cmake_minimum_required(VERSION 3.8)\nproject(a)\nfind_package(ament_cmake REQUIRED)\n{}ament_package()\n"
ERROR = "find_package(OpenCV 9 REQUIRED)\n"


@pytest.fixture
def ws(tmp_path) -> Path:
    """One package with one error, whatever the target."""
    (tmp_path / "ws/a").mkdir(parents=True)
    (tmp_path / "ws/a/package.xml").write_text(MANIFEST)
    (tmp_path / "ws/a/CMakeLists.txt").write_text(CMAKE.format(ERROR))
    return tmp_path / "ws"


# -- check -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.name)
@pytest.mark.parametrize("format", ["text", "json", "sarif", "github", "markdown", "html"])
def test_every_format_on_the_examples(say, example, format):
    said = say("check", example, "--format", format)
    assert said.status == 1
    assert "cmake-version" in said.out or "library-version" in said.out or format == "markdown"
    if format in ("json", "sarif"):
        assert json.loads(said.out)
    assert said.err == ""


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.name)
def test_json_is_what_the_schema_says(say, example):
    schema = json.loads(say("check", "--schema").out)
    jsonschema.Draft202012Validator.check_schema(schema)
    report = json.loads(say("check", example, "--format", "json").out)
    jsonschema.validate(report, schema)
    assert report["tool"]["version"] == __version__
    assert [target["reason"] for target in report["targets"]] == ["named in rosimpact.toml"] * 3
    failed = json.loads(say("check", example / "nowhere", "--format", "json").out)
    jsonschema.validate(failed, schema)
    assert "nowhere" in failed["failure"]


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.name)
def test_findings_come_in_order(say, example):
    report = json.loads(say("check", example, "--format", "json").out)
    places = [(finding["path"], finding["line"], finding["column"]) for finding in report["findings"]]
    assert places == sorted(places) and len(places) > 2


def test_the_schema_in_the_documentation_is_the_one_that_is_printed(say):
    assert json.loads(say("check", "--schema").out) == json.loads((ROOT / "docs/findings.schema.json").read_text())


def test_the_first_line_says_which_targets_and_why(say, ws):
    said = say("check", ws, "-t", "humble", "-t", "jazzy")
    assert said.out.splitlines()[0].startswith("targets humble (") and said.out.splitlines()[0].endswith(": asked for")
    (ws / "Dockerfile").write_text("FROM ros:jazzy\n")
    assert "jazzy" in (first := say("check", ws).out.splitlines()[0]) and "Dockerfile" in first


@pytest.mark.parametrize(
    ("arguments", "settings", "status"),
    [
        ((), "", 1),
        (("--fail-on", "never"), "", 0),
        (("--fail-on", "error"), "", 1),
        (("--fail-on", "note"), "", 1),
        ((), "fail_on = 'never'", 0),
        (("--fail-on", "error"), "fail_on = 'never'", 1),
        (("--ignore", "library-version"), "", 0),
        (("--ignore", "versions"), "", 0),
        (("--select", "packages"), "", 0),
        (("--select", "library-version,packages"), "", 1),
        (("--select", "all", "--ignore", "versions"), "", 0),
        ((), "ignore = ['library-version']", 0),
        (("--ignore", "packages"), "ignore = ['library-version']", 1),
        ((), "severity = { library-version = 'warning' }", 0),
        (("--fail-on", "warning"), "severity = { library-version = 'warning' }", 1),
        (("--fail-on", "warning"), "severity = { library-version = 'note' }", 0),
        ((), "severity = { versions = 'off' }", 0),
        ((), "severity = { all = 'note' }\n[paths.'a/**']\nseverity = { library-version = 'error' }", 1),
        ((), "[paths.'a/**']\nignore = ['all']", 0),
        ((), "[paths.'b/**']\nignore = ['all']", 1),
    ],
)
def test_exit_status(say, ws, arguments, settings, status):
    (ws / "rosimpact.toml").write_text(f"[check]\ntargets = ['jazzy']\n{settings}\n")
    assert say("check", ws, *arguments).status == status


def test_output_goes_to_a_file(say, ws, tmp_path):
    said = say("check", ws, "-t", "jazzy", "--format", "json", "--output", tmp_path / "new/folder/report.json")
    assert said.out == "" and said.status == 1
    assert json.loads((tmp_path / "new/folder/report.json").read_text())["findings"]
    said = say("check", ws, "-t", "jazzy", "-o", tmp_path / "report.txt")
    assert said.out == "" and "error[library-version]" in (tmp_path / "report.txt").read_text()


def test_a_failure_goes_to_the_file_too(say, ws, tmp_path):
    said = say("check", ws, "-t", "gutsy", "--format", "json", "--output", tmp_path / "report.json")
    assert said.status == 2 and "gutsy" in said.err
    assert "gutsy" in json.loads((tmp_path / "report.json").read_text())["failure"]


def test_notes_are_shown_when_asked_for(say, ws):
    (ws / "a/CMakeLists.txt").write_text(CMAKE.format("# rosimpact: allow(removed-header)\n"))
    assert "note[unused-suppression]" not in say("check", ws, "-t", "jazzy").out
    assert "note[unused-suppression]" in say("check", ws, "-t", "jazzy", "--notes").out


def test_annotations_carry_the_path_from_the_repository_and_the_summary_is_written(say, ws, tmp_path, monkeypatch):
    monkeypatch.setenv("GITHUB_WORKSPACE", str(tmp_path))
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(tmp_path / "summary.md"))
    said = say("check", ws, "-t", "jazzy", "--format", "github")
    assert "::error file=ws/a/CMakeLists.txt," in said.out
    assert (
        "library-version" in (tmp_path / "summary.md").read_text() or "OpenCV" in (tmp_path / "summary.md").read_text()
    )
    monkeypatch.setenv("GITHUB_WORKSPACE", str(tmp_path / "elsewhere"))
    assert "::error file=a/CMakeLists.txt," in say("check", ws, "-t", "jazzy", "--format", "github").out


def test_a_baseline(say, ws, tmp_path):
    known = tmp_path / "known.json"
    said = say("check", ws, "-t", "jazzy", "--write-baseline", known)
    assert said.status == 0 and said.out == "" and "1 finding" in said.err
    said = say("check", ws, "-t", "jazzy", "--baseline", known)
    assert said.status == 0 and "in the baseline" in said.out

    (ws / "a/CMakeLists.txt").write_text(CMAKE.format("# moved down\n" + ERROR + "find_package(Boost 9.9 REQUIRED)\n"))
    said = say("check", ws, "-t", "jazzy", "--baseline", known, "--format", "json")
    assert said.status == 1
    fresh = {finding["subject"] for finding in json.loads(said.out)["findings"]}
    assert "Boost" in fresh and "OpenCV" not in fresh

    # writing with a baseline at hand keeps what it knows
    say("check", ws, "-t", "jazzy", "--baseline", known, "--write-baseline", known)
    assert {"Boost", "OpenCV"} <= {entry["subject"] for entry in json.loads(known.read_text())["findings"]}


def test_pruning_a_baseline_removes_fixed_findings_and_adds_nothing(say, ws, tmp_path):
    known = tmp_path / "known.json"
    say("check", ws, "-t", "jazzy", "--write-baseline", known)
    (ws / "a/CMakeLists.txt").write_text(CMAKE.format("find_package(Boost 9.9 REQUIRED)\n"))
    said = say("check", ws, "-t", "jazzy", "--baseline", known, "--prune-baseline")
    assert said.status == 1 and "1 fixed, removed" in said.err
    assert "OpenCV" not in known.read_text() and "Boost" not in known.read_text()


def test_nothing_analysed_leaves_the_baseline_alone(say, tmp_path):
    known = tmp_path / "known.json"
    known.write_text("{}")
    (tmp_path / "empty").mkdir()
    assert say("check", tmp_path / "empty", "--write-baseline", known).status == 2
    assert known.read_text() == "{}"


@pytest.fixture
def curable(ws, monkeypatch):
    """A rule whose finding is fixed by declaring a dependency."""
    from rosimpact.impact.model.cmake.build import At
    from rosimpact.impact.rules import rule as registry
    from rosimpact.impact.rules.fix_actions import Declare
    from rosimpact.impact.rules.rule import Diagnostic
    from rosimpact.impact.rules.text import Text

    def lacks(view):
        for package in view:
            if "rclcpp" not in package.declared:
                fix = (Declare(package.linked.manifest_path, "rclcpp"),)
                yield Diagnostic(At(package.linked.manifest_path, 1), "rclcpp", package.name, fix=fix)

    # Content of its own: what the shipped rules said of the same files is remembered, and must not be mixed with this.
    (ws / "a/CMakeLists.txt").write_text(CMAKE.format(ERROR + "# curable\n"))
    rule = load_rules()["undeclared-package"]
    rule = rule._replace(run=lacks, texts={"": Text("not declared", "declare it")})
    monkeypatch.setitem(registry._RULES, "undeclared-package", rule)
    return ws


def test_fixes_are_printed_as_a_patch(say, curable):
    said = say("check", curable, "-t", "jazzy", "--diff")
    assert said.status == 1
    assert "+  <depend>rclcpp</depend>" in said.out and "--- a/a/package.xml" in said.out
    assert (curable / "a/package.xml").read_text() == MANIFEST


@pytest.mark.parametrize(("folder", "listed"), [("third_party/a", False), ("a", True), ("src/Vendor/own/a", False)])
def test_other_peoples_code_is_reported_and_not_fixed(say, curable, folder, listed):
    inner = curable / "moved"
    (curable / "a").rename(inner)
    (curable / folder).parent.mkdir(parents=True, exist_ok=True)
    inner.rename(curable / folder)
    if listed:
        (curable / ".gitmodules").write_text('[submodule "a"]\n\tpath = a\n\turl = ../a.git\n')
    said = say("check", curable, "-t", "jazzy", "--diff")
    assert said.status == 1
    assert said.out == ""


def test_fixes_are_written_and_what_remains_is_reported(say, curable):
    said = say("check", curable, "-t", "jazzy", "--fix")
    assert "1 file changed" in said.err
    assert (curable / "a/package.xml").read_text() == MANIFEST.replace(
        "<depend>libopencv-dev</depend>", "<depend>libopencv-dev</depend>\n  <depend>rclcpp</depend>"
    )
    assert said.status == 1 and "library-version" in said.out and "undeclared-package" not in said.out
    assert "0 files changed" in say("check", curable, "-t", "jazzy", "--fix").err


def test_a_fix_that_cannot_be_written_is_named(say, curable, monkeypatch):
    from rosimpact.impact.analysis import fix

    def denied(root, path, data, original):
        raise PermissionError(13, "Permission denied", path)

    monkeypatch.setattr(fix, "write", denied)
    said = say("check", curable, "-t", "jazzy", "--fix")
    assert said.status == 2
    assert "a/package.xml" in said.err and "Permission denied" in said.err
    assert "undeclared-package" in said.out


def test_a_file_that_changed_since_it_was_read_is_not_fixed(say, curable, monkeypatch):
    from rosimpact.impact.analysis import fix

    write, manifest = fix.write, curable / "a/package.xml"
    edited = MANIFEST.replace("</package>", "  <!-- edited -->\n</package>")

    def late(*arguments):
        manifest.write_text(edited)
        write(*arguments)

    monkeypatch.setattr(fix, "write", late)
    said = say("check", curable, "-t", "jazzy", "--fix")
    assert said.status == 2 and "a/package.xml: not fixed: changed since it was read" in said.err
    assert manifest.read_text() == edited


def test_a_package_that_is_a_link_is_not_fixed(say, curable, tmp_path):
    """Whether a link is followed or not: what it leads to stays as it is."""
    outside = tmp_path / "elsewhere"
    (curable / "a").rename(outside)
    (curable / "a").symlink_to(outside)
    say("check", curable, "-t", "jazzy", "--fix")
    assert (outside / "package.xml").read_text() == MANIFEST
    (curable / "a").unlink()
    outside.rename(curable / "a")
    (curable / "b").symlink_to("a")
    said = say("check", curable, "-t", "jazzy", "--fix")
    assert "1 file changed" in said.err and (curable / "b").is_symlink()
    assert (curable / "a/package.xml").read_text().count("rclcpp") == 1


def test_a_manifest_that_is_a_link_is_not_fixed(say, curable, tmp_path):
    outside = tmp_path / "elsewhere.xml"
    (curable / "a/package.xml").rename(outside)
    (curable / "a/package.xml").symlink_to(outside)
    say("check", curable, "-t", "jazzy", "--fix")
    assert outside.read_text() == MANIFEST and (curable / "a/package.xml").is_symlink()


def test_a_manifest_of_two_names_is_fixed_under_one(say, curable, tmp_path):
    os.link(curable / "a/package.xml", tmp_path / "other name")
    assert "1 file changed" in say("check", curable, "-t", "jazzy", "--fix").err
    assert (tmp_path / "other name").read_text() == MANIFEST
    assert "rclcpp" in (curable / "a/package.xml").read_text()


@pytest.fixture
def refusing(ws, tmp_path):
    """What a hostile repository puts in the way of reports."""
    (tmp_path / "outside").mkdir()
    (tmp_path / "outside/secret").write_text("keep")
    (ws / ".git").mkdir()
    (ws / ".git/config").write_text("keep")
    (ws / "reports").symlink_to(tmp_path / "outside")
    (ws / "report.json").symlink_to(tmp_path / "outside/secret")
    (ws / "history").symlink_to(".git")
    os.mkfifo(ws / "pipe")
    return ws


@pytest.mark.parametrize("option", ["--output", "--write-baseline"])
@pytest.mark.parametrize("name", [".git/config", "report.json", "reports/secret", "reports/new", "history/config",
                                  "pipe", "a", "a/", "/proc/version", "a/package.xml/x", "x" * 5000, ""])  # fmt: skip
def test_outputs_are_refused_before_the_work(say, refusing, tmp_path, monkeypatch, option, name):
    from rosimpact.impact.cli import check as command

    monkeypatch.setattr(command, "run_check", lambda *_: pytest.fail("the work was begun"))
    monkeypatch.chdir(refusing)
    for place in (name, refusing / name) if name and len(name) < 200 else (name,):
        said = say("check", ".", "-t", "jazzy", option, place)
        assert said.status == 2 and "cannot be written" in said.err and len(said.err.splitlines()) == 1
    assert os.listdir(tmp_path / "outside") == ["secret"]
    assert (tmp_path / "outside/secret").read_text() == (refusing / ".git/config").read_text() == "keep"


@pytest.mark.parametrize("command", [["check", "-t", "jazzy"], ["graph"], ["logic"], ["impact", "--base", "HEAD"],
                                     ["upgrade", "--from", "humble", "--to", "jazzy"]])  # fmt: skip
def test_no_command_writes_through_a_link(say, refusing, tmp_path, command):
    name, *options = command
    for place in ("report.json", "reports/new"):
        said = say(name, refusing, *options, "-o", refusing / place)
        assert said.status == 2 and "cannot be written" in said.err
    assert os.listdir(tmp_path / "outside") == ["secret"]
    assert (tmp_path / "outside/secret").read_text() == "keep"


def test_links_of_the_user_lead_to_reports(say, ws, tmp_path):
    (tmp_path / "disk").mkdir()
    (tmp_path / "mine").symlink_to("disk")
    assert say("check", ws, "-t", "jazzy", "-o", tmp_path / "mine/new/report.txt").status == 1
    assert "library-version" in (tmp_path / "disk/new/report.txt").read_text()


def test_a_report_may_go_to_a_descriptor(say, ws):
    for place in ("/dev/stdout", "/dev/fd/1"):
        assert json.loads(say("check", ws, "-t", "jazzy", "-f", "json", "-o", place).out)["findings"]
    assert say("check", ws, "-t", "jazzy", "-f", "json", "-o", "/dev/null").out == ""


@pytest.mark.parametrize("name", ["link", "pipe", "folder", "no/folder"])
def test_a_summary_that_cannot_be_written_hides_no_report(say, ws, tmp_path, monkeypatch, name):
    (tmp_path / "victim").write_text("keep")
    (tmp_path / "link").symlink_to("victim")
    (tmp_path / "folder").mkdir()
    os.mkfifo(tmp_path / "pipe")
    monkeypatch.setenv("GITHUB_STEP_SUMMARY", str(tmp_path / name))
    said = say("check", ws, "-t", "jazzy", "-f", "github")
    assert said.status == 1 and "::error" in said.out and "the step summary cannot be written" in said.err
    assert (tmp_path / "victim").read_text() == "keep"


def test_findings_known_to_the_baseline_are_not_fixed(say, curable, tmp_path):
    say("check", curable, "-t", "jazzy", "--write-baseline", tmp_path / "known.json")
    assert say("check", curable, "-t", "jazzy", "--baseline", tmp_path / "known.json", "--diff").out == ""


# -- the other commands ------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("rule", sorted(load_rules()))
def test_explain(say, rule):
    said = say("explain", rule)
    assert said.status == 0 and said.out.startswith(f"{rule}: ")


def test_explain_says_what_is_assumed_of_the_build_farm(say):
    said = " ".join(say("explain", "unreleased-package").out.split())
    assert "Assumed is that whatever the distro names at its last sync can be installed from its archive" in said


def test_explain_lists_the_rules_and_knows_no_others(say):
    listed = say("explain").out
    assert all(f"  {rule} " in listed for rule in load_rules())
    said = say("explain", "removed-haeder")
    assert said.status == 2 and "did you mean `removed-header`" in said.err


def test_explain_knows_families(say):
    said = say("explain", "qos")
    assert said.status == 0
    assert said.out.startswith("qos: a family of rules.\n\nThe name stands for\n")
    assert "did you mean `packages`?" in say("explain", "pakages").err


def test_an_unknown_name_to_select_gets_the_nearest_and_all_families(say, tmp_path):
    families = "families are api, general, graph, interfaces, logic, packages, qos, sources, values, versions"
    said = say("check", tmp_path, "--select", "zzzz")
    assert (said.status, said.err.partition("; ")[2]) == (2, families + "\n")
    said = say("check", tmp_path, "--select", "grpah")
    assert said.err.partition("; ")[2] == f"did you mean `graph`? {families}\n"


def test_explain_knows_groups(say):
    assert "  changed-constant           changed-constant, removed-constant\n" in say("explain").out
    said = say("explain", "changed-constant").out
    assert said.startswith("changed-constant: ") and "\nThe name also stands for\n    removed-constant: " in said


def test_why_of_no_name(say):
    said = say("why", "", ROOT / "examples/ros2_ws")
    assert said.status == 2 and "no name was given" in said.err


def test_why(say):
    example = ROOT / "examples/ros2_ws"
    said = say("why", "cv_bridge", example, "--target", "jazzy")
    assert said.status == 0
    assert "jazzy: `cv_bridge` as package" in said.out and "src/porter_vision/package.xml:12" in said.out
    # The package is there and declared, but not the header that is included.
    assert said.out.splitlines()[-2] == "not safe: check reports 1 finding on it:"
    rows = json.loads(say("why", "cv_bridge", example, "--target", "jazzy", "--format", "json").out)
    assert rows[0]["offers"][0]["version"].startswith("4.")
    said = say("why", "nobody_has_this", example, "--target", "jazzy")
    assert said.status == 1 and "nobody is known to provide it" in said.out
    assert say("why", "x", example, "--target", "gutsy").status == 2


def test_env_capture_is_a_target(say, ws, tmp_path, monkeypatch):
    monkeypatch.setenv("ROS_DISTRO", "jazzy")
    said = say("env", "capture", "-o", tmp_path / "envs/laptop.json")
    assert said.status == 0 and "--target" in said.err
    assert json.loads((tmp_path / "envs/laptop.json").read_text())["distro"] == "jazzy"
    said = say("check", ws, "--target", tmp_path / "envs/laptop.json", "--format", "json")
    assert said.status == 1 and json.loads(said.out)["targets"][0]["name"] == "laptop"
    (tmp_path / "file").touch()
    assert say("env", "capture", "-o", tmp_path / "file/x.json").status == 2


def test_data_status(say):
    said = say("data", "status")
    assert said.status == 0 and "distro data of 20" in said.out and "ros/rosdistro" in said.out
    assert json.loads(say("data", "status", "--format", "json").out)["updated"] is False


def test_data_build_names_what_is_no_repository(say, tmp_path):
    said = say("data", "build", tmp_path, "-o", tmp_path / "out", "--work", tmp_path / "work")
    assert said.status == 2 and str(tmp_path) in said.err


def test_version_is_that_of_the_distribution(say):
    from importlib.metadata import version

    assert say("--version").out.strip() == f"rosimpact {version('rosimpact')}"


def test_help_loads_nothing_heavy():
    code = (
        "import sys; from rosimpact.impact.cli.app import main; sys.argv = ['rosimpact', '--help']\n"
        "try: main()\nexcept SystemExit: pass\n"
        "print(*sorted(m for m in sys.modules if m.split('.')[0] in "
        "{'yaml', 'rich', 'pygit2', 'catkin_pkg', 'joblib', 'sqlite3', 'msgspec', 'requests'}))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert "Usage: rosimpact" in run.stdout
    assert run.stdout.splitlines()[-1] == ""


def test_a_check_loads_no_more_than_it_needs(ws, cache):
    code = (
        "import sys; from rosimpact.impact.analysis.check import check, Options\n"
        f"check({str(ws)!r}, Options(targets=('jazzy',)))\ncheck({str(ws)!r}, Options(targets=('jazzy',)))\n"
        "print(*sorted(m for m in ('rich', 'pygit2', 'joblib', 'requests', 'github', 'sklearn') if m in sys.modules))"
    )
    environment = {**os.environ, "ROSIMPACT_CACHE": str(cache)}
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment)
    assert run.stdout == "\n"


def test_a_reader_that_has_read_enough_is_no_error(ws, cache):
    command = f"{sys.executable} -m rosimpact.impact.cli check {ws} -t jazzy --format html | head -c 10"
    environment = {**os.environ, "ROSIMPACT_CACHE": str(cache)}
    run = subprocess.run(command, shell=True, capture_output=True, text=True, env=environment)
    assert run.stderr == ""
