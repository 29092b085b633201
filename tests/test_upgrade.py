"""`rosimpact upgrade`: a small workspace on the distro that it leaves and on the one that it moves to."""

from __future__ import annotations

import json
import shlex
import subprocess
from pathlib import Path

import jsonschema
import pytest
from rosimpact.impact.analysis.findings import group_items
from rosimpact.impact.analysis.target_compare import compare_findings
from rosimpact.impact.rules.rule import Finding

ROOT = Path(__file__).parents[1]
MANIFEST = """<package format="3">
  <name>{}</name><version>1.0.0</version><description>d</description>
  <maintainer email="a@b.org">a</maintainer><license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
{}  <export><build_type>ament_cmake</build_type></export>
</package>
"""
CMAKE = """cmake_minimum_required(VERSION 3.8)
project({})
find_package(ament_cmake REQUIRED)
{}ament_package()
"""
# On kilted: cv_bridge.h is gone, moved by the name alone, the executor is deprecated. OpenCV 9 is nowhere.
IMAGES = "#include <cv_bridge/cv_bridge.h>\n"
EXECUTOR = "#include <rclcpp/rclcpp.hpp>\nrclcpp::executors::StaticSingleThreadedExecutor spin;\n"


def package(name: str, *depends: str, cmake: str = "", **sources: str) -> dict[str, str]:
    """Files of a package that builds its sources. sources: text by name, without the end."""
    found = "".join(f"find_package({each} REQUIRED)\n" for each in depends)
    built = f"add_library({name} {' '.join(f'src/{each}.cpp' for each in sources)})\n" if sources else ""
    if built and depends:
        linked = " ".join(f"{each}::{each}" for each in depends if each != "zoom")
        built += f"target_link_libraries({name} {linked})\n"
    if built:
        built += f"install(TARGETS {name} DESTINATION lib)\n"
    declared = "".join(f"  <depend>{each}</depend>\n" for each in depends)
    return {
        f"{name}/package.xml": MANIFEST.format(name, declared),
        f"{name}/CMakeLists.txt": CMAKE.format(name, found + cmake + built),
        **{f"{name}/src/{each}.cpp": text for each, text in sources.items()},
    }


def written(folder: Path, *packages: dict[str, str]) -> Path:
    for files in packages:
        for name, text in files.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text)
    return folder


@pytest.fixture
def ws(tmp_path) -> Path:
    """`arm` needs `zoom`; both break on kilted, `lid` on every distro, `wheel` on none."""
    lid = package("lid", cmake="find_package(OpenCV 9 REQUIRED)\n")
    lid["lid/package.xml"] = lid["lid/package.xml"].replace(
        "  <export>", "  <depend>libopencv-dev</depend>\n  <export>"
    )
    return written(
        tmp_path / "ws",
        lid,
        package("arm", "zoom", "cv_bridge", "rclcpp", look=IMAGES, run=EXECUTOR),
        package("zoom", "cv_bridge", near=IMAGES, far="\n" + IMAGES),
        package("wheel", "rclcpp", turn="#include <rclcpp/rclcpp.hpp>\n"),
    )


def work(report: dict) -> list[tuple[str, str, str, list[str]]]:
    return [
        (step["package"], item["rule"], item["subject"], [f"{f['path']}:{f['line']}" for f in item["findings"]])
        for step in report["work"]
        for item in step["items"]
    ]


def test_the_verdict_comes_first_and_the_work_in_build_order(say, ws):
    said = say("upgrade", ws, "--from", "humble", "--to", "kilted")
    assert (said.status, said.err) == (1, "")
    lines = said.out.splitlines()
    assert lines[0] == "humble → kilted breaks 2 of 4 packages: 2 errors to fix, in 3 places"
    assert lines[1] == f"  2 of 2 items can be fixed: rosimpact check {ws} --target kilted --fix"
    titles = [line for line in lines if " of 2: " in line]
    assert titles == ["1 of 2: zoom", "2 of 2: arm"]
    first = lines[lines.index("1 of 2: zoom") : lines.index("2 of 2: arm")]
    assert any("`cv_bridge/cv_bridge.h` is not available" in line and line.endswith("[fixable]") for line in first)
    assert [line for line in first if "→" in line] == ["  → zoom/src/far.cpp:2:10"]
    assert "  and 1 more place: zoom/src/near.cpp:1" in first
    assert "  help: include `cv_bridge/cv_bridge.hpp`" in first
    assert "deprecated on kilted" in lines and "StaticSingleThreadedExecutor` is deprecated" in said.out
    assert "OpenCV" not in said.out, "what is broken on both is counted alone"
    assert f"1 error already on humble: rosimpact check {ws} --target humble lists it" in lines[-1]


