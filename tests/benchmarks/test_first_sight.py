"""Candidates and releases are found in a git repository made here; the ledger only grows, from clean trees."""

from __future__ import annotations

import json
import os
import sqlite3
import subprocess
import sys
from collections.abc import Callable
from datetime import date
from pathlib import Path
from types import SimpleNamespace

import pytest

sys.path.append(str(Path(__file__).parents[2] / "benchmarks"))

import first_sight
import mining
import released

MANIFEST = """<package format="3">
  <name>{name}</name>
  <version>{version}</version>
  <buildtool_depend>{tool}</buildtool_depend>
{depends}</package>
"""
CMAKE = """project(talker)
find_package(ament_cmake REQUIRED)
find_package(rclcpp REQUIRED)
add_executable(talker src/talker.cpp)
ament_target_dependencies(talker rclcpp)
install(TARGETS talker DESTINATION lib/talker)
ament_package()
"""
TALKER = """#include <rclcpp/rclcpp.hpp>
#include <tf2_ros/buffer.h>
int main(int argc, char ** argv)
{
  rclcpp::init(argc, argv);
  tf2_ros::Buffer buffer(clock);
  while (rclcpp::ok()) executor.spin_node_once(node);
}
"""


def manifest(depends: str = "", version: str = "0.0.1", tool: str = "ament_cmake", name: str = "talker") -> str:
    return MANIFEST.format(name=name, version=version, tool=tool, depends=depends)


def depend(name: str) -> str:
    return f"  <depend>{name}</depend>\n"


START = {
    "talker/package.xml": manifest(depend("rclcpp")),
    "talker/CMakeLists.txt": CMAKE,
    "talker/src/talker.cpp": TALKER,
    "README.md": "A talker.\n",
}

Commit = Callable[..., str]


@pytest.fixture
def clone(tmp_path: Path) -> mining.Clone:
    folder = tmp_path / "clones" / "someone+talker"
    folder.mkdir(parents=True)
    subprocess.run(["git", "init", "-q", "-b", "main", str(folder)], check=True)
    return mining.find_clones(tmp_path / "clones", ["someone/talker", "someone/absent"])[0]


@pytest.fixture
def commit(clone: mining.Clone) -> Commit:
    """Commits files of the clone, given as path and text, with a message and on a day; gives the commit."""
    folder = clone.folder.parent
    who = {f"GIT_{role}_{what}": "someone" for role in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}

    def make(files: dict[str, str], message: str, day: str = "2023-05-01") -> str:
        for path, text in files.items():
            (folder / path).parent.mkdir(parents=True, exist_ok=True)
            (folder / path).write_text(text)
        dates = {f"GIT_{role}_DATE": f"{day}T12:00:00Z" for role in ("AUTHOR", "COMMITTER")}
        setting = {"cwd": folder, "check": True, "env": {**os.environ, **who, **dates}}
        subprocess.run(["git", "add", "-A"], **setting)
        subprocess.run(["git", "commit", "-q", "-m", message], **setting)
        return clone.read("rev-parse", "HEAD").strip()

    return make


def replace(path: str, old: str, new: str) -> dict[str, str]:
    assert old in START[path]
    return {path: START[path].replace(old, new)}


CASES = [
    (
        "a dependency that sources use and nobody declared",
        {"talker/package.xml": manifest(depend("rclcpp") + depend("tf2_ros"))},
        "add missing dependency on tf2_ros",
        ("missing-package-dep", ["tf2_ros"]),
    ),
    (
        "a dependency that nothing uses",
        {"talker/package.xml": manifest(depend("rclcpp") + depend("rclcpp_components"))},
        "add dependency on rclcpp_components",
        None,
    ),
    (
        "a dependency under another name",
        {"talker/package.xml": manifest(depend("rclcpp_components"))},
        "Fix package.xml",
        ("unreleased-or-renamed-dep", ["rclcpp"]),
    ),
    (
        "a header that moved",
        replace("talker/src/talker.cpp", "tf2_ros/buffer.h", "tf2_ros/buffer.hpp"),
        "Use the hpp headers of tf2_ros",
        ("header-moved", ["tf2_ros/buffer.h"]),
    ),
    (
        "a header of the standard library that nothing brings any longer",
        replace("talker/src/talker.cpp", "#include <tf2", "#include <cstdint>\n#include <tf2"),
        "Fix build with GCC 13",
        ("system-library", ["cstdint"]),
    ),
    (
        "a package that CMake did not search",
        replace("talker/CMakeLists.txt", "add_exec", "find_package(tf2_ros REQUIRED)\nadd_exec"),
        "Fix CMake",
        ("missing-find-package", ["tf2_ros"]),
    ),
    (
        "a file that was not installed",
        replace("talker/CMakeLists.txt", "ament_package", "install(DIRECTORY maps DESTINATION share/x)\nament_package"),
        "Install the maps",
        ("install-or-export", ["maps", "x"]),
    ),
    (
        "a call that has another name on a distro",
        replace("talker/src/talker.cpp", "spin_node_once", "spin_once"),
        "Fix build on Jazzy",
        ("upstream-api-change", ["spin_node_once"]),
    ),
    ("a text that no build reads", {"README.md": "A loud talker.\n"}, "Fix missing dependency", None),
    (
        "a release",
        {"talker/package.xml": manifest(depend("rclcpp") + depend("tf2_ros"), version="0.0.2")},
        "0.0.2",
        None,
    ),
    (
        "other work beside it",
        replace("talker/src/talker.cpp", "int main", "#include <map>\n" + "int count = 0;\n" * 100 + "int main"),
        "Count the things that were said",
        None,
    ),
]


