"""What a person writes after --target, and what stands when nothing is written."""

import os
import re
import subprocess
from pathlib import Path
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.config import Config
from rosimpact.impact.targets.distro.known import list_known_distros
from rosimpact.impact.targets.resolve import (
    TargetError,
    choose_default_distros,
    choose_targets,
    find_named_distros,
    parse_dpkg,
    parse_image,
    parse_target,
    read_branch,
)
from rosimpact.impact.tree import GitTree, WorkingTree

DISTROS = list_known_distros()
NAMES = [known.name for known in DISTROS]
CONFIG = Config(
    path=Path("rosimpact.toml"),
    targets={
        "robot": {"distro": "humble", "date": "2025-06-01", "platform": "Ubuntu 22.04", "versions": {"opencv": "4.9"}},
        "lab": {"distro": "jazzy@2025-01-01"},
        "odd": {"distro": "humble", "colour": "red"},
        "lost": {"distro": "humbel"},
    },
)

TEXTS = [
    # text, distro, date, platform
    ("jazzy", "jazzy", None, "ubuntu noble"),
    (" jazzy ", "jazzy", None, "ubuntu noble"),
    ("humble@2024-03-01", "humble", "2024-03-01", "ubuntu jammy"),
    ("robot", "humble", "2025-06-01", "ubuntu jammy"),
    ("robot@2024-01-01", "humble", "2024-01-01", "ubuntu jammy"),
    ("lab", "jazzy", "2025-01-01", "ubuntu noble"),
    ("docker:osrf/ros:humble-desktop", "humble", None, "ubuntu jammy"),
    ("docker:ros:noetic-ros-base-focal", "noetic", None, "ubuntu focal"),
    ("docker:ros:noetic-ros-base-buster", "noetic", None, "debian buster"),
]


@pytest.mark.parametrize(("text", "distro", "date", "platform"), TEXTS)
def test_a_text_gives_a_target(text, distro, date, platform):
    found = parse_target(text, CONFIG)
    assert (found.distro, found.platform, found.name) == (distro, platform, text.strip())
    assert date is None or found.date == date


TABLES = [
    ({"platform": "ubuntu nobel"}, "unknown platform `ubuntu nobel`; did you mean `noble`?"),
    ({"platform": "nobel"}, "unknown platform `nobel`; did you mean `noble`?"),
    ({"platform": "ubunto 24.04"}, "unknown platform `ubunto 24.04`; did you mean `ubuntu`?"),
    ({"platform": "solaris"}, "unknown platform `solaris`; known systems: alpine, "),
    ({"versions": {"opencvv": "4.9"}}, "`versions` has an unknown name `opencvv`; did you mean `opencv`?"),
    ({"versions": {"nav2_costmap2d": "1.3"}}, "an unknown name `nav2_costmap2d`; did you mean `nav2_costmap_2d`?"),
    ({"versions": {"\x1b[1m": "1"}}, "; a ROS package or a platform library is meant"),
    ({"platform": "ubuntu 25.10"}, ""),
    ({"platform": "Debian sid"}, ""),
    ({"platform": "fedora 41"}, ""),
    ({"platform": "conda-forge"}, ""),
    ({"platform": "robostack"}, ""),
    ({"versions": {"OpenCV": "4.9", "qt5": "5.15", "nav2_costmap_2d": "1.3"}}, ""),
]


@pytest.mark.parametrize(("table", "expected"), TABLES)
def test_a_table_with_names_that_nobody_knows_is_an_error(table, expected):
    config = Config(targets={"robot": {"distro": "jazzy", **table}})
    if not expected:
        assert parse_target("robot", config).name == "robot"
        return
    with pytest.raises(TargetError, match=re.escape(expected)) as raised:
        parse_target("robot", config)
    assert "[targets.robot]" in str(raised.value) and "\x1b" not in str(raised.value)


def test_a_configured_target_takes_its_versions():
    assert parse_target("robot", CONFIG).find_library("opencv") == "4.9"


ERRORS = [
    ("jazy", "did you mean `jazzy`"),
    ("robt", "did you mean `robot`"),
    ("nonsense", "Known distros: groovy, hydro"),
    ("nonsense", "Targets of rosimpact.toml: lab, lost, odd, robot"),
    ("", "Known distros"),
    ("humble@soon", "is no date"),
    ("humble@2024-99-99", "is no date"),
    ("docker:ubuntu:22.04", "tells no distro"),
    ("docker:", "tells no distro"),
    ("missing.json", "rosimpact env capture"),
    ("missing.dpkg.txt", "dpkg -l"),
    ("odd", "has no `colour`"),
    ("lost", "unknown distro `humbel`"),
]


