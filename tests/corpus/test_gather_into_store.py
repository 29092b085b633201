"""Gathering from services as they are: page by page into one store, without loss and without doubles."""

from __future__ import annotations

import itertools
import json
import random
from collections.abc import Callable
from pathlib import Path

import pytest
from rosimpact.corpus.gather import find_missing, find_service, gather, hydrate, import_reports, refresh
from rosimpact.corpus.polite import Client
from rosimpact.corpus.report import BugReport, CorpusError
from rosimpact.corpus.sources.github import GitHub, Listed, Searched
from rosimpact.corpus.sources.ros_answers import Archive, ArchivedFiles, Askbot
from rosimpact.corpus.sources.stack_exchange import StackExchange, TaggedQuestions
from rosimpact.corpus.store import CorpusStore, GatheredReport
from server import Fault, Services, archived, askbot_item, issue, pull, question, stamp
from waiting import Hours

NAV = "ros-navigation/navigation2"


@pytest.fixture
def server():
    services = Services()
    yield services
    services.close()


@pytest.fixture
def store(tmp_path):
    with CorpusStore(tmp_path / "corpus.sqlite", clock=ticking()) as opened:
        yield opened


def ticking() -> Callable[[], float]:
    """A second passes whenever somebody looks."""
    return itertools.count(1_000_000_000.0).__next__


def client(service: str = "GitHub", clock: Hours | None = None) -> Client:
    return Client(service, clock=clock or Hours(), timeout=2)


def github(server: Services) -> GitHub:
    return GitHub(client(), server.url)


def exchange(server: Services) -> StackExchange:
    return StackExchange(client("Stack Exchange"), f"{server.url}/2.3")


def ids(store: CorpusStore) -> list[str]:
    return [report.id for report in store.iterate_reports()]


def many(repository: str, count: int, start: int = 0) -> list[dict]:
    return [issue(repository, n + 1, day=stamp(1_700_000_000 + 60 * (start + n))) for n in range(count)]


# -- GitHub ------------------------------------------------------------------------------------------------------------


def test_a_report_of_github_is_what_was_posted(server, store):
    server.issues[NAV] = [issue(NAV, 7, day="2024-03-01T12:00:00Z", title="Costmap is empty", labels=[{"name": "bug"}])]
    gather(Listed(github(server), NAV), store)
    assert list(store.iterate_reports()) == [
        BugReport(
            id=f"{NAV}#7",
            url=f"https://github.com/{NAV}/issues/7",
            source="github",
            date="2024-03-01",
            title="Costmap is empty",
            body="Node 7 dies.\n\n```\n[ERROR] [7]: no transform\n```",
            tags=("bug",),
            author="robotnik",
        )
    ]


@pytest.mark.parametrize("field", ["body", "user", "labels"])
def test_an_issue_may_lack_what_its_author_or_github_left_out(server, store, field):
    server.issues[NAV] = [issue(NAV, 7, **{field: [] if field == "labels" else None})]
    gather(Listed(github(server), NAV), store)
    report = store.report(f"{NAV}#7")
    assert report is not None
    assert (report.body == "", report.author == "", report.tags == ()) == tuple(
        field == name for name in ("body", "user", "labels")
    )


def test_every_page_is_read_and_one_that_shifts_loses_nothing(server, store):
    server.issues[NAV] = many(NAV, 450)
    touched = iter(range(5))

    def comment(asked) -> None:
        """While pages are read, somebody comments on issues of the first page, which moves them to the end."""
        number = next(touched, None)
        if number is not None:
            server.issues[NAV][number]["updated_at"] = stamp(1_700_000_000 + 60 * 500 + number)

    server.after = comment
    gather(Listed(github(server), NAV), store)
    assert len(ids(store)) == 450