@pytest.mark.parametrize(("files", "message", "expected"), [case[1:] for case in CASES], ids=[c[0] for c in CASES])
def test_mine_guesses(clone, commit, files, message, expected):
    parent = commit(START, "initial")
    fix = commit(files, message, "2024-02-03")
    found = mining.mine(clone, "2013-01-01", per_family=6, seed=1)
    assert [(r["guessed_family"], r["guessed_names"]) for r in found] == ([expected] if expected else [])
    for record in found:
        assert (record["fix"], record["parent"], record["date"], record["ros"]) == (fix, parent, "2024-02-03", 2)
        assert record["packages"] == [{"name": "talker", "path": "talker"}]
        assert record["files"] == list(files)


def test_mine_leaves_out_what_the_repository_defines_itself(clone, commit):
    own = {"talker/include/talker/node.hpp": "void spin_node_once(Node node)\n{\n}\n"}
    commit({**START, **own}, "initial")
    commit(replace("talker/src/talker.cpp", "spin_node_once", "spin_once"), "Fix build on Jazzy")
    assert mining.mine(clone, "2013-01-01", per_family=6, seed=1) == []


def test_mine_leaves_out_ignored_packages(clone, commit):
    commit({**START, "talker/COLCON_IGNORE": "\n"}, "initial")
    commit(replace("talker/src/talker.cpp", "tf2_ros/buffer.h", "tf2_ros/buffer.hpp"), "Use the hpp headers of tf2_ros")
    assert mining.mine(clone, "2013-01-01", per_family=6, seed=1) == []


def test_mine_reads_the_generation_from_the_parent(clone, commit):
    commit({**START, "talker/package.xml": manifest(tool="catkin")}, "initial")
    commit(replace("talker/src/talker.cpp", "#include <tf2", "#include <memory>\n#include <tf2"), "Fix build")
    assert [record["ros"] for record in mining.mine(clone, "2013-01-01", per_family=6, seed=1)] == [1]


def test_mine_takes_a_few_of_each_family_and_the_same_ones_with_the_same_seed(clone, commit):
    commit(START, "initial")
    text = TALKER
    for number in range(8):
        text = text.replace("#include <tf2", f"#include <header_{number}.hpp>\n#include <tf2")
        commit({"talker/src/talker.cpp": text}, f"Fix build with header {number}")
    found = [mining.mine(clone, "2013-01-01", per_family=3, seed=seed) for seed in (1, 1, 2)]
    assert [len(records) for records in found] == [3, 3, 3]
    assert found[0] == found[1] != found[2]


def test_mine_goes_on_after_a_commit_whose_file_is_not_there(clone, commit):
    commit(START, "initial")
    lost = commit(replace("talker/CMakeLists.txt", "lib/talker", "lib"), "Fix install")
    commit(replace("talker/src/talker.cpp", "#include <tf2", "#include <memory>\n#include <tf2"), "Fix build")
    blob = clone.read("rev-parse", f"{lost}:talker/CMakeLists.txt").strip()
    (clone.folder / "objects" / blob[:2] / blob[2:]).unlink()
    found = mining.mine(clone, "2013-01-01", per_family=6, seed=1)
    assert [record["guessed_names"] for record in found] == [["memory"]]


