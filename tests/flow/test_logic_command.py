"""`rosimpact logic` as it is typed: what it prints, where it ends, and what it cannot tell."""

from __future__ import annotations

import json
from pathlib import Path

import pygit2
import pytest
from rosimpact.impact.cli.app import app
from rosimpact.impact.facts.store import Store
from rosimpact.impact.logic.repository import Logic, Range, read
from typer.testing import CliRunner

MANIFEST = "<package><name>beep</name><buildtool_depend>catkin</buildtool_depend></package>"
BEEP = """import rospy
from std_msgs.msg import Empty

def run():
    pub = rospy.Publisher("beeps", Empty, queue_size=1)
    if rospy.get_param("~on", True):
        pub.publish(Empty())

if __name__ == "__main__":
    rospy.init_node("beep")
    run()
"""


def history(folder: Path, *trees: dict[str, str | bytes]) -> Path:
    """A repository with a commit for each tree."""
    repo = pygit2.init_repository(str(folder), bare=True)
    parents: list = []
    for number, tree in enumerate(trees):
        index = pygit2.Index()
        for path, content in tree.items():
            data = content if isinstance(content, bytes) else content.encode()
            index.add(pygit2.IndexEntry(path, repo.create_blob(data), pygit2.enums.FileMode.BLOB))
        who = pygit2.Signature("A", "a@b.c", 1_700_000_000 + number, 0)
        parents = [repo.create_commit(None, who, who, f"commit {number}", index.write_tree(repo), parents)]
    repo.create_reference("refs/heads/main", parents[0])
    repo.set_head("refs/heads/main")
    return folder


def beep(*pairs: tuple[str, str]) -> dict[str, str | bytes]:
    text = BEEP
    for old, new in pairs:
        assert old in text
        text = text.replace(old, new)
    return {"package.xml": MANIFEST, "scripts/beep.py": text}


def logic(repository: Path, folder: Path) -> Logic:
    with Store(folder) as store:
        return read(str(repository), Range(), store)


def told(repository: Path, folder: Path) -> list[tuple[str, str]]:
    return [(commit.summary, change.kind) for commit, change in logic(repository, folder).changes]


@pytest.fixture
def typed(tmp_path, monkeypatch):
    monkeypatch.setenv("ROSIMPACT_CACHE", str(tmp_path / "cache"))
    return lambda *arguments: CliRunner().invoke(app, ["logic", *map(str, arguments), "--quiet"])


def test_names_that_match_apart_but_not_together(tmp_path, typed) -> None:
    def both(change: tuple[str, str]) -> dict[str, str | bytes]:
        hum = {**beep(change, ("beeps", "hums")), "package.xml": MANIFEST.replace(">beep<", ">hum<")}
        trees = {"beep": beep(change), "hum": hum}
        return {f"{name}/{path}": data for name, tree in trees.items() for path, data in tree.items()}

    repository = history(tmp_path / "repo", both(("True)", "True)")), both(("True)", "True) and ready()")))
    shown = typed(repository, "--package", "beep", "--topic", "hums")
    assert "--package beep --topic hums: changes match each of them, but nothing matches both" in shown.stderr
    shown = typed(repository, "--package", "beep", "--topic", "hmus")
    assert "--topic hmus: nothing of it changed" in shown.stderr and "--package" not in shown.stderr


@pytest.mark.parametrize(
    ("asked", "said"),
    [
        (("--package", "bep"), "--package bep: nothing of it changed; what did is of beep"),
        (("--topic", "beps"), "--topic beps: nothing of it changed; what did is of beeps"),
        (("--topic", "beeps"), ""),
    ],
)
def test_a_name_that_nothing_changed_of_is_said(tmp_path, typed, asked, said) -> None:
    repository = history(tmp_path / "repo", beep(), beep(("True)", "True) and ready()")))
    shown = typed(repository, *asked)
    assert shown.exit_code == 0
    assert said in shown.stderr
    assert bool(said) == ("nothing of it changed" in shown.stderr)


