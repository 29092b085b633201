"""A report's text: its parts and its words."""

import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.classifier.reading import read
from rosimpact.classifier.signs import SIGNS
from rosimpact.classifier.text import list_general_words, list_plain_words, make_n_grams, split_parts

BODY = """It fails on my machine.

```
[ INFO] starting
[ERROR] no such topic
[ERROR] no such topic
```
<!-- please fill in the template -->
make[2]: *** [all] Error 1
So what now?
"""


def test_prose_code_and_error_lines_are_told_apart():
    parts = split_parts("Fails", BODY)
    assert "It fails on my machine." in parts.prose
    assert "So what now?" in parts.prose
    assert "starting" not in parts.prose
    assert "template" not in parts.prose + parts.code
    assert parts.errors.split("\n") == ["make[2]: *** [all] Error 1", "[ERROR] no such topic"] or parts.errors.split(
        "\n"
    ) == ["[ERROR] no such topic", "make[2]: *** [all] Error 1"]


@pytest.mark.parametrize("fence", ["```", "~~~", "{{{", "<pre>"])
def test_a_fence_that_is_never_closed_holds_the_rest(fence):
    parts = split_parts("x", f"before\n{fence}\nerror: inside")
    assert "inside" not in parts.prose
    assert parts.errors == "error: inside"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("see https://example.org/a/b now", ["see", "urlx", "now"]),
        ("opencv 4.5.1 of 2021", ["opencv", "verx", "of", "numx"]),
        ("/opt/ros/jazzy/lib/x.so", ["pathx", "x", "so"]),
        ("commit 0123abcdef", ["commit", "hashx"]),
    ],
)
def test_plain_words_replace_what_differs_from_report_to_report(text, words):
    assert list_plain_words(text) == words


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("missing dependencies of my_pkg", ["miss", "dependenc", "of", "<name>"]),
        ("on Noetic and jammy", ["on", "<distro>", "and", "<platform>"]),
        ("sensor_msgs", ["<interfaces>"]),
        ("LaserScan std::optional 1.2 3", ["<class>", "<scoped>", "std::optional", "<version>", "<number>"]),
    ],
)
def test_general_words_replace_names(text, words):
    assert list_general_words(text) == words


def test_n_grams_are_runs_of_words():
    assert make_n_grams(["a", "b", "c"], 2) == ["a", "b", "c", "a b", "b c"]


@pytest.mark.parametrize(
    ("title", "body", "sign"),
    [
        ("Broken since the upgrade to noetic", "", "after an upgrade (text)"),
        ("x", "/usr/lib/a.so: undefined symbol: _Z3fo", "symbol lookup (report)"),
        ("x", "E: Unable to locate package ros-jazzy-foo", "package not located (report)"),
        ("x", "ModuleNotFoundError: No module named 'foo'", "no module named (report)"),
        ("add the missing dependency on tf2", "", "dependency missing (title)"),
        ("Client wants topic /a to have datatype/md5sum b", "", "types refused (report)"),
        ("x", "the subscriber is best effort, so QoS is incompatible", "QoS (report)"),
        ("Driver stops publishing after a reset", "", "condition and publish (title)"),
        ("latched map is sent once", "", "latched (title)"),
        ("How to make a plan?", "", "question (title)"),
    ],
)
def test_signs_show(title, body, sign):
    assert read(title, body).signs[SIGNS.index(sign)] > 0


def test_sign_names_are_unique():
    assert len(set(SIGNS)) == len(SIGNS)


@given(st.text(), st.text())
def test_any_text_is_read(title, body):
    assert len(read(title, body).signs) == len(SIGNS)


@pytest.mark.parametrize("piece", ["<!--", "```", "/a", "a.", "[ERROR] ", "not " * 3, "( ", "::a", "no \t"])
def test_what_repeats_without_end_is_read_all_the_same(piece):
    assert len(read(piece * 20, piece * 20_000).signs) == len(SIGNS)
