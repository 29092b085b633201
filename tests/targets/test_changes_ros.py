"""Known changes of ROS packages: the facts as a target sees them, and the shape of the two files they stand in."""

import json
import re
from pathlib import Path

import pytest

from rosimpact.impact.targets import changes
from rosimpact.impact.targets.changes import DISTROS
from rosimpact.impact.targets.distro import DistroTarget

FILES = ("changes_ros.json", "changes_ros_tags.json")
KINDS = {
    *("header-removed", "header-renamed", "package-removed", "package-renamed", "api-removed", "api-renamed", "api-changed"),
    *("python-removed", "python-api", "msg-field", "msg-removed", "cmake-removed", "cmake-renamed"),
}
DATA = Path(changes.__file__).parent / "data"
BOUND = re.compile(r"\d+(\.\d+)+\Z")


def groups():
    for name in FILES:
        path = DATA / name
        for group in json.loads(path.read_text())["changes"]:
            yield pytest.param(group, id=f"{path.stem}:{group['package']}:{group['kind']}:{group.get('removed_in', '')}")


@pytest.mark.parametrize("group", list(groups()))
def test_every_group_says_what_when_and_whence(group):
    assert group["kind"] in KINDS
    assert group["source"] and group["names"]
    bounds = [group[key] for key in ("removed_in", "deprecated_in") if group.get(key)]
    assert bounds, "a change that never happens"
    for bound in (*bounds, *filter(None, [group.get("new_since"), group.get("back_in")])):
        assert bound == "ros2" or bound in DISTROS or BOUND.match(bound), bound
    for old, new in group["names"].items():
        assert old and old != new
        if group["kind"].startswith("header-"):
            assert re.search(r"\.(h|hpp|hh|hxx)\Z", old), old
        elif group["kind"].startswith(("api-", "python-", "cmake-")):
            assert re.fullmatch(r"[A-Za-z_][\w]*((::|\.)[A-Za-z_]\w*)*", old), old
        elif group["kind"].startswith("msg-"):
            assert re.fullmatch(r"\w+/\w+(\.\w+)?", old), old


# What the target's own versions say about names that everybody has met.
SEEN = [
    # kind, package, old name, distros where it is gone, distros where it is not
    ("api-removed", "rclcpp", "RCLCPP_SCOPE_EXIT", ("iron", "jazzy"), ("foxy", "humble")),
    ("header-renamed", "class_loader", "class_loader/class_loader.h", ("foxy", "humble", "jazzy"), ("melodic", "noetic")),
]


@pytest.mark.parametrize(("kind", "package", "old", "gone", "there"), SEEN)
def test_gone_where_it_is_gone(kind, package, old, gone, there):
    for distro in (*gone, *there):
        states = {
            c.state for c in DistroTarget(distro).changes() if c.package == package and c.old == old and c.kind.split("-")[0] in kind
        }
        assert ("removed" in states) == (distro in gone), distro
