"""One dependency asked about: who provides it, in which version, since when, who uses it, and whether that is safe."""

from __future__ import annotations

from pathlib import Path

import pytest
from rosimpact.impact.analysis.why import NameOffer, WhyAnswer, find_answers, render_text

EXAMPLE = Path(__file__).parents[1] / "examples/ros2_ws"


@pytest.fixture(autouse=True)
def _cache(cache, monkeypatch):
    monkeypatch.setenv("ROSIMPACT_CACHE", str(cache))


@pytest.mark.parametrize(
    ("name", "kind", "what", "provider"),
    [
        ("cv_bridge", "package", "package", "cv_bridge"),
        ("porter_msgs", "package", "workspace", "porter_msgs"),
        ("libopencv-dev", "rosdep key", "key", "libopencv-dev"),
        ("OpenCV", "CMake package", "key", "libopencv-dev"),
        ("cv_bridge/cv_bridge.hpp", "header", "package", "cv_bridge"),
        ("opencv2/core.hpp", "header", "key", "libopencv-dev"),
        ("porter_vision/marker_detector.hpp", "header", "workspace", "porter_vision"),
        ("vector", "header", "system", ""),
        ("yaml", "Python module", "key", "python3-yaml"),
        ("rclpy.node", "Python module", "package", "rclpy"),
        ("ament_python_install_package", "CMake command", "package", "ament_cmake_python"),
        ("rclcpp::rclcpp", "CMake target", "package", "rclcpp"),
    ],
)
def test_who_provides_a_name(name, kind, what, provider):
    found = find_answers(name, EXAMPLE, ("jazzy",))
    offers = [offer for answer in found if answer.as_what == kind for offer in answer.offers]
    assert (what, provider) in {(offer.kind, offer.name) for offer in offers}


@pytest.mark.parametrize(
    ("name", "target", "kind", "since"),
    [
        # It came with 0.25.10, two years and more after the distro; to Jazzy with 0.36.6.
        ("tf2/LinearMath/Vector3.hpp", "humble", "package", "2025-01-21"),
        ("tf2/LinearMath/Vector3.hpp", "humble@2024-03-01", "absent", ""),
        ("tf2/LinearMath/Vector3.h", "humble", "package", "2022-04-20"),
        # The command went with 2.8.5; one that stays is there.
        ("ament_target_dependencies", "lyrical", "absent", ""),
        ("ament_export_dependencies", "lyrical", "package", "2026-04-29"),
    ],
)
def test_since_when_a_version_has_a_name(name, target, kind, since):
    (answer,) = find_answers(name, None, (target,))
    assert [(offer.kind, offer.since) for offer in answer.offers] == [(kind, since)]


@pytest.mark.parametrize(
    ("target", "platform", "said"),
    [
        ("humble", "", "; what its files hold is judged by debian bullseye (1.11.1) and debian bookworm (1.13.0), where"
                       " they agree"),
        ("jazzy", "", "; what its files hold is judged by debian bookworm (1.13.0) and debian trixie (1.15.0), where"
                      " they agree"),
        # No release before Ubuntu 20.04 was read.
        ("noetic", "", "; what its files hold is judged by debian bullseye (1.11.1), a later release"),
        # Debian stands for itself.
        ("jazzy", 'platform = "debian trixie"', ""),
    ],
)  # fmt: skip
def test_which_releases_of_debian_stand_for_one_of_ubuntu(target, platform, said, tmp_path):
    (tmp_path / "package.xml").write_text(PACKAGE_OF_TWO)
    (tmp_path / "rosimpact.toml").write_text(f'[targets.mine]\ndistro = "{target}"\n{platform}')
    (answer,) = find_answers("libpcl-all-dev", tmp_path, ("mine",))
    assert [offer.note for offer in answer.offers] == [f"apt: libpcl-dev{said}"]


PACKAGE_OF_TWO = """<package format="2"><name>pool</name><version>1.0.0</version><description>pool</description>
<maintainer email="robots@example.org">Robots</maintainer><license>Apache-2.0</license>
<buildtool_depend>catkin</buildtool_depend><exec_depend>python3-scipy</exec_depend></package>
"""


def test_a_key_that_brings_another_one_is_not_used_where_that_is(tmp_path):
    (tmp_path / "package.xml").write_text(PACKAGE_OF_TWO)
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.0.2)\nproject(pool)\nfind_package(catkin REQUIRED)\ncatkin_package()\n"
        "catkin_install_python(PROGRAMS swim DESTINATION lib)\n"
    )
    (tmp_path / "swim").write_text("#!/usr/bin/env python3\nimport numpy\nimport scipy\n")
    used = {key: find_answers(key, tmp_path, ("noetic",))[0].used for key in ("python3-scipy", "python3-numpy")}
    assert used == {"python3-scipy": ("swim:3", "package.xml:3"), "python3-numpy": ("swim:2",)}


def test_a_command_of_cmake_is_used_where_it_is_called(tmp_path):
    (tmp_path / "package.xml").write_text(PACKAGE_OF_TWO.replace("catkin", "ament_cmake"))
    (tmp_path / "CMakeLists.txt").write_text(
        "cmake_minimum_required(VERSION 3.8)\nproject(pool)\nfind_package(ament_cmake REQUIRED)\n"
        "AMENT_TARGET_DEPENDENCIES(pool rclcpp)\nament_package()\n"
    )
    (answer,) = find_answers("ament_target_dependencies", tmp_path, ("jazzy",))
    assert (answer.as_what, answer.used) == ("CMake command", ("CMakeLists.txt:4",))
    (answer,) = find_answers("ament_export_targets", tmp_path, ("jazzy",))
    assert (answer.as_what, answer.used) == ("CMake command", ())