def candidate(repo: str, family: str, date: str = "2024-01-01", ros: int = 2) -> dict:
    return {"repo": repo, "guessed_family": family, "date": date, "ros": ros, "weight": 6}


def test_selection_takes_turns():
    records = [candidate("a/many", "other-build") for _ in range(9)] + [candidate("a/many", "header-moved")]
    records += [candidate("b/one", "other-build")]
    chosen = mining.select(records, 3, seed=1, share_recent=0.5, share_ros2=0.5)
    assert sorted((r["repo"], r["guessed_family"]) for r in chosen) == [
        ("a/many", "header-moved"),
        ("a/many", "other-build"),
        ("b/one", "other-build"),
    ]


def test_selection_keeps_the_shares():
    records = [candidate(f"a/{n}", "other-build", date="2015-01-01", ros=1) for n in range(20)]
    records += [candidate(f"b/{n}", "other-build") for n in range(4)]
    chosen = mining.select(records, 10, seed=1, share_recent=0.6, share_ros2=0.7)
    assert (sum(r["ros"] == 1 for r in chosen), sum(r["ros"] == 2 for r in chosen)) == (3, 4)


def test_commits_of_a_repository_that_was_used_before_are_known(clone, commit):
    here = commit(START, "initial")
    assert mining.find_known([clone], [here, "0" * 40]) == {here}


@pytest.fixture
def history(tmp_path: Path) -> sqlite3.Connection:
    """rosdistro's history of one repository in two distros: 0.1.0 there for a year, 0.2.0 built the second time only,
    0.3.0 there for a week."""
    base = sqlite3.connect(tmp_path / "history.sqlite")
    for table in ("distro", "repo", "package"):
        base.execute(f"create table {table}(id integer primary key, name text unique)")
    base.executescript(
        """create table str(id integer primary key, s text unique);
        create table repo_event(distro int, repo int, ts int, gone int, version int, status int, src_type int,
                                src_url int, src_branch int, rel_url int, sha text);
        create table pkg_event(distro int, package int, ts int, repo int, version int);
        insert into distro values (1, 'humble'), (2, 'noetic');
        insert into repo values (1, 'talker'), (2, 'other');
        insert into package values (1, 'talker'), (2, 'listener'), (3, 'other');
        insert into str values (1, 'https://github.com/Someone/talker.git'), (2, '0.1.0-1'), (3, '0.2.0-1'),
                               (4, '0.2.0-2'), (5, '0.3.0-1'), (6, '0.4.0-1');"""
    )
    year, day = 365 * 86400, 86400
    start = 19000 * day
    events = [(0, 2), (year, 3), (year + 2 * day, 4), (2 * year, 5), (2 * year + 7 * day, 6)]
    for distro, later in ((1, 0), (2, 10 * day)):
        for at, version in events:
            event = (distro, 1, start + later + at, 0, version, None, None, 1, None, None, f"sha{version}")
            base.execute(f"insert into repo_event values ({','.join('?' * 11)})", event)
            base.execute("insert into pkg_event values (?, 1, ?, 1, ?)", (distro, start + later + at, version))
    base.execute("insert into pkg_event values (1, 3, ?, 2, 2)", (start,))
    base.commit()
    return base


def test_releases_were_built_at_the_first_go_and_stayed(clone, commit, history):
    for version in ("0.1.0", "0.2.0", "0.3.0", "0.4.0"):
        commit({**START, "talker/package.xml": manifest(depend("rclcpp"), version=version)}, f"release {version}")
        clone.read("tag", version)
    built = clone.read("rev-parse", "0.1.0").strip()
    mended = commit(replace("talker/CMakeLists.txt", "lib/talker", "lib"), "Fix install")
    repaired = [
        {"id": "talker-1", "repo": "someone/talker", "fix": mended, "expected_file": "talker/CMakeLists.txt"},
        {"id": "talker-2", "repo": "someone/talker", "fix": built, "expected_file": "talker/CMakeLists.txt"},
        {"id": "talker-3", "repo": "someone/talker", "fix": mended, "expected_file": "talker/absent.cpp"},
        {"id": "other-1", "repo": "someone/other", "fix": mended, "expected_file": "talker/CMakeLists.txt"},
    ]
    sources = released.find_sources(history)
    found = released.find_releases(clone, history, sources, repaired, most=3, seed=1)
    assert sorted((r["distro"], r["tag"], r["ros"]) for r in found) == [("humble", "0.1.0", 2), ("noetic", "0.1.0", 1)]
    assert next(record for record in found if record["distro"] == "humble") == {
        "repo": "someone/talker",
        "tag": "0.1.0",
        "commit": built,
        "distro": "humble",
        "ros": 2,
        "packages": ["talker"],
        "package_paths": [{"name": "talker", "path": "talker"}],
        "release": "0.1.0-1",
        "rosdistro_commit": "sha2",
        "in_distro_from": "2022-01-08",
        "in_distro_until_at_least": "2023-01-07",
        "source_url": "https://github.com/Someone/talker.git",
        "possibly_latent": ["talker-1"],
    }
    assert len(released.find_releases(clone, history, sources, [], most=1, seed=1)) == 1


