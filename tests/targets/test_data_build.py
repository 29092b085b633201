"""`data build` on a small rosdistro with every trap of the real one, and `data update` from file URLs."""

import subprocess
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.databuild import keys, manifests, releases
from rosimpact.databuild.git import BuildError
from rosimpact.databuild.snapshot import build, read_status, update
from rosimpact.impact.targets.distro.distro import DistroTarget
from rosimpact.impact.targets.snapshot import Snapshot
from rosimpact.impact.targets.surface.store import load_shipped

INDEX = """\
%YAML 1.1
---
distributions:
  groovy:
    distribution: [groovy/distribution.yaml]
    distribution_status: end-of-life
    distribution_type: ros1
    python_version: 2
  humble:
    distribution: [humble/distribution.yaml]
    distribution_status: active
    distribution_type: ros2
    python_version: 3
  ardent:
    distribution: [ardent/distribution.yaml]
    distribution_status: end-of-life
    distribution_type: ros2
    python_version: 3
type: index
version: 4
"""
HEAD = "%YAML 1.1\n---\nrelease_platforms:\n  rhel:\n  - '8'\n  ubuntu:\n  - jammy\nrepositories:\n"
TAIL = "type: distribution\nversion: 2\n"


def listed(name, version, packages=(), url=""):
    lines = [f"  {name}:"]
    if version:
        lines.append("    release:")
        if packages:
            lines += ["      packages:", *(f"      - {package}" for package in packages)]
        lines += ["      tags:", "        release: release/{package}/{version}", "      url: https://example.org/r.git"]
        lines.append(f"      version: {version}")
    if url:
        lines += ["    source:", "      type: git", f"      url: {url}", "      version: main"]
    lines.append("    status: maintained")
    return "\n".join(lines) + "\n"


def distribution(*repositories):
    return HEAD + "".join(repositories) + TAIL


class Repository:
    """A git repository whose commits say when they were made."""

    def __init__(self, path: Path):
        self.path = path
        path.mkdir()
        self.git("init", "-q", "-b", "master")

    def git(self, *arguments, day="2020-01-01"):
        environment = {
            "GIT_AUTHOR_NAME": "a", "GIT_AUTHOR_EMAIL": "a@example.org", "GIT_COMMITTER_NAME": "a",
            "GIT_COMMITTER_EMAIL": "a@example.org", "GIT_AUTHOR_DATE": f"{day}T12:00:00Z",
            "GIT_COMMITTER_DATE": f"{day}T12:00:00Z", "PATH": "/usr/bin:/bin", "HOME": str(self.path),
        }  # fmt: skip
        return subprocess.run(
            ["git", *arguments], cwd=self.path, env=environment, check=True, capture_output=True, text=True
        ).stdout

    def commit(self, day, files, tag=None):
        for name, text in files.items():
            target = self.path / name
            if text is None:
                target.unlink()
                continue
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(text)
        self.git("add", "-A")
        self.git("commit", "-q", "-m", day, day=day)
        if tag:
            self.git("tag", tag)


