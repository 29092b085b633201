"""What a person writes after --target, and what stands when nothing is written."""

import os
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.config import Config
from rosimpact.impact.targets.distro.known import list_known_distros
from rosimpact.impact.targets.resolve import (
    TargetError,
    choose_targets,
    parse_dpkg,
    parse_image,
    parse_target,
)
from rosimpact.impact.tree import WorkingTree

DISTROS = list_known_distros()
CONFIG = Config(
    path=Path("rosimpact.toml"),
    targets={
        "robot": {"distro": "humble", "date": "2025-06-01", "platform": "Ubuntu 22.04", "versions": {"opencv": "4.9"}},
        "lab": {"distro": "jazzy@2025-01-01"},
        "odd": {"distro": "humble", "colour": "red"},
        "lost": {"distro": "humbel"},
    },
)

TEXTS = [
    # text, distro, date, platform
    ("jazzy", "jazzy", None, "ubuntu noble"),
    (" jazzy ", "jazzy", None, "ubuntu noble"),
    ("humble@2024-03-01", "humble", "2024-03-01", "ubuntu jammy"),
    ("robot", "humble", "2025-06-01", "ubuntu jammy"),
    ("robot@2024-01-01", "humble", "2024-01-01", "ubuntu jammy"),
    ("lab", "jazzy", "2025-01-01", "ubuntu noble"),
    ("docker:osrf/ros:humble-desktop", "humble", None, "ubuntu jammy"),
    ("docker:ros:noetic-ros-base-focal", "noetic", None, "ubuntu focal"),
    ("docker:ros:noetic-ros-base-buster", "noetic", None, "debian buster"),
]


@pytest.mark.parametrize(("text", "distro", "date", "platform"), TEXTS)
def test_a_text_gives_a_target(text, distro, date, platform):
    found = parse_target(text, CONFIG)
    assert (found.distro, found.platform, found.name) == (distro, platform, text.strip())
    assert date is None or found.date == date


TABLES = [
    ({"platform": "ubuntu nobel"}, "unknown platform `ubuntu nobel`; did you mean `noble`?"),
    ({"platform": "nobel"}, "unknown platform `nobel`; did you mean `noble`?"),
    ({"platform": "ubunto 24.04"}, "unknown platform `ubunto 24.04`; did you mean `ubuntu`?"),
    ({"platform": "solaris"}, "unknown platform `solaris`; known systems: alpine, "),
    ({"versions": {"opencvv": "4.9"}}, "`versions` has an unknown name `opencvv`; did you mean `opencv`?"),
    ({"versions": {"nav2_costmap2d": "1.3"}}, "an unknown name `nav2_costmap2d`; did you mean `nav2_costmap_2d`?"),
    ({"versions": {"\x1b[1m": "1"}}, "; a ROS package or a platform library is meant"),
    ({"platform": "ubuntu 25.10"}, ""),
    ({"platform": "Debian sid"}, ""),
    ({"platform": "fedora 41"}, ""),
    ({"platform": "conda-forge"}, ""),
    ({"platform": "robostack"}, ""),
    ({"versions": {"OpenCV": "4.9", "qt5": "5.15", "nav2_costmap_2d": "1.3"}}, ""),
]


@pytest.mark.parametrize(("table", "expected"), TABLES)
def test_a_table_with_names_that_nobody_knows_is_an_error(table, expected):
    config = Config(targets={"robot": {"distro": "jazzy", **table}})
    if not expected:
        assert parse_target("robot", config).name == "robot"
        return
    with pytest.raises(TargetError, match=re.escape(expected)) as raised:
        parse_target("robot", config)
    assert "[targets.robot]" in str(raised.value) and "\x1b" not in str(raised.value)


def test_a_configured_target_takes_its_versions():
    assert parse_target("robot", CONFIG).find_library("opencv") == "4.9"


ERRORS = [
    ("jazy", "did you mean `jazzy`"),
    ("robt", "did you mean `robot`"),
    ("nonsense", "Known distros: groovy, hydro"),
    ("nonsense", "Targets of rosimpact.toml: lab, lost, odd, robot"),
    ("", "Known distros"),
    ("humble@soon", "is no date"),
    ("humble@2024-99-99", "is no date"),
    ("docker:ubuntu:22.04", "tells no distro"),
    ("docker:", "tells no distro"),
    ("missing.json", "rosimpact env capture"),
    ("missing.dpkg.txt", "dpkg -l"),
    ("odd", "has no `colour`"),
    ("lost", "unknown distro `humbel`"),
]


@pytest.mark.parametrize(("text", "says"), ERRORS)
def test_an_error_says_what_is_known_or_to_do(text, says):
    with pytest.raises(TargetError, match=says.replace("(", r"\(")):
        parse_target(text, CONFIG)


@given(st.text(max_size=25))
def test_any_text_gives_a_target_or_a_target_error(text):
    try:
        assert parse_target(text, CONFIG).distro
    except TargetError as error:
        assert str(error)


