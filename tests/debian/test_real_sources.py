"""Real packages in CI: ROS 1 as Debian ships it, read from the source packages.

`.ci/debian-sources FOLDER` unpacks them; ROSIMPACT_DEBIAN_SOURCES names the folder. What is known of them was found by
reading them, not by running the checker.
"""

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from rosimpact.impact import check_workspace

SOURCES = os.environ.get("ROSIMPACT_DEBIAN_SOURCES", "")
NAMES = ("ros-ros-comm", "ros-image-pipeline")

# Of the versions that were read: packages counted by hand, and defects as severity, rule, package, path and subject.
READ = {
    # Python 2 in scripts that no rule installs, and imports that would close a cycle if they were declared.
    ("ros-ros-comm", "1.15.15"): (
        32,
        """
        note    python-version topic_tools tools/topic_tools/scripts/demux_add  `except rospy.ServiceException, e`
        note    python-version topic_tools tools/topic_tools/scripts/demux_delete  `except rospy.ServiceException, e`
        note    python-version topic_tools tools/topic_tools/scripts/demux_list  `except rospy.ServiceException, e`
        note    python-version topic_tools tools/topic_tools/scripts/demux_select  `except rospy.ServiceException, e`
        note    undeclared-package  rospy        clients/rospy/src/rospy/logger_level_service_caller.py  rosnode
        note    undeclared-package  rospy        clients/rospy/src/rospy/logger_level_service_caller.py  rosservice
        note    undeclared-package  topic_tools  tools/topic_tools/scripts/relay_field   rostopic
        """,
    ),
    # CMake names are case-sensitive.
    ("ros-image-pipeline", "1.17.0"): (
        8,
        """
        warning misspelt-cmake-variable depth_image_proc  depth_image_proc/CMakeLists.txt             BOOST_INCLUDE_DIRS
        """,
    ),
}

# Files that cannot be read in full, by source package.
UNREADABLE: dict[str, int] = {"ros-ros-comm": 0, "ros-image-pipeline": 0}


@pytest.fixture(scope="module", params=NAMES)
def name(request):
    folder(request.param)
    return request.param


def folder(name: str) -> Path:
    """Where a source package lies; skips the test when it is not there."""
    if not SOURCES:
        pytest.skip("ROSIMPACT_DEBIAN_SOURCES is not set; unpack the sources with .ci/debian-sources FOLDER")
    path = Path(SOURCES) / name
    if not path.is_dir():
        pytest.skip(f"{name} is not in {SOURCES}; .ci/debian-sources says why it could not be had")
    return path


def version(name: str) -> str:
    """The upstream version in debian/changelog, without epoch, revision and repacking suffix."""
    first = (folder(name) / "debian/changelog").read_text(encoding="utf-8").splitlines()[0]
    match = re.search(r"\((?:\d+:)?([\d.]+)", first)
    assert match, first
    return match[1]


def manifests(top: Path) -> Iterator[Path]:
    """Folders with a package.xml, none of them below another, hidden folders left out."""
    if (top / "package.xml").is_file():
        yield top
        return
    for entry in sorted(top.iterdir()):
        if entry.is_dir() and not entry.is_symlink() and not entry.name.startswith("."):
            yield from manifests(entry)


@pytest.fixture(scope="module")
def report(name):
    """The JSON report of the command line, which must not have failed."""
    program = Path(sys.executable).parent / "rosimpact"
    command = [program, "check", folder(name), "--target", "noetic", "--format", "json"]
    result = subprocess.run(command, capture_output=True, text=True)
    assert "Traceback" not in result.stderr, result.stderr
    assert result.returncode in (0, 1), result.stderr
    return json.loads(result.stdout)


@pytest.fixture(scope="module")
def read(name):
    """What was found in this version by reading it: number of packages, severity by defect. Skips other versions."""
    known = READ.get((name, version(name)))
    if known is None:
        pytest.skip(f"{name} {version(name)} is not among the versions that were read: {sorted(READ)}")
    count, table = known
    rows = [row.split(maxsplit=4) for row in table.strip().splitlines()]
    return count, {tuple(defect): severity for severity, *defect in rows}


def found(report) -> dict[tuple[str, ...], str]:
    """Severity of what was found by rule, package, path and subject."""
    return {(f["rule"], f["package"], f["path"], f["subject"]): f["severity"] for f in report["findings"]}


def test_every_package_is_found(name, report):
    assert report["coverage"]["packages"] == len(list(manifests(folder(name))))


def test_the_number_of_packages_is_that_counted_by_hand(report, read):
    assert report["coverage"]["packages"] == read[0]


def test_every_file_is_read(name, report):
    coverage = report["coverage"]
    assert coverage["files"] > 100
    assert coverage["files"] - coverage["parsed"] == UNREADABLE[name]


def test_known_defects_are_found(report, read):
    told = found(report)
    assert {defect: told.get(defect) for defect in read[1]} == read[1]


def test_nothing_else_is_called_an_error(report, read):
    """These packages build: whatever else is called an error is a false one."""
    known = {defect for defect, severity in read[1].items() if severity == "error"}
    assert {defect for defect, severity in found(report).items() if severity == "error"} == known


def test_findings_point_into_the_sources(name, report):
    for finding in report["findings"]:
        lines = (folder(name) / finding["path"]).read_bytes().count(b"\n") + 1
        assert 0 <= finding["line"] <= lines, finding
        assert finding["targets"] == ["noetic"], finding


def test_other_tools_get_the_same(name, report):
    findings = check_workspace(folder(name), targets=["noetic"])
    assert [f.fingerprint for f in findings] == [f["fingerprint"] for f in report["findings"]]