@pytest.fixture(scope="module")
def rosdistro(tmp_path_factory):
    repository = Repository(tmp_path_factory.mktemp("clones") / "rosdistro")
    # The forms of 2012 and 2013.
    repository.commit(
        "2012-08-01",
        {"releases/groovy.yaml": "release-name: groovy\nrepositories:\n  roscpp:\n    url: u\n    version: 1.0.0-0\n"},
    )
    repository.commit(
        "2013-05-01",
        {
            "releases/groovy.yaml": None,
            "groovy/release.yaml": "%YAML 1.1\n---\nplatforms:\n  ubuntu:\n  - precise\nrepositories:\n"
            "  ros_comm:\n    packages:\n      roscpp:\n      rospy:\n    url: u\n    version: 1.1.0-0\n",
        },
    )
    groovy = "repositories:\n" + listed("ros_comm", "1.2.0-0", ("roscpp", "rospy"))
    repository.commit("2014-02-01", {"groovy/release.yaml": None, "groovy/distribution.yaml": groovy})
    # A fork, merged with its history later.
    repository.git("checkout", "-q", "-b", "fork")
    repository.commit("2017-12-06", {"ardent/distribution.yaml": distribution(listed("rclcpp", "0.1.0-1"))})
    repository.commit("2018-03-01", {"ardent/distribution.yaml": distribution(listed("rclcpp", "0.2.0-1"))})
    repository.git("checkout", "-q", "master")
    repository.commit("2018-06-01", {"README.md": "x"})
    repository.git("merge", "-q", "--no-ff", "-m", "merge", "fork", day="2019-01-10")
    rosdep = "boost:\n  debian: [libboost-all-dev]\n  ubuntu:\n    '*': [libboost-all-dev]\n    xenial: null\n"
    repository.commit(
        "2022-05-01",
        {
            "index-v4.yaml": INDEX,
            "humble/distribution.yaml": distribution(
                listed("rclcpp", "1.0.0-1", ("rclcpp", "rclcpp_action"), "https://r")
            ),
            "rosdep/base.yaml": rosdep,
            "rosdep/python.yaml": "a-pip: &anchor\n  ubuntu:\n    pip:\n      packages: [a]\nb-pip: *anchor\n",
        },
    )
    repository.commit("2022-05-20", {"README.md": "y"}, tag="humble/2022-05-23")
    repository.commit(
        "2022-06-01", {"humble/distribution.yaml": distribution(listed("rclcpp", "1.1.0-1", ("rclcpp",)))}
    )
    # A package moves between repositories in one commit, and a commit that goes back in time.
    moved = distribution(listed("rclcpp", "1.1.0-1", ("other",)), listed("rclcpp_core", "2.0.0-1", ("rclcpp",)))
    repository.commit("2022-06-20", {"humble/distribution.yaml": moved})
    early = moved.replace("2.0.0-1", "2.1.0-1")
    repository.commit("2022-06-10", {"humble/distribution.yaml": early}, tag="humble/2022-06-25")
    repository.commit("2022-06-11", {"humble/distribution.yaml": early.replace("2.1.0", "2.2.0")})
    # A broken version of a file changes nothing.
    repository.commit("2022-07-01", {"humble/distribution.yaml": early.replace("    status", "   \tstatus", 1)})
    repository.commit("2022-07-02", {"humble/distribution.yaml": early.replace("2.1.0", "2.3.0")})
    # A sync tagged beside the line, on a commit that holds a release back.
    repository.git("checkout", "-q", "-b", "hold")
    repository.commit("2022-08-01", {"humble/distribution.yaml": early}, tag="humble/2022-08-02")
    repository.git("checkout", "-q", "master")
    repository.commit("2022-08-05", {"rosdep/base.yaml": rosdep.replace("xenial: null", "focal: [libboost-old]")})
    repository.commit(
        "2022-09-01", {"humble/distribution.yaml": distribution(listed("gone", None))}, tag="humble/final"
    )
    return repository.path


XML = """<package format="3"><name>rclcpp</name><version>{version}</version><description>d</description>\
<depend>rcl</depend><depend condition="$ROS_VERSION == 1">roscpp</depend>\
<test_depend version_gte="1.2">gtest</test_depend><member_of_group>g</member_of_group>\
<export><build_type>{build}</build_type></export></package>"""


@pytest.fixture(scope="module")
def meta_ros(tmp_path_factory):
    repository = Repository(tmp_path_factory.mktemp("clones") / "meta-ros")

    def cache(stamp, *texts):
        lines = [f"# humble/cache.yaml 2022-06-01 abc {stamp} 1.9.0", "distribution_file: []", "name: humble"]
        lines.append("release_package_xmls:")
        lines += [f"  rclcpp: '{text}'" for text in texts]
        return "\n".join([*lines, "source_repo_package_xmls: {}", ""])

    path = "meta-ros2-humble/files/humble/generated/cache.yaml"
    repository.commit("2022-05-02", {path: cache("20220502000000", XML.format(version="1.0.0", build="ament_cmake"))})
    repository.git("checkout", "-q", "-b", "other")
    newer = XML.format(version="2.1.0", build="ament_cmake").replace("<depend>rcl</depend>", "<depend>rcl2</depend>")
    repository.commit("2022-06-02", {path: cache("20220602000000", newer)})
    repository.git("checkout", "-q", "master")
    return repository.path


@pytest.fixture(scope="module")
def built(rosdistro, meta_ros, tmp_path_factory):
    folder = tmp_path_factory.mktemp("data")
    result = build(rosdistro, folder / "out", folder / "work", meta_ros)
    return folder, result, Snapshot(folder / "out", folder / "cache")


STATES = [
    # distro, day, what is released there
    ("groovy", "2012-09-01", {"roscpp": "1.0.0"}),
    ("groovy", "2013-06-01", {"roscpp": "1.1.0", "rospy": "1.1.0"}),
    ("groovy", "2020-01-01", {"roscpp": "1.2.0", "rospy": "1.2.0"}),
    ("ardent", "2018-01-01", {"rclcpp": "0.1.0"}),
    ("ardent", "2020-01-01", {"rclcpp": "0.2.0"}),
    ("humble", "2022-05-10", {"rclcpp": "1.0.0", "rclcpp_action": "1.0.0"}),  # before the first sync: the commit
    ("humble", "2022-06-10", {"rclcpp": "1.0.0", "rclcpp_action": "1.0.0"}),  # after it: the sync
    ("humble", "2022-07-01", {"rclcpp": "2.1.0", "other": "1.1.0"}),  # moved, and not what came a commit later
    ("humble", "2022-08-03", {"rclcpp": "2.1.0", "other": "1.1.0"}),  # held back
    ("humble", None, {}),
]


