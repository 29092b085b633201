"""`rosimpact impact`, and what `check --base` says of it, in a git repository."""

from __future__ import annotations

import json
import subprocess
from pathlib import Path

import jsonschema
import pytest
from rosimpact.impact.report.json import render_schema

MANIFEST = """<package format="3"><name>bell</name><version>1.0.0</version><description>x</description>
<maintainer email="a@b.org">a</maintainer><license>MIT</license><exec_depend>rclpy</exec_depend>
<exec_depend>std_msgs</exec_depend><export><build_type>ament_python</build_type></export></package>
"""
SETUP = """from setuptools import setup
setup(name='bell', version='1.0.0', packages=['bell'],
      entry_points={'console_scripts': ['ring = bell.ring:main', 'hear = bell.hear:main']})
"""
RING = """import rclpy
from rclpy.node import Node
from std_msgs.msg import Empty


class Ring(Node):
    def __init__(self):
        super().__init__('ring')
        self.rope = True
        self.publisher = self.create_publisher(Empty, 'bell', 10)
        self.create_timer(1.0, self.tick)

    def tick(self):
        self.publisher.publish(Empty())


def main():
    rclpy.init()
    rclpy.spin(Ring())
"""
HEAR = """import rclpy
from rclpy.node import Node
from std_msgs.msg import Empty


class Hear(Node):
    def __init__(self):
        super().__init__('hear')
        self.create_subscription(Empty, 'bell', self.heard, 10)

    def heard(self, message):
        pass


def main():
    rclpy.init()
    rclpy.spin(Hear())
"""


@pytest.fixture
def ws(tmp_path: Path) -> Path:
    """A repository whose last commit is without the edit that lies in the folder."""
    files = {
        "bell/package.xml": MANIFEST, "bell/setup.py": SETUP, "bell/bell/__init__.py": "", "bell/bell/ring.py": RING,
        "bell/bell/hear.py": HEAR, "bell/resource/bell": "",
    }  # fmt: skip
    for name, text in files.items():
        path = tmp_path / "ws" / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    settings = ["-c", "user.name=a", "-c", "user.email=a@b.org", "-c", "init.defaultBranch=main"]
    for arguments in (("init",), ("add", "-A"), ("commit", "-m", "first")):
        subprocess.run(["git", *settings, *arguments], cwd=tmp_path / "ws", check=True, capture_output=True)
    (tmp_path / "ws/bell/bell/ring.py").write_text(
        RING.replace("        self.publisher.publish", "        if self.rope:\n            self.publisher.publish")
    )
    return tmp_path / "ws"


def test_the_edit_reaches_who_listens(ws: Path, say):
    said = say("impact", ws, "--base", "HEAD")
    assert said.status == 0
    assert "  tightened  /bell  (/ring)  bell/bell/ring.py:15\n" in said.out
    assert "      → /hear  /bell  bell/bell/hear.py:9\n" in said.out
    assert said.out.splitlines()[-1] == "3 of 3 API calls resolved; 3 files read"


def test_json_to_a_file(ws: Path, say, tmp_path: Path):
    said = say("impact", ws, "--base", "HEAD", "-f", "json", "-o", tmp_path / "impact.json")
    assert (said.status, said.out) == (0, "")
    document = json.loads((tmp_path / "impact.json").read_text())
    assert [(one["change"], [hop["node"] for hop in one["reaches"]]) for one in document["changes"]] == [
        ("tightened", ["bell/hear"])
    ]
    assert document["base"] == "HEAD"


@pytest.mark.parametrize("asked", [("--node", "hear"), ("--topic", "bell"), ("--package", "bell")])
def test_what_is_there_may_be_asked_for(ws: Path, say, asked: tuple[str, str]):
    assert "tightened  /bell" in say("impact", ws, "--base", "HEAD", *asked).out
    said = say("impact", ws, "--rev", "HEAD", "--base", "HEAD", *asked)
    assert (said.status, said.out) == (0, "no change that message flow knows of\n")