def test_what_it_says_can_be_fixed_is_fixed_by_the_command_it_names(say, ws):
    command = next(
        line.partition("fixed: ")[2]
        for line in say("upgrade", ws, "--from", "humble", "--to", "kilted").out.splitlines()
        if "fixed: " in line
    )
    assert say(*shlex.split(command)[1:]).status == 1, "OpenCV 9 is nowhere"
    said = say("upgrade", ws, "--from", "humble", "--to", "kilted")
    assert said.status == 0
    assert said.out.splitlines()[0] == "humble → kilted: no new break in 4 packages; 1 error already on humble"
    assert "error of humble is" not in said.out and "can be fixed" not in said.out


def test_json_is_what_the_schema_says(say, ws):
    schema = json.loads(say("upgrade", "--schema").out)
    jsonschema.Draft202012Validator.check_schema(schema)
    assert schema == json.loads((ROOT / "docs/upgrade.schema.json").read_text()), (
        "rosimpact upgrade --schema > docs/upgrade.schema.json"
    )
    report = json.loads(say("upgrade", ws, "--from", "humble", "--to", "kilted", "-f", "json").out)
    jsonschema.validate(report, schema)
    assert report["schema"] == 1
    assert (report["from"]["distro"], report["to"]["distro"]) == ("humble", "kilted")
    header = "cv_bridge/cv_bridge.h"
    assert work(report) == [
        ("zoom", "removed-header", header, ["zoom/src/far.cpp:2", "zoom/src/near.cpp:1"]),
        ("arm", "removed-header", header, ["arm/src/look.cpp:1"]),
    ]
    assert [(s["package"], [i["rule"] for i in s["items"]]) for s in report["deprecations"]] == [
        ("arm", ["deprecated-name"])
    ]
    assert report["verdict"] == {
        "safe": False, "packages": 2, "errors": 2, "warnings": 0, "places": 3,
        "text": "humble → kilted breaks 2 of 4 packages: 2 errors to fix, in 3 places",
    }  # fmt: skip
    assert report["fix"]["items"] == 2 and report["work"][0]["items"][0]["fixable"] == 2
    assert report["both"] == {"error": 1, "warning": 0, "note": 0}


def test_each_side_is_what_check_says_of_it_alone(say, ws):
    def found(target: str) -> dict[tuple, dict]:
        report = json.loads(say("check", ws, "--target", target, "-f", "json").out)
        every = [f for f in report["findings"] if f["severity"] != "note"]
        return {(f["rule"], f["package"], f["path"], f["line"], f["subject"]): f for f in every}

    report = json.loads(say("upgrade", ws, "--from", "humble", "--to", "kilted", "-f", "json").out)
    said = [f for step in report["work"] for item in step["items"] for f in item["findings"]]
    humble, kilted = found("humble"), found("kilted")
    expected = [f for key, f in kilted.items() if key not in humble]
    assert sorted(said, key=str) == sorted(expected, key=str) and len(said) == 3


@pytest.mark.parametrize(
    ("arguments", "status"),
    [
        (("--to", "humble@2024-03-01"), 0),
        (("--to", "kilted"), 1),
        (("--to", "kilted", "--fail-on", "never"), 0),
        (("--to", "kilted", "--packages", "wheel,lid"), 0),
        (("--to", "kilted", "--packages", "zoom"), 1),
        (("--to", "kilted", "--packages", "wheel", "--fail-on", "note"), 0),
        (("--to", "iron", "--packages", "zoom"), 0),
        (("--to", "iron", "--packages", "zoom", "--fail-on", "note"), 1),
    ],
)
def test_the_exit_status(say, ws, arguments, status):
    assert say("upgrade", ws, "--from", "humble", *arguments).status == status