@pytest.mark.parametrize(("distro", "day", "expected"), STATES)
def test_what_is_released_when(built, distro, day, expected):
    target = DistroTarget(distro, day, data=built[2])
    assert {name: target.find_version(name) for name in target.list_released()} == expected


def test_the_result_says_what_was_read(built):
    _, result, snapshot = built
    assert result.date == "2022-09-01"
    assert snapshot.date == "2022-09-01"
    assert result.unreadable == {"humble": 1}
    assert result.manifests == 2
    assert set(snapshot.info.sources) == {"ros/rosdistro", "ros/meta-ros"}


@pytest.mark.parametrize(
    ("day", "expected"),
    [("2022-06-10", {"rcl", "gtest", "g"}), ("2022-07-01", {"rcl2", "gtest", "g"})],
)
def test_manifests_of_every_branch(built, day, expected):
    target = DistroTarget("humble", day, data=built[2])
    found = target.list_dependencies("rclcpp")
    assert {d.name for d in found} == expected
    assert {d.bounds for d in found if d.name == "gtest"} == {(("version_gte", "1.2"),)}
    assert target.build_type("rclcpp") == "ament_cmake"


@pytest.mark.parametrize(
    ("day", "platform", "key", "expected"),
    [
        ("2022-06-10", "ubuntu xenial", "boost", None),
        ("2022-06-10", "ubuntu focal", "boost", ("libboost-all-dev",)),
        ("2022-08-10", "ubuntu focal", "boost", ("libboost-old",)),
        ("2022-08-10", "debian bookworm", "boost", ("libboost-all-dev",)),
        ("2022-06-10", "ubuntu jammy", "b-pip", ("a",)),  # a YAML alias of another key
    ],
)
def test_rosdep_rules_over_time(built, day, platform, key, expected):
    found = DistroTarget("humble", day, platform, data=built[2]).resolve(key)
    assert (found and found.packages) == expected


def test_platforms_and_sources(built):
    target = DistroTarget("humble", "2022-06-10", data=built[2])
    assert target.platform == "ubuntu jammy"
    assert target.find_repository("rclcpp") == ("rclcpp", "https://r", "main")


def test_a_second_build_gives_the_same_bytes(built, rosdistro, meta_ros):
    folder = built[0]
    build(rosdistro, folder / "again", folder / "work", meta_ros)
    assert (folder / "again" / "snapshot.json").read_bytes() == (folder / "out" / "snapshot.json").read_bytes()


def test_a_build_continues_from_an_earlier_one(built, rosdistro, meta_ros, tmp_path):
    """What was read of a shorter history gives the same as reading the whole."""
    bare = tmp_path / "bare"
    subprocess.run(["git", "clone", "-q", "--bare", rosdistro, bare], check=True)
    head = subprocess.run(["git", "rev-parse", "HEAD~3"], cwd=rosdistro, check=True, capture_output=True, text=True)
    subprocess.run(["git", "update-ref", "refs/heads/master", head.stdout.strip()], cwd=bare, check=True)
    early = build(bare, tmp_path / "early", tmp_path / "work", meta_ros)
    assert early.date < "2022-09-01"
    build(rosdistro, tmp_path / "late", tmp_path / "work", meta_ros)
    assert (tmp_path / "late" / "snapshot.json").read_bytes() == (built[0] / "out" / "snapshot.json").read_bytes()


def test_damaged_progress_is_read_anew(built, rosdistro, meta_ros, tmp_path):
    (tmp_path / "work").mkdir()
    (tmp_path / "work" / "humble.history").write_bytes(b"damaged")
    build(rosdistro, tmp_path / "out", tmp_path / "work", meta_ros)
    assert (tmp_path / "out" / "snapshot.json").read_bytes() == (built[0] / "out" / "snapshot.json").read_bytes()


@pytest.mark.parametrize("case", ["folder", "empty", "other"])
def test_a_clone_that_is_none_is_named(tmp_path, case):
    path = tmp_path / "x"
    if case == "folder":
        path.mkdir()
    elif case == "empty":
        Repository(path)
    else:
        Repository(path).commit("2020-01-01", {"README.md": "x"})
    with pytest.raises(BuildError, match=r"x (is no git|has no)"):
        build(path, tmp_path / "out", tmp_path / "work")


# data update