@pytest.mark.parametrize(("text", "says"), ERRORS)
def test_an_error_says_what_is_known_or_to_do(text, says):
    with pytest.raises(TargetError, match=says.replace("(", r"\(")):
        parse_target(text, CONFIG)


@given(st.text(max_size=25))
def test_any_text_gives_a_target_or_a_target_error(text):
    try:
        assert parse_target(text, CONFIG).distro
    except TargetError as error:
        assert str(error)


IMAGES = [
    ("ros:humble", ("humble", None)),
    ("ros:humble-ros-base-jammy", ("humble", "ubuntu jammy")),
    ("osrf/ros:noetic-desktop-full", ("noetic", None)),
    ("ghcr.io/o/ci:5000-jazzy", ("jazzy", None)),
    ("registry:5000/team/ros2-iron:latest", ("iron", None)),
    ("rostooling/setup-ros-docker:ubuntu-jammy-ros-humble-ros-base-latest", ("humble", "ubuntu jammy")),
    ("moveit/moveit2:rolling-ci@sha256:0123", ("rolling", None)),
    ("ros", ("lyrical", None)),
    ("ros:latest", ("lyrical", None)),
    ("ubuntu:jammy", None),
    ("registry:5000/team/app", None),
    ("", None),
]


@pytest.mark.parametrize(("image", "expected"), IMAGES)
def test_a_docker_image_by_its_name(image, expected):
    assert parse_image(image, DISTROS) == expected


LISTING = """\
Desired=Unknown/Install/Remove/Purge/Hold
||/ Name                    Version                              Architecture Description
+++-=======================-====================================-============-===========
ii  cmake                   3.22.1-1ubuntu1.22.04.2              amd64        make
ii  libopencv-dev           4.5.4+dfsg-9ubuntu4                  amd64        headers
hi  libc6:amd64             2.35-0ubuntu3.8                      amd64        held
rc  libboost-dev            1.74.0.3ubuntu7                      amd64        removed
ii  ros-humble-cv-bridge    3.2.1-1jammy.20240217.071034         amd64        bridge
ii  ros-humble-rclcpp       16.0.8-1jammy.20240217.064242        amd64        client library
"""


def test_a_dpkg_listing_holds_what_is_installed():
    assert [(row.name, row.version) for row in parse_dpkg(LISTING)][:3] == [
        ("cmake", "3.22.1-1ubuntu1.22.04.2"),
        ("libopencv-dev", "4.5.4+dfsg-9ubuntu4"),
        ("libc6", "2.35-0ubuntu3.8"),
    ]
    assert "libboost-dev" not in [row.name for row in parse_dpkg(LISTING)]


@given(st.text())
def test_any_text_can_be_read_as_a_listing(text):
    assert all(row.name and row.version for row in parse_dpkg(text))


def test_a_dpkg_listing_is_a_target(tmp_path):
    (tmp_path / "robot.dpkg.txt").write_text(LISTING)
    found = parse_target("robot.dpkg.txt", None, tmp_path)
    assert (found.name, found.distro, found.date, found.platform) == ("robot", "humble", "2024-02-17", "ubuntu jammy")
    assert found.find_version("rclcpp") == "16.0.8"
    assert found.find_version("cv_bridge") == "3.2.1"
    assert found.find_library("opencv") == "4.5.4"


@pytest.mark.parametrize(
    ("text", "says"), [("", "lists no installed"), ("ii cmake 3.22 amd64 x", "no package of a ROS")]
)
def test_a_listing_without_ros_is_refused(tmp_path, text, says):
    (tmp_path / "x.dpkg.txt").write_text(text)
    with pytest.raises(TargetError, match=says):
        parse_target("x.dpkg.txt", None, tmp_path)


CI = [
    ("FROM ros:humble-ros-base\n", ["humble"]),
    ("FROM osrf/ros:noetic-desktop-full AS build", ["noetic"]),
    ("      matrix:\n        ros_distribution: [humble, jazzy]\n", ["humble", "jazzy"]),
    ("env:\n  - ROS_DISTRO=melodic\n  - ROS_DISTRO=noetic\n", ["melodic", "noetic"]),
    ("uses: ros-tooling/setup-ros@v0.7\nros_distribution:\n  - humble\n  - rolling\n", ["humble", "rolling"]),
    ("        - {ROS_DISTRO: iron, ROS_REPO: main}", ["iron"]),
    ("RUN apt-get install -y ros-galactic-desktop", ["galactic"]),
    ("source /opt/ros/foxy/setup.bash", ["foxy"]),
    ("# FROM ros:melodic\nFROM ros:noetic", ["noetic"]),
    ("  distro: jazzy  # not humble", ["jazzy"]),
    ("run: iron the shirts on a rolling basis", []),
    ("runs-on: ubuntu-jammy\nstrategy: rolling", []),
    ("image: crystal-lang", []),
    ("", []),
]