def test_formats(tmp_path, typed) -> None:
    repository = history(tmp_path / "repo", beep(), beep(("True)", "True) and ready()")))
    shown = typed(repository)
    assert shown.exit_code == 0
    assert "tightened        beeps (beep/beep)  scripts/beep.py:7" in shown.stdout
    document = json.loads(typed(repository, "--format", "json").stdout)
    assert [change["kind"] for change in document["changes"]] == ["tightened", "new"]
    page = tmp_path / "page.html"
    assert typed(repository, "--format", "html", "--output", page).exit_code == 0
    assert page.read_text().startswith("<!doctype html>")
    assert "1 tightened;" in typed(repository, "--commits", 1, "--topic", "/beeps").stdout
    assert "no change" in typed(repository, "--package", "other").stdout


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--range", "nowhere..HEAD"), "`nowhere` is no revision"),
        (("--since", "yesterday"), "--since: `yesterday` is no date"),
        (("--format", "sarif"), "--format sarif: unknown"),
    ],
)
def test_what_cannot_be_done_is_said(tmp_path, typed, options, said: str) -> None:
    shown = typed(history(tmp_path / "repo", beep()), *options)
    assert shown.exit_code == 2
    assert said in shown.output


def test_where_there_is_no_repository(tmp_path, typed) -> None:
    shown = typed(tmp_path)
    assert shown.exit_code == 2
    assert "not in a git repository" in shown.output
    assert "does not exist" in typed(tmp_path / "nowhere").output


def test_a_folder_of_a_repository(tmp_path) -> None:
    repository = tmp_path / "ws"
    inner = {f"src/beep/{path}": text for path, text in beep().items()}
    outer = {f"other/{path}": str(text).replace("beep", "honk") for path, text in beep().items()}
    history(repository / ".git", {**inner, **outer})
    pygit2.Repository(str(repository / ".git")).config["core.bare"] = False
    (repository / "src").mkdir()
    assert [change.path for _, change in logic(repository / "src", tmp_path / "a").changes] == [
        "src/beep/scripts/beep.py"
    ]
    assert len(logic(repository, tmp_path / "b").changes) == 2


def test_a_statement_of_which_less_is_known_is_not_gone(tmp_path) -> None:
    unknown = beep(
        ('rospy.Publisher("beeps", Empty, queue_size=1)', "Beeper()"), ("import rospy", "class Beeper: pass")
    )
    assert told(history(tmp_path / "repo", beep(), unknown), tmp_path / "cache") == [("commit 0", "new")]


@pytest.mark.parametrize("content", [b"\0\xff\xfe", b"(" * 50_000, b"def f(:\n", b"", b"\xef\xbb\xbfimport rospy\r\n"])
def test_files_that_cannot_be_read_end_nothing(tmp_path, content: bytes) -> None:
    broken: dict[str, str | bytes] = {**beep(), "scripts/other.py": content, "src/other.cpp": content}
    assert told(history(tmp_path / "repo", beep(), broken, beep()), tmp_path / "cache") == [("commit 0", "new")]


def test_a_history_that_was_cut_off(tmp_path) -> None:
    repository = history(tmp_path / "repo", beep(), beep(("True", "False")), beep(("True", "None")))
    (newest, middle, first) = logic(repository, tmp_path / "cache").commits
    (repository / "shallow").write_text(f"{middle.id}\n")
    found = logic(repository, tmp_path / "other")
    assert {commit.id for commit in found.commits} <= {newest.id, middle.id}
    assert first.id not in {commit.id for commit, _ in found.changes}


def test_an_interrupted_run_keeps_what_it_read(tmp_path, monkeypatch) -> None:
    trees = [beep(('rospy.get_param("~on", True)', f"rate > {number}")) for number in range(60)]
    repository = history(tmp_path / "repo", *trees)

    def stop(what: str, done: int, total: int) -> None:
        if what == "comparing commits":
            raise KeyboardInterrupt

    with Store(tmp_path / "cache") as store, pytest.raises(KeyboardInterrupt):
        read(str(repository), Range(), store, 1, stop)
    monkeypatch.setattr("rosimpact.impact.logic.repository._digest_chunk", lambda *_: pytest.fail("digested anew"))
    changes = logic(repository, tmp_path / "cache").changes
    assert [change.kind for _, change in changes] == ["tightened"] * 59 + ["new"]