def test_more_reports_of_one_second_than_fit_a_page(server, store):
    """A bot that labels all issues at once gives them one time of update."""
    server.issues[NAV] = [issue(NAV, n, day="2024-01-01T00:00:00Z") for n in range(1, 351)]
    gather(Listed(github(server), NAV), store)
    assert len(ids(store)) == 350


def test_pull_requests_come_only_where_asked_for(server, tmp_path):
    server.issues[NAV] = [issue(NAV, 1), pull(NAV, 2)]
    for kinds, expected in ((("issue",), ["issue"]), (("issue", "pull"), ["issue", "pull"])):
        with CorpusStore(tmp_path / f"{len(kinds)}.sqlite") as store:
            gather(Listed(github(server), NAV, kinds=kinds), store)
            assert [report.kind for report in store.iterate_reports()] == expected


def test_since_goes_by_the_day_of_posting(server, store):
    old = issue(NAV, 1, day="2023-12-31T23:59:59Z", updated_at="2024-05-01T00:00:00Z")
    server.issues[NAV] = [old, issue(NAV, 2, day="2024-01-01T00:00:00Z")]
    gather(Listed(github(server), NAV, since="2024-01-01"), store)
    assert ids(store) == [f"{NAV}#2"]


def test_the_second_time_only_what_is_new_comes_and_nothing_new_costs_nothing(server, store):
    server.issues[NAV] = many(NAV, 120)
    gather(Listed(github(server), NAV), store)
    server.asked.clear()
    assert gather(Listed(github(server), NAV), store).new == 0
    assert [asked.headers.get("if-none-match", "")[:3] for asked in server.asked] == ['W/"']

    server.issues[NAV] += [issue(NAV, 121, day=stamp(1_700_000_000 + 60 * 400))]
    server.issues[NAV][3] |= {"body": "edited", "updated_at": stamp(1_700_000_000 + 60 * 401)}
    taken = gather(Listed(github(server), NAV), store)
    assert (taken.new, taken.changed) == (1, 1)
    edited = store.report(f"{NAV}#4")
    assert edited is not None and edited.body == "edited"
    assert len(ids(store)) == 121


def test_a_repository_that_moved_counts_once(server, store):
    """GitHub redirects the old name with its query; the reports carry the new one."""
    server.issues["ros-planning/navigation2"] = many("ros-planning/navigation2", 150)
    gather(Listed(github(server), "ros-planning/navigation2"), store)
    server.issues = {NAV: many(NAV, 160)}
    server.moved["ros-planning/navigation2"] = NAV
    gather(Listed(github(server), "ros-planning/navigation2"), store)
    gather(Listed(github(server), NAV), store)
    assert len(ids(store)) == 160
    assert set(ids(store)) == {f"{NAV}#{n}" for n in range(1, 161)}
    assert store.report("ros-planning/navigation2#1") == store.report(f"{NAV}#1")


def test_a_search_goes_beyond_the_thousand_results_that_github_gives(server, store):
    server.issues[NAV] = many(NAV, 2_300)
    gather(Searched(github(server), f"repo:{NAV} transform"), store)
    assert len(ids(store)) == 2_300
    server.asked.clear()
    server.issues[NAV] += many(NAV, 2_301)[-1:]
    assert gather(Searched(github(server), f"repo:{NAV} transform"), store).new == 1
    assert len(server.asked) == 1


def test_a_server_of_github_enterprise(server, store):
    server.issues[NAV] = [issue(NAV, n, url="https://ghe.example.org") for n in range(1, 131)]
    hub = GitHub(client(), f"{server.url}/api/v3", "t")
    gather(Listed(hub, NAV), store)
    gather(Searched(hub, f"repo:{NAV} transform"), store)
    assert hub.fetch_quota() == (10_000, 5_000)
    report = store.report(f"{NAV}#130")
    assert report is not None and report.url == f"https://ghe.example.org/{NAV}/issues/130"
    assert len(ids(store)) == 130