@pytest.mark.parametrize(
    ("tag", "text"),
    [
        ("0.1.1", manifest(version="0.1.0")),
        ("0.1.0", manifest(version="0.0.9")),
        ("0.1.0", manifest(version="0.1.0", name="x")),
    ],
)
def test_tags_without_the_released_packages_are_no_releases(clone, commit, history, tag, text):
    commit({"talker/package.xml": text}, "release")
    clone.read("tag", tag)
    assert released.find_releases(clone, history, released.find_sources(history), [], most=3, seed=1) == []


@pytest.mark.parametrize("tag", ["0.1.0", "v0.1.0", "humble-0.1.0", "humble/0.1.0", "talker-0.1.0", "v0.1.0-humble"])
def test_tags_have_many_spellings(clone, tag):
    day = date(2023, 1, 1)
    release = released.Release("humble", "talker", "0.1.0-1", day, day, "", "")
    tags = {"0.1.01": "bad", "0.1.0-rolling": "bad", tag: "c0ffee"}
    assert released.find_tag(clone, tags, release) == (tag, "c0ffee")


def test_ros1_trees_are_left_out_until_ros2_has_its_share():
    records = [{"ros": ros, "at": at} for at, ros in enumerate([1, 1, 2, 1, 2, 1, 2])]
    chosen = released.select(records, 100, share_ros2=0.6, seed=1)
    assert [record["ros"] for record in chosen].count(1) == 2
    assert chosen == sorted(chosen, key=lambda record: record["at"])
    assert [r for r in chosen if r["ros"] == 2] == [r for r in records if r["ros"] == 2]


def test_draw_leaves_out_and_mixes(tmp_path):
    for distro, names in (("humble", "a/one a/two b/gone c/wrap_vendor a/plain"), ("noetic", "a/two d/old d/older")):
        (tmp_path / distro).mkdir()
        entries = {
            name.split("/")[1]: {
                "source": {"url": f"https://github.com/{name}.git"},
                **({} if name == "a/plain" else {"release": {"version": "1.0.0-1"}}),
            }
            for name in names.split()
        }
        (tmp_path / distro / "distribution.yaml").write_text(json.dumps({"repositories": entries}))
    drawn = first_sight.draw(tmp_path, ["elsewhere/Gone"], 10, 0.5, seed=1)
    assert sorted(drawn) == ["a/one", "a/two", "d/old", "d/older"]
    assert [name[0] for name in drawn] == ["a", "d", "a", "d"]
    assert first_sight.draw(tmp_path, ["elsewhere/Gone"], 1, 0.5, seed=1) == drawn[:1]


JUDGED = [
    {"result": "found", "error": True, "tier": "A", "hardness": "hard", "family": "header-moved"},
    {"result": "found", "error": False, "tier": "B", "hardness": "hard", "family": "header-moved"},
    {"result": "missed", "tier": "A", "hardness": "hard", "family": "other-build"},
    {"result": "failed", "tier": "A", "hardness": "conditional", "family": "other-build"},
]
TREES = [
    {"result": "run", "packages": 3, "alarmed": 1, "warnings": 2},
    {"result": "failed", "packages": 1, "alarmed": 1, "warnings": 0},
]
FIGURES = {
    "breaks": 4,
    "found": 2,
    "found_as_error": 1,
    "recall": 0.5,
    "as_errors": 0.25,
    "tier_a_hard": 2,
    "tier_a_hard_found": 1,
    "families": {"header-moved": [2, 2], "other-build": [0, 2]},
    "trees": 2,
    "packages": 4,
    "packages_with_error": 2,
    "warnings_per_package": 0.5,
    "failed": 2,
}


def test_figures_are_counted():
    assert first_sight.summarize(JUDGED, TREES) == FIGURES


@pytest.mark.parametrize(("judged", "trees"), [([{"result": "no repository"}, *JUDGED], TREES), (JUDGED, [])])
def test_half_a_batch_has_no_figures(judged, trees):
    with pytest.raises(SystemExit, match="not scored"):
        first_sight.summarize(judged, trees)


