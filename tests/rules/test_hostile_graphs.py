"""Graphs that hostile workspaces make: what is compared with what stays bounded."""

import random

import pytest
from rosimpact.impact.analysis.check import check
from rosimpact.impact.analysis.session import Options
from rosimpact.impact.model.flow import edges
from rosimpact.impact.model.flow.misspelling import NearNames, is_in_namespace, is_slip_of_name

NAMES = ["/scan", "/scans", "/sacn", "/front/scan", "/odom", "/Odom", "/odom_", "scan", "/cmd_vel", "/cmdvel", "/arm_l"]


@pytest.mark.parametrize("namespaces", [False, True])
def test_near_names_are_those_that_a_comparison_of_all_finds(namespaces):
    chance = random.Random(7)
    letters = "abXY_1/"
    made = ["".join(chance.choice(letters) for _ in range(chance.randint(4, 9))).strip("/") or "a" for _ in range(200)]
    names = [*NAMES, *made, *(name[:2] + name[3:] for name in made if "/" not in name and len(name) > 5)]
    near = NearNames([(name, name) for name in names], namespaces=namespaces)
    for one in names:
        same = [n for n in names if is_slip_of_name(one, n) or (namespaces and is_in_namespace(one, n))]
        assert list(near.find_near(one)) == same


def test_very_long_names_are_near_to_nothing():
    near = NearNames([("a" * 1_000_000, 1), ("scan", 2)], namespaces=True)
    assert list(near.find_near("a" * 999_999)) == []
    assert list(near.find_near("scna")) == ([2] if is_slip_of_name("scna", "scan") else [])


MANIFEST = """<package format="3"><name>{}</name><version>1.0.0</version><description>d</description>
<maintainer email="a@b.org">m</maintainer><license>l</license>{}</package>"""


@pytest.mark.parametrize(("most", "listed", "more"), [(2, 2, True), (3, 3, False), (9, 3, False)])
def test_cycles_beyond_the_limit_are_named(tmp_path, monkeypatch, most, listed, more):
    """Three packages, of which each two need each other."""
    import sys

    check(tmp_path, Options(("jazzy",), cache=tmp_path / "cache"))  # loads the rules
    monkeypatch.setattr(sys.modules["rosimpact.impact.rules.packages.dependency_cycle"], "_MOST_CYCLES", most)
    for one, others in {"a": "bc", "b": "ac", "c": "ab"}.items():
        (tmp_path / "ws" / one).mkdir(parents=True)
        needs = "".join(f"<depend>{other}</depend>\n" for other in others)
        (tmp_path / "ws" / one / "package.xml").write_text(MANIFEST.format(one, needs))
    report = check(tmp_path / "ws", Options(("jazzy",), cache=tmp_path / "cache", select=("dependency-cycle",)))
    notes = [f.message for f in report.findings if f.severity == "note"]
    assert len(report.findings) - len(notes) == listed
    assert notes == ([f"there are more than {most} dependency cycles; the others are not listed"] if more else [])


@pytest.mark.parametrize(("each", "in_all", "left"), [(4, 100, None), (3, 100, 1), (100, 2, 2), (100, 4, None)])
def test_pairs_beyond_the_limit_are_named(tmp_path, monkeypatch, each, in_all, left):
    """Two publishers and two subscribers of a topic."""
    monkeypatch.setattr(edges, "_MOST_PAIRS", each)
    monkeypatch.setattr(edges, "_MOST_PAIRS_IN_ALL", in_all)
    package = tmp_path / "ws" / "p"
    package.mkdir(parents=True)
    (package / "package.xml").write_text(MANIFEST.format("p", "<export><build_type>ament_python</build_type></export>"))
    (package / "setup.py").write_text(
        "from setuptools import setup\nsetup(name='p', entry_points={'console_scripts': ['a = p.a:main']})\n"
    )
    (package / "p").mkdir()
    (package / "p" / "__init__.py").write_text("")
    (package / "p" / "a.py").write_text(
        "import rclpy\nfrom std_msgs.msg import String\n\ndef main():\n    rclpy.init()\n"
        "    n = rclpy.create_node('n')\n"
        + "    n.create_publisher(String, 't', 1)\n" * 2
        + "    n.create_subscription(String, 't', print, 1)\n" * 2
    )
    options = Options(("jazzy",), preview=True, cache=tmp_path / "cache", select=("topic-type-mismatch",))
    noted = [f.message for f in check(tmp_path / "ws", options).findings]
    more = [f"too many nodes use the topic `/t`: {left} pairs were not compared"] if left else []
    assert noted == more
