"""Matching in bounded time says what re.match() says."""

import re

import pytest
from rosimpact.edges.patterns import PatternError, matches

PATTERNS = [
    "a", "a+b?", "(a|b)*c", ".*_msgs$", r"\w+_\d{2,3}", "[^a-c]x", r"\bfoo\b", "^a|b$", "(?:ab){2}", "a*?b", r"\D\S",
]  # fmt: skip
NAMES = ["", "a", "aab", "abab", "bbac", "foo_msgs", "foo", "x_12", "dx", "foo bar", "zz9"]


@pytest.mark.parametrize("pattern", PATTERNS)
def test_the_same_as_re(pattern):
    assert [matches(pattern, name) for name in NAMES] == [re.match(pattern, name) is not None for name in NAMES]


@pytest.mark.parametrize("pattern", ["(a+)+$", "(a|a)*$", "a*" * 30 + "$", "(.*a){12}$"])
def test_patterns_that_keep_re_busy(pattern):
    assert not matches(pattern, "a" * 200 + "!")


@pytest.mark.parametrize("pattern", ["(", "(a)\\1", "(?=a)", "((a{1,50}){1,50}){1,50}", "x" * 2000, "(?i)a"])
def test_patterns_that_are_refused(pattern):
    with pytest.raises(PatternError):
        matches(pattern, "a")