def test_an_issue_that_was_transferred_is_found_where_it_is_now(server, store):
    server.issues["ros2/rclcpp"] = [issue("ros2/rclcpp", 31, body="moved here")]
    place = {"Location": f"{server.url}/repos/ros2/rclcpp/issues/31"}
    server.fail(Fault(301, place))
    store.want(["ros2/ros2#7"])
    hydrate(github(server), "github", ["ros2/ros2#7"], store)
    gather(Listed(github(server), "ros2/rclcpp"), store)
    assert [(one.id, one.url, one.body) for one in store.iterate_reports()] == [
        ("ros2/ros2#7", "https://github.com/ros2/rclcpp/issues/31", "moved here")
    ]


def test_a_search_that_ran_out_of_time_is_asked_again(server, store):
    server.issues[NAV] = many(NAV, 30)
    server.incomplete = 2
    gather(Searched(github(server), f"repo:{NAV} transform"), store)
    assert len(ids(store)) == 30


def test_a_search_that_github_cannot_read_says_what_github_said(server, store):
    server.fail(Fault(422, body=b'{"message": "Validation Failed"}'))
    with pytest.raises(CorpusError, match=r"status 422 \(Validation Failed\); check the query"):
        gather(Searched(github(server), "repo:("), store)


@pytest.mark.parametrize("name", ["", "navigation2", "a/b/c", "../x"])
def test_a_name_that_is_none_is_refused_before_anything_is_asked(server, name):
    with pytest.raises(CorpusError, match="write github:owner/name"):
        Listed(github(server), name)


def test_what_is_kept_names_the_author_and_nothing_else_of_the_person(server, store):
    server.issues[NAV] = [issue(NAV, 1)]
    gather(Listed(github(server), NAV), store)
    raw = json.loads(store.read_raw(f"{NAV}#1"))
    assert raw["user"] == {"login": "robotnik", "html_url": "https://github.com/robotnik"}
    whole = store.path.read_bytes() + store.read_raw(f"{NAV}#1")
    for secret in (b"example.org", b"avatar", b"4711", b"assignee", b"MDQ6"):
        assert secret not in whole


# -- Stack Exchange and ROS Answers ------------------------------------------------------------------------------------


def test_questions_of_a_tag_come_in_the_order_of_posting(server, store):
    server.questions = [question(n) for n in range(1, 251)] + [question(900, tags=["arduino"])]
    taken = gather(TaggedQuestions(exchange(server), "ros2"), store)
    assert taken.new == 250
    assert all("key" not in asked.query and asked.query["site"] == "robotics" for asked in server.asked)
    server.asked.clear()
    server.questions.append(question(300))
    assert gather(TaggedQuestions(exchange(server), "ros2"), store).new == 1
    assert len(server.asked) == 1


def test_questions_that_were_migrated_in_one_second(server, store):
    server.questions = [question(n, creation_date=1_700_000_000) for n in range(1, 331)]
    gather(TaggedQuestions(exchange(server), "ros2"), store)
    assert len(ids(store)) == 330


@pytest.mark.parametrize("archive_first", [True, False])
def test_a_migrated_question_counts_once_whichever_side_came_first(server, store, tmp_path, archive_first):
    folder = tmp_path / "archive" / "content" / "question"
    folder.mkdir(parents=True)
    (folder / "10010.md").write_bytes(archived(10010, migrated=31710))
    footer = (
        '<p><a href="https://answers.ros.org/question/10010/slug/"><img src="x.png" alt="Rosanswers logo" /></a></p>'
        "<p>It fails.</p><hr /><p>Originally posted by <a>mj</a> on ROS Answers with karma: 21 on 2011-05-20</p>"
    )
    server.questions = [question(31710, footer), question(5)]
    jobs = [Archive(tmp_path / "archive"), TaggedQuestions(exchange(server), "ros2")]
    for source in jobs if archive_first else reversed(jobs):
        gather(source, store)
    assert ids(store) == ["robotics-se:5", "ros-answers:10010"]
    assert store.count_copied() == 1
    copy = store.report("robotics-se:31710")
    assert copy is not None and copy.same_as == "ros-answers:10010"


