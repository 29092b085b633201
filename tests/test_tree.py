"""WorkingTree, GitTree and JoinedTree: the same files, the same ids, the same folders left out."""

import os
import subprocess
import time

import pygit2
import pytest
from rosimpact.impact.tree import (
    GitTree,
    JoinedTree,
    PathProblem,
    TreeError,
    WorkingTree,
    compute_blob_id,
    normalize_path,
    open_merge_bases,
    shown,
)
from rosimpact.impact.tree import working as tree_module


def write(root, files):
    """files: content by path; a content that starts with `->` is a link, None an empty folder."""
    for path, content in files.items():
        place = os.path.join(os.fsencode(root), path.encode("utf-8", "surrogateescape"))
        os.makedirs(place if content is None else os.path.dirname(place), exist_ok=True)
        if content is not None and content.startswith("->"):
            os.symlink(content[2:], place)
        elif content is not None:
            with open(place, "wb") as file:
                file.write(content.encode())
    return root


def commit(root, message="change", parents=None):
    """Commits everything below root and returns the commit's id."""
    if os.path.isdir(os.path.join(root, ".git")):
        repo = pygit2.Repository(str(root))
    else:
        repo = pygit2.init_repository(str(root), initial_head="main")
    repo.index.add_all()
    repo.index.write()
    who = pygit2.Signature("t", "t@example.org", 1_600_000_000, 0)
    if parents is None:
        parents = [] if repo.head_is_unborn else [repo.head.target]
    return str(repo.create_commit("HEAD", who, who, message, repo.index.write_tree(), parents))


def paths(tree):
    return [entry.path for entry in tree.list_entries()]


def age(root, seconds=100):
    """Makes every file old enough for its id to be remembered, change times included."""
    old = time.time() - seconds
    for folder, _, names in os.walk(root):
        for name in names:
            os.utime(os.path.join(folder, name), (old, old))


@pytest.fixture
def later(monkeypatch):
    """Lets the tree believe that time has passed since the files were written."""
    monkeypatch.setattr(tree_module.time, "time_ns", lambda: int((time.time() + 100) * 1e9))


# (files, what is listed): the same for a directory without git and for a commit of all of it
LISTED = {
    "everything is listed, hidden folders included": (
        {"a/package.xml": "", ".github/workflows/ci.yml": "", ".gitignore": "", "z": ""},
        [".github/workflows/ci.yml", ".gitignore", "a/package.xml", "z"],
    ),
    "COLCON_IGNORE": ({"a/COLCON_IGNORE": "", "a/package.xml": "", "a/b/c.cpp": "", "ab/c": ""}, ["ab/c"]),
    "AMENT_IGNORE": ({"a/AMENT_IGNORE": "", "a/x": "", "b": ""}, ["b"]),
    "CATKIN_IGNORE": ({"a/CATKIN_IGNORE": "", "a/x": "", "b": ""}, ["b"]),
    "a marker below a package": ({"p/package.xml": "", "p/q/COLCON_IGNORE": "", "p/q/x.h": ""}, ["p/package.xml"]),
    "a marker at the root": ({"COLCON_IGNORE": "", "x": ""}, []),
    "an install space": ({"install/_setup_util.py": "", "install/share/a/package.xml": "", "x": ""}, ["x"]),
    "a build folder of colcon": ({"build/a/colcon_build.rc": "0", "build/a/build/lib/a/n.py": "", "x": ""}, ["x"]),
    "a build folder of CMake": ({"build/CMakeCache.txt": "", "build/a.cpp": "", "x": ""}, ["x"]),
    "built beside the sources": (
        {"CMakeCache.txt": "", "CMakeLists.txt": "", "a.cpp": ""}, ["CMakeCache.txt", "CMakeLists.txt", "a.cpp"]
    ),
    "products are skipped by their marker only": (
        {"build/a.cpp": "", "log/package.xml": "", "devel/COLCON_IGNORE": "", "devel/x": "", "src/p/build/b.cpp": ""},
        ["build/a.cpp", "log/package.xml", "src/p/build/b.cpp"],
    ),
    "a file is not its folder's prefix": ({"a-b/x": "", "a/x": "", "a.x": ""}, ["a-b/x", "a.x", "a/x"]),
    "links to files count as files": ({"a": "text", "b/c": "->../a"}, ["a", "b/c"]),
    "links to folders are followed": ({"a/x": "", "b/l": "->../a"}, ["a/x", "b/l/x"]),
    "a chain of links": ({"a/x": "", "l1": "->l2", "l2": "->a"}, ["a/x", "l1/x"]),
    "a link below a linked folder": ({"a/l": "->../b", "b/x": "", "c": "->a"}, ["a/l/x", "b/x"]),
    "a link to a parent": ({"a/b/up": "->../..", "a/x": ""}, ["a/x"]),
    "links that lead into each other": (
        {"a/to_b": "->../b", "b/to_a": "->../a", "a/x": "", "b/y": ""},
        ["a/to_b/y", "a/x", "b/to_a/x", "b/y"],
    ),
    "a link to itself": ({"loop": "->loop", "x": ""}, ["x"]),
    "a broken link": ({"l": "->nowhere", "x": ""}, ["x"]),
    "a link out of the tree's history": ({"l": "->../../nowhere/else", "x": ""}, ["x"]),
    "a link into an ignored folder is followed": ({"a/COLCON_IGNORE": "", "a/p/x": "", "l": "->a/p"}, ["l/x"]),
    "a name that is not UTF-8": ({"a\udcff.cpp": "x"}, ["a\udcff.cpp"]),
    "names with spaces and newlines": ({"a b/c\nd": ""}, ["a b/c\nd"]),
    "nothing": ({}, []),
}


