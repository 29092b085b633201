"""A machine as a target: read from commands and folders, written without names or paths, read back, compared."""

from __future__ import annotations

import getpass
import json
import os
import socket

import pytest
from rosimpact.impact.targets.capture import (
    CapturedMachine,
    capture,
    dump_capture,
    find_differences,
    load_capture,
    make_target,
    read,
    read_dpkg_rows,
    strip_version,
)
from rosimpact.impact.targets.distro.distro import DistroTarget, TargetError

DPKG = """ii \tros-humble-rclcpp\t16.0.8-1jammy.20240304.103405
ii \tros-humble-cv-bridge\t3.2.1-1jammy.20240304
ii \tros-humble-rclcpp-dbgsym\t16.0.8-1jammy
ii \tros-noetic-roscpp\t1.16.0-1focal
rc \tros-humble-gone\t1.0.0-1
ii \tlibopencv-dev:amd64\t4.5.4+dfsg-9ubuntu4
ii \tg++\t4:11.2.0-1ubuntu1
ii \tpython3\t3.10.6-1~22.04
ii \tbash\t5.1-6
un \tnothing\t
"""
MANIFEST = "<package><name>{}</name><version>{}</version></package>"


def machine_of(tmp_path, listing=DPKG, **environment):
    (tmp_path / "etc").mkdir(exist_ok=True)
    (tmp_path / "etc/os-release").write_text('ID=ubuntu\nVERSION_CODENAME=jammy\nHOME_URL="x"\n')
    answers = {"dpkg-query": listing, "g++": "11.4.0\n", "cmake": "cmake version 3.22.1\n", "clang": ""}
    return capture(lambda command: answers.get(command[0], ""), tmp_path, environment)


def test_a_machine(tmp_path):
    machine = machine_of(tmp_path)
    assert machine.distro == "humble" and machine.platform == "ubuntu jammy"
    assert machine.packages == {"cv_bridge": "3.2.1", "rclcpp": "16.0.8"}
    assert machine.libraries["opencv"] == "4.5.4" and machine.libraries["python3"] == "3.10.6"
    assert machine.libraries["gcc"] == "11.4.0" and machine.tools == {"cmake": "3.22.1", "gcc": "11.4.0"}
    assert "bash" not in machine.debian and "gone" not in machine.packages


def test_overlays_cover_what_is_installed(tmp_path):
    for prefix, version in (("opt/ros/humble", "16.0.8"), ("ws/install/rclcpp", "99.0.0"), ("under/install", "50.0.0")):
        folder = tmp_path / prefix / "share/rclcpp"
        folder.mkdir(parents=True)
        (folder / "package.xml").write_text(MANIFEST.format("rclcpp", version))
    overlaid = f"{tmp_path}/ws/install/rclcpp:{tmp_path}/under/install:{tmp_path}/nowhere"
    assert machine_of(tmp_path).packages["rclcpp"] == "16.0.8"
    assert machine_of(tmp_path, AMENT_PREFIX_PATH=overlaid).packages["rclcpp"] == "99.0.0"


@pytest.mark.parametrize(
    ("listing", "environment", "distro"),
    [
        (DPKG, {}, "humble"),
        (DPKG, {"ROS_DISTRO": "noetic"}, "noetic"),
        ("", {"ROS_DISTRO": "jazzy"}, "jazzy"),
        ("", {}, ""),
        ("garbage\n\tii\t\n\0\n", {}, ""),
    ],
)
def test_the_distro(tmp_path, listing, environment, distro):
    assert machine_of(tmp_path, listing, **environment).distro == distro


def test_the_file_is_sorted_and_free_of_names_and_paths(tmp_path):
    text = dump_capture(machine_of(tmp_path, AMENT_PREFIX_PATH=str(tmp_path)))
    assert text == dump_capture(machine_of(tmp_path, AMENT_PREFIX_PATH=str(tmp_path)))
    data = json.loads(text)
    assert list(data) == sorted(data) and list(data["packages"]) == sorted(data["packages"])
    for secret in (str(tmp_path), getpass.getuser() + "@", socket.gethostname()):
        assert secret not in text


