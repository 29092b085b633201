"""Known upstream changes, judged on targets by version, distro, day and release tree."""

import json
import re

import pytest
from rosimpact.impact.targets.changes import (
    DISTROS,
    find_row_version,
    iterate_in_force,
    list_excuses,
    load_rows,
    load_transitive,
)
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.tables import DATA
from rosimpact.impact.targets.version import parse


def states(target, old):
    return {state for row, state in iterate_in_force(target) if row.old == old}


@pytest.mark.parametrize(
    ("distro", "versions", "old", "expected"),
    [
        # Platform libraries, by version
        ("noetic", {"opencv": "3.2"}, "CV_BGR2GRAY", set()),
        ("noetic", {"opencv": "4.2"}, "CV_BGR2GRAY", {"removed"}),
        ("noetic", {"opencv": "2.4.9"}, "cv::SIFT", set()),
        ("noetic", {"opencv": "4.2"}, "cv::SIFT", {"removed"}),
        ("noetic", {"opencv": "4.5.4"}, "cv::SIFT", set()),  # back in 4.4
        ("noetic", {"boost": "1.65"}, "boost/signals.hpp", set()),
        ("noetic", {"boost": "1.71"}, "boost/signals.hpp", {"removed"}),
        ("noetic", {"boost": "1.58"}, "boost::asio::io_service", {"absent"}),
        ("noetic", {"boost": "1.71"}, "boost::asio::io_service", {"deprecated"}),
        ("noetic", {"boost": "1.90"}, "boost::asio::io_service", {"removed"}),
        ("humble", {"numpy": "1.19"}, "numpy.float", set()),
        ("humble", {"numpy": "1.21"}, "numpy.float", {"deprecated"}),
        ("humble", {"numpy": "1.26"}, "numpy.float", {"removed"}),
        ("humble", {"numpy": "1.26"}, "numpy.bool", {"removed"}),
        ("humble", {"numpy": "2.2"}, "numpy.bool", set()),
        ("humble", {"opencv": ""}, "CV_BGR2GRAY", set()),  # not installed
        # Python 2 distros run on 2.7 whatever the platform's Python 3 is
        ("melodic", {}, "string.letters", set()),
        ("noetic", {}, "string.letters", {"removed"}),
        ("jazzy", {}, "imp.load_source", {"removed"}),
        # ROS packages
        ("kinetic", {}, "PLUGINLIB_DECLARE_CLASS", {"deprecated"}),
        ("melodic", {}, "PLUGINLIB_DECLARE_CLASS", {"removed"}),
        ("humble", {}, "rclcpp::executor::FutureReturnCode", {"removed"}),
        ("foxy", {}, "rclcpp::executor::FutureReturnCode", {"deprecated"}),
        ("humble", {}, "RCLCPP_SCOPE_EXIT", {"deprecated"}),
        ("iron", {}, "RCLCPP_SCOPE_EXIT", {"removed"}),
        ("noetic", {}, "roscpp", set()),
        ("humble", {}, "roscpp", {"removed"}),
    ],
)
def test_state_of_a_change(distro, versions, old, expected):
    assert states(DistroTarget(distro, versions=versions), old) == expected


@pytest.mark.parametrize(
    ("distro", "date", "old", "expected"),
    [
        # Distros are not constant: tf2's .hpp came to humble with 0.25.10, in December 2024
        ("humble", "2024-03-01", "tf2/time.h", {"absent"}),
        ("humble", "2025-06-01", "tf2/time.h", set()),
        ("iron", None, "tf2/time.h", {"absent"}),
        ("kilted", None, "tf2/time.h", {"deprecated"}),
        ("jazzy", "2024-06-30", "message_filters/subscriber.h", {"absent"}),
        # The old names of xmlrpcpp stay on its include path
        ("noetic", None, "XmlRpcException.h", {"deprecated"}),
        ("indigo", None, "XmlRpcException.h", {"absent"}),
        # Removed in lyrical: certain of rolling only from lyrical's release on
        ("rolling", "2024-01-15", "rcpputils::fs::path", set()),
        ("rolling", "2026-08-01", "rcpputils::fs::path", {"removed"}),
    ],
)
def test_state_on_a_day(distro, date, old, expected):
    assert states(DistroTarget(distro, date), old) == expected


def test_a_change_says_what_instead_and_where_from():
    target = DistroTarget("noetic", versions={"opencv": "4.2"})
    (row,) = (row for row, _ in iterate_in_force(target) if row.old == "CV_AA")
    assert (row.kind, row.package, row.new) == ("api-removed", "opencv", "cv::LINE_AA")
    assert find_row_version(row, target) == "4.2"
    assert "OpenCV 4.0" in row.source
    assert "imgproc/imgproc_c.h" in list_excuses(row.package, row.old)


def reviewed_rows():
    """The rows of data/changes.json, without those that other files of the folder derive from release tags."""
    groups = json.loads((DATA / "changes.json").read_text())["changes"]
    names = {(group["kind"], group["package"], name) for group in groups for name in group["names"]}
    return [row for row in load_rows() if (row.kind, row.package, row.old) in names]


def test_every_row_is_complete():
    wrong = []
    for row in reviewed_rows():
        bounds = [b for b in (row.removed_in, row.deprecated_in, row.new_since, row.back_in, *row.new_in.values()) if b]
        if not row.source or not row.old or row.old == row.new:
            wrong.append((row, "incomplete"))
        if not (row.removed_in or row.deprecated_in or row.new_since or row.kind.startswith(("header", "msg"))):
            wrong.append((row, "never in force"))
        if any(b not in DISTROS and b != "ros2" and not parse(b) for b in bounds):
            wrong.append((row, "no version and no distro"))
        if row.library and any(b in DISTROS for b in bounds):
            wrong.append((row, "a library has versions, no distros"))
    assert not wrong


@pytest.mark.parametrize(
    ("kind", "shape"),
    [
        ("header-", r"[\w.+/-]+\Z"),
        ("api-", r"(?:[A-Za-z_]\w*::)*[A-Za-z_]\w*\Z"),
        ("python-", r"[A-Za-z_]\w*(?:\.[A-Za-z_]\w*)*\Z"),
        ("package-", r"[a-z][a-z0-9_]*\Z"),
        ("cmake-", r"\w+\Z"),
    ],
)
def test_old_names_are_what_a_scanner_finds(kind, shape):
    assert not [row.old for row in reviewed_rows() if row.kind.startswith(kind) and not re.match(shape, row.old)]


def test_no_name_twice_for_one_package():
    seen = [(row.package, row.old, row.kind.partition("-")[0], row.ros) for row in reviewed_rows()]
    assert sorted({name for name in seen if seen.count(name) > 1}) == []


def test_transitive_includes_are_complete():
    assert not [row for row in load_transitive() if not (row.name and row.headers and row.since and row.source)]
    by_name = {row.name: row for row in load_transitive()}
    assert by_name["uint32_t"].headers[0] == "cstdint"
    assert by_name["uint32_t"].since == "13"


def test_what_one_table_does_not_say_of_a_name_is_taken_from_the_other():
    # ceres/manifold.h came with 2.1 and local_parameterization.h went with 2.2; the special table tells the latter.
    (row,) = [row for row in load_rows() if (row.kind, row.old) == ("header-removed", "ceres/local_parameterization.h")]
    assert (row.removed_in, row.new_since) == ("2.2", "2.1")
