"""`rosimpact corpus gather`, `hydrate`, `refresh`, `export`, `status`: what they print, and how they end."""

from __future__ import annotations

import io
import json
import subprocess
import sys
import tarfile
import time

import pytest
from rosimpact.corpus.gather import Progress
from rosimpact.corpus.progress import Estimate, Reporter, describe_progress
from rosimpact.corpus.report import BugReport, read_reports, write_rows
from rosimpact.corpus.store import ReportCounts, open_reports
from rosimpact.impact.cli.app import app
from server import Fault, Services, archived, askbot_item, issue, question, stamp
from typer.testing import CliRunner

REPO = "ros2/rclcpp"


@pytest.fixture
def server():
    services = Services()
    services.issues[REPO] = [issue(REPO, n + 1, day=stamp(1_600_000_000 + n)) for n in range(120)]
    yield services
    services.close()


@pytest.fixture
def store(tmp_path, monkeypatch):
    for name in ("GITHUB_TOKEN", "GH_TOKEN", "GH_ENTERPRISE_TOKEN", "GITHUB_ENTERPRISE_TOKEN", "STACK_EXCHANGE_KEY"):
        monkeypatch.delenv(name, raising=False)
    monkeypatch.setenv("PYTHON_KEYRING_BACKEND", "keyring.backends.null.Keyring")
    monkeypatch.setenv("ROSIMPACT_CORPUS", str(tmp_path / "corpus.sqlite"))
    return tmp_path / "corpus.sqlite"


@pytest.fixture
def archive(tmp_path):
    folder = tmp_path / "archive" / "content" / "question"
    folder.mkdir(parents=True)
    for number in (9075, 10010):
        (folder / f"{number}.md").write_bytes(archived(number, migrated=number + 1))
    return tmp_path / "archive"


def test_a_gathering_of_github(say, server, store):
    said = say("corpus", "gather", f"github:{REPO}", "--api", server.url)
    where = server.url.removeprefix("http://")
    assert (said.status, said.out, said.err) == (0, f"github:{REPO} at {where} issue: 120 new\n", "")
    assert say("corpus", "gather", f"github:{REPO}", "--api", server.url).out.endswith("issue: nothing new\n")
    assert len(list(open_reports(store))) == 120


@pytest.mark.parametrize(
    "what",
    [
        f"github:{REPO}",
        f"https://github.com/{REPO}",
        f"https://github.com/{REPO}.git",
        f"https://github.com/{REPO}/issues",
    ],
)
def test_a_repository_may_be_given_as_people_have_it_at_hand(say, server, store, what):
    assert say("corpus", "gather", what, "--api", server.url, "--quiet").status == 0
    assert len(list(open_reports(store))) == 120


def test_verbose_says_a_line_for_each_page(say, server, store):
    said = say("corpus", "gather", f"github:{REPO}", "--api", server.url, "--verbose")
    lines = said.err.splitlines()
    assert len(lines) == 2
    assert "100 of about 150 read; 100 new" in lines[0]  # the last page is taken for half full
    assert "120 read; 120 new" in lines[1]


def test_a_limit_beyond_the_wait_ends_with_status_1_and_the_time(say, server, store):
    server.fail(Fault(), Fault(429, {"Retry-After": "7200"}))
    said = say("corpus", "gather", f"github:{REPO}", "--api", server.url, "--wait", "1")
    assert said.status == 1
    assert "rosimpact: GitHub: the rate limit is reached, and says to come back at " in said.err
    assert "run the same command again then" in said.err
    assert len(list(open_reports(store))) == 100
    assert say("corpus", "gather", f"github:{REPO}", "--api", server.url).status == 0
    assert len(list(open_reports(store))) == 120