def test_an_error_about_all_packages_counts_for_each(say, ws):
    said = say("upgrade", ws, "--from", "humble", "--to", "noetic")
    assert said.out.splitlines()[0] == "humble → noetic breaks 4 of 4 packages: 1 error to fix, in 1 place"
    said = say("upgrade", ws, "--from", "humble", "--to", "noetic", "--packages", "zoom")
    assert said.out.splitlines()[0] == "humble → noetic breaks 1 of 1 package: 1 error to fix, in 1 place"
    assert say("check", ws, "--target", "noetic").out.count("  ✗ 1\n") == 4


def test_packages_with_warnings_alone_are_counted_beside_those_that_break(say, tmp_path):
    ws = written(tmp_path / "ws", package("a") | package("b"))
    for name, depend in (("a", "test_depend"), ("b", "depend")):
        manifest = ws / name / "package.xml"
        text = manifest.read_text().replace("  <export>", f"  <{depend}>gazebo_ros</{depend}>\n  <export>")
        manifest.write_text(text)
    said = say("upgrade", ws, "--from", "humble", "--to", "jazzy").out.splitlines()[0]
    assert said == (
        "humble → jazzy breaks 1 of 2 packages and may break 1 more: 1 error and 1 warning to fix, in 2 places"
    )


def test_a_warning_fails_when_asked_to(say, tmp_path):
    ws = written(tmp_path / "ws", package("a"))
    manifest = ws / "a/package.xml"
    manifest.write_text(
        manifest.read_text().replace("  <export>", "  <test_depend>gazebo_ros</test_depend>\n  <export>")
    )
    asked = ("upgrade", ws, "--from", "humble", "--to", "jazzy")
    said = say(*asked)
    assert said.out.splitlines()[0] == "humble → jazzy may break 1 of 1 package: 1 warning to fix, in 1 place"
    assert said.status == 0
    assert say(*asked, "--fail-on", "warning").status == 1


def test_only_packages_that_were_asked_for(say, ws):
    said = say("upgrade", ws, "--from", "humble", "--to", "kilted", "--packages", "zoom")
    assert said.out.splitlines()[0] == "humble → kilted breaks 1 of 1 package: 1 error to fix, in 2 places"
    assert "arm" not in said.out.replace(str(ws), "")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--from", "humble", "--to", "humble"), "humble and humble are the same target; give two"),
        (("--from", "humble", "--to", "gutsy"), "gutsy"),
        (("--from", "humble", "--to", "jazzy", "--packages", "boat"), "boat: the workspace has no such package"),
        (("--from", "humble", "--to", "jazzy", "-f", "sarif"), "choose one of text, json, html"),
        (("--from", "humble", "--to", "jazzy", "--fail-on", "noise"), "choose one of error, warning, note, never"),
    ],
)  # fmt: skip
def test_what_cannot_be_done_is_told_in_a_line(say, ws, arguments, words):
    said = say("upgrade", ws, *arguments)
    assert said.status == 2 and said.out == ""
    assert words in said.err and len(said.err.splitlines()) == 1


@pytest.mark.parametrize(
    ("include", "verdict"),
    [
        ("<vector>", "humble → jazzy is safe: no known break in 1 package"),
        ('"zoom/own.h"', "humble → jazzy: no known break in 1 package; 1 cmake, 1 include unresolved"),
    ],
)
def test_safe_is_only_what_was_resolved(say, tmp_path, include, verdict):
    private = ("zoom",) if "zoom" in include else ()
    ws = written(tmp_path / "ws", package("a", "rclcpp", *private, run=f"#include {include}\n"))
    asked = ("upgrade", ws, "--from", "humble", "--to", "jazzy")
    assert say(*asked).out.splitlines()[0] == verdict
    assert json.loads(say(*asked, "-f", "json").out)["verdict"]["safe"] == ("is safe" in verdict)


def test_a_folder_without_packages_is_no_upgrade(say, tmp_path):
    said = say("upgrade", tmp_path, "--from", "humble", "--to", "jazzy")
    assert said.status == 2 and "no package was found" in said.err


