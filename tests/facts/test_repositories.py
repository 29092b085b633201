"""Lists of repositories: what is read of files of vcstool and wstool."""

import pytest
from rosimpact.impact.facts.kinds import find_kind
from rosimpact.impact.facts.repositories import ListedRepository, extract

# (text, repositories)
LISTS = [
    (
        "repositories:\n  src/arm-driver: {type: git, url: https://example.org/r/arm.git, version: 1.5}\n",
        [ListedRepository("src/arm-driver", "https://example.org/r/arm.git", "1.5")],
    ),
    (
        "- git: {local-name: arm, uri: 'git@example.org:r/arm_driver.git'}\n- other: {local-name: ../x}\n",
        [ListedRepository("arm", "git@example.org:r/arm_driver.git"), ListedRepository("../x", "")],
    ),
    ("repositories:\n", []),
    ("- arm\n- [1]\n", []),
    ("", []),
]


@pytest.mark.parametrize(("text", "expected"), LISTS)
def test_repositories_are_read(text, expected):
    facts = extract(text.encode())
    assert (list(facts.repositories), facts.problems) == (expected, ())


def test_what_is_no_yaml_is_a_problem():
    facts = extract(b"repositories: [")
    assert facts.repositories == () and len(facts.problems) == 1


def test_a_repository_is_called_as_its_folder_and_its_url():
    assert LISTS[0][1][0].names == {"arm_driver", "arm"}
    assert LISTS[1][1][0].names == {"arm", "arm_driver"}


@pytest.mark.parametrize("path", [".rosinstall", "robot.rosinstall", "robot.repos", "a/ros2.repos"])
def test_lists_are_told_by_their_names(path):
    assert find_kind(path) == "repositories"
