"""rosimpact surface: what a package offers, and what changed, from the command line."""

import json
import re
import subprocess

import pytest
from rosimpact.impact.cli.app import app
from rosimpact.impact.targets.distro.distro import DistroTarget
from typer.testing import CliRunner

MANIFEST = """<package format="3"><name>{name}</name><version>{version}</version><description>d</description>
<maintainer email="a@b.c">m</maintainer><license>l</license><buildtool_depend>ament_cmake</buildtool_depend>
<export><build_type>ament_cmake</build_type></export></package>"""
CMAKE = """cmake_minimum_required(VERSION 3.16)
project({name})
find_package(ament_cmake REQUIRED)
install(DIRECTORY include/ DESTINATION include)
ament_package()
"""
OLD = """namespace rclcpp {
class Node { public: void spin(int times = 1); int rate; [[deprecated("use spin")]] void turn(); };
void gone(const char * with_a_long_name, unsigned long and_another_long_name, double and_one_more);
}
"""
NEW = """namespace rclcpp {
class Node { public: void spin(int times, bool fast); void fresh(); [[deprecated("use spin")]] void turn(); };
}
"""


def git(folder, *arguments):
    identity = ("-c", "user.name=a", "-c", "user.email=a@b.c")
    subprocess.run(["git", "-C", str(folder), *identity, *arguments], check=True, capture_output=True)


@pytest.fixture
def repos(tmp_path, monkeypatch):
    """A folder with a clone of two releases of rclcpp."""
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path / "cache"))
    place = tmp_path / "clones" / "ros2+rclcpp"
    (place / "rclcpp/include/rclcpp").mkdir(parents=True)
    git(place, "init", "-q", "-b", "rolling")
    for tag, text in (("16.0.0", OLD), ("28.1.0", NEW)):
        (place / "rclcpp/package.xml").write_text(MANIFEST.format(name="rclcpp", version=tag))
        (place / "rclcpp/CMakeLists.txt").write_text(CMAKE.format(name="rclcpp"))
        (place / "rclcpp/include/rclcpp/node.hpp").write_text(text)
        git(place, "add", "-A")
        git(place, "commit", "-qm", "x")
        git(place, "tag", tag)
    git(place, "branch", "humble", "16.0.0")
    return place.parent


def run(*arguments):
    return CliRunner().invoke(app, ["surface", *map(str, arguments)])


def test_diff_as_text(repos):
    result = run("diff", "rclcpp", "16.0.0", "28.1.0", "--repos", repos)
    assert (result.exit_code, result.stdout) == (
        0,
        """package rclcpp 16.0.0 → 28.1.0
  16.0.0: 16.0.0 of ros2/rclcpp
  28.1.0: 28.1.0 of ros2/rclcpp

Breaking changes: 3
  in rclcpp/node.hpp
  removed field  rclcpp::Node::rate
    - int rclcpp::Node::rate
  signature method (arity)  rclcpp::Node::spin
    - void rclcpp::Node::spin(int times = 1)
    + void rclcpp::Node::spin(int times, bool fast)
  removed function  rclcpp::gone
    - void rclcpp::gone(const char* with_a_long_name, unsigned long and_another_long_name, double and_one_more)

New: 1 (1 method)

--all also lists additions and compatible changes
""",
    )


def test_a_line_fits_eighty_columns(repos, tmp_path):
    from rosimpact.databuild.surface.clones import Clone
    from rosimpact.databuild.surface.compare import RepositorySurfaces, compare_states
    from rosimpact.databuild.surface.report import SurfaceDifference, VersionSource, render_diff_text, show_text
    from rosimpact.impact.facts.store import Store
    from rosimpact.impact.report.style import PLAIN

    clone = Clone(repos / "ros2+rclcpp")
    with Store(tmp_path / "other") as store:
        old, new = (RepositorySurfaces(clone.read_surfaces(tag, store, 1)) for tag in ("16.0.0", "28.1.0"))
    source = VersionSource("16.0.0", "16.0.0", "ros2/rclcpp", "16.0.0")
    style = PLAIN._replace(width=80)
    told = render_diff_text(SurfaceDifference(source, source, compare_states(old, new)), style, True)
    shown = show_text(old.surfaces["rclcpp"], source, style, True)
    assert [line for line in (told + shown).splitlines() if len(line) > 80] == []
    assert "and_one_more" in told and "and_one_more" in shown


def test_diff_of_a_clone_as_json(repos):
    result = run("diff", repos / "ros2+rclcpp", "16.0.0", "rolling", "--format", "json")
    data = json.loads(result.stdout)
    assert [(c["package"], c["kind"], c["name"], c["breaks"]) for c in data["changes"]] == [
        ("rclcpp", "added", "rclcpp::Node::fresh", False),
        ("rclcpp", "removed", "rclcpp::Node::rate", True),
        ("rclcpp", "signature", "rclcpp::Node::spin", True),
        ("rclcpp", "removed", "rclcpp::gone", True),
    ]


def test_diff_as_markdown_says_what_is_approximate(repos):
    result = run("diff", "rclcpp", "humble", "28.1.0", "--repos", repos, "--format", "markdown")
    version = DistroTarget("humble").find_version("rclcpp")
    assert f"`humble` of ros2/rclcpp: {version} is not there." in result.stdout
    assert "| removed field | `rclcpp::Node::rate` | `int rclcpp::Node::rate` |  |" in result.stdout


