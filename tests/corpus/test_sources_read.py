"""What is read from the formats of the three services, with the traps that each of them sets."""

from __future__ import annotations

import contextlib
import json

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.corpus.report import CorpusError
from rosimpact.corpus.sources.markup import convert_to_markdown
from rosimpact.corpus.sources.person import make_public_name
from rosimpact.corpus.sources.ros_answers import (
    Archive,
    Askbot,
    SavedPages,
    is_live_site,
    parse_archived,
    parse_item,
    parse_page,
)
from rosimpact.corpus.sources.stack_exchange import convert, find_original
from server import archived, askbot_item, question

# -- HTML as Markdown --------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("html", "text"),
    [
        ("<p>One <em>two</em>\nthree.</p><p>Four.</p>", "One *two* three.\n\nFour."),
        ("<pre><code>a  b\n\n\n\nc\n</code></pre>", "```\na  b\n\n\n\nc\n```"),  # code keeps its blank lines
        ("<p>run <code>rosdep install</code></p>", "run `rosdep install`"),
        ("<p><code>a `b` c</code></p>", "``a `b` c``"),
        ("<pre>```\nx\n```</pre>", "````\n```\nx\n```\n````"),
        ('<p>see <a href="http://x/y">here</a></p>', "see [here](http://x/y)"),
        ('<a href="http://x/y">http://x/y</a>', "http://x/y"),
        ("<ul><li>a</li><li>b<ul><li>c</li></ul></li></ul>", "- a\n- b\n\n   - c"),
        ("<ol><li>a</li><li>b</li></ol>", "1. a\n2. b"),
        ("<blockquote><p>a</p><p>b</p></blockquote><p>c</p>", "> a\n>\n> b\n\nc"),
        ("<h2>Setup</h2><p>x</p>", "## Setup\n\nx"),
        ("a<br />b", "a\nb"),
        ("<p>a &lt;b&gt; &amp; c</p>", "a <b> & c"),
        ('<p>x</p><script>alert("x")</script><!-- no -->', "x"),
        ('<p><img alt="rviz" src="a.png"></p>', "![rviz](a.png)"),
        ("", ""),
    ],
)
def test_what_matters_of_html_survives(html, text):
    assert convert_to_markdown(html) == text


@given(st.text(alphabet=st.characters(codec="utf-8", exclude_characters="\r\x00"), max_size=200))
def test_code_survives_whatever_it_holds(code):
    import html

    text = convert_to_markdown(f"<p>before</p><pre><code>{html.escape(code)}</code></pre><p>after</p>")
    assert code.strip("\n") in text
    assert text.startswith("before\n\n```") and text.endswith("```\n\nafter")


@given(st.text(max_size=300))
def test_any_text_is_some_html(text):
    assert isinstance(convert_to_markdown(text), str)


@pytest.mark.parametrize(
    ("given", "kept"),
    [("Ann B", "Ann B"), ("ann@example.org", "ann"), ("ann@home", "ann@home"), ("@ann", "@ann"), (None, "")],
)
def test_a_name_that_is_a_mail_address_is_not_kept_as_one(given, kept):
    assert make_public_name(given) == kept


def test_mail_addresses_as_names_stay_out_of_what_is_kept():
    found = parse_archived(archived(1).replace(b"fergs\n", b"f@example.org\n"), "1.md")
    item = parse_item(askbot_item(1, author={"id": 1, "username": "m@example.org"}))
    asked = convert(question(1, owner={"display_name": "m@example.org"}))
    assert found is not None
    for one in (found[0], item, asked):
        assert b"example.org" not in one.raw.replace(b"answers.example.org", b"")
    assert (item.report.author, asked.report.author) == ("m", "m")


# -- the archive of ROS Answers ----------------------------------------------------------------------------------------


def test_a_file_of_the_archive():
    found = parse_archived(archived(10010, migrated=31710, body="It fails:\n\n    no transform"), "10010.md")
    assert found is not None
    (report, raw, *_), copy = found
    assert (report.id, report.date, report.tags) == ("ros-answers:10010", "2013-11-11", ("tf2", "catkin"))
    assert (report.author, report.licence, report.kind) == ("Martin Günther", "CC-BY-SA-3.0", "question")
    assert report.body == "It fails:\n\n    no transform"
    assert copy == "robotics-se:31710"
    kept = json.loads(raw)
    assert kept["answers"][0]["body_markdown"] == "Source your workspace."
    assert kept["answers"][0]["owner_display_name"] == "fergs"
    assert not {"owner_id", "owner_karma", "owner_user_id"} & ({*kept} | {*kept["answers"][0]})