def test_a_wait_is_told(say, server, store, monkeypatch):
    monkeypatch.setattr("rosimpact.corpus.polite.Clock.sleep", lambda self, seconds: None)
    server.fail(Fault(429, {"Retry-After": "45"}))
    said = say("corpus", "gather", f"github:{REPO}", "--api", server.url)
    assert said.err == "GitHub: the rate limit is reached; waiting 45 s\n"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["answers.ros.org"], "answers.ros.org went offline in 2024; gather its archive with"),
        (["https://answers.ros.org/question/9075/"], "went offline in 2024"),
        (["ros-answers", "--api", "https://answers.ros.org"], "went offline in 2024"),
        (["launchpad"], "launchpad: is no source; write github:owner/name, ros-answers or stack-exchange"),
        (["github:"], "github: names no repository; write github:owner/name, or give --search"),
        (["github:rclcpp"], "github:rclcpp: names no repository; write github:owner/name"),
        (["github:a/b", "--since", "yesterday"], "--since yesterday: is no day; write it like 2024-01-31"),
        (["github:a/b", "--tag", "ros2"], "--tag: says nothing to github; leave it out"),
        (["stack-exchange", "--pulls"], "--pulls: says nothing to stack-exchange; leave it out"),
        (["ros-answers", "--archive", "nowhere"], "nowhere: holds no `content/question`; give a clone of"),
        (["ros-answers", "--pages", "nowhere"], "nowhere: is no folder"),
        (["github:a/b", "--api", "nonsense"], "--api nonsense: is no address"),
        (["github:a/b", "--api", "http://[::"], "--api http://[::: is no address; give one like https://api.github.com"),
        (["stack-exchange", "--api", "https://"], "--api https://: is no address"),
        (["ros-answers", "--api", "answers.example.org"], "--api answers.example.org: is no address"),
        (["https://[::"], "https://[::: is no source"),
    ],
)  # fmt: skip
def test_what_cannot_be_is_said_in_a_line(say, store, arguments, message):
    said = say("corpus", "gather", *arguments)
    assert said.status == 2
    assert said.err.startswith("rosimpact: ") and message in said.err and said.err.count("\n") == 1


def test_something_that_is_no_github_is_said_in_a_line(say, server, store):
    server.fail(Fault(body=b'[{"id": 1}]'))
    said = say("corpus", "gather", f"github:{REPO}", "--api", server.url)
    assert said.status == 2 and "check that --api leads to a GitHub server" in said.err


def test_questions_of_stack_exchange(say, server, store):
    server.questions = [question(1), question(2, tags=["ros"]), question(3, tags=["arduino"])]
    said = say("corpus", "gather", "stack-exchange", "--tag", "ros2", "--api", f"{server.url}/2.3")
    assert said.status == 0 and said.out.endswith(": 1 new\n")
    assert say("corpus", "gather", "stack-exchange", "--api", f"{server.url}/2.3").status == 0
    assert len(list(open_reports(store))) == 2  # ros and ros2 where no tag is given


def test_questions_of_an_askbot(say, server, store):
    server.askbot = [askbot_item(n) for n in range(1, 61)]
    assert say("corpus", "gather", "ros-answers", "--api", server.url).status == 0
    assert len(list(open_reports(store))) == 60


def test_the_archive_from_a_clone(say, store, archive):
    (archive / "content/question/5.md").write_text("nonsense")
    said = say("corpus", "gather", "ros-answers", "--archive", archive)
    assert said.status == 0 and said.out.endswith(": 2 new\n")
    assert said.err == (
        "rosimpact: left out: content/question/5.md: has no YAML between lines of `---` at its top; take the file out\n"
    )


@pytest.fixture
def packed(server, monkeypatch):
    """The archive as the network has it."""
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w:gz") as tar:
        for number in (9075, 10010):
            data = archived(number)
            member = tarfile.TarInfo(f"answers-archive-1a2b/content/question/{number}.md")
            member.size = len(data)
            tar.addfile(member, io.BytesIO(data))
    server.files["tar.gz"] = packed.getvalue()
    monkeypatch.setattr("rosimpact.corpus.polite.Clock.sleep", lambda self, seconds: None)
    monkeypatch.setattr("rosimpact.corpus.sources.ros_answers.TARBALL", f"{server.url}/tar.gz")


