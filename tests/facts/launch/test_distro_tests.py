"""Tests of ROS_DISTRO in launch files: how they are written, and what stands under them alone."""

import pytest
from rosimpact.impact.facts.condition import UNDECIDED
from rosimpact.impact.facts.distro_branches import list_compared_words
from rosimpact.impact.facts.launch.distro_tests import read_machine_test
from rosimpact.impact.facts.launch.references import extract


@pytest.mark.parametrize(
    ("written", "test"),
    [
        ("$(eval '\\'$(env ROS_DISTRO)\\' == \\'humble\\'')", "os.environ['ROS_DISTRO'] == 'humble'"),
        ("$(eval env('ROS_DISTRO') == 'noetic')", "os.environ.get('ROS_DISTRO') == 'noetic'"),
        ("$(eval \"'$(optenv ROS_DISTRO x)' in ['a', 'b']\")", "os.environ['ROS_DISTRO'] in ['a', 'b']"),
        ("$(equals $(env ROS_DISTRO) humble)", "(os.environ['ROS_DISTRO'] == 'humble')"),
        ("$(not-equals humble $(env ROS_DISTRO))", "('humble' != os.environ['ROS_DISTRO'])"),
        ("$(not $(equals $(env ROS_DISTRO) humble))", "not ((os.environ['ROS_DISTRO'] == 'humble'))"),
        ("$(or $(equals $(env ROS_DISTRO) humble) $(var other))",
         "((os.environ['ROS_DISTRO'] == 'humble') or undecided)"),
        ("$(equals $(var distro) humble)", "(os.environ['ROS_DISTRO'] == 'humble')"),
        ("$(eval arg('distro') == 'noetic')", "os.environ.get('ROS_DISTRO') == 'noetic'"),
        ("$(equals $(var other) humble)", ""),
        ("$(var distro)", ""),
        ("$(equals $(env ROBOT) humble)", ""),
        ("$(equals " * 60 + "$(env ROS_DISTRO)", ""),
    ],
)  # fmt: skip
def test_tests_of_the_environment(written, test):
    found = read_machine_test(written, False, {"distro": "$(env ROS_DISTRO)", "other": "true"})
    assert (found.text if found is not UNDECIDED else "") == test


@pytest.mark.parametrize(
    ("test", "words"),
    [
        ('$ROS_DISTRO == "humbel"', ["humbel"]),
        ("$ROS_DISTRO != iron and $ROS_VERSION == 2", ["iron"]),
        ("$ENV{ROS_DISTRO} MATCHES ^(foxy|galactic)$ OR X STREQUAL humbel", ["foxy", "galactic"]),
        ("humble STREQUAL $ENV{ROS_DISTRO}", ["humble"]),
        ("$ENV{ROS_DISTRO} IN_LIST jazzy;kilted;", ["jazzy", "kilted"]),
        ("MY_ROS_DISTRO STREQUAL humbel", []),
        ("$ENV{ROS_DISTRO} STREQUAL ${MY_DISTRO}", []),
    ],
)
def test_words_that_the_distro_is_compared_with(test, words):
    assert list(list_compared_words(test)) == words


def test_what_stands_in_branches_alone():
    text = """<launch>
  <let name="a" value="1" if="$(equals $(env ROS_DISTRO) humble)"/>
  <let name="b" value="1"/>
  <let name="b" value="2" if="$(equals $(env ROS_DISTRO) humble)"/>
  <node pkg="p" exec="x" name="one" if="$(equals $(env ROS_DISTRO) foxy)"/>
  <node pkg="q" exec="y" name="one" if="$(equals $(env ROS_DISTRO) iron)"/>
  <node pkg="p" exec="$(var a)" name="$(var b)"/>
</launch>"""
    found = extract(text.encode(), "launch_xml")
    assert [(one.name, one.line, one.kind, len(one.branches)) for one in found.branched] == [
        ("a", 7, "name", 1),
        ("ROS_DISTRO", 5, "start", 2),
    ]
    assert [(one.name, one.line) for one in found.compared] == [("humble", 2), ("humble", 4), ("foxy", 5), ("iron", 6)]