def test_of_a_migrated_question_the_post_with_a_label_speaks(server, store, tmp_path):
    folder = tmp_path / "content" / "question"
    folder.mkdir(parents=True)
    (folder / "10010.md").write_bytes(archived(10010, migrated=31710))
    server.questions = [question(31710)]
    gather(Archive(tmp_path), store)
    gather(TaggedQuestions(exchange(server), "ros2"), store)
    assert ids(store) == ["ros-answers:10010"]
    store.want(["robotics-se:31710"])
    assert ids(store) == ["robotics-se:31710"]


def test_an_askbot_gives_its_first_page_beyond_the_end_and_is_not_read_for_ever(server, store):
    server.askbot = [askbot_item(n) for n in range(1, 131)]
    gather(Askbot(client("Askbot"), server.url), store)
    assert len(ids(store)) == 130
    assert [asked.query["page"] for asked in server.asked] == ["1", "2", "3"]
    server.askbot += [askbot_item(n) for n in range(131, 161)]
    assert gather(Askbot(client("Askbot"), server.url), store).new == 30
    assert [asked.query["page"] for asked in server.asked[3:]] == ["3", "4"]


def test_a_question_deleted_while_an_askbot_is_read_hides_none(server, store):
    server.askbot = [askbot_item(n) for n in range(1, 131)]

    def delete(asked) -> None:
        if asked.query["page"] == "1" and len(server.askbot) == 130:
            del server.askbot[0]

    server.after = delete
    gather(Askbot(client("Askbot"), server.url), store)
    assert {f"ros-answers:{n}" for n in range(2, 131)} <= set(ids(store))


def test_the_archive_is_read_anew_only_where_a_file_changed(store, tmp_path, monkeypatch):
    from rosimpact.corpus.sources import ros_answers

    folder = tmp_path / "content" / "question"
    folder.mkdir(parents=True)
    for number in range(1, 451):
        (folder / f"{number}.md").write_bytes(archived(number))
    gather(Archive(tmp_path, known=store.read_digest), store)
    assert len(ids(store)) == 450
    (folder / "7.md").write_bytes(archived(7, body="Edited."))
    parsed = []
    parse = ros_answers.parse_archived
    monkeypatch.setattr(ros_answers, "parse_archived", lambda data, name: parsed.append(name) or parse(data, name))
    taken = gather(Archive(tmp_path, known=store.read_digest), store)
    assert parsed == ["content/question/7.md"]
    assert taken.changed == 1


def test_one_bad_file_of_the_archive_is_named_and_the_rest_is_read(store, tmp_path):
    folder = tmp_path / "content" / "question"
    folder.mkdir(parents=True)
    (folder / "1.md").write_bytes(archived(1))
    (folder / "2.md").write_bytes(b"---\ntitle: [\n---\ntext\n")
    (folder / "3.md").write_bytes(b"no front matter")
    source = Archive(tmp_path)
    gather(source, store)
    assert ids(store) == ["ros-answers:1"]
    assert [line.split(":")[0].split(",")[0] for line in source.unread] == [
        "content/question/2.md",
        "content/question/3.md",
    ]


# -- by id -------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("id", "service"),
    [
        ("ros2/rclcpp#12", "github"),
        ("https://api.github.com/repos/rospilot/rospilot/issues/72", "github"),
        ("ros-answers:10010", "ros-answers"),
        ("robotics-se:98659", "robotics-se"),
        ("gazebo-answers:1", ""),
        ("robotics-se:", ""),
    ],
)
def test_an_id_says_who_has_the_report(id, service):
    assert find_service(id) == service