@pytest.mark.parametrize(("text", "expected"), CI)
def test_distros_that_a_ci_file_names(text, expected):
    assert find_named_distros(text, NAMES) == expected


@given(st.text())
def test_any_text_may_be_a_ci_file(text):
    assert set(find_named_distros(text, NAMES)) <= set(NAMES)


def workflow(*distros):
    return f"ros_distribution: [{', '.join(distros)}]"


DAY = "2026-08-22"
CHOICES = [
    # ros, CI texts, branches, environment, expected distros, the reason contains
    (2, [], [], {"ROS_DISTRO": "humble"}, ("humble",), "sourced"),
    (1, [], [], {"ROS_DISTRO": "humble"}, ("noetic",), "nothing names"),  # of the other generation
    (2, [], [], {"ROS_DISTRO": "private"}, ("lyrical",), "nothing names"),
    (2, [("", "ci.yml", workflow("humble", "jazzy"))], [], {}, ("humble", "jazzy"), "ci.yml"),
    (2, [("", "ci.yml", workflow("foxy", "jazzy"))], [], {}, ("jazzy",), "ci.yml"),  # no ended one beside a living one
    (1, [("", "ci.yml", workflow("melodic", "noetic"))], [], {}, ("melodic", "noetic"), "ci.yml"),
    (
        2,
        [("a", "a/ci.yml", workflow("jazzy", "humble")), ("b", "b/ci.yml", workflow("jazzy"))],
        [],
        {},
        ("jazzy",),
        "1 more",
    ),
    (2, [("", "ci.yml", workflow("bouncy"))], [("", "jazzy-devel")], {}, ("jazzy",), "branch jazzy-devel"),
    (2, [("", "ci.yml", workflow("bouncy"))], [("", "main")], {}, ("lyrical",), "bouncy ended long ago"),
    (2, [], [("", "humble")], {}, ("humble",), "branch humble"),
    (1, [], [("", "kinetic-devel")], {}, ("kinetic",), "branch kinetic-devel"),
    (2, [("", "ci.yml", workflow("jazzy")), ("a/b", "a/b/ci.yml", workflow("humble"))], [], {}, ("jazzy",), "ci.yml"),
    (2, [("", "x.repos", "version: main"), ("a", "a/ci.yml", workflow("humble"))], [], {}, ("humble",), "a/ci.yml"),
    (2, [("", "pixi.toml", 'channels = ["robostack-humble"]')], [], {}, ("humble",), "pixi.toml"),
    (2, [("", "x.repos", "repositories:\n  a:\n    version: humble-devel")], [], {}, ("humble",), "x.repos"),
    (2, [("", "x.repos", "repositories:\n  a:\n    version: humble")], [("", "jazzy")], {}, ("jazzy",), "branch"),
    (2, [("", "x.repos", "  iron_ore:\n    version: main")], [], {}, ("lyrical",), "newest long-term"),
    (1, [("", ".rosinstall", "- git: {uri: x, version: melodic-devel}")], [], {}, ("melodic",), ".rosinstall"),
    (2, [], [("", "main")], {}, ("lyrical",), "newest long-term"),
    (1, [], [], {}, ("noetic",), "newest long-term"),
]


@pytest.mark.parametrize(("ros", "texts", "branches", "environment", "expected", "says"), CHOICES)
def test_what_stands_when_nothing_is_asked_for(ros, texts, branches, environment, expected, says):
    distros, reason = choose_default_distros(ros, texts, branches, DISTROS, environment, DAY)
    assert distros == expected
    assert says in reason


INSTALLING = [
    ("sudo apt install ros-jazzy-desktop", [], ("jazzy",), "README.md"),
    ("source /opt/ros/jazzy/setup.bash  # or /opt/ros/humble", [], ("humble", "jazzy"), "README.md"),
    ("source /opt/ros/bouncy/setup.bash", [], ("lyrical",), "nothing names another"),  # long ended
    ("Works with ROS 2 Jazzy", [], ("lyrical",), "nothing names another"),
    ("ros-jazzy-desktop", [("", "ci.yml", workflow("humble"))], ("humble",), "ci.yml"),
]