@pytest.mark.parametrize(("files", "listed"), LISTED.values(), ids=LISTED)
def test_what_is_listed(tmp_path, files, listed):
    write(tmp_path, files)
    working = WorkingTree(tmp_path)
    assert paths(working) == listed
    revision = commit(tmp_path)
    git = GitTree(tmp_path, revision)
    assert paths(git) == listed
    assert git.list_entries() == working.list_entries()
    for path in listed:
        assert git.find_content_id(path) == working.find_content_id(path)
        assert git.read(path) == working.read(path)
    assert sorted(git.aliases.items()) == sorted(working.aliases.items())
    assert [p.path for p in git.problems] == [p.path for p in working.problems]
    assert git.skipped == working.skipped


PROBLEMS = {
    "a link to itself": ({"loop": "->loop"}, "loop", "link"),
    "a broken link": ({"a/l": "->nowhere"}, "a/l", "`nowhere` is broken"),
    "a link to a parent": ({"a/up": "->.."}, "a/up", "one of its own parent folders"),
    "a name that is not UTF-8": ({"a\udcff": ""}, "a\udcff", "not valid UTF-8"),
    "a submodule": (
        {".gitmodules": '[submodule "lib"]\n\tpath = lib\n\turl = ../lib\n', "lib": None},
        "lib",
        "not checked out",
    ),
}


@pytest.mark.parametrize(("files", "path", "message"), PROBLEMS.values(), ids=PROBLEMS)
def test_problems_are_named(tmp_path, files, path, message):
    tree = WorkingTree(write(tmp_path, files))
    tree.list_entries()
    assert [p.path for p in tree.problems] == [path]
    assert message in tree.problems[0].message


def test_what_is_skipped_is_told(tmp_path):
    tree = WorkingTree(write(tmp_path, {"a/COLCON_IGNORE": "", "b/x": "", "l1": "->b", "l2": "->b"}))
    tree.list_entries()
    assert [problem.path for problem in tree.skipped if "COLCON_IGNORE" in problem.message] == ["a"]
    assert len(tree.skipped) == 2 and tree.skipped[1].path in ("l1", "l2")


# (tracked files, files beside them, what is listed)
UNTRACKED = {
    "products at the root": (
        {"src/p/x": ""},
        {"build/p/y": "", "install/y": "", "log/y": "", "devel/y": "", "src/p/build/y": ""},
        ["src/p/build/y", "src/p/x"],
    ),
    "tracked products": ({"log/p.xml": "", "build/x": ""}, {"log/y": ""}, ["build/x", "log/p.xml", "log/y"]),
    "new files count": ({"a": ""}, {"b": "", "new_package/package.xml": ""}, ["a", "b", "new_package/package.xml"]),
    "hidden folders": ({".github/x": "", ".docker/x": ""}, {".cache/y": ""}, [".docker/x", ".github/x"]),
    "hidden folders that people write in": (
        {"a": ""}, {".devcontainer/Dockerfile": "", ".vscode/b": ""}, [".devcontainer/Dockerfile", "a"]
    ),
    "virtual environments": ({"a": "", "env/x": ""}, {"venv/pyvenv.cfg": "", "venv/x.py": ""}, ["a", "env/x"]),
    "a folder called env is none": ({"a": ""}, {"env/package.xml": ""}, ["a", "env/package.xml"]),
}  # fmt: skip