def test_labelled_ids_are_gathered_again_and_those_gone_are_told(server, store):
    server.issues = {"ANYbotics/elevation_mapping": many("ANYbotics/elevation_mapping", 3)}
    server.issues["rospilot/rospilot"] = [issue("rospilot/rospilot", 72)]
    server.gone["ANYbotics/elevation_mapping#2"] = 410
    labelled = [
        "anybotics/elevation_mapping#1",  # spelled otherwise than GitHub does
        "ANYbotics/elevation_mapping#2",
        "https://api.github.com/repos/rospilot/rospilot/issues/72",
        "nobody/nothing#1",
    ]
    store.want(labelled)
    todo = find_missing(store, labelled)
    assert todo == {"github": labelled}
    taken = hydrate(github(server), "github", todo["github"], store)
    assert (taken.new, taken.gone) == (2, 2)
    assert {report.id for report in store.iterate_reports()} == {labelled[0], labelled[2]}
    assert find_missing(store, labelled) == {}


def test_a_labelled_report_keeps_its_id_when_its_repository_moves_and_is_gathered_too(server, store):
    server.issues[NAV] = many(NAV, 3)
    server.moved["ros-planning/navigation2"] = NAV
    store.want(["ros-planning/navigation2#2"])
    hydrate(github(server), "github", ["ros-planning/navigation2#2"], store)
    gather(Listed(github(server), NAV), store)
    assert sorted(ids(store)) == [f"{NAV}#1", f"{NAV}#3", "ros-planning/navigation2#2"]


def test_texts_at_hand_are_taken_over_and_replace_nothing(store):
    ours = BugReport("ros2/rclcpp#1", "u", "github", "2024-01-01", "t", "ours", wording="abridged")
    other = BugReport("ros2/rclcpp#9", "u", "github", "2024-01-01", "t", "of no label")
    taken, left_out = import_reports([ours, other], store, frozenset(["ros2/rclcpp#1"]))
    assert (taken.new, left_out) == (1, 1)
    import_reports(
        [BugReport("ros2/rclcpp#1", "u", "github", None, "t", "another")], store, frozenset(["ros2/rclcpp#1"])
    )
    assert store.report("ros2/rclcpp#1") == ours


def test_single_questions_of_the_archive_come_over_the_network(server, store):
    server.files["raw/content/question/10010.md"] = archived(10010)
    server.files["raw/content/question/1.md"] = archived(1, site="answers.gazebosim.org")
    service = ArchivedFiles(client("archive"), f"{server.url}/raw")
    taken = hydrate(service, "ros-answers", ["ros-answers:10010", "ros-answers:1", "ros-answers:404"], store)
    assert (taken.new, taken.gone) == (1, 2)


def test_an_archive_that_has_moved_makes_no_question_gone(server, store):
    service = ArchivedFiles(client("archive"), f"{server.url}/raw")
    with pytest.raises(CorpusError, match=r"is not at .*/raw any more; clone .* and give it with --archive DIR"):
        hydrate(service, "ros-answers", ["ros-answers:7"], store)
    assert store.find_kept("ros-answers:7") is None


def test_a_text_that_names_another_source_is_asked_for_where_its_id_leads(server, store):
    """As one of the corpus does: found on ROS Answers, posted on GitHub."""
    id = "https://api.github.com/repos/rospilot/rospilot/issues/72"
    import_reports([BugReport(id, id, "ros-answers", None, "t", "old")], store, frozenset([id]))
    server.issues["rospilot/rospilot"] = [issue("rospilot/rospilot", 72, body="new")]
    assert refresh(lambda source, count: github(server), store, ALL).changed == 1
    found = store.report(id)
    assert found is not None and found.body == "new"


# -- refresh -----------------------------------------------------------------------------------------------------------