CAMEL = b"""---
Answers: []
Comments:
- BodyMarkdown: same here
  CreationDate: '2013-07-30T15:49:01Z'
  OriginalPostID: 4000
  OwnerDisplayName: suvrat
  OwnerKarma: 53
  OwnerProfileUrl: https://answers.ros.org/users/438/suvrat/
CreationDate: '2012-09-19T23:07:26Z'
MigratedUrl: https://robotics.stackexchange.com/questions/25232/how-to-stop
OriginalPostID: 9075
OriginalPostURL: https://answers.ros.org/question/9075/how-to-stop/
OwnerDisplayName: nkoenig
OwnerKarma: 7676
Tags: gazebo
Title: how to stop
UpvoteCount: 0
---
Text\r
of two lines
"""


def test_older_commits_of_the_archive_write_keys_otherwise():
    found = parse_archived(CAMEL, "9075.md")
    assert found is not None
    (report, raw, *_), copy = found
    assert (report.id, report.title, report.body) == ("ros-answers:9075", "how to stop", "Text\nof two lines")
    assert copy == "robotics-se:25232"
    assert json.loads(raw)["comments"][0]["body_markdown"] == "same here"
    assert b"7676" not in raw


def test_questions_of_gazebo_lie_in_the_same_folder_and_are_none_of_ros():
    assert parse_archived(archived(1, site="answers.gazebosim.org"), "1.md") is None


@pytest.mark.parametrize("title", ["2013", "no", "1.10", "2013-01-01", "~", "'quoted: yes'"])
def test_a_title_that_yaml_takes_for_something_else_is_still_a_title(title):
    found = parse_archived(archived(1, title=title), "1.md")
    assert found is not None
    assert found[0].report.title == title.strip("'")


def test_a_question_may_hold_lines_of_dashes():
    found = parse_archived(archived(1, body="a\n---\nb\n---\nc"), "1.md")
    assert found is not None
    assert found[0].report.body == "a\n---\nb\n---\nc"


@pytest.mark.parametrize(
    ("data", "message"),
    [
        (b"no front matter", "1.md: has no YAML between lines of `---`"),
        (b"---\ntitle: [\n---\nx", "1.md, line [0-9]+: is no YAML"),
        (b"---\njust text\n---\nx", "1.md: has no YAML"),
        (b"---\ntitle: x\n---\nx", "1.md: has no `original_post_id`"),
        (b"", "1.md: has no YAML"),
    ],
)
def test_a_file_that_is_no_question_is_named(data, message):
    with pytest.raises(CorpusError, match=message):
        parse_archived(data, "1.md")


@given(st.binary(max_size=300))
def test_no_bytes_break_the_reader_of_the_archive(data):
    for whole in (data, b"---\n" + data + b"\n---\n" + data):
        with contextlib.suppress(CorpusError):
            parse_archived(whole, "1.md")


def test_a_folder_that_is_no_archive_says_what_to_give(tmp_path):
    with pytest.raises(CorpusError, match=r"give a clone of https://github\.com/ros-infrastructure/answers-archive"):
        Archive(tmp_path)


def test_a_tarball_without_questions_says_what_to_give(tmp_path):
    import tarfile

    with tarfile.open(tmp_path / "archive.tar.gz", "w:gz") as tar:
        tar.add(__file__, "answers-archive/README.md")
    with pytest.raises(CorpusError, match=r"holds no questions; give a clone of .* with --archive DIR"):
        list(Archive(tmp_path / "archive.tar.gz").read_pages(None))


def test_a_tarball_that_is_damaged_says_so(tmp_path):
    (tmp_path / "archive.tar.gz").write_bytes(b"\x1f\x8b nothing of the kind")
    with pytest.raises(CorpusError, match="is damaged; delete it, and it is fetched again"):
        list(Archive(tmp_path / "archive.tar.gz").read_pages(None))


def test_the_archive_lists_more_copies_than_its_questions_name(tmp_path):
    (tmp_path / "content/question").mkdir(parents=True)
    (tmp_path / "content/question/9.md").write_bytes(archived(9))
    (tmp_path / "answers").mkdir()
    posts = [{"OriginalPostID": 9, "NewUrl": "https://robotics.stackexchange.com/questions/25232/x"}]
    (tmp_path / "answers/ros-to-robotics.json").write_text(json.dumps({"Posts": posts}))
    assert [page.copies for page in Archive(tmp_path).read_pages(None)] == [(("robotics-se:25232", "ros-answers:9"),)]


@pytest.mark.parametrize(
    ("address", "gone"),
    [
        ("https://answers.ros.org/question/9075/", True),
        ("http://answers.ros.org./questions/", True),
        ("answers.ros.org", True),
        ("https://answers.gazebosim.org/", False),
        ("https://mirror.example.org/answers.ros.org/", False),
    ],
)
def test_the_site_that_is_no_more_is_known(address, gone):
    assert is_live_site(address) is gone