def test_the_archive_from_the_network(say, server, store, packed):
    server.fail(Fault(part=0.5))
    assert say("corpus", "gather", "ros-answers", "--quiet").status == 0
    assert len(list(open_reports(store))) == 2
    assert say("corpus", "gather", "ros-answers", "--quiet").status == 0
    assert len(server.asked) == 2, "half a file was fetched anew, and a whole one is not fetched again the same day"


def test_a_fetch_that_must_try_again_says_so(say, server, store, packed):
    server.fail(Fault(503, {"Retry-After": "30"}))
    said = say("corpus", "gather", "ros-answers")
    assert said.status == 0
    first, second = said.err.splitlines()
    assert first == "fetching the archive of ROS Answers"
    assert second.startswith("the archive of ROS Answers: 127.0.0.1/tar.gz answered with status 503; waiting 30 s")


def test_what_a_killed_fetch_left_is_removed_and_what_another_writes_is_not(say, server, store, packed, tmp_path):
    code = (
        "from rosimpact.corpus.polite import Client; from pathlib import Path; import sys; "
        "Client('archive').download(sys.argv[1], Path(sys.argv[2]))"
    )

    def parts() -> set[str]:
        return {path.name for path in tmp_path.iterdir() if path.name.startswith(".answers-archive")}

    def half_fetched() -> subprocess.Popen:
        before, asked = parts(), len(server.asked)
        server.fail(Fault(pause=0.5))
        process = subprocess.Popen(
            [sys.executable, "-c", code, f"{server.url}/tar.gz", str(tmp_path / "answers-archive.tar.gz")]
        )
        until = time.monotonic() + 20
        while (len(server.asked) == asked or parts() == before) and time.monotonic() < until:
            time.sleep(0.01)
        return process

    killed = half_fetched()
    (left,) = parts()
    other = half_fetched()
    try:
        assert left in parts() and len(parts()) == 2
        killed.kill()
        killed.wait()
        assert say("corpus", "gather", "ros-answers").status == 0
        assert len(parts()) == 1 and left not in parts()
    finally:
        other.kill()
        other.wait()
    assert len(list(open_reports(store))) == 2


def write_labels(path, *ids: str) -> None:
    rows = [
        {"id": id, "label": "other", "kind": None, "phase": "run", "why": "w", "annotators": ["other"],
         "decided": "single"}
        for id in ids
    ]  # fmt: skip
    path.write_text("".join(json.dumps(row) + "\n" for row in rows))


def test_hydrate_gathers_every_labelled_text_and_names_those_gone(say, server, store, tmp_path, monkeypatch):
    monkeypatch.setattr("rosimpact.corpus.sources.ros_answers.FILES", f"{server.url}/raw")
    monkeypatch.setattr("rosimpact.corpus.sources.stack_exchange.API", f"{server.url}/2.3")
    server.files["raw/content/question/9075.md"] = archived(9075)
    server.questions = [question(98659)]
    labels = tmp_path / "labels.jsonl"
    write_labels(labels, "ROS2/rclcpp#7", f"{REPO}#999", "ros-answers:9075", "ros-answers:1", "robotics-se:98659")
    said = say("corpus", "hydrate", "--labels", labels, "--api", server.url)
    assert said.status == 0
    assert said.out == f"gone: {REPO}#999\ngone: ros-answers:1\n5 labelled: 3 at hand, 2 gone, 0 to be gathered\n"
    assert {one.id for one in open_reports(store)} == {"ROS2/rclcpp#7", "ros-answers:9075", "robotics-se:98659"}
    server.asked.clear()
    assert say("corpus", "hydrate", "--labels", labels, "--api", server.url).status == 0
    assert server.asked == [], "what is known is not asked for again"