@pytest.mark.parametrize(("tracked", "beside", "listed"), UNTRACKED.values(), ids=UNTRACKED)
@pytest.mark.parametrize("index", ["version 2", "version 4"])
def test_products_that_git_does_not_track(tmp_path, tracked, beside, listed, index):
    commit(write(tmp_path, tracked))
    if index == "version 4":
        subprocess.run(["git", "-C", tmp_path, "update-index", "--index-version=4"], check=True)
    write(tmp_path, beside)
    assert paths(WorkingTree(tmp_path)) == listed


def test_several_repositories(tmp_path):
    commit(write(tmp_path / "src/one", {"package.xml": "", "build/x": ""}))
    commit(write(tmp_path / "src/two", {"p/package.xml": ""}))
    write(tmp_path, {"build/y": "", "src/own/package.xml": ""})
    tree = WorkingTree(tmp_path)
    assert paths(tree) == [
        "build/y",
        "src/one/build/x",
        "src/one/package.xml",
        "src/own/package.xml",
        "src/two/p/package.xml",
    ]
    assert sorted(tree.repositories) == ["src/one", "src/two"]
    assert tree.repositories["src/one"] == os.path.realpath(tmp_path / "src/one")


def test_a_folder_of_a_larger_repository(tmp_path):
    commit(write(tmp_path, {"ws/src/p/package.xml": "", "x": ""}))
    write(tmp_path, {"ws/build/y": "", "ws/.git_not": ""})
    tree = WorkingTree(tmp_path / "ws")
    assert paths(tree) == [".git_not", "src/p/package.xml"]
    assert tree.repositories == {"": os.path.realpath(tmp_path)}
    inner = GitTree(tmp_path, "HEAD", "ws")
    assert paths(inner) == ["src/p/package.xml"]
    assert inner.read("src/p/package.xml") == b"" and not inner.exists("x") and not inner.exists("../x")
    with pytest.raises(TreeError, match="no folder"):
        GitTree(tmp_path, "HEAD", "nowhere")


def test_a_worktree_knows_what_is_tracked(tmp_path):
    main = tmp_path / "main"
    commit(write(main, {"a": "", "log/x": ""}))
    pygit2.Repository(str(main)).add_worktree("other", str(tmp_path / "other"))
    write(tmp_path / "other", {"build/y": ""})
    assert paths(WorkingTree(tmp_path / "other")) == ["a", "log/x"]


@pytest.mark.parametrize("message", ["Permission denied", "Input/output error"])
def test_a_folder_that_cannot_be_listed(tmp_path, monkeypatch, message):
    write(tmp_path, {"a/x": "", "secret/y": ""})
    scandir = os.scandir

    def refuse(place):
        if not isinstance(place, int) and os.fspath(place).endswith("secret"):
            raise OSError(13, message)
        return scandir(place)

    monkeypatch.setattr(tree_module.os, "scandir", refuse)
    tree = WorkingTree(tmp_path)
    assert paths(tree) == ["a/x"]
    assert tree.problems == [PathProblem("secret", f"the folder cannot be listed: {message.lower()}")]


def test_what_is_neither_file_nor_folder(tmp_path):
    os.mkfifo(tmp_path / "pipe")
    tree = WorkingTree(tmp_path)
    assert paths(tree) == []
    assert tree.problems == [PathProblem("pipe", "neither a file nor a folder")]


def test_a_link_to_many_files_elsewhere_is_cut_off(tmp_path, monkeypatch):
    write(tmp_path, {f"elsewhere/{i}/x": "" for i in range(20)} | {"ws/a": "", "ws/far": "->../elsewhere"})
    monkeypatch.setattr(tree_module, "LINKED_FILES_AT_MOST", 5)
    tree = WorkingTree(tmp_path / "ws", follow_links=True)
    assert 5 < len(paths(tree)) < 12
    assert [p.path for p in tree.problems] == ["far"]


