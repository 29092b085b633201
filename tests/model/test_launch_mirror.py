"""Names that real launch files give, against what a person read in them.

data/launch_names_read.jsonl, one a line: repositories with their commits, file (`package/path`), arguments and
environment of the launch, runs (`package/executable` or the plugin), namespace and named (where several run the same,
or where the name is left to the program, that name), asks (`node`, or a topic as the code writes it) and what is
expected.
"""

import json
import os
import subprocess
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

import pytest
from launched_names import full_name
from rosimpact.impact.facts.launch.flow import extract
from rosimpact.impact.facts.launch.parameter_files import extract as parameters
from rosimpact.impact.model.flow.names import join_name, parse_ros2_rule, remap_ros1_name, remap_ros2_name
from rosimpact.impact.model.launch.follow import follow
from rosimpact.impact.model.launch.result import Started

MIRROR = os.environ.get("ROSIMPACT_MIRROR", "")
ROWS = [json.loads(line) for line in (Path(__file__).parent / "data/launch_names_read.jsonl").read_text().splitlines()]


def git(repository, *arguments):
    folder = Path(MIRROR) / repository / "repo"
    folder = folder / ".git" if (folder / ".git").is_dir() else folder
    return subprocess.run(["git", "-C", folder, *arguments], capture_output=True, check=True).stdout


class Repositories:
    """Files of commits of mirrored repositories, by package."""

    def __init__(self, commits):
        self.places = {}
        for repository, commit in commits.items():
            paths = git(repository, "ls-tree", "-r", "--name-only", commit).decode().splitlines()
            for manifest in (path for path in paths if path.rpartition("/")[2] == "package.xml"):
                name = ElementTree.fromstring(git(repository, "show", f"{commit}:{manifest}")).findtext("name")
                folder = manifest.rpartition("/")[0]
                self.places[(name or "").strip()] = (repository, commit, f"{folder}/" if folder else "")

    def read(self, package, path):
        place = self.places.get(package)
        if place is None:
            return None
        repository, commit, folder = place
        try:
            return git(repository, "show", f"{commit}:{folder}{path}")
        except subprocess.CalledProcessError:
            return None

    def find_launch_file(self, package, path):
        data = self.read(package, path)
        kind = {"py": "launch_python", "yaml": "launch_yaml"}.get(path.rpartition(".")[2], "launch_xml")
        return None if data is None else extract(data, kind)

    def find_parameter_file(self, package, path):
        data = self.read(package, path)
        return None if data is None else parameters(data)


@cache
def repositories(commits):
    return Repositories(dict(commits))


def runs(started: Started, row):
    what = started.plugin.value or f"{started.package.value}/{started.executable.value}"
    named = not row["named"] or started.name.value in ("", row["named"])
    return what == row["runs"] and named and row["namespace"] in ("", started.namespace.value)


def answer(started: Started, asks, named):
    """What a node calls a name, or itself; the reasons where that is not known."""
    if asks == "node":
        return full_name(started).value or full_name(started).reasons
    name, namespace = started.name.value or named or "unnamed", started.namespace.value or "/"
    remaps = [(r.old.value, r.new.value) for r in started.remaps if r.old.value and r.new.value]
    if started.generation == 1:
        return remap_ros1_name(asks, join_name(namespace, name), remaps)
    rules = [rule for rule in (parse_ros2_rule(f"{old}:={new}") for old, new in remaps) if rule is not None]
    return remap_ros2_name(asks, name, namespace, rules)


@pytest.mark.skipif(not MIRROR, reason="ROSIMPACT_MIRROR does not name the folder of mirrored repositories")
def test_names_of_real_launch_files():
    wrong = []
    read = 0
    for row in ROWS:
        if not all((Path(MIRROR) / repository).is_dir() for repository in row["repositories"]):
            continue
        read += 1
        package, _, path = row["file"].partition("/")
        sources = repositories(tuple(row["repositories"].items()))
        launch = follow(package, path, sources, row["arguments"], row["environment"])
        given = [answer(started, row["asks"], row["named"]) for started in launch.started if runs(started, row)]
        if given != [row["expected"]]:
            wrong.append((row["file"], row["runs"], row["asks"], row["expected"], given))
    if not read:
        pytest.skip(f"none of the repositories read is in {MIRROR}")
    assert len(wrong) <= 0.05 * read, wrong


def test_forty_names_were_read():
    assert len(ROWS) >= 40
    assert len({row["file"] for row in ROWS}) >= 20