@pytest.mark.parametrize(("text", "texts", "expected", "says"), INSTALLING)
def test_what_tells_how_to_install_things_comes_last(text, texts, expected, says):
    installing = [("", "README.md", text)]
    distros, reason = choose_default_distros(2, texts, [("", "main")], DISTROS, {}, DAY, installing)
    assert distros == expected
    assert says in reason


LOOPS = [
    ("for DISTRO in humble jazzy; do git checkout $DISTRO; done  # of ROS", []),
    ("for D in humble jazzy; do docker pull ros:$D-ros-base; done", ["humble", "jazzy"]),
    ("for D in humble jazzy; do\n  . /opt/ros/${D}/setup.bash\ndone", ["humble", "jazzy"]),
    ("for D in humble jazzy; do\n  ROS_DISTRO=$D make\ndone", ["humble", "jazzy"]),
    ("for D in humble jazzy; do\n  build --image=ours/$D\ndone  # ROS", ["humble", "jazzy"]),
]


@pytest.mark.parametrize(("text", "expected"), LOOPS)
def test_what_a_loop_runs_through_counts_where_it_names_something_of_ros(text, expected):
    assert find_named_distros(f"# ROS\nname: ros\n{text}", [known.name for known in DISTROS]) == expected


class OneFile:
    """A tree of one CI file."""

    repositories = {"": "/nowhere"}  # noqa: RUF012

    def __init__(self, path, text):
        self.path, self.text = path, text

    def list_entries(self):
        return [SimpleNamespace(path=self.path, size=len(self.text))]

    def read(self, path, limit=0):
        return self.text.encode()


@pytest.mark.parametrize(
    ("path", "distro"),
    [
        (".github/workflows/ci.yaml", "humble"),
        ("src/a/.gitlab-ci.yml", "humble"),
        ("docker/Dockerfile", "humble"),
        ("docker/robot.dockerfile", "humble"),
        ("Dockerfile.ci", "humble"),
        ("wheel_Dockerfile", "humble"),
        ("Dockerfile-dev", "humble"),
        ("make_dockerfile.txt", "lyrical"),
        ("src/third_party/a/.gitlab-ci.yml", "lyrical"),
        ("docs/ci.yaml", "lyrical"),
        ("scripts/apt-requirements.txt", "humble"),
        ("src/a/install_tools.sh", "humble"),
        ("src/a/notes.md", "lyrical"),
        ("notes/MyDockerfiles.md", "lyrical"),
    ],
)
def test_files_that_are_looked_into(path, distro, monkeypatch):
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    chosen = choose_targets((), Config(), 2, OneFile(path, "FROM ros:humble  # has ros-humble-desktop"))
    assert [item.target.distro for item in chosen] == [distro]
    assert chosen[0].reason


@pytest.mark.parametrize(
    ("revision", "distro"),
    [("jazzy", "jazzy"), ("origin/humble-devel", "humble"), ("1.2.0-humble", "humble"), ("c0ffee", "lyrical")],
)
def test_a_revision_that_is_asked_for_names_a_distro(revision, distro, monkeypatch):
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    tree = OneFile("README.md", "")
    tree.revision = revision
    assert [item.target.distro for item in choose_targets((), Config(), 2, tree)] == [distro]


@pytest.mark.parametrize(("revision", "distro"), [("{id}", "humble"), ("jazzy", "jazzy"), ("HEAD~1", "humble")])
def test_a_commit_that_head_means_is_of_its_branch(revision, distro, tmp_path, monkeypatch):
    monkeypatch.delenv("ROS_DISTRO", raising=False)

    def git(*arguments):
        given = ["git", "-C", tmp_path, "-c", "user.name=a", "-c", "user.email=a@example.org", *arguments]
        return subprocess.run(given, check=True, capture_output=True, text=True).stdout.strip()

    git("init", "-q", "-b", "humble")
    git("commit", "-q", "--allow-empty", "-m", "one")
    git("commit", "-q", "--allow-empty", "-m", "two")
    git("branch", "jazzy")
    tree = GitTree(tmp_path, revision.format(id=git("rev-parse", "HEAD")))
    assert [item.target.distro for item in choose_targets((), Config(), 2, tree)] == [distro]