def test_hydrate_that_must_stop_says_what_is_left(say, server, store, tmp_path):
    labels = tmp_path / "labels.jsonl"
    write_labels(labels, *(f"{REPO}#{n}" for n in range(1, 6)))
    server.fail(*[Fault(path="issues")] * 2, Fault(403, {"Retry-After": "7200"}, path="issues"))
    said = say("corpus", "hydrate", "--labels", labels, "--api", server.url, "--wait", "1")
    assert said.status == 1
    assert said.out == "5 labelled: 2 at hand, 0 gone, 3 to be gathered\n"
    assert say("corpus", "hydrate", "--labels", labels, "--api", server.url).out.startswith("5 labelled: 5 at hand")


def test_hydrate_says_beforehand_when_the_quota_will_not_do(say, server, store, tmp_path):
    labels = tmp_path / "labels.jsonl"
    write_labels(labels, *(f"{REPO}#{n}" for n in range(1, 6)))
    server.quota = 3
    said = say("corpus", "hydrate", "--labels", labels, "--api", server.url)
    assert "5 reports to ask for, 3 requests left of 5,000 an hour" in said.err
    assert "GITHUB_TOKEN raises it" in said.err


def test_hydrate_takes_texts_that_are_at_hand(say, store, tmp_path):
    labels, texts = tmp_path / "labels.jsonl", tmp_path / "texts.jsonl"
    write_labels(labels, f"{REPO}#1", f"{REPO}#2")
    rows = [BugReport(f"{REPO}#{n}", "u", "github", None, "t", f"body {n}", wording="abridged") for n in (1, 3)]
    write_rows(texts, rows)
    said = say("corpus", "hydrate", "--labels", labels, "--from", texts)
    assert said.status == 0
    assert said.out == f"{texts}: 1 new; 1 without a label left out\n2 labelled: 1 at hand, 0 gone, 1 to be gathered\n"
    assert list(open_reports(store)) == rows[:1]


def test_refresh_from_the_command_line(say, server, store, archive):
    say("corpus", "gather", f"github:{REPO}", "--api", server.url)
    say("corpus", "gather", "ros-answers", "--archive", archive)
    server.issues[REPO][0]["body"] = "edited"
    server.gone[f"{REPO}#2"] = 410
    (archive / "content/question/9075.md").unlink()
    said = say("corpus", "refresh", "--api", server.url, "--archive", archive)
    assert said.status == 0 and said.out == "refresh: 1 changed, 119 unchanged, 2 gone\n"
    assert len(list(open_reports(store))) == 120


def test_export_and_status(say, server, store, archive, tmp_path):
    say("corpus", "gather", f"github:{REPO}", "--api", server.url)
    say("corpus", "gather", "ros-answers", "--archive", archive)
    lines, columns = tmp_path / "out.jsonl", tmp_path / "out.parquet"
    assert say("corpus", "export", lines).out == f"{lines}: 122 reports\n"
    assert list(read_reports(lines)) == list(open_reports(store))
    said = say("corpus", "status")
    assert "  github: 120 reports, 0 of them labelled; 0 gone\n" in said.out
    assert "  ros-answers: 2 reports, 0 of them labelled; 0 gone\n" in said.out
    assert "issue: up to date, 20" in said.out
    parquet = pytest.importorskip("pyarrow.parquet")
    assert say("corpus", "export", columns).status == 0
    rows = parquet.read_table(columns).to_pylist()
    assert len(rows) == 122
    assert [BugReport(**row | {"tags": tuple(row["tags"])}) for row in rows] == list(open_reports(store))


def test_one_is_one(say, server, store, tmp_path):
    server.issues[REPO] = server.issues[REPO][:1]
    say("corpus", "gather", f"github:{REPO}", "--api", server.url)
    assert say("corpus", "export", tmp_path / "out.jsonl").out.endswith(": 1 report\n")
    assert "  github: 1 report, 0 of them labelled; 0 gone\n" in say("corpus", "status").out