IMAGES = [
    ("ros:humble", ("humble", None)),
    ("ros:humble-ros-base-jammy", ("humble", "ubuntu jammy")),
    ("osrf/ros:noetic-desktop-full", ("noetic", None)),
    ("ghcr.io/o/ci:5000-jazzy", ("jazzy", None)),
    ("registry:5000/team/ros2-iron:latest", ("iron", None)),
    ("rostooling/setup-ros-docker:ubuntu-jammy-ros-humble-ros-base-latest", ("humble", "ubuntu jammy")),
    ("moveit/moveit2:rolling-ci@sha256:0123", ("rolling", None)),
    ("ros", ("lyrical", None)),
    ("ros:latest", ("lyrical", None)),
    ("ubuntu:jammy", None),
    ("registry:5000/team/app", None),
    ("", None),
]


@pytest.mark.parametrize(("image", "expected"), IMAGES)
def test_a_docker_image_by_its_name(image, expected):
    assert parse_image(image, DISTROS) == expected


LISTING = """\
Desired=Unknown/Install/Remove/Purge/Hold
||/ Name                    Version                              Architecture Description
+++-=======================-====================================-============-===========
ii  cmake                   3.22.1-1ubuntu1.22.04.2              amd64        make
ii  libopencv-dev           4.5.4+dfsg-9ubuntu4                  amd64        headers
hi  libc6:amd64             2.35-0ubuntu3.8                      amd64        held
rc  libboost-dev            1.74.0.3ubuntu7                      amd64        removed
ii  ros-humble-cv-bridge    3.2.1-1jammy.20240217.071034         amd64        bridge
ii  ros-humble-rclcpp       16.0.8-1jammy.20240217.064242        amd64        client library
"""


def test_a_dpkg_listing_holds_what_is_installed():
    assert [(row.name, row.version) for row in parse_dpkg(LISTING)][:3] == [
        ("cmake", "3.22.1-1ubuntu1.22.04.2"),
        ("libopencv-dev", "4.5.4+dfsg-9ubuntu4"),
        ("libc6", "2.35-0ubuntu3.8"),
    ]
    assert "libboost-dev" not in [row.name for row in parse_dpkg(LISTING)]


@given(st.text())
def test_any_text_can_be_read_as_a_listing(text):
    assert all(row.name and row.version for row in parse_dpkg(text))


def test_a_dpkg_listing_is_a_target(tmp_path):
    (tmp_path / "robot.dpkg.txt").write_text(LISTING)
    found = parse_target("robot.dpkg.txt", None, tmp_path)
    assert (found.name, found.distro, found.date, found.platform) == ("robot", "humble", "2024-02-17", "ubuntu jammy")
    assert found.find_version("rclcpp") == "16.0.8"
    assert found.find_version("cv_bridge") == "3.2.1"
    assert found.find_library("opencv") == "4.5.4"


@pytest.mark.parametrize(
    ("text", "says"), [("", "lists no installed"), ("ii cmake 3.22 amd64 x", "no package of a ROS")]
)
def test_a_listing_without_ros_is_refused(tmp_path, text, says):
    (tmp_path / "x.dpkg.txt").write_text(text)
    with pytest.raises(TargetError, match=says):
        parse_target("x.dpkg.txt", None, tmp_path)


def test_asked_for_comes_first_then_the_configuration(tmp_path):
    (tmp_path / "Dockerfile").write_text("FROM ros:humble")
    tree = WorkingTree(tmp_path)
    asked = choose_targets(("jazzy", "robot", "jazzy"), CONFIG, 2, tree)
    assert [item.target.name for item in asked] == ["jazzy", "robot"]
    config = CONFIG._replace(default_targets=("lab",))
    chosen = choose_targets((), config, 2, tree)
    assert [(item.target.name, item.reason) for item in chosen] == [("lab", "named in rosimpact.toml")]


def test_build_stamps_of_no_day_do_not_count(tmp_path):
    rows = "".join(
        f"ii  ros-humble-{name}  1.2.3-1jammy.{stamp}  amd64  text\n"
        for name, stamp in (("a", "20240301.101010"), ("b", "29999999.101010"), ("c", "20249999.101010"))
    )
    (tmp_path / "robot.dpkg.txt").write_text(rows)
    assert parse_target("robot.dpkg.txt", folder=tmp_path).date == "2024-03-01"


@pytest.mark.parametrize("make", [os.mkfifo, os.mkdir, lambda path: path.symlink_to("/dev/zero")])
@pytest.mark.parametrize("name", ["robot.dpkg.txt", "robot.json"])
def test_a_file_that_is_none_is_not_opened(tmp_path, make, name):
    make(tmp_path / name)
    with pytest.raises(TargetError, match=name):
        parse_target(name, folder=tmp_path)


@pytest.mark.parametrize("key", ["date", "platform", "file", "versions"])
def test_numbers_that_cannot_be_written_are_no_texts(key):
    number = 16**9000
    table = {"distro": "jazzy", key: {"opencv": number} if key == "versions" else number}
    with pytest.raises(TargetError, match="must be texts"):
        parse_target("robot", Config(targets={"robot": table}))