def test_ci_files_below_another_repositorys_are_not_those_of_the_workspace(monkeypatch):
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    tree = OneFile("", "")
    texts = {".github/workflows/ci.yaml": "FROM ros:jazzy", "src/nav/.github/workflows/ci.yaml": "FROM ros:humble"}
    tree.list_entries = lambda: [SimpleNamespace(path=path, size=20) for path in texts]
    tree.read = lambda path, limit: texts[path].encode()
    assert [item.target.distro for item in choose_targets((), Config(), 2, tree)] == ["jazzy"]


@pytest.mark.parametrize("kind", ["files", "revision"])
def test_the_ci_files_of_the_repository_speak_for_a_folder_of_it_that_names_no_distro(tmp_path, monkeypatch, kind):
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    texts = {
        ".github/workflows/build.yaml": "container: ros:kilted",
        "Dockerfile": "FROM ros:rolling",  # of another folder's packages
        "src/silent/package.xml": "<package/>",
        "src/named/Dockerfile": "FROM ros:humble",
        "tools/.gitlab-ci.yml": "image: ros:foxy",
    }
    for path, text in texts.items():
        (tmp_path / path).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / path).write_text(text)

    def git(*arguments):
        given = ["git", "-C", tmp_path, "-c", "user.name=a", "-c", "user.email=a@example.org", *arguments]
        subprocess.run(given, check=True, capture_output=True)

    git("init", "-q", "-b", "main")
    git("add", ".")
    git("commit", "-q", "-m", "one")

    def choose(folder):
        tree = WorkingTree(tmp_path / folder) if kind == "files" else GitTree(tmp_path, "HEAD", folder)
        return [(item.target.distro, item.reason) for item in choose_targets((), Config(), 2, tree)]

    assert choose("src/silent") == [("kilted", "named by the workspace (../../.github/workflows/build.yaml)")]
    assert [distro for distro, _ in choose("src/named")] == ["humble"]


def test_asked_for_comes_first_then_the_configuration():
    tree = OneFile("Dockerfile", "FROM ros:humble")
    asked = choose_targets(("jazzy", "robot", "jazzy"), CONFIG, 2, tree)
    assert [item.target.name for item in asked] == ["jazzy", "robot"]
    config = CONFIG._replace(default_targets=("lab",))
    chosen = choose_targets((), config, 2, tree)
    assert [(item.target.name, item.reason) for item in chosen] == [("lab", "named in rosimpact.toml")]


@pytest.mark.parametrize(
    ("head", "branch"), [("ref: refs/heads/humble-devel\n", "humble-devel"), ("0123456789abcdef\n", ""), ("", "")]
)
def test_the_branch_of_a_repository(tmp_path, head, branch):
    (tmp_path / ".git").mkdir()
    (tmp_path / ".git" / "HEAD").write_text(head)
    assert read_branch(tmp_path) == branch


def test_a_worktree_has_its_own_branch(tmp_path):
    (tmp_path / "main" / ".git" / "worktrees" / "w").mkdir(parents=True)
    (tmp_path / "main" / ".git" / "worktrees" / "w" / "HEAD").write_text("ref: refs/heads/jazzy\n")
    (tmp_path / "w").mkdir()
    (tmp_path / "w" / ".git").write_text("gitdir: ../main/.git/worktrees/w\n")
    assert read_branch(tmp_path / "w") == "jazzy"
    assert read_branch(tmp_path / "nowhere") == ""


def test_build_stamps_of_no_day_do_not_count(tmp_path):
    rows = "".join(
        f"ii  ros-humble-{name}  1.2.3-1jammy.{stamp}  amd64  text\n"
        for name, stamp in (("a", "20240301.101010"), ("b", "29999999.101010"), ("c", "20249999.101010"))
    )
    (tmp_path / "robot.dpkg.txt").write_text(rows)
    assert parse_target("robot.dpkg.txt", folder=tmp_path).date == "2024-03-01"


@pytest.mark.parametrize("make", [os.mkfifo, os.mkdir, lambda path: path.symlink_to("/dev/zero")])
@pytest.mark.parametrize("name", ["robot.dpkg.txt", "robot.json"])
def test_a_file_that_is_none_is_not_opened(tmp_path, make, name):
    make(tmp_path / name)
    with pytest.raises(TargetError, match=name):
        parse_target(name, folder=tmp_path)


@pytest.mark.parametrize("key", ["date", "platform", "file", "versions"])
def test_numbers_that_cannot_be_written_are_no_texts(key):
    number = 16**9000
    table = {"distro": "jazzy", key: {"opencv": number} if key == "versions" else number}
    with pytest.raises(TargetError, match="must be texts"):
        parse_target("robot", Config(targets={"robot": table}))