def test_parquet_without_pyarrow_says_what_to_install(say, server, store, monkeypatch, tmp_path):
    say("corpus", "gather", f"github:{REPO}", "--api", server.url)
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    said = say("corpus", "export", tmp_path / "out.parquet")
    assert said.status == 2 and "Parquet needs pyarrow; install it with `pip install rosimpact[study]`" in said.err


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["export", "out.csv"], "is not there; gather something first"),
        (["status"], "is not there; gather something first with `rosimpact corpus gather`"),
        (["refresh", "--source", "launchpad"], "--source launchpad: unknown; choose one of github"),
    ],
)
def test_commands_on_nothing_say_what_to_do_first(say, store, arguments, message):
    said = say("corpus", *arguments)
    assert said.status == 2 and message in said.err


def test_a_format_that_is_none(say, server, store, tmp_path):
    say("corpus", "gather", f"github:{REPO}", "--api", server.url)
    said = say("corpus", "export", tmp_path / "out.csv")
    assert said.status == 2 and "of no known format; name it *.jsonl or *.parquet" in said.err


# -- progress ----------------------------------------------------------------------------------------------------------


def test_an_estimate_counts_what_was_waited_and_is_silent_until_it_can_know():
    times = iter([0.0, 10.0, 20.0, 90.0, 100.0])
    estimate = Estimate(clock=lambda: next(times))
    # 300 reports in 90 s, a minute of it waited: 3.3 a second
    assert [estimate.estimate_left(done, 1000) for done in (100, 200, 300, 400)] == [None, None, None, 180.0]
    assert estimate.estimate_left(500, None) is None


def test_progress_in_words():
    assert describe_progress(Progress(1200, 4000, ReportCounts(new=1000, same=200)), 75.0) == (
        "1,200 of about 4,000 read; 1,000 new, 200 unchanged, about 75 s left"
    )
    assert describe_progress(Progress(0, None, ReportCounts()), None) == "0 read; nothing new"


def test_a_terminal_shows_a_line_that_renews_itself():
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    stream = Terminal()
    with Reporter("github:a/[b]", stream=stream) as reporter:
        for done in (100, 200):
            reporter.report_page(Progress(done, 400, ReportCounts(new=done)))
        reporter.print_line("GitHub: the rate limit is reached; waiting 45 s")
        assert reporter._bars is not None
        reporter._bars.refresh()
    assert "github:a/[b]" in stream.getvalue() and "waiting 45 s" in stream.getvalue()


@pytest.mark.parametrize(
    "arguments",
    [
        ["gather", "launchpad"],
        ["gather", "ros-answers", "--archive", "nowhere"],
        ["gather", f"github:{REPO}", "--api", "{server}/nothing/here", "--wait", "0"],
        ["gather", "github:ros2/empty", "--api", "{server}"],
        ["gather", "stack-exchange", "--api", "{server}/2.3"],
        ["hydrate", "--labels", "nowhere.jsonl"],
        ["hydrate", "--labels", "{tmp}/labels.jsonl", "--from", "nowhere.jsonl"],
        ["hydrate", "--labels", "{tmp}/labels.jsonl", "--api", "{server}/nothing/here", "--wait", "0"],
    ],
)
def test_what_fails_or_finds_nothing_leaves_no_store(say, server, store, tmp_path, arguments):
    server.issues["ros2/empty"] = []
    write_labels(tmp_path / "labels.jsonl", f"{REPO}#1", "launchpad:1")
    server.fail(*[Fault(500, path="nothing")] * 20)
    said = say("corpus", *(part.format(server=server.url, tmp=tmp_path) for part in arguments))
    assert said.status in (0, 2) and "fault of rosimpact" not in said.err
    assert [path.name for path in tmp_path.iterdir()] == ["labels.jsonl"]


def test_refresh_makes_no_store(tmp_path):
    result = CliRunner().invoke(app, ["corpus", "refresh", "--store", str(tmp_path / "none.sqlite")])
    assert result.exit_code == 2
    assert "none.sqlite: is not there" in result.output
    assert list(tmp_path.iterdir()) == []