def test_a_deep_tree(tmp_path):
    folder = "/".join(["d"] * 400)
    tree = WorkingTree(write(tmp_path, {folder + "/x": ""}))
    assert paths(tree) == [folder + "/x"]


@pytest.mark.parametrize("place", ["nowhere", "file"])
def test_no_such_folder(tmp_path, place):
    write(tmp_path, {"file": ""})
    with pytest.raises(TreeError, match="give the folder"):
        WorkingTree(tmp_path / place)


# path, exists, is a folder
EXISTING = [
    ("", True, True), (".", True, True), ("p", True, True), ("p/", True, True), ("p/x.h", True, False),
    ("p/../p/x.h", True, False), ("p/third_party/y.h", True, False), ("p/third_party", True, True), ("q", False, False),
    ("p/x.h/z", False, False), ("..", False, False), ("/etc", False, False), ("link/x.h", True, False),
]  # fmt: skip


@pytest.mark.parametrize(("path", "exists", "is_dir"), EXISTING)
def test_exists_knows_skipped_folders_and_stays_inside(tmp_path, path, exists, is_dir):
    write(tmp_path, {"p/x.h": "", "p/third_party/COLCON_IGNORE": "", "p/third_party/y.h": "", "link": "->p"})
    git = GitTree(tmp_path, commit(tmp_path))
    for tree in (WorkingTree(tmp_path), git, JoinedTree({"": git})):
        tree.list_entries()
        assert (tree.exists(path), tree.is_dir(path)) == (exists, is_dir), tree


@pytest.mark.parametrize("path", ["../secret", "/etc/hostname", "nowhere"])
def test_reading_outside_of_the_tree_fails(tmp_path, path):
    write(tmp_path, {"secret": "", "ws/x": ""})
    git = GitTree(tmp_path / "ws", commit(tmp_path / "ws"))
    for tree in (WorkingTree(tmp_path / "ws"), git):
        with pytest.raises(OSError):
            tree.read(path)
        with pytest.raises(OSError):
            tree.find_content_id(path)


def test_ids_are_gits(tmp_path):
    write(tmp_path, {"a": "hello\n"})
    expected = subprocess.run(["git", "hash-object", tmp_path / "a"], capture_output=True, text=True, check=True)
    assert WorkingTree(tmp_path).find_content_id("a") == expected.stdout.strip() == compute_blob_id(b"hello\n")


def test_remembered_ids_are_not_read_again(tmp_path, later, monkeypatch):
    write(tmp_path, {"a": "1", "b": "2", "c\udcff": "3"})
    first = WorkingTree(tmp_path)
    ids = {path: first.find_content_id(path) for path in paths(first)}
    memory = first.make_memory()
    second = WorkingTree(tmp_path)
    second.list_entries()
    second.recall(memory)
    monkeypatch.setattr(second, "read_with_id", None)
    assert {path: second.find_content_id(path) for path in paths(second)} == ids
    assert second.make_memory() is None, "nothing new, nothing to write"