def test_named_machines_and_a_revision(say, ws):
    """Two names of rosimpact.toml; the files of a commit, which cannot be fixed in place."""
    (ws / "rosimpact.toml").write_text('[targets.laptop]\ndistro = "humble"\n[targets.robot]\ndistro = "kilted"\n')
    git = ["git", "-c", "user.name=a", "-c", "user.email=a@b.org", "-c", "init.defaultBranch=main"]
    for arguments in (["init"], ["add", "-A"], ["commit", "-m", "first"]):
        subprocess.run([*git, *arguments], cwd=ws, check=True, capture_output=True)
    (ws / "zoom/src/near.cpp").write_text("\n")
    asked = ("upgrade", ws, "--from", "laptop", "--to", "robot")
    assert "2 errors to fix, in 2 places" in say(*asked).out
    said = say(*asked, "--rev", "HEAD")
    assert said.out.startswith("laptop → robot breaks 2 of 4 packages: 2 errors to fix, in 3 places")
    assert f"rosimpact check {ws} --target robot --rev HEAD --diff" in said.out


def test_a_configuration_that_lies_elsewhere(say, ws, tmp_path):
    config = tmp_path / "ours.toml"
    config.write_text(
        '[targets.old]\ndistro = "humble"\n[targets.next]\ndistro = "kilted"\n[check]\nfail_on = "never"\n'
    )
    said = say("upgrade", ws, "--from", "old", "--to", "next", "--config", config)
    assert said.status == 0, "the configuration says what fails"
    assert said.out.startswith("old → next breaks 2 of 4 packages")
    assert f"rosimpact check {ws} --target next --config {config} --fix" in said.out


def test_the_output_in_the_documentation_is_real(say, monkeypatch):
    """Run the command and paste what it prints when this fails; only the seconds may differ."""
    page = (ROOT / "docs/upgrade.md").read_text(encoding="utf-8")
    command, shown = page.partition("```console\n$ ")[2].partition("\n```")[0].split("\n", 1)
    monkeypatch.chdir(ROOT)
    said = say(*command.split()[1:])
    assert said.out.rpartition(" · ")[0] == shown.rpartition(" · ")[0]


# -- the comparison ----------------------------------------------------------------------------------------------------


def finding(
    severity: str = "error", subject: str = "x.h", line: int = 1, package: str = "a", rule: str = "r"
) -> Finding:
    return Finding(rule, severity, package, f"{package}.cpp", line, 1, subject, (), f"{subject} is gone")


@pytest.mark.parametrize(
    ("other", "new"),
    [
        ([], True),
        ([finding()], False),
        ([finding("warning")], True),
        ([finding("warning"), finding()], False),
        ([finding(line=2)], True),
        ([finding(subject="y.h")], True),
        ([finding(rule="s")], True),
        ([finding(package="b")], True),
    ],
)
def test_a_finding_is_new_unless_the_other_side_has_it_as_gravely(other, new):
    assert [len(group) for group in compare_findings([finding()], other)] == ([1, 0] if new else [0, 1])


def undeclared(key: str, line: int = 1, used: str = "cv2") -> Finding:
    said = f"`{used}` is imported, but `a` does not depend on `{key}`"
    return Finding("undeclared-package", "warning", "a", "a/a.py", line, 8, key, (), said)


@pytest.mark.parametrize(
    ("now", "then", "new"),
    [
        ([undeclared("python3-opencv")], [undeclared("python-opencv")], 0),
        ([undeclared("python3-opencv"), undeclared("python3-numpy")], [undeclared("python-opencv")], 1),
        ([undeclared("python3-opencv")], [undeclared("python-opencv", line=2)], 1),
        ([undeclared("python3-opencv")], [undeclared("python-opencv", used="cv")], 1),
        ([undeclared("b"), undeclared("a")], [undeclared("a")], 1),
    ],
)
def test_a_subject_that_has_another_name_there_is_the_same_fault(now, then, new):
    assert len(compare_findings(now, then).new) == new


def test_one_cause_in_a_package_is_one_item():
    found = [finding(line=3), finding("warning", line=1), finding(line=2, package="b"), finding(line=4, subject="y.h")]
    made = group_items(found, ["b", "a"])
    assert [(item.package, item.subject, item.severity, [f.line for f in item.findings]) for item in made] == [
        ("b", "x.h", "error", [2]),
        ("a", "x.h", "error", [3, 1]),
        ("a", "y.h", "error", [4]),
    ]