@pytest.fixture
def online(tmp_path, rosdistro):
    """A rosdistro served from files: `master` and one newer sync of humble."""
    newer = distribution(listed("rclcpp", "3.0.0-1", ("rclcpp", "brand_new")))
    for ref in ("master", "humble/2022-10-01"):
        folder = tmp_path / "net" / ref
        for name, text in {
            "index-v4.yaml": INDEX,
            "humble/distribution.yaml": newer,
            "rosdep/base.yaml": "boost:\n  ubuntu: [libboost-new]\nnew-key:\n  ubuntu: [new]\n",
            "rosdep/python.yaml": "{}\n",
            "rosdep/ruby.yaml": "{}\n",
            "rosdep/osx-homebrew.yaml": "{}\n",
        }.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text)
    return f"file://{tmp_path}/net/{{ref}}/index-v4.yaml"


def test_update_adds_newer_syncs_and_rules(built, online, tmp_path):
    found = update(tmp_path / "up", built[2], online, lambda distro: ["2022-05-23", "2022-10-01"])
    assert [failure.split(":")[0] for failure in found.failures] == ["manifests of humble"]
    assert found.syncs == ("humble/2022-10-01",)
    after = Snapshot(tmp_path / "up", tmp_path / "cache")
    target = DistroTarget("humble", "2022-10-01", data=after)
    assert {name: target.find_version(name) for name in target.list_released()} == {
        "rclcpp": "3.0.0",
        "brand_new": "3.0.0",
    }
    assert not DistroTarget("humble", "2022-09-30", data=after).list_released()
    today = DistroTarget("humble", data=after)
    assert today.resolve("boost").packages == ("libboost-new",)
    assert today.resolve("new-key").packages == ("new",)
    assert today.resolve("b-pip") is None
    assert DistroTarget("groovy", data=after).find_version("roscpp") == "1.2.0"
    assert read_status(after).updated
    assert read_status(after).last_syncs == {"humble": "2022-10-01"}
    assert read_status(after).surfaces == load_shipped().about._asdict()


def test_update_tells_what_failed_and_keeps_the_rest(built, online, tmp_path):
    def refuse(distro):
        raise OSError("rate limit")

    found = update(tmp_path / "up", built[2], online, refuse)
    assert found.syncs == ()
    assert any("rate limit" in failure for failure in found.failures)
    assert any("manifests of humble" in failure for failure in found.failures)
    assert DistroTarget("humble", data=Snapshot(tmp_path / "up", tmp_path / "cache")).resolve("new-key")


def test_update_without_network_is_one_clear_error(built, tmp_path):
    with pytest.raises(BuildError, match="go online and try again; the data of 2022-09-01 stays in use"):
        update(tmp_path / "up", built[2], f"file://{tmp_path}/nowhere/{{ref}}/index-v4.yaml", lambda distro: [])
    assert not (tmp_path / "up").exists()


# Parsers

BLOCKS = [
    ("  a:\n    release:\n      version: 1.0.0-1\n", ("a", "1.0.0-1", ("a",))),
    ("  a:\n    release:\n      packages: [c, b]\n      version: 1.0\n", ("a", "1.0", ("b", "c"))),
    ("  a:\n    source:\n      url: u\n      version: main\n", ("a", None, ())),
    ("  a:\n    release:\n      url: u\n", ("a", None, ())),
    ("  a:\n", ("a", None, ())),
    ("  a: [\n", None),
    ("  a: {}\n  b: {}\n", None),
    ("", None),
]


@pytest.mark.parametrize(("block", "expected"), BLOCKS)
def test_a_block_of_a_distribution_file(block, expected):
    found = releases.parse_block(block.encode(), "humble/distribution.yaml")
    assert (found and (found[0], found[1].version, found[1].packages)) == expected


@given(st.binary(max_size=200))
def test_any_bytes_may_be_a_file(data):
    parts = releases.split_file(b"repositories:\n" + data)
    assert parts is not None
    for block in parts[1]:
        releases.parse_block(block, "x/distribution.yaml")
    for block in keys.split_file(data):
        keys.parse_rules(block)
    for block in manifests.split_cache(b"release_package_xmls:\n" + data):
        assert isinstance(block, bytes)


MANIFESTS = [
    ("<package><name>a</name><version>1</version><run_depend>b</run_depend></package>", "b\tex"),
    ("<package><name>a</name><version>1</version><depend>b</depend><test_depend>b</test_depend></package>", "b\tbexs"),
    ("<package><name>a</name><version>1</version></package>", ""),
    ("<package><version>1</version></package>", None),
    ("<package>", None),
    ('<!DOCTYPE x [<!ENTITY a "a">]><package><name>&a;</name></package>', None),
    ("", None),
]


@pytest.mark.parametrize(("text", "entries"), MANIFESTS)
def test_a_manifest(text, entries):
    found = manifests.parse_manifest("humble", text)
    assert (found.entries if found else None) == entries


@given(st.text(max_size=100))
def test_any_text_may_be_a_manifest(text):
    manifests.parse_manifest("humble", text)