CHANGES = {
    "longer": lambda file: file.write_text("12"),
    "same size": lambda file: file.write_text("2"),
    "same size and time": lambda file: (file.write_text("2"), os.utime(file, ns=(1, 1))),
    "another file in its place": lambda file: (file.with_name("n").write_text("2"), file.with_name("n").replace(file)),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_a_changed_file_is_read_again(tmp_path, later, change):
    write(tmp_path, {"a": "1"})
    os.utime(tmp_path / "a", ns=(1, 1))
    first = WorkingTree(tmp_path)
    first.list_entries()
    assert first.find_content_id("a") == compute_blob_id(b"1")
    memory = first.make_memory()
    time.sleep(0.02)  # the clock of the file system must have moved on
    change(tmp_path / "a")
    second = WorkingTree(tmp_path)
    second.list_entries()
    second.recall(memory)
    assert second.find_content_id("a") == compute_blob_id((tmp_path / "a").read_bytes())


def test_a_file_changed_just_now_is_not_remembered(tmp_path):
    write(tmp_path, {"new": "1", "old": "1"})
    tree = WorkingTree(tmp_path)
    tree.list_entries()
    tree.find_content_id("new")
    assert tree.make_memory() is None, "its time stamp may not tell of the next change"


def test_a_file_with_a_time_stamp_in_the_future_is_not_remembered(tmp_path, later):
    write(tmp_path, {"a": "1"})
    os.utime(tmp_path / "a", (time.time() + 10_000,) * 2)
    tree = WorkingTree(tmp_path)
    tree.list_entries()
    tree.find_content_id("a")
    assert tree.make_memory() is None


@pytest.mark.parametrize(
    "memory",
    [b"", b"rubbish", b"\x94\x01\xc4\x00\xc4\x00\xc4\x03abc", b"\x94\x63\xc4\x00\xc4\x00\xc4\x00"],
    ids=["empty", "no msgpack", "lengths that do not fit", "another format"],
)
def test_a_damaged_memory_is_dropped(tmp_path, memory):
    tree = WorkingTree(write(tmp_path, {"a": "1"}))
    tree.list_entries()
    tree.recall(memory)
    assert tree.find_content_id("a") == compute_blob_id(b"1")


def test_forgotten_files_leave_the_memory(tmp_path, later):
    write(tmp_path, {f"f{i}": str(i) for i in range(300)})
    first = WorkingTree(tmp_path)
    for path in paths(first):
        first.find_content_id(path)
    full = first.make_memory()
    for i in range(290):
        os.remove(tmp_path / f"f{i}")
    second = WorkingTree(tmp_path)
    second.list_entries()
    second.recall(full)
    assert len(second.make_memory()) < len(full) / 10


def test_revisions(tmp_path):
    first = commit(write(tmp_path, {"a": "1"}))
    write(tmp_path, {"b": "2"})
    second = commit(tmp_path)
    repo = pygit2.Repository(str(tmp_path))
    who = pygit2.Signature("t", "t@example.org", 1_600_000_000, 0)
    repo.create_tag("v1", first, pygit2.enums.ObjectType.COMMIT, who, "annotated")
    repo.create_reference("refs/remotes/origin/only-there", first)
    for revision, expected in [
        (first, ["a"]), (first[:8], ["a"]), ("v1", ["a"]), ("HEAD~1", ["a"]), ("only-there", ["a"]),
        (f"{first}^{{tree}}", ["a"]), ("main", ["a", "b"]), ("HEAD", ["a", "b"]), (second, ["a", "b"]),
    ]:  # fmt: skip
        assert paths(GitTree(tmp_path, revision)) == expected, revision
    assert GitTree(tmp_path, "v1").label == f"v1 ({first[:10]})"
    assert GitTree(tmp_path, first).label == first[:10]
    assert GitTree(tmp_path, "main").open_revision("v1").commit == first


def test_a_bare_repository_and_a_folder_in_a_repository(tmp_path):
    commit(write(tmp_path / "full", {"src/a": "1"}))
    pygit2.clone_repository(str(tmp_path / "full"), str(tmp_path / "bare.git"), bare=True)
    assert paths(GitTree(tmp_path / "bare.git")) == ["src/a"]
    assert GitTree(tmp_path / "bare.git").name == "bare"
    assert paths(GitTree(tmp_path / "full/src")) == ["src/a"]


def test_merge_base(tmp_path):
    base = commit(write(tmp_path, {"a": "1"}))
    repo = pygit2.Repository(str(tmp_path))
    write(tmp_path, {"theirs": ""})
    theirs = commit(tmp_path)
    repo.create_branch("upstream", repo[theirs])
    repo.reset(base, pygit2.enums.ResetMode.HARD)
    write(tmp_path, {"ours": ""})
    commit(tmp_path)
    assert GitTree(tmp_path).merge_base("upstream").commit == base
    assert paths(GitTree(tmp_path).merge_base("upstream")) == ["a"]


def test_no_merge_base(tmp_path):
    commit(write(tmp_path, {"a": "1"}))
    repo = pygit2.Repository(str(tmp_path))
    who = pygit2.Signature("t", "t@example.org", 1_600_000_000, 0)
    lone = repo.create_commit(None, who, who, "lone", repo.index.write_tree(), [])
    with pytest.raises(TreeError, match="no history"):
        GitTree(tmp_path).merge_base(str(lone))


def test_a_folder_above_repositories_names_them(tmp_path):
    for name in ("one", "two"):
        commit(write(tmp_path / "src" / name, {"a": ""}))
    with pytest.raises(TreeError, match=r"one of a single repository: .*src/one`, `.*src/two`\)"):
        GitTree(tmp_path)


def test_no_such_revision_or_repository(tmp_path):
    with pytest.raises(TreeError, match="not in a git repository; give a folder that is in one"):
        GitTree(tmp_path)
    with pytest.raises(TreeError, match="git"):
        GitTree(tmp_path / "nowhere")
    commit(write(tmp_path, {"a": "1"}))
    for revision in ("v9", "a" * 40, "", "HEAD:a"):
        with pytest.raises(TreeError, match="no revision"):
            GitTree(tmp_path, revision)


def test_a_repository_without_commits(tmp_path):
    pygit2.init_repository(str(tmp_path))
    with pytest.raises(TreeError, match="no revision"):
        GitTree(tmp_path)
    assert paths(WorkingTree(write(tmp_path, {"a": ""}))) == ["a"]


def test_a_submodule_of_a_revision(tmp_path):
    commit(write(tmp_path, {"a": ""}))
    repo = pygit2.Repository(str(tmp_path))
    repo.index.add(pygit2.IndexEntry("lib", pygit2.Oid(hex="1" * 40), pygit2.enums.FileMode.COMMIT))
    who = pygit2.Signature("t", "t@example.org", 1_600_000_000, 0)
    repo.create_commit("HEAD", who, who, "sub", repo.index.write_tree(), [repo.head.target])
    tree = GitTree(tmp_path)
    assert paths(tree) == ["a"]
    assert tree.problems == [PathProblem("lib", "submodule at 1111111111, kept in another repository")]


def test_an_object_that_is_missing(tmp_path):
    commit(write(tmp_path, {"a": "1", "b": "2"}))
    oid = compute_blob_id(b"1")
    os.remove(tmp_path / ".git/objects" / oid[:2] / oid[2:])
    tree = GitTree(tmp_path)
    assert [(entry.path, entry.size) for entry in tree.list_entries()] == [("a", 0), ("b", 1)]
    with pytest.raises(OSError, match="missing"):
        tree.read("a")


def test_trees_joined(tmp_path):
    """A workspace whose one repository is read at an earlier commit."""
    write(tmp_path, {"top": "", "src/own/x": "new"})
    old = commit(write(tmp_path / "src/repo", {"a": "old", "skipped/COLCON_IGNORE": "", "link": "->d", "d/y": ""}))
    write(tmp_path / "src/repo", {"b": ""})
    (tmp_path / "src/repo/a").write_text("new")
    joined = JoinedTree({"": WorkingTree(tmp_path), "src/repo": GitTree(tmp_path / "src/repo", old)})
    assert paths(joined) == ["src/own/x", "src/repo/a", "src/repo/d/y", "src/repo/link/y", "top"]
    assert joined.read("src/repo/a") == b"old" and joined.find_content_id("src/repo/a") == compute_blob_id(b"old")
    assert not joined.exists("src/repo/b") and joined.is_dir("src") and joined.exists("top")
    assert joined.aliases == {"src/repo/link": "src/repo/d"}
    assert [p.path for p in joined.skipped] == ["src/repo/skipped"]
    assert list(joined.repositories) == ["src/repo"]
    with pytest.raises(OSError):
        JoinedTree({"src": WorkingTree(tmp_path)}).read("elsewhere")


@pytest.fixture
def team(tmp_path):
    """A workspace of two repositories, each with a branch `upstream` one commit behind, and a file of neither."""
    for name in ("one", "two"):
        root = write(tmp_path / "src" / name, {"old": name})
        base = commit(root)
        pygit2.Repository(str(root)).create_reference("refs/heads/upstream", base)
        write(root, {"new": name})
        commit(root)
    return write(tmp_path, {"own/x": ""})


@pytest.mark.parametrize(
    ("revisions", "default", "listed"),
    [
        ({}, "upstream", ["own/x", "src/one/old", "src/two/old"]),
        ({"src/two": "upstream"}, "", ["own/x", "src/one/new", "src/one/old", "src/two/old"]),
        ({"src/two/": "HEAD"}, "upstream", ["own/x", "src/one/old", "src/two/new", "src/two/old"]),
    ],
)
def test_a_workspace_at_its_merge_bases(team, revisions, default, listed):
    assert paths(open_merge_bases(WorkingTree(team), revisions, default)) == listed


@pytest.mark.parametrize(
    ("revisions", "default", "message"),
    [
        ({}, "v9", "no revision.*PATH=REV"),
        ({"own": "HEAD"}, "", "`own` is no git repository.*`src/one`, `src/two`"),
        ({"../elsewhere": "HEAD"}, "", "no git repository"),
    ],
)
def test_no_merge_bases(team, revisions, default, message):
    with pytest.raises(TreeError, match=message):
        open_merge_bases(WorkingTree(team), revisions, default)


def test_merge_bases_of_other_trees(team):
    assert paths(open_merge_bases(GitTree(team / "src/one"), {}, "upstream")) == ["old"]
    assert paths(open_merge_bases(WorkingTree(team / "src/one"), {}, "upstream")) == ["old"]
    commit(write(team / "large", {"ws/a": ""}))
    write(team / "large", {"ws/b": ""})
    assert paths(open_merge_bases(WorkingTree(team / "large/ws"), {}, "HEAD")) == ["a"]
    with pytest.raises(TreeError, match="no git repository"):
        open_merge_bases(WorkingTree(write(team.parent / "plain", {"a": ""})), {}, "HEAD")


@pytest.mark.parametrize(
    ("path", "text"),
    [("src/a.cpp", "src/a.cpp"), ("a\udcffb", "a\\xffb"), ("a\nb\x1b[31m", "a\\nb\\x1b[31m"), ("ü", "ü")],
)
def test_paths_as_they_are_printed(path, text):
    assert shown(path) == text


@pytest.mark.parametrize(
    ("path", "expected"),
    [
        ("", ""), (".", ""), ("a/../b", "b"), ("a/./b//c/", "a/b/c"), ("..a", "..a"),
        ("..", None), ("a/../../b", None), ("/a", None),
    ],
)  # fmt: skip
def test_inside(path, expected):
    assert normalize_path(path) == expected


# what a link leads to, words of the problem that names it
LEAVING = {
    "a file": ("../secret", "--follow-links"),
    "a folder": ("..", "--follow-links"),
    "nothing": ("../nowhere", "--follow-links"),
    "a device": ("/dev/zero", "--follow-links"),
    "a process's environment": ("/proc/self/environ", "--follow-links"),
    "a database of version control": (".git/config", "`.git`, which is not read"),
}


@pytest.mark.parametrize(("target", "words"), LEAVING.values(), ids=LEAVING)
def test_links_out_of_the_tree_are_named_and_not_followed(tmp_path, target, words):
    write(tmp_path, {"secret": "key", "ws/.git/config": "token", "ws/link": "->" + target, "ws/x": ""})
    tree = WorkingTree(tmp_path / "ws")
    assert paths(tree) == ["x"]
    assert [problem.path for problem in tree.problems] == ["link"] and words in tree.problems[0].message
    with pytest.raises(OSError):
        tree.read("link")
    if words == "--follow-links":
        assert not tree.exists("link") and not tree.is_dir("link") and not tree.exists("link/secret")


def test_links_out_of_the_tree_are_followed_when_asked_for(tmp_path):
    write(tmp_path, {"secret": "key", "lib/a.h": "", "ws/link": "->../secret", "ws/lib": "->../lib"})
    tree = WorkingTree(tmp_path / "ws", follow_links=True)
    assert paths(tree) == ["lib/a.h", "link"] and tree.read("link") == b"key"


def test_links_out_of_a_folder_of_a_revision(tmp_path):
    commit(write(tmp_path, {"shared/a.h": "", "ws/l": "->../shared", "ws/x": ""}))
    assert paths(GitTree(tmp_path, "HEAD", "ws")) == ["x"]
    assert paths(GitTree(tmp_path, "HEAD", "ws", follow_links=True)) == ["l/a.h", "x"]


def test_a_root_that_is_a_link_is_read(tmp_path):
    write(tmp_path, {"real/a": "1", "ws": "->real"})
    tree = WorkingTree(tmp_path / "ws")
    assert paths(tree) == ["a"] and tree.read("a") == b"1"


def test_a_file_that_became_a_link_out_of_the_tree_is_not_read(tmp_path):
    write(tmp_path, {"secret": "key", "ws/a": "1"})
    tree = WorkingTree(tmp_path / "ws")
    tree.list_entries()
    os.remove(tmp_path / "ws/a")
    os.symlink("../secret", tmp_path / "ws/a")
    with pytest.raises(OSError, match="outside"):
        tree.read("a")


def test_files_over_a_limit_are_not_read(tmp_path):
    git = GitTree(tmp_path, commit(write(tmp_path, {"a": "12345"})))
    for tree in (WorkingTree(tmp_path), git):
        assert tree.read("a", 5) == b"12345"
        with pytest.raises(OSError, match="larger than 4 bytes"):
            tree.read("a", 4)


@pytest.mark.parametrize("spoil", [lambda data: data[: len(data) // 2], lambda data: b"", lambda data: b"x" * 99])
def test_a_damaged_object_costs_its_file_alone(tmp_path, spoil):
    commit(write(tmp_path, {"a": "0123456789abcdefghij", "b": "2"}))
    oid = compute_blob_id(b"0123456789abcdefghij")
    place = tmp_path / ".git/objects" / oid[:2] / oid[2:]
    place.chmod(0o644)
    place.write_bytes(spoil(place.read_bytes()))
    tree = GitTree(tmp_path)
    assert paths(tree) == ["a", "b"] and tree.read("b") == b"2"
    with pytest.raises(OSError):
        tree.read("a")


@pytest.mark.parametrize("name", ["HEAD", "config", "packed-refs", "refs/heads/x", "objects/ab/cd", "shallow"])
def test_a_pipe_in_a_repository_is_named(tmp_path, name):
    commit(write(tmp_path, {"a": ""}))
    place = tmp_path / ".git" / name
    place.parent.mkdir(exist_ok=True)
    place.unlink(missing_ok=True)
    os.mkfifo(place)
    with pytest.raises(TreeError, match="not a regular file"):
        GitTree(tmp_path)
    assert paths(WorkingTree(tmp_path)) == ["a"]


def test_a_folder_that_stands_everywhere_is_cut_off(tmp_path):
    repo = pygit2.Repository(pygit2.init_repository(str(tmp_path), initial_head="main").path)
    item, mode = repo.create_blob(b"x"), pygit2.enums.FileMode.BLOB
    for _ in range(8):
        builder = repo.TreeBuilder()
        for number in range(10):
            builder.insert(str(number), item, mode)
        item, mode = builder.write(), pygit2.enums.FileMode.TREE
    who = pygit2.Signature("t", "t@example.org", 1_600_000_000, 0)
    repo.create_commit("HEAD", who, who, "many", item, [])
    tree = GitTree(tmp_path)
    assert len(tree.list_entries()) <= 100_000
    assert all("the same folder stands at more than" in problem.message for problem in tree.problems)


def test_a_folder_is_no_base(tmp_path):
    commit(write(tmp_path, {"src/a": "1"}))
    with pytest.raises(TreeError, match="without a commit"):
        GitTree(tmp_path).merge_base("HEAD:src")


@pytest.mark.parametrize(("kind", "entries", "told"), [
    (WorkingTree, 7, True), (GitTree, 7, True), (WorkingTree, 50, False), (GitTree, 50, False),
])  # fmt: skip
def test_paths_have_so_many_characters_in_all(tmp_path, monkeypatch, kind, entries, told):
    from rosimpact.edges.limits import Limits
    from rosimpact.impact.tree import paths, working

    for name in ("a", "b", "c"):
        place = tmp_path / ("d" * 250) / name
        place.parent.mkdir(exist_ok=True)
        place.write_text(name)
    commit(tmp_path)
    for module in (paths, working):
        monkeypatch.setattr(module, "get_limits", lambda: Limits(entries=entries))
    tree = kind(tmp_path)
    tree.list_entries()
    assert any("characters in all" in problem.message for problem in tree.problems) is told