def test_asking_the_site_that_is_no_more_says_where_its_questions_are():
    with pytest.raises(CorpusError, match=r"went offline in 2024; gather its archive .* or the migrated questions"):
        Askbot(None, "https://answers.ros.org")  # type: ignore[arg-type]


# -- pages of Askbot ---------------------------------------------------------------------------------------------------

BODY = """<p>My node dies:</p><pre><code>[ERROR] [1.2]: no transform
</code></pre><ul><li>Ubuntu 18.04</li></ul>"""

OF_2020 = f"""<html><head><link rel="canonical" href="https://answers.ros.org/question/344567/node-dies/"></head><body>
<h1 id="js-question-title-344567"><div class="js-editable-content">Node dies [closed]</div></h1>
<div class="post js-question" id="post-id-344567"><div class="vote-number">-1</div>
<div class="post-content"><div class="post-update-info-container">
<div class="post-update-info"><p>asked <abbr class="timeago" title="2020-02-13 22:20:26 -0600">Feb 13 '20</abbr></p>
<div class="user-card"><a class="js-avatar-box" href="/users/1/ann/"><img src="/avatar.png"></a>
<div class="user-info"><a href="/users/1/ann/">ann</a><span class="reputation">11</span></div></div></div></div>
<div class="post-body"><div id="js-post-body-344567"><div class="js-editable"><div
class="js-editable-content">{BODY}</div>
</div></div></div>
<ul id="question-tags"><li><a class="js-tag-name" href="/questions/tags:tf2/">tf2</a></li>
<li><a class="js-tag-name">melodic</a></li></ul>
<div class="comments"><div class="comment js-comment" id="comment-5"><div class="comment-body"><p>which version?</p>
<a class="author">bob</a><abbr class="timeago" title="2019-01-01 00:00:00 -0600"></abbr></div></div></div></div></div>
<div class="post answer accepted-answer" id="post-id-344570"><div class="post-body"><div class="js-editable">
<div class="js-editable-content"><p>Upgrade.</p></div></div></div></div></body></html>"""

NEWER = f"""<html><body><h1 class="js-question-title"><a href="/question/344567/node-dies/">Node dies</a></h1>
<div id="js-post-344567" class="js-post js-question" data-post-id="344567"><div class="js-post-vote-number">-1</div>
<div class="js-post-body"><div class="js-editable-content">{BODY}</div></div>
<div class="js-post-update-info"><abbr class="js-timeago" title="2020-02-13 22:20:26 -0600"></abbr>
<div class="js-user-info user-info"><a href="/users/1/ann/">ann</a></div></div>
<div class="js-question-tags"><a class="js-tag-name">tf2</a><a class="js-tag-name">melodic</a></div>
<div class="js-comments"><div class="js-comment"><div class="js-comment-body js-editable-content">which version?</div>
<a class="author">bob</a></div></div></div>
<div class="js-answer js-accepted-answer" id="js-post-344570"><div class="js-post-body">Upgrade.</div></div>
</body></html>"""


@pytest.mark.parametrize("html", [OF_2020, NEWER], ids=["theme of 2018-2023", "newer Askbot"])
def test_a_saved_page_of_either_generation(html):
    """Logs and lists stay, comments and answers stay out, and 22:20 six hours west of Greenwich is the next day."""
    found = parse_page(html)
    assert found is not None
    report = found.report
    assert (report.id, report.title, report.tags) == ("ros-answers:344567", "Node dies", ("tf2", "melodic"))
    assert (report.date, report.author) == ("2020-02-14", "ann")
    assert report.body == "My node dies:\n\n```\n[ERROR] [1.2]: no transform\n```\n\n- Ubuntu 18.04"
    assert b"avatar" not in found.raw and b"bob" not in found.raw


def test_a_page_whose_author_is_gone():
    start = OF_2020.index('<div class="user-card">')
    end = OF_2020.index("</div></div></div></div>", start)
    found = parse_page(OF_2020[:start] + OF_2020[end + len("</div></div>") :])
    assert found is not None
    assert found.report.author == ""


@pytest.mark.parametrize("html", ["", "<p>Log in</p>", "<h1>Users</h1><ul class='user-list'></ul>", "\x00\xff"])
def test_a_page_that_holds_no_question(html):
    assert parse_page(html) is None


def test_a_folder_of_saved_pages_names_those_it_cannot_read(tmp_path):
    (tmp_path / "sub").mkdir()
    (tmp_path / "sub" / "a.html").write_text(OF_2020)
    (tmp_path / "users.htm").write_text("<h1>Users</h1>")
    (tmp_path / "style.css").write_text("h1 {}")
    source = SavedPages(tmp_path)
    reports = [gathered.report.id for page in source.read_pages(None) for gathered in page.reports]
    assert (reports, source.unread) == (["ros-answers:344567"], ["users.htm: holds no question"])