# -- the page ----------------------------------------------------------------------------------------------------------


def texts(browser, selector: str) -> list[str]:
    return browser.execute_script(
        "return [...document.querySelectorAll(arguments[0])].map((node) => node.textContent)", selector
    )


@pytest.fixture
def page(say, ws, tmp_path, opened):
    file = tmp_path / "upgrade.html"
    assert say("upgrade", ws, "--from", "humble", "--to", "kilted", "-f", "html", "-o", file).status == 1
    return lambda fragment="": opened(file.read_text(encoding="utf-8"), fragment)


def test_the_page_shows_the_work(page, ws):
    browser = page()
    assert texts(browser, "#verdict") == ["humble → kilted breaks 2 of 4 packages: 2 errors to fix, in 3 places"]
    assert texts(browser, "#command") == [f"rosimpact check {ws} --target kilted --fix"]
    assert [text.partition(" ")[0] for text in texts(browser, "#targets li")] == ["humble", "→", "kilted"]
    assert texts(browser, "#list h2") == ["zoom1 of 2 · 1 error", "arm2 of 2 · 1 error", "Deprecated on kilted", "arm"]
    assert texts(browser, "#list .badge") == ["error", "error", "deprecated"]
    assert texts(browser, "#list .can") == ["fixable", "fixable"]
    assert texts(browser, "#list mark")[:2] == ["cv_bridge/cv_bridge.h"] * 2
    assert browser.get_log("browser") == []


def test_further_places_are_unfolded(page):
    browser = page()
    assert texts(browser, "#list .place")[:2] == ["zoom/src/far.cpp:2:10", "arm/src/look.cpp:1:10"]
    browser.find_element("css selector", "#list details.places summary").click()
    # A browser tells that something was unfolded when it next has time.
    wait = pytest.importorskip("selenium.webdriver.support.ui").WebDriverWait(browser, 60)
    assert wait.until(lambda _: texts(browser, "#list details.places .place")) == ["zoom/src/near.cpp:1:10"]


@pytest.mark.parametrize(
    ("fragment", "items"),
    [
        ("#package=%3Dzoom", ["error"]),
        ("#deprecated=0", ["error", "error"]),
        ("#byhand=1", ["deprecated"]),
        ("#search=look.cpp", ["error"]),
        ("#rule=deprecated-name", ["deprecated"]),
        ("#search=%3Cscript%3E", []),
    ],
)
def test_filters_live_in_the_address(page, fragment, items):
    browser = page(fragment)
    assert texts(browser, "#list .badge") == items
    assert texts(browser, "#count") == [f"{len(items)} of 3 items"]
    browser.refresh()
    assert texts(browser, "#list .badge") == items


def test_hostile_text_stays_text(say, tmp_path, opened):
    name = "<img src=x onerror=window.hacked=1>"
    ws = written(tmp_path / name, package("a", "cv_bridge", look=IMAGES))
    (ws / "a/src/look.cpp").write_text(f"{IMAGES[:-1]}  // </script><script>window.hacked=1</script>{name}\n")
    browser = opened(say("upgrade", ws, "--from", "humble", "--to", "kilted", "-f", "html").out)
    assert browser.execute_script("return window.hacked") is None
    assert "onerror=window.hacked=1>" in texts(browser, "#list pre")[0]
    assert browser.get_log("browser") == []


def test_what_was_to_come_and_has_come_is_a_break(say, tmp_path):
    ws = written(tmp_path / "ws", package("a"))
    manifest = ws / "a/package.xml"
    manifest.write_text(
        manifest.read_text().replace("  <export>", "  <depend>gripper_controllers</depend>\n  <export>")
    )
    assert "will be removed" in say("check", ws, "--target", "jazzy").out
    said = say("upgrade", ws, "--from", "jazzy", "--to", "kilted")
    assert said.status == 1
    assert said.out.splitlines()[0] == "jazzy → kilted breaks 1 of 1 package: 1 error to fix, in 1 place"