def test_show(repos):
    result = run("show", "rclcpp@16.0.0", "--repos", repos, "--all")
    assert "    method  void rclcpp::Node::turn()  deprecated: use spin\n" in result.stdout
    data = json.loads(run("show", "rclcpp@16.0.0", "--repos", repos, "--format", "json").stdout)
    assert [(i["part"], i["what"], i["name"]) for i in data["items"]] == [
        ("C++", "header", "rclcpp/node.hpp"),
        ("C++", "class", "rclcpp::Node"),
        ("C++", "method", "rclcpp::Node::spin"),
        ("C++", "field", "rclcpp::Node::rate"),
        ("C++", "method", "rclcpp::Node::turn"),
        ("C++", "function", "rclcpp::gone"),
        ("CMake", "cmake package", "rclcpp"),
    ]


def test_without_clones_what_is_shipped_answers():
    result = run("diff", "rclcpp", "humble", "jazzy", "--all")
    assert result.exit_code == 0, result.stderr
    old, new = (DistroTarget(distro).find_version("rclcpp") for distro in ("humble", "jazzy"))
    assert result.stdout.startswith(f"package rclcpp {old} (humble) → {new} (jazzy)\n  humble: ")
    assert " of the shipped surfaces" in result.stdout.splitlines()[1]
    # Deprecated in Galactic for the one of rcpputils, and gone after Humble.
    assert "  removed header  rclcpp/scope_exit.hpp\n" in result.stdout
    assert "  header  rclcpp/scope_exit.hpp" in run("show", "rclcpp@humble").stdout
    assert "  header  rclcpp/scope_exit.hpp" not in run("show", f"rclcpp@{new}").stdout


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("diff", "rclcpp", "0.0.1", "humble"), "`rclcpp` 0.0.1 is not shipped, others from "),
        (("show", "rclcpp@noetic"), "noetic has no `rclcpp`; released in "),
        (("diff", "rclcpp", "16.0.0", "9.9.9", "--repos", "REPOS"), "has no tag for it"),
        (("diff", "REPOS/ros2+rclcpp", "16.0.0", "nowhere"), "nowhere"),
        (("diff", "REPOS/ros2+rclcpp", "16.0.0", "28.1.0", "--packages", "x"), "--packages x: "),
        (("diff", "rclcpp", "a", "b", "--format", "x"), "--format x: unknown; choose one of text, json, markdown"),
        (("show", "rclcpp", "--repos", "REPOS/none"), "no such folder"),
        (("show", "rclcpp@/opt/ros/nowhere"), "/opt/ros/nowhere: no such file or folder; give an installed prefix"),
        (("diff", "rclcpp", "/opt/ros/nowhere", "jazzy"), "/opt/ros/nowhere: no such file or folder"),
        (("diff", "/nowhere/rclcpp", "16.0.0", "28.1.0"), "/nowhere/rclcpp: no such folder; give a package"),
        (("show", "nothing_like_it", "--repos", "REPOS"), "no distro ever had `nothing_like_it`"),
    ],
)
def test_errors_are_one_line(repos, arguments, said):
    result = run(*(argument.replace("REPOS", str(repos)) for argument in arguments))
    assert result.exit_code == 2
    assert result.stderr.startswith("rosimpact: ") and result.stderr.count("\n") == 1
    assert said in result.stderr


def test_counts_of_kinds_are_plural():
    from rosimpact.databuild.surface.report import SurfaceDifference, VersionSource, render_diff_text
    from rosimpact.databuild.surface.version_change import VersionChange
    from rosimpact.impact.report.style import PLAIN
    from rosimpact.impact.targets.surface.changes import PARAMETER

    changes = tuple(VersionChange("arm", "build", "added", PARAMETER, name, breaks=False) for name in "ab")
    source = VersionSource("a", "1.0.0", "arm", "")
    shown = render_diff_text(SurfaceDifference(source, source, {"arm": changes}), PLAIN, False)
    assert "New: 2 (2 parameters of a node)" in shown


def test_hashes_of_messages():
    assert "\n  hash  std_msgs/msg/String  992ce8a1687cec8c8bd883ec73ca41d1\n" in run("show", "std_msgs@noetic").stdout
    # A version alone does not tell what other packages' messages were at that time.
    version = run("show", "std_msgs@noetic").stdout.split()[1]
    assert "PoseStamped  " not in run("show", f"geometry_msgs@{version}").stdout
    changed = run("diff", "sensor_msgs", "foxy", "jazzy", "--all").stdout
    assert re.search(r"wire interface  sensor_msgs/msg/Range\n +- RIHS01_9430\w+\n +\+ RIHS01_b42b\w+\n", changed)


def test_build(repos, tmp_path):
    from rosimpact.impact.targets.surface.store import Surfaces

    file = tmp_path / "surfaces.sqlite"
    result = run("build", "--distro", "humble", "--packages", "rclcpp", "--repos", repos, "-o", file, "--jobs", 1)
    assert result.exit_code == 0, result.stderr
    assert result.stdout.startswith(f"{file}: 1 package, 1 version, ")
    assert result.stdout.endswith("; 1 with a branch for a missing tag, 0 without a clone\n")
    assert Surfaces(file).find_history("rclcpp", 2).index_names()["rclcpp::Node"]


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--distro", "jazy"), "`jazy` is no distro; known are "),
        (("--distro", "noetic"), "no clone has a package asked for"),
        (("--distro", "humble", "--repos", "REPOS/none"), "no such folder"),
        (("--distro", "humble", "--dask", "127.0.0.1"), "--dask 127.0.0.1: missing port number"),
        (("--distro", "humble", "--dask", "127.0.0.1:8786", "--jobs", "2"), "give only one of the two"),
    ],
)
def test_errors_of_build_are_one_line(repos, tmp_path, arguments, said):
    given = (argument.replace("REPOS", str(repos)) for argument in arguments)
    result = run("build", "--repos", repos, "-o", tmp_path / "x.sqlite", "--packages", "rclcpp", *given)
    assert result.exit_code == 2
    assert said in result.stderr and result.stderr.count("\n") == 1