def test_an_item_of_askbots_api():
    found = parse_item(askbot_item(7, title="Rviz &amp; tf [closed]"))
    assert (found.report.id, found.report.date) == ("ros-answers:7", "2011-03-13")
    assert found.report.body == "Question 7\n\n```\nrosrun a b\n```"
    assert json.loads(found.raw)["author"] == {"username": "martin"}


# -- Robotics Stack Exchange -------------------------------------------------------------------------------------------

LOGO = (
    '<p><a href="https://answers.ros.org/question/215452/it-stops/" rel="nofollow noreferrer">'
    '<img src="https://i.stack.imgur.com/x.png" alt="Rosanswers logo" /></a></p>\n'
)
FOOTER = (
    '<hr />\n<p>Originally posted by <a href="https://answers.ros.org/users/5/ann/" rel="nofollow noreferrer">Ann B</a>'
    " on ROS Answers with karma: 21 on 2015-05-20</p>\n<p>Post score: 0</p>\n"
)
COMMENTS = (
    "<hr />\n<h4>Original comments</h4>\n<p><strong>Comment by <a>bob</a> on 2015-05-21</strong>:<br />Which version?"
    "</p>\n"
)


@pytest.mark.parametrize(
    ("body", "text", "original"),
    [
        (LOGO + "<p>It stops.</p>\n" + FOOTER, "It stops.", "215452"),
        (LOGO + "<p>It stops.</p>\n" + FOOTER + COMMENTS, "It stops.", "215452"),
        ("<p>It stops.</p>\n" + FOOTER, "It stops.", ""),  # the logo was edited away
        (LOGO + "<p>See <a href='https://answers.ros.org/question/1/x/'>this</a>.</p>" + FOOTER,
         "See [this](https://answers.ros.org/question/1/x/).", "215452"),
        ("<p>As in <a href='https://answers.ros.org/question/1/x/'>this</a>.</p>" + FOOTER,
         "As in [this](https://answers.ros.org/question/1/x/).", ""),
        (LOGO + "<p>It stops.</p>\n" + FOOTER + "<p>EDIT: solved.</p>", "It stops.\n\nEDIT: solved.", "215452"),
        (LOGO + "<p>a</p><hr /><p>b</p>" + FOOTER, "a\n\n---\n\nb", "215452"),
        (LOGO + "<p>It stops.<br />Originally posted by <a>Ann B</a> on ROS Answers with karma: 21 on 2015-05-20</p>",
         "It stops.", "215452"),
    ],
)  # fmt: skip
def test_a_migrated_question_is_read_as_it_was_posted(body, text, original):
    report = convert(question(67689, body)).report
    assert report.body == text
    assert report.same_as == (f"ros-answers:{original}" if original else "")
    assert (report.date, report.author) == ("2015-05-20", "Ann B")
    assert report.licence == "CC-BY-SA-4.0"


def test_a_question_of_gazebo_answers_is_no_copy_of_one_of_ros():
    body = LOGO.replace("answers.ros.org", "answers.gazebosim.org") + "<p>x</p>" + FOOTER.replace("ROS", "Gazebo")
    found = find_original(body)
    assert (found.id, found.date) == ("", "2015-05-20")


@pytest.mark.parametrize(
    "body",
    [
        "<p>It stops.</p>",
        "<p>I read what was originally posted by Ann on ROS Answers.</p>",
        "<p>Originally posted by nobody</p>",
        "<p>See https://answers.ros.org/question/5/x/</p>",
    ],
)
def test_a_question_that_was_never_migrated_is_left_as_it_is(body):
    assert find_original(body) == ("", "", "", body)


def test_a_question_of_stack_exchange():
    found = convert(question(98659))
    report = found.report
    assert (report.id, report.title) == ("robotics-se:98659", 'It stops & says "no map"')
    assert (report.author, report.date, report.tags) == ("Jürgen", "2023-11-16", ("ros2", "navigation"))
    kept = json.loads(found.raw)
    assert kept["owner"] == {"display_name": "J&#252;rgen", "link": question(1)["owner"]["link"]}


def test_votes_and_views_change_no_report():
    one, other = convert(question(1)), convert(question(1, view_count=99, score=4, last_activity_date=1_800_000_000))
    assert one.digest == other.digest


def test_a_question_whose_author_left():
    owner = {"user_type": "does_not_exist", "display_name": "user9"}
    assert convert(question(1, owner=owner)).report.author == "user9"
    assert convert(question(1, owner=None)).report.author == ""


@pytest.mark.parametrize("item", [{}, {"question_id": 1}, {"question_id": "x", "creation_date": 1, "body": ""}])
def test_what_is_no_question_is_said(item):
    with pytest.raises(CorpusError, match="is no question"):
        convert(item)
