"""The distros that a workspace is for, as it tells itself."""

import subprocess
from types import SimpleNamespace

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.impact.config import Config
from rosimpact.impact.targets.default_distros import (
    ReleasedPackage,
    StatedVersion,
    choose_default_distros,
    find_foreign_folders,
    find_named_distros,
    read_branch,
)
from rosimpact.impact.targets.distro.known import list_known_distros
from rosimpact.impact.targets.resolve import choose_targets
from rosimpact.impact.tree import GitTree, WorkingTree

DISTROS = list_known_distros()
NAMES = [known.name for known in DISTROS]
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


def release(path, home, *distros, repository=""):
    return ReleasedPackage(StatedVersion(path, repository, path.rpartition("/")[2], "1.2.3"), home, distros)


OWN = StatedVersion("src/ours", "", "ours", "0.0.0")
RELEASED = [
    # released packages, CI texts, what tells how to install things, the distros and where they come from
    ([release("src/a", "a", "humble"), release("src/b", "b", "humble", "jazzy")], [], [], ("humble",), "a 1.2.3"),
    # Packages of one repository are one voice.
    (
        [release("src/x/a", "x", "humble"), release("src/x/b", "x", "humble"), release("src/y", "y", "jazzy")],
        [],
        [],
        ("humble", "jazzy"),
        "1 more",
    ),
    ([release("src/a", "a", "humble")], [("", "ci.yml", workflow("jazzy"))], [], ("jazzy",), "ci.yml"),
    ([release("src/a", "a", "humble")], [], [("", "README.md", "ros-jazzy-desktop")], ("jazzy",), "README.md"),
    # What came with somebody else's package says least.
    ([release("src/a", "a", "humble")], [("", "src/a/Dockerfile", "FROM ros:jazzy")], [], ("humble",), "a 1.2.3"),
    ([release("src/a", "a")], [("", "src/a/Dockerfile", "FROM ros:jazzy")], [], ("jazzy",), "src/a/Dockerfile"),
    (
        [release("src/a", "a")],
        [("", "src/a/Dockerfile", "FROM ros:eloquent")],
        [("", "README.md", "source /opt/ros/humble/setup.bash"), ("", "src/a/README.md", "ros-jazzy-a")],
        ("humble",),
        "README.md",
    ),
    ([release("src/a", "a")], [("", "src/a/Dockerfile", "FROM ros:eloquent")], [], ("lyrical",), "eloquent ended"),
    ([release("src/a", "a", "galactic")], [], [], ("lyrical",), "nothing names another"),
]


@pytest.mark.parametrize(("released", "texts", "installing", "expected", "says"), RELEASED)
def test_released_versions_say_more_than_what_came_with_them(released, texts, installing, expected, says):
    packages = [OWN, StatedVersion("src/more", "", "more", "0.0.0"), *(one.package for one in released)]
    distros, reason = choose_default_distros(
        2, texts, [("", "main")], DISTROS, {}, DAY, installing, released=released, packages=packages
    )
    assert distros == expected
    assert says in reason


@pytest.mark.parametrize(
    ("texts", "expected"), [([], "noetic"), ([("", "ci.yml", workflow("melodic"))], "melodic")]
)
def test_of_a_generation_that_has_ended_an_old_readme_says_nothing(texts, expected):
    installing = [("", "README.md", "sudo apt install ros-melodic-desktop ros-lunar-desktop")]
    assert choose_default_distros(1, texts, [("", "main")], DISTROS, {}, DAY, installing)[0] == (expected,)


FOREIGN = [
    # A repository of its own packages, some of them not released.
    ([release("x/a", "x"), release("x/b", "x")], [StatedVersion("x/c", "", "c", "1.2.3")], ()),
    # Another's among ours.
    ([release("src/a", "a")], [OWN, StatedVersion("src/b", "", "b", "0.0.0")], ("src/a",)),
    # A whole repository among ours has one folder, with what in it is not released.
    (
        [release("src/nav/a", "nav"), release("src/nav/b", "nav"), release("src/c", "c")],
        [OWN, StatedVersion("src/nav/d", "", "d", "1.2.3")],
        ("src/nav", "src/c"),
    ),
    # Ours lie between them.
    (
        [release("src/a", "x"), release("src/b", "x"), release("src/c", "c")],
        [OWN, StatedVersion("src/ours2", "", "ours2", "0.0.0")],
        ("src/a", "src/b", "src/c"),
    ),
    # Clones beside each other are each their own.
    ([release("src/a", "a", repository="src/a"), release("src/b", "b", repository="src/b")], [OWN], ()),
]


@pytest.mark.parametrize(("released", "others", "expected"), FOREIGN)
def test_the_folders_of_somebody_else(released, others, expected):
    assert find_foreign_folders(released, [*others, *(one.package for one in released)]) == expected


def test_a_workspace_with_released_packages_is_for_the_distro_that_released_them(tmp_path, monkeypatch):
    monkeypatch.delenv("ROS_DISTRO", raising=False)
    packages = [StatedVersion(f"src/{name}", None, name, "0.0.0") for name in ("ours", "more", "much")]
    packages.append(StatedVersion("src/nav2_util", None, "nav2_util", "1.1.6"))
    chosen = choose_targets((), Config(), 2, WorkingTree(tmp_path), packages=packages)
    assert [(item.target.distro, item.reason) for item in chosen] == [
        ("humble", "what released the versions of packages here (nav2_util 1.1.6)")
    ]