def test_written_and_read_back(tmp_path):
    machine = machine_of(tmp_path)
    (tmp_path / "laptop.json").write_text(dump_capture(machine))
    assert read(tmp_path / "laptop.json") == machine
    target = load_capture(tmp_path / "laptop.json")
    assert (
        target.name == "laptop"
        and target.find_version("rclcpp") == "16.0.8"
        and target.find_library("opencv") == "4.5.4"
    )
    assert target.find_version("nav2_core") is not None, "what is not installed can still be installed"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "cannot be read"),
        ("{", "cannot be read"),
        ("[]", "no captured machine"),
        ('{"rosimpact_target": 2}', "no captured machine"),
        ('{"rosimpact_target": 1, "packages": 3}', "names no ROS distro"),
        ('{"rosimpact_target": 1, "distro": "gutsy"}', "gutsy"),
        ('{"rosimpact_target": 1, "distro": "humble", "date": "then"}', "then"),
        ('{"rosimpact_target": 1, "distro": "humble", "date": "99999-01-01"}', "99999-01-01` is no date"),
        ('{"rosimpact_target": 1, "distro": "humble", "date": "' + "9" * 10**6 + '"}', "9` is no date"),
        ('{"rosimpact_target": ' + "9" * 5000 + "}", "cannot be read"),
        ("[" * 100_000, "nested too deeply"),
        ('{"rosimpact_target": 1e999}', "no captured machine"),
        ('{"rosimpact_target": 1, "distro": "humble", "packages": {"a": "1\\ud800"}}', "is no text"),
    ],
)
def test_what_is_no_captured_machine_is_named(tmp_path, text, words):
    (tmp_path / "x.json").write_text(text)
    with pytest.raises(TargetError, match=rf"x\.json.*{words}"):
        load_capture(tmp_path / "x.json")


@pytest.mark.parametrize("make", [os.mkfifo, os.mkdir, lambda path: path.symlink_to("/dev/zero")])
def test_what_is_no_file_is_not_opened(tmp_path, make):
    make(tmp_path / "x.json")
    with pytest.raises(TargetError, match=r"not a regular file|is a folder"):
        load_capture(tmp_path / "x.json")


def test_a_file_larger_than_its_limit_is_named(tmp_path):
    with open(tmp_path / "x.json", "wb") as file:
        file.truncate(3 << 30)
    with pytest.raises(TargetError, match=r"x\.json.*larger than 64 MB"):
        load_capture(tmp_path / "x.json")


@pytest.mark.parametrize("date", ["0001-01-01", "9999-12-31"])
def test_the_first_and_the_last_day_of_all(date):
    target = DistroTarget("humble", date, versions={"opencv": "9" * 5000, "rclcpp": "9" * 5000 + ".1"})
    assert target.find_version("rclcpp")
    assert target.find_library("opencv") == "9" * 5000
    assert find_differences(DistroTarget("humble"), target)


@pytest.mark.parametrize(
    ("version", "expected"),
    [("1:4.5.4+dfsg-9", "4.5.4"), ("3.10.6-1~22.04", "3.10.6"), ("16.0.8", "16.0.8"), ("4:11.2.0-1ubuntu1", "11.2.0")],
)
def test_plain_versions(version, expected):
    assert strip_version(version) == expected


def test_the_first_package_that_tells_a_library_counts():
    rows = [("libvtk7-dev", "7.1.1"), ("libvtk9-dev", "9.1.0"), ("libboost-dev", "1.74.0.3ubuntu7")]
    _, _, libraries, matter = read_dpkg_rows(rows)
    assert libraries["boost"] == "1.74.0" and matter["libboost-dev"] == "1.74.0.3ubuntu7"
    assert libraries["vtk"] == "9.1.0" and matter["libvtk9-dev"] == "9.1.0" and "libvtk7-dev" not in matter


@pytest.mark.parametrize(
    ("version", "expected"),
    [("1.74.0.3", "1.74.0"), ("1.71.0.0ubuntu2", "1.71.0"), ("1.46.1", "1.46.1"), ("0.9.8.1-3", "0.9.8.1")],
)
def test_debians_own_count_is_no_part_of_a_librarys_version(version, expected):
    assert read_dpkg_rows([("libboost-dev", version)])[2]["boost"] == expected


def test_packages_of_ros_in_debian_are_of_no_distro():
    own = [("ros-image-proc", "1.17.0-6"), ("ros-image-publisher", "1.17.0-6")]
    assert read_dpkg_rows(own)[:2] == ("", {})
    assert read_dpkg_rows([*own, ("ros-noetic-roscpp", "1.16.0-1focal")])[:2] == ("noetic", {"roscpp": "1.16.0"})


def test_differences():
    humble = DistroTarget("humble", "2024-03-01")
    other = humble.copy_with_changes(versions={"opencv": "4.9", "rclcpp": "99.0"}, name="other")
    found = {(d.kind, d.name): (d.first, d.second) for d in find_differences(humble, other)}
    assert found[("library", "opencv")][1] == "4.9"
    assert found[("package", "rclcpp")][1] == "99.0"
    assert len(found) == 2
    assert find_differences(humble, humble) == []
    assert ("platform", "ubuntu jammy", "ubuntu noble") in {
        (d.name, d.first, d.second) for d in find_differences(humble, DistroTarget("jazzy"))
    }


def test_a_machine_without_a_distro_is_no_target():
    with pytest.raises(TargetError, match="names no ROS distro"):
        make_target(CapturedMachine("", "", "", {}, {}, {}, {}, {}), "x", "x.json")