def test_only_the_first_row_of_a_batch_is_first_sight(tmp_path):
    ledger = tmp_path / "ledger.jsonl"
    for batch in ("a", "a", "b"):
        first_sight.append_row(ledger, batch, "c0ffee" * 6, FIGURES)
    first = ledger.read_text().splitlines()
    assert [json.loads(line)["first_sight"] for line in first] == [True, False, True]
    first_sight.append_row(ledger, "b", "c0ffee" * 6, FIGURES)
    assert ledger.read_text().splitlines()[:3] == first
    table = first_sight.format_table(first_sight.read_records(ledger)).splitlines()
    assert [line.count("|") for line in table] == [12] * 6
    assert [line.split(" | ")[2:10] for line in table[2:4]] == [
        ["a", "first sight", "4", "0.500", "0.250", "1/2", "4", "2"],
        ["a", "learned", "4", "0.500", "0.250", "1/2", "4", "2"],
    ]


def test_rows_about_other_questions_are_not_in_the_table():
    row = {"date": "2026-01-01", "commit": "c0ffee" * 6, "batch": "callbacks", "first_sight": True, "callbacks": 3}
    assert first_sight.format_table([row]) == first_sight.format_table([])


@pytest.fixture
def checkout(clone, commit, monkeypatch) -> Path:
    """A checkout with a batch of one break and one release, and a judgement that finds and alarms nothing."""
    root = clone.folder.parent
    batch = {"batches/x.breaks.jsonl": json.dumps({"id": "x-1"}) + "\n", "batches/x.releases.jsonl": "{}\n"}
    judgement = (
        "import json\n"
        "def load(path, sample):\n    return [json.loads(line) for line in open(path)]\n"
        "def score_break(args, record):\n"
        "    return {'result': 'missed', 'tier': 'A', 'hardness': 'hard', 'family': args.by_id['x-1']['id']}\n"
        "def score_negative(args, record):\n"
        "    return {'result': 'failed', 'packages': 2, 'alarmed': 2, 'warnings': 0}\n"
    )
    commit({**batch, "score.py": judgement}, "initial")
    # Installed from a wheel, it is another than the one beside the benchmark, which is refused.
    beside = SimpleNamespace(origin=str(Path(first_sight.__file__).parents[1] / "impact/__init__.py"))
    monkeypatch.setattr(first_sight, "find_spec", lambda name: beside)
    for name, path in (("ROOT", root), ("LEDGER", root / "ledger.jsonl"), ("BATCHES", root / "batches")):
        monkeypatch.setattr(first_sight, name, path)
    return root


def test_a_batch_is_scored_from_what_is_committed(checkout, clone, capsys):
    score = ["score", "--batch", "x", "--score", str(checkout / "score.py"), "--clones", str(checkout), "--jobs", "1"]
    first_sight.main(score)
    first_sight.main(score)
    rows = first_sight.read_records(checkout / "ledger.jsonl")
    assert [(r["first_sight"], r["found"], r["packages_with_error"]) for r in rows] == [(True, 0, 2), (False, 0, 2)]
    assert {row["commit"] for row in rows} == {clone.read("rev-parse", "HEAD").strip()}
    assert rows[0]["families"] == {"x-1": [0, 1]}
    capsys.readouterr()
    first_sight.main(["show"])
    assert "| x | first sight | 1 | 0.000 |" in capsys.readouterr().out


@pytest.mark.parametrize("path", ["score.py", "batches/x.breaks.jsonl", "batches/new.jsonl"])
def test_nothing_is_scored_that_is_not_committed(checkout, path):
    (checkout / path).write_text("{}\n")
    with pytest.raises(SystemExit, match=path):
        first_sight.main(["score", "--batch", "x", "--score", str(checkout / "score.py"), "--clones", str(checkout)])
    assert not (checkout / "ledger.jsonl").exists()


def test_the_curve_is_drawn(checkout, tmp_path):
    pytest.importorskip("matplotlib")
    for batch in ("a", "a", "b"):
        first_sight.append_row(first_sight.LEDGER, batch, "c0ffee" * 6, FIGURES)
    first_sight.main(["plot", str(tmp_path / "curve.svg")])
    text = (tmp_path / "curve.svg").read_text()
    assert "<svg" in text
    assert all(label in text for label in ("found, at first sight", "found, learned", "found as an error, learned"))