def test_one_answer_for_each_target():
    found = find_answers("cv_bridge", EXAMPLE, ("humble", "jazzy"))
    versions = {answer.target: answer.offers[0].version for answer in found if answer.as_what == "package"}
    assert versions["humble"].startswith("3.") and versions["jazzy"].startswith("4.")
    assert {answer.offers[0].since[:4] for answer in found if answer.as_what == "package"} == {"2022", "2024"}


def test_what_is_assumed_of_the_build_farm_is_said(tmp_path):
    """A version that was given for a machine is there; of what a distro names it is not known whether it was built."""
    (tmp_path / "rosimpact.toml").write_text('[targets.dock]\ndistro = "jazzy"\nversions = { cv_bridge = "4.2.0" }\n')
    (tmp_path / "package.xml").write_text(PACKAGE_OF_TWO)
    notes = {
        name: [offer.note for answer in find_answers(name, tmp_path, ("dock",)) for offer in answer.offers]
        for name in ("cv_bridge", "image_geometry")
    }
    assert set(notes["cv_bridge"]) == {""}
    assert set(notes["image_geometry"]) == {"taken to be built for ubuntu noble"}


def test_a_package_that_is_gone_says_where_it_was_last():
    (offer,) = find_answers("turtlesim", EXAMPLE, ("jazzy",))[0].offers
    assert offer.kind == "package"
    found = find_answers("actionlib", EXAMPLE, ("jazzy",))
    assert all(offer.kind == "absent" for answer in found for offer in answer.offers)


def test_a_name_that_nobody_knows():
    (answer,) = find_answers("nobody_has_this", EXAMPLE, ("jazzy",))
    assert answer.offers == () and answer.used == ()


def test_uses_and_whether_they_are_safe():
    (answer, *_) = find_answers("cv_bridge", EXAMPLE, ("jazzy",))
    assert "src/porter_vision/package.xml:12" in answer.used and answer.undeclared == ()
    undeclared = find_answers("teleop_twist_joy", EXAMPLE, ("jazzy",)) + find_answers(
        "v4l2_camera", EXAMPLE, ("jazzy",)
    )
    assert any("porter_bringup" in answer.undeclared for answer in undeclared)


def test_a_package_is_not_safe_whose_change_breaks_a_use():
    (answer, *_) = find_answers("message_filters", EXAMPLE, ("rolling",))
    places = {line.split(": ")[0] for line in answer.findings if "[changed-signature]" in line}
    assert places == {"src/porter_vision/src/marker_node.cpp:35", "src/porter_vision/src/marker_node.cpp:36"}


def answer(what: str, *offers: NameOffer, used=(), undeclared=(), changes=(), findings=()) -> WhyAnswer:
    return WhyAnswer("jazzy", what, offers, used, undeclared, changes, findings)


PACKAGE = NameOffer("package", "cv_bridge", "4.1.0", "2024-04-19", "")


@pytest.mark.parametrize(
    ("found", "expected"),
    [
        ([], ""),
        ([answer("name")], "on jazzy: `x` as name\n  nobody is known to provide it there\nused at 0 places"),
        (
            [answer("package", PACKAGE), answer("header", PACKAGE)],
            "on jazzy: `x` as package, header\n  package cv_bridge  4.1.0  since 2024-04-19\nused at 0 places",
        ),
        (
            [answer("package", PACKAGE, used=("a/b.cpp:1",), undeclared=("a",), changes=("c",))],
            "on jazzy: `x` as package\n  package cv_bridge  4.1.0  since 2024-04-19\n  c\n"
            "used at 1 place:\n  a/b.cpp:1\n"
            "not safe: used and not declared in a",
        ),
        (
            [answer("package", PACKAGE, used=tuple(f"a.cpp:{n}" for n in range(1, 15)))],
            "on jazzy: `x` as package\n  package cv_bridge  4.1.0  since 2024-04-19\nused at 14 places:\n"
            + "".join(f"  a.cpp:{n}\n" for n in range(1, 13))
            + "  and 2 more\n"
            "safe: every package that uses it declares it, or something that brings it, "
            "and check reports nothing on it",
        ),
        (
            [answer("header", PACKAGE, used=("a.cpp:1",), findings=("a.cpp:1: error: gone [removed-header]",))],
            "on jazzy: `x` as header\n  package cv_bridge  4.1.0  since 2024-04-19\nused at 1 place:\n  a.cpp:1\n"
            "not safe: check reports 1 finding on it:\n  a.cpp:1: error: gone [removed-header]",
        ),
    ],
)
def test_answers_as_text(found, expected):
    assert render_text("x", found) == expected


def test_what_is_recognised_as_a_workspace(tmp_path, monkeypatch):
    from rosimpact.impact.analysis.why import is_workspace

    assert not is_workspace(tmp_path)
    (tmp_path / "src/a/b").mkdir(parents=True)
    (tmp_path / "src/a/b/package.xml").touch()
    assert is_workspace(tmp_path)
    monkeypatch.setenv("HOME", str(tmp_path))
    assert not is_workspace(tmp_path), "all of a home folder would be read"
