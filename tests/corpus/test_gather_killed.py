"""A gatherer that is killed at random points goes on: nothing is lost, and nothing is there twice."""

from __future__ import annotations

import contextlib
import multiprocessing
import random
import signal
import sqlite3
import time
from pathlib import Path

import pytest
from rosimpact.corpus import gather_commands
from rosimpact.corpus.gather_commands import Manner
from rosimpact.corpus.store import open_reports
from server import Services, archived, issue, question, stamp

KILLS = 20
REPO = "ros2/rclcpp"
# Fresh processes that have the imports done, so that kills fall into the work rather than into Python's start
processes = multiprocessing.get_context("forkserver")
processes.set_forkserver_preload(["rosimpact.corpus.gather_commands", "rosimpact.corpus.sources.github",
                                  "rosimpact.corpus.sources.ros_answers", "github.Issue", "yaml"])  # fmt: skip


@pytest.fixture
def server():
    services = Services()
    # a page is not there at once, and a kill may fall between request and answer
    services.after = lambda asked: time.sleep(0.005)
    yield services
    services.close()


def arguments(what: str, **more) -> dict:
    given = {"since": "", "pulls": False, "search": "", "tags": (), "archive": None, "pages": None}
    return {"what": what, **given, **more}


def test_github_killed_while_issues_are_edited_and_posted(server, tmp_path):
    rows = server.issues[REPO] = [
        issue(REPO, n + 1, day=stamp(1_600_000_000 + n // 7), body=f"body {n} " + "x" * 500) for n in range(4_000)
    ]
    chance = random.Random(3)

    def meanwhile(kill: int) -> None:
        row = chance.choice(rows)
        # Time does not go back: a gathering that came to its end has seen all that was changed until then.
        row |= {"body": f"edited after kill {kill}", "updated_at": stamp(1_660_000_000 + 2 * kill)}
        rows.append(issue(REPO, 5_000 + kill, day=stamp(1_660_000_001 + 2 * kill)))

    manner = Manner(tmp_path / "corpus.sqlite", server.url, 1.0, False, True)
    middle = killed(arguments(f"github:{REPO}", manner=manner), manner.store, meanwhile, chance)
    assert middle >= 5, "too few of the kills fell into the work for this test to mean something"
    found = {report.id: report.body for report in open_reports(tmp_path / "corpus.sqlite")}
    assert found == {f"{REPO}#{row['number']}": row["body"].replace("\r\n", "\n") for row in rows}


def test_stack_exchange_killed(server, tmp_path, monkeypatch):
    server.questions = [question(n, creation_date=1_600_000_000 + n // 9) for n in range(1, 3_000)]
    manner = Manner(tmp_path / "corpus.sqlite", f"{server.url}/2.3", 1.0, False, True)
    given = arguments("stack-exchange", tags=("ros2",), manner=manner)
    middle = killed(given, manner.store, lambda kill: None, random.Random(4))
    assert middle >= 5, "too few of the kills fell into the work for this test to mean something"
    ids = [report.id for report in open_reports(tmp_path / "corpus.sqlite")]
    assert len(ids) == len(set(ids)) == 2_999


def test_the_archive_killed(tmp_path):
    folder = tmp_path / "archive" / "content" / "question"
    folder.mkdir(parents=True)
    for number in range(1, 6_001):
        (folder / f"{number}.md").write_bytes(archived(number, body=f"body {number} " + "x" * 500))
    manner = Manner(tmp_path / "corpus.sqlite", "", 1.0, False, True)
    given = arguments("ros-answers", archive=tmp_path / "archive", manner=manner)
    middle = killed(given, manner.store, lambda kill: None, random.Random(5))
    assert middle >= 5, "too few of the kills fell into the work for this test to mean something"
    found = {report.id: report.body for report in open_reports(tmp_path / "corpus.sqlite")}
    assert found == {f"ros-answers:{n}": f"body {n} " + "x" * 500 for n in range(1, 6_001)}


def killed(given: dict, store: Path, meanwhile, chance: random.Random) -> int:
    """Starts a gathering, kills it at a random moment, twenty times, and then lets it end. Every other kill waits until
    it has written something. Returns how many of the kills found it in the middle of its work."""
    middle, before = 0, 0
    for kill in range(KILLS):
        process = start(given)
        if kill % 2:
            until = time.monotonic() + 20
            while written(store) == before and process.is_alive() and time.monotonic() < until:
                time.sleep(0.001)
            time.sleep(chance.uniform(0, 0.02))
        else:
            time.sleep(chance.uniform(0, 0.5))
        process.kill()
        process.join(20)
        assert process.exitcode in (0, -signal.SIGKILL)
        meanwhile(kill)
        now = written(store)
        assert now >= before, "what was written is lost"
        middle += process.exitcode == -signal.SIGKILL and now > before
        before = now
    last = start(given)
    last.join(60)
    assert last.exitcode == 0
    with contextlib.closing(sqlite3.connect(store)) as database:
        assert database.execute("PRAGMA integrity_check").fetchone() == ("ok",)
    return middle


def start(given: dict):
    process = processes.Process(target=gather_commands.gather, kwargs=given, daemon=True)
    process.start()
    return process


def written(store: Path) -> int:
    try:
        # A question that fails would leave the file open, and this is asked thousands of times.
        with contextlib.closing(sqlite3.connect(f"file:{store}?mode=ro", uri=True)) as database:
            return database.execute("SELECT count(*) FROM report").fetchone()[0]
    except sqlite3.OperationalError:
        return 0  # it was killed before the file, or its tables, were made
