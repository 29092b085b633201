"""What a change brings: old findings do not fail the run, new ones do, in one repository or in several."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pygit2
import pytest
from rosimpact.impact.analysis.check import check, compare
from rosimpact.impact.analysis.revision_compare import BaseError, open_base_tree, read_pinned
from rosimpact.impact.analysis.session import Options
from rosimpact.impact.tree import GitTree, TreeError, WorkingTree

MANIFEST = """<package format="3">
  <name>{name}</name><version>1.0.0</version><description>d</description>
  <maintainer email="a@b.org">a</maintainer><license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <depend>libopencv-dev</depend>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""
CMAKE = (
    "cmake_minimum_required(VERSION 3.8)\nproject({name})\nfind_package(ament_cmake REQUIRED)\n{more}ament_package()\n"
)
WRONG = "find_package(OpenCV 9 REQUIRED)\n"  # on no target, so an error
JAZZY = Options(targets=("jazzy",))


def package(folder: Path, more: str = "") -> Path:
    """A package named as its folder, with more lines of CMake."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / "package.xml").write_text(MANIFEST.format(name=folder.name))
    (folder / "CMakeLists.txt").write_text(CMAKE.format(name=folder.name, more=more))
    return folder


def commit(folder: Path, message: str = "a commit") -> str:
    try:
        repository = pygit2.Repository(str(folder))
    except pygit2.GitError:
        repository = pygit2.init_repository(str(folder), initial_head="main")
    repository.index.add_all()
    repository.index.write()
    who = pygit2.Signature("a", "a@b.org", 1_700_000_000, 0)
    parents = [] if repository.head_is_unborn else [repository.head.target]
    return str(repository.create_commit("HEAD", who, who, message, repository.index.write_tree(), parents))


def branch(folder: Path, name: str) -> None:
    repository = pygit2.Repository(str(folder))
    repository.create_branch(name, repository[repository.head.target])


def errors(path: Path, *base: str, **options) -> dict[str, bool]:
    """Subjects of errors by package and whether they are new."""
    report = check(path, Options(targets=("jazzy",), base=base, **options))
    return {finding.package: finding.new for finding in report.findings if finding.severity == "error"}


@pytest.fixture(autouse=True)
def _cache(cache, monkeypatch):
    monkeypatch.setenv("ROSIMPACT_CACHE", str(cache))
    monkeypatch.delenv("ROS_DISTRO", raising=False)


def test_what_was_wrong_before_is_old(tmp_path):
    package(tmp_path / "old", WRONG)
    commit(tmp_path)
    package(tmp_path / "fresh", WRONG)
    assert errors(tmp_path, "HEAD") == {"old": False, "fresh": True}
    assert errors(tmp_path) == {"old": True, "fresh": True}


def test_uncommitted_committed_and_branched_changes_count_alike(tmp_path):
    package(tmp_path / "a")
    commit(tmp_path)
    branch(tmp_path, "release")
    package(tmp_path / "a", WRONG)
    assert errors(tmp_path, "release") == {"a": True}
    commit(tmp_path)
    assert errors(tmp_path, "release") == {"a": True}
    assert errors(tmp_path, "HEAD") == {"a": False}


def test_what_happened_on_the_base_since_is_not_ours(tmp_path):
    """The merge base counts: a fault fixed on main after we left is still old here."""
    package(tmp_path / "a", WRONG)
    commit(tmp_path)
    branch(tmp_path, "feature")
    package(tmp_path / "a")
    commit(tmp_path, "fixed on main")
    repository = pygit2.Repository(str(tmp_path))
    repository.checkout("refs/heads/feature")
    assert errors(tmp_path, "main") == {"a": False}


def test_moved_lines_and_moved_files_stay_old(tmp_path):
    package(tmp_path / "a", WRONG)
    commit(tmp_path)
    package(tmp_path / "a", "# a comment\n\n" + WRONG)
    assert errors(tmp_path, "HEAD") == {"a": False}
    (tmp_path / "moved").mkdir()
    shutil.move(tmp_path / "a", tmp_path / "moved/a")
    assert errors(tmp_path, "HEAD") == {"a": False}


def test_a_second_fault_of_a_kind_is_new(tmp_path):
    package(tmp_path / "a", WRONG)
    commit(tmp_path)
    package(tmp_path / "a", WRONG + WRONG)
    report = check(tmp_path, JAZZY._replace(base=("HEAD",)))
    assert [finding.new for finding in report.findings if finding.severity == "error"] == [False, True]


@pytest.fixture
def workspace(tmp_path) -> Path:
    """Two repositories below src/, each with one package, each changed for the worse after its first commit."""
    for name in ("driver", "navigation"):
        package(tmp_path / f"src/{name}/{name}")
        commit(tmp_path / f"src/{name}")
        branch(tmp_path / f"src/{name}", "release")
        package(tmp_path / f"src/{name}/{name}", WRONG)
        commit(tmp_path / f"src/{name}")
    return tmp_path


@pytest.mark.parametrize(
    ("base", "new"),
    [
        (["release"], {"driver": True, "navigation": True}),
        (["HEAD"], {"driver": False, "navigation": False}),
        (["HEAD", "src/driver=release"], {"driver": True, "navigation": False}),
        (["src/driver=release", "src/navigation=HEAD"], {"driver": True, "navigation": False}),
        (["driver=release", "./src/navigation/=HEAD"], {"driver": True, "navigation": False}),
        (["src/driver=release"], {"driver": True, "navigation": False}),
    ],
)
def test_several_repositories(workspace, base, new):
    assert errors(workspace, *base) == new


def test_a_repository_without_a_base_is_said_to_be_left_out(workspace):
    report = check(workspace, JAZZY._replace(base=("src/driver=release",)))
    assert any("src/navigation" in note and "nothing in it counts as new" in note for note in report.targets[0].notes)


@pytest.mark.parametrize(
    ("name", "text"),
    [
        (
            "a.repos",
            "repositories:\n  driver: {{type: git, url: x, version: {driver}}}\n  navigation: {{version: HEAD}}\n",
        ),
        ("a.repos", "repositories:\n  src/driver: {{version: '{driver}'}}\n  other: {{version: main}}\n"),
        (
            "a.rosinstall",
            "- git: {{local-name: driver, uri: x, version: {driver}}}\n- hg: {{local-name: navigation}}\n",
        ),
    ],
)
def test_a_pinned_file(workspace, name, text):
    pinned = pygit2.Repository(str(workspace / "src/driver")).revparse_single("release").id
    (workspace / name).write_text(text.format(driver=pinned))
    assert errors(workspace, str(workspace / name)) == {"driver": True, "navigation": False}


def test_only_git_repositories_with_a_version_are_read_from_a_file(tmp_path):
    file = tmp_path / "x.repos"
    file.write_text("repositories:\n  a: {type: git, version: 1.0}\n  b: {type: hg, version: x}\n  c: {type: git}\n")
    assert read_pinned(file) == {"a": "1.0"}
    with pytest.raises(BaseError, match=r"gone\.repos"):
        read_pinned(tmp_path / "gone.repos")


def test_interfaces_that_change(tmp_path):
    folder = package(tmp_path / "my_msgs", "find_package(rosidl_default_generators REQUIRED)\n"
                     'rosidl_generate_interfaces(my_msgs "msg/A.msg")\n')  # fmt: skip
    (folder / "msg").mkdir()
    (folder / "msg/A.msg").write_text("int32 kept\nint32 gone\n")
    commit(tmp_path)
    (folder / "msg/A.msg").write_text("int32 kept\n")
    report = check(tmp_path, JAZZY._replace(base=("HEAD",)))
    assert [(f.subject, f.new) for f in report.findings if f.rule == "removed-field"] == [("gone", True)]
    assert not [f for f in check(tmp_path, JAZZY).findings if f.rule == "removed-field"]
    nothing = check(tmp_path, JAZZY._replace(base=("HEAD",), ignore=("interfaces",)))
    assert not [f for f in nothing.findings if f.rule == "removed-field"]


def test_a_finding_against_the_base_can_be_silenced(tmp_path):
    folder = package(tmp_path / "my_msgs", 'rosidl_generate_interfaces(my_msgs "msg/A.msg")\n')
    (folder / "msg").mkdir()
    (folder / "msg/A.msg").write_text("int32 a\n")
    commit(tmp_path)
    (folder / "msg/A.msg").write_text("float32 a  # rosimpact: allow(changed-field-type)\n")
    report = check(tmp_path, JAZZY._replace(base=("HEAD",)))
    assert "changed-field-type" not in {f.rule for f in report.findings}
    assert "changed-field-type" in {f.rule for f in report.suppressed}


def test_folders_are_compared_as_well(tmp_path):
    package(tmp_path / "before/a")
    package(tmp_path / "after/a", WRONG)
    report = compare(tmp_path / "after", tmp_path / "before", JAZZY)
    assert [f.new for f in report.findings if f.severity == "error"] == [True]
    assert report.base
    assert not [f for f in compare(tmp_path / "after", tmp_path / "after", JAZZY).findings if f.new]


# -- revisions ---------------------------------------------------------------------------------------------------------


def test_a_revision_is_checked_without_a_checkout(tmp_path):
    package(tmp_path / "a", WRONG)
    first = commit(tmp_path)
    package(tmp_path / "a")
    commit(tmp_path)
    assert errors(tmp_path, rev=first) == {"a": True}
    assert errors(tmp_path, rev="HEAD") == {}
    assert errors(tmp_path) == {}


def test_a_folder_of_a_revision(tmp_path):
    package(tmp_path / "robot/a", WRONG)
    package(tmp_path / "other/b", WRONG)
    commit(tmp_path)
    assert errors(tmp_path / "robot", rev="HEAD") == {"a": True}
    (tmp_path / "robot/a/CMakeLists.txt").write_text(CMAKE.format(name="a", more=""))
    commit(tmp_path)
    assert errors(tmp_path / "robot", "HEAD~1", rev="HEAD") == {}
    assert errors(tmp_path / "robot", "HEAD", rev="HEAD~1") == {"a": False}


def test_a_bare_repository(tmp_path):
    package(tmp_path / "work/a", WRONG)
    (tmp_path / "work/rosimpact.toml").write_text('[targets.robot]\ndistro = "humble"\n')
    commit(tmp_path / "work")
    pygit2.clone_repository(str(tmp_path / "work"), str(tmp_path / "bare.git"), bare=True)
    report = check(tmp_path / "bare.git")
    assert [f.package for f in report.findings if f.severity == "error"] == ["a"]
    assert [target.name for target in report.targets] == ["robot"]


def test_a_folder_of_a_repository_is_no_bare_repository(tmp_path):
    """What a change adds beside a workspace does not show another one in its place."""
    package(tmp_path / "empty/clean")
    commit(tmp_path / "empty")
    package(tmp_path / "work/ws/a", WRONG)
    pygit2.clone_repository(str(tmp_path / "empty"), str(tmp_path / "bare.git"), bare=True)
    shutil.copytree(tmp_path / "bare.git", tmp_path / "work/ws", dirs_exist_ok=True)
    commit(tmp_path / "work")
    assert [f.package for f in check(tmp_path / "work/ws").findings if f.severity == "error"] == ["a"]


@pytest.mark.parametrize(("target", "tracked", "refused"), [
    ("../secret", True, True), ("../secret", False, False), ("src", True, False),
])  # fmt: skip
def test_a_workspace_that_a_repository_links_elsewhere(tmp_path, target, tracked, refused):
    package(tmp_path / "secret/a", WRONG)
    package(tmp_path / "work/src/a", WRONG)
    if tracked:
        (tmp_path / "work/ws").symlink_to(target)
    commit(tmp_path / "work")
    if not tracked:
        (tmp_path / "work/ws").symlink_to(target)
    if refused:
        with pytest.raises(TreeError, match="leads out of its repository, and is not followed"):
            check(tmp_path / "work/ws")
    found = check(tmp_path / "work/ws", Options(follow_links=refused))
    assert [f.package for f in found.findings if f.severity == "error"] == ["a"]


@pytest.mark.parametrize("folder", ["0", "z"])
def test_a_package_that_another_of_its_name_stands_for_is_a_warning(tmp_path, folder):
    package(tmp_path / "a", WRONG)
    package(tmp_path / folder / "a")
    told = [f for f in check(tmp_path, JAZZY).findings if "not analysed, because another package named" in f.message]
    assert [finding.severity for finding in told] == ["warning"]


def test_base_tree_of_a_revision_is_a_revision(tmp_path):
    package(tmp_path / "a")
    first = commit(tmp_path)
    package(tmp_path / "a", WRONG)
    commit(tmp_path)
    tree, notes = open_base_tree(GitTree(tmp_path), [first])
    assert isinstance(tree, GitTree) and tree.commit == first and notes == []


def test_a_named_folder_that_is_no_repository(tmp_path):
    package(tmp_path / "a")
    commit(tmp_path)
    with pytest.raises(Exception, match=r"`b` is no git repository.*`\.`"):
        open_base_tree(WorkingTree(tmp_path), ["b=HEAD"])


# -- the exit status --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("before", "after", "status"),
    [(WRONG, WRONG, 0), ("", WRONG, 1), (WRONG, "", 0), ("", "", 0), (WRONG, WRONG * 2, 1)],
)
def test_only_what_is_new_fails(say, tmp_path, before, after, status):
    package(tmp_path / "a", before)
    commit(tmp_path)
    package(tmp_path / "a", after)
    said = say("check", tmp_path, "--target", "jazzy", "--base", "HEAD", "--format", "json")
    assert said.status == status
    assert json.loads(said.out)["base"] == "HEAD"
