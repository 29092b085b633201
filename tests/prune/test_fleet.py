"""The fleet of the examples, pruned: built, run with a real master, and compared with what it was before."""

import shutil
import subprocess
from pathlib import Path

import pytest
from rosimpact.impact.prune.session import prepare
from rosimpact.impact.prune.verify import Verification, verify

FLEET = Path(__file__).parents[2] / "examples" / "fleet"
COMMANDS = ["fleet_brain/brain", "fleet_log/log.py", "fleet_log/track.py", "fleet_eye/eye"]


def has_ros1() -> bool:
    """Whether catkin, roscpp, rospy and a master are there."""
    headers = any(Path(prefix, "include/ros/ros.h").exists() for prefix in ("/usr", "/opt/ros/noetic"))
    programs = all(map(shutil.which, ("cmake", "rosmaster", "g++")))
    if not headers or not programs or not Path("/usr/share/catkin/cmake/toplevel.cmake").exists():
        return False
    imports = "import rospy, netifaces, genpy, gencpp"
    return not subprocess.run(["/usr/bin/python3", "-c", imports], check=False).returncode


pytestmark = pytest.mark.skipif(not has_ros1(), reason="catkin, roscpp, rospy and a master are not all there")


def test_a_pruned_fleet_does_what_it_did(monkeypatch, capsys):
    monkeypatch.setenv("CXXFLAGS", "-O0")
    done = verify(FLEET, prepare(FLEET), commands=COMMANDS, seconds=5)
    assert isinstance(done, Verification)
    assert (done.failure, done.exits) == ("", ())
    assert [one for one in done.topics if one.difference] == []
    assert {(one.topic, one.node) for one in done.topics} >= {
        ("/report", "/eye"), ("/spare_report", "/eye"), ("/track", "/eye"), ("/archive", "/track"), ("/alarm", "/log"),
        ("/said", "/brain"), ("/said", "/log"), ("/said", "/track"),
    }  # fmt: skip
    with capsys.disabled():
        print()
        for one in done.topics:
            print(f"{one.topic} of {one.node}: {one.bytes_before:,.0f} B a message, pruned {one.bytes_after:,.0f} B")
            pruned = one.topic in ("/report", "/spare_report", "/track", "/archive")
            assert (one.bytes_after < 0.5 * one.bytes_before) if pruned else one.topic in ("/said", "/alarm")