def everything(server: Services, store: CorpusStore, folder: Path, count: int = 3) -> None:
    server.issues[NAV] = many(NAV, count)
    server.questions = [question(n) for n in range(1, count + 1)]
    questions = folder / "content" / "question"
    questions.mkdir(parents=True)
    for number in range(1, count + 1):
        (questions / f"{number}.md").write_bytes(archived(number))
    gather(Listed(github(server), NAV), store)
    gather(TaggedQuestions(exchange(server), "ros2"), store)
    gather(Archive(folder), store)


def services(server: Services, folder: Path):
    def service(source: str, count: int):
        if source == "github":
            return github(server)
        return exchange(server) if source == "robotics-se" else Archive(folder)

    return service


ALL = ("ros-answers", "robotics-se", "github")


def test_refresh_takes_edits_over_and_lets_go_of_what_was_deleted(server, store, tmp_path):
    everything(server, store, tmp_path / "archive")
    server.issues[NAV][0]["body"] = "edited"
    server.gone[f"{NAV}#2"] = 404
    server.questions[0]["body"] = "<p>edited</p>"
    del server.questions[1]
    (tmp_path / "archive/content/question/1.md").write_bytes(archived(1, body="edited"))
    (tmp_path / "archive/content/question/2.md").unlink()

    taken = refresh(services(server, tmp_path / "archive"), store, ALL)

    assert (taken.changed, taken.gone, taken.same) == (3, 3, 3)
    for prefix in (f"{NAV}#", "robotics-se:", "ros-answers:"):
        edited, gone = store.report(f"{prefix}1"), store.find_kept(f"{prefix}2")
        assert edited is not None and edited.body == "edited"
        assert gone is not None and gone.gone
        assert store.report(f"{prefix}2") is None and store.read_raw(f"{prefix}2") == b""
    assert len(ids(store)) == 6


def test_a_deleted_text_leaves_the_file_itself(tmp_path):
    """Not only its row: neither a free page nor the journal may hold it."""
    path = tmp_path / "corpus.sqlite"
    chance = random.Random(1)
    reports = [BugReport(f"a/b#{n}", "u", "github", None, "t", chance.randbytes(3000).hex()) for n in range(40)]
    with CorpusStore(path), CorpusStore(path) as store:  # one more has it open, or closing it would mend much by itself
        store.put([GatheredReport(report) for report in reports])
        packed = [row[0] for row in store._fetch_all("SELECT report FROM report ORDER BY id")]
        # what fits no page goes on in others, from which a piece of its end is looked for
        assert all(blob[-500:-400] in everything_of(tmp_path) for blob in packed)
        store.forget([(report.id, "github") for report in reports])
        store.close()
        assert not any(blob[-500:-400] in everything_of(tmp_path) for blob in packed)


def everything_of(folder: Path) -> bytes:
    return b"".join(file.read_bytes() for file in folder.iterdir())


def test_what_did_not_change_costs_nothing_of_the_quota(server, store):
    server.issues[NAV] = many(NAV, 2)
    store.want([f"{NAV}#1"])
    hydrate(github(server), "github", [f"{NAV}#1"], store)
    assert refresh(lambda source, count: github(server), store, ["github"]).same == 1
    assert server.asked[-1].headers["if-none-match"].startswith('W/"')


def test_a_refresh_that_was_left_goes_on_with_those_not_yet_asked_for(server, store, tmp_path):
    server.issues[NAV] = many(NAV, 10)
    gather(Listed(github(server), NAV), store)
    refresh(services(server, tmp_path), store, ["github"], limit=6)
    server.asked.clear()
    refresh(services(server, tmp_path), store, ["github"])
    assert len(server.asked) == 4


def test_a_report_that_comes_back_has_its_text_again(server, store):
    server.issues[NAV] = many(NAV, 1)
    server.gone[f"{NAV}#1"] = 410
    hydrate(github(server), "github", [f"{NAV}#1"], store)
    assert ids(store) == []
    server.gone.clear()
    refresh(lambda source, count: github(server), store, ["github"])
    assert ids(store) == [f"{NAV}#1"]
