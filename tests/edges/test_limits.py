"""Limits are the user's: every name, unit and mistake of ROSIMPACT_LIMITS."""

import re
from dataclasses import fields
from pathlib import Path

import pytest
from rosimpact.edges import limits as limits_module
from rosimpact.edges.limits import KB, MB, LimitError, Limits, format_limits, format_size, parse, read_limits


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("", Limits()),
        ("cpp=32MB", Limits(cpp=32 * MB)),
        (" cpp = 32 mb , seconds=60,", Limits(cpp=32 * MB, seconds=60)),
        ("manifest=10k,index=1g", Limits(manifest=10 * KB, index=1024 * MB)),
        ("nodes=17", Limits(nodes=17)),
    ],
)
def test_limits_are_read(text, expected):
    assert parse(text) == read_limits({"ROSIMPACT_LIMITS": text}) == expected


@pytest.mark.parametrize("text", ["cpp", "cpp=", "cpp=-1", "cpp=0", "cpp=1TB", "cxx=1MB", "cpp=" + "9" * 5000, "cpp=²"])
def test_a_wrong_limit_is_an_error_that_shows_how_to_write_one(text):
    with pytest.raises(LimitError, match=r"ROSIMPACT_LIMITS: .* write for example cpp=32MB; known are manifest, cmake"):
        parse(text)


@pytest.mark.parametrize(
    ("size", "text"), [(0, "0 bytes"), (900, "900 bytes"), (1536, "1.5 KB"), (8 * MB, "8 MB"), (3 << 30, "3 GB")]
)
def test_sizes_as_people_write_them(size, text):
    assert format_size(size) == text


def test_the_documentation_lists_every_limit_with_its_default():
    page = (Path(__file__).parents[2] / "docs" / "security.md").read_text(encoding="utf-8")
    rows = dict(re.findall(r"(?m)^\| `(\w+)` \| .* \| ([^|]+) \|$", page))
    counts, seconds = {"entries", "depth", "nodes", "items"}, {"seconds"}
    expected = {}
    for field in fields(Limits):
        value = field.default
        unit = f"{value:,}" if field.name in counts else f"{value} s" if field.name in seconds else format_size(value)
        expected[field.name] = unit
    assert rows == expected


@pytest.mark.parametrize(
    ("text", "expected"),
    [("", ""), ("seconds=60,memory=1GB", ""), ("items=5", " items=5"), ("depth=200,cpp=1KB", " cpp=1024")],
)
def test_what_is_remembered_depends_on_the_limits_that_decide_it(monkeypatch, text, expected):
    monkeypatch.setattr(limits_module, "get_limits", lambda: parse(text))
    format_limits.cache_clear()
    try:
        assert format_limits() == expected
    finally:
        format_limits.cache_clear()