def test_a_revision_against_itself_reaches_nothing(ws: Path, say):
    said = say("impact", ws, "--rev", "HEAD", "--base", "HEAD")
    assert (said.status, said.out) == (0, "no change that message flow knows of\n")


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ((), "--base: missing"),
        (("--base", "nowhere"), "nowhere"),
        (("--base", "HEAD", "--node", "hera"), "`hera`: no node of this name; there is `hear`"),
        (("--base", "HEAD", "--topic", "/bel"), "`/bel`: no topic, service or action of this name; there is `bell`"),
        (("--base", "HEAD", "--package", "ball"), "`ball`: no package of this name; there is `bell`"),
        (("--base", "HEAD", "-f", "dot"), "--format dot: unknown; choose one of text, json, markdown"),
    ],
)
def test_what_cannot_be_done_is_said_in_a_line(ws: Path, say, arguments: tuple[str, ...], told: str):
    said = say("impact", ws, *arguments)
    assert said.status == 2
    assert told in said.err
    assert len(said.err.strip().splitlines()) == 1


def test_check_says_it_after_the_findings(ws: Path, say):
    said = say("check", ws, "--base", "HEAD", "-t", "jazzy")
    assert said.status == 0
    section = said.out.partition("affected by this change\n")[2].splitlines()
    assert section[:3] == [
        "  tightened  /bell  (/ring)  bell/bell/ring.py:15",
        "      only when `self.rope`",
        "      reaches /hear",
    ]
    assert "affected by this change" not in say("check", ws, "-t", "jazzy").out


def test_check_says_it_to_machines(ws: Path, say):
    document = json.loads(say("check", ws, "--base", "HEAD", "-t", "jazzy", "-f", "json").out)
    jsonschema.validate(document, json.loads(render_schema()))
    (change,) = document["impact"]["changes"]
    assert (change["topics"], change["reaches"], change["reached"]) == (["/bell"], ["bell/hear"], 1)
    said = say("check", ws, "--base", "HEAD", "-t", "jazzy", "-f", "markdown").out
    assert "Message flow: 1 publish condition changed; 1 node of 2 reached" in said
    assert len(said.strip().splitlines()) <= 10
    page = say("check", ws, "--base", "HEAD", "-t", "jazzy", "-f", "html").out
    assert '"condition tightened","/bell","bell/bell/ring.py",15' in page


def test_rules_say_it_too(ws: Path, say):
    said = say("check", ws, "--base", "HEAD", "-t", "jazzy", "--select", "logic").out
    assert "warning[tightened-publish-condition]" in said
    assert "read by `hear`" in said


def test_what_fails_there_does_not_take_the_findings_along(ws: Path, say, monkeypatch):
    def fails(*_):
        raise RuntimeError("broken")

    monkeypatch.setattr("rosimpact.impact.analysis.downstream.compute_impact", fails)
    said = say("check", ws, "--base", "HEAD", "-t", "jazzy")
    assert said.status == 2
    assert "impact failed" in said.text


def test_a_page_without_a_base_has_no_such_section(ws: Path, say):
    assert '"impact":null' in say("check", ws, "-t", "jazzy", "-f", "html").out


def test_check_says_what_a_launch_file_changes(ws: Path, say):
    (ws / "bell/bell/ring.py").write_text(RING)
    launch = ws / "bell/launch/bell.launch.xml"
    launch.parent.mkdir()
    launch.write_text('<launch><node pkg="bell" exec="ring"/><node pkg="bell" exec="hear"/></launch>\n')
    settings = ["-c", "user.name=a", "-c", "user.email=a@b.org"]
    for arguments in (("add", "-A"), ("commit", "-m", "second")):
        subprocess.run(["git", *settings, *arguments], cwd=ws, check=True, capture_output=True)
    text = launch.read_text().replace('exec="hear"/>', 'exec="hear"><remap from="bell" to="gong"/></node>')
    launch.write_text(text)
    out = say("check", ws, "--base", "HEAD", "-t", "jazzy").out
    assert "renamed  /gong  (/hear)  bell/launch/bell.launch.xml:1" in out
    assert "nothing in the workspace subscribes to /bell of /ring any more" in out
    assert "1 launch setting changed" in out
    out = say("check", ws, "--base", "HEAD", "-t", "jazzy", "--preview", "--select", "lost-edge").out
    assert "nothing subscribes to `/bell` any more; `/hear` did at the base, and now reads `/gong`" in out
