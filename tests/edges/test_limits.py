"""Limits are the user's: every name, unit and mistake of ROSIMPACT_LIMITS."""

import pytest
from rosimpact.edges.limits import KB, MB, LimitError, Limits, of_environment, parse, size_text


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
    assert parse(text) == of_environment({"ROSIMPACT_LIMITS": text}) == expected


@pytest.mark.parametrize("text", ["cpp", "cpp=", "cpp=-1", "cpp=0", "cpp=1TB", "cxx=1MB", "cpp=" + "9" * 5000, "cpp=²"])
def test_a_wrong_limit_is_an_error_that_shows_how_to_write_one(text):
    with pytest.raises(LimitError, match="ROSIMPACT_LIMITS: .* write for example cpp=32MB; known are manifest, cmake"):
        parse(text)


@pytest.mark.parametrize(
    ("size", "text"), [(0, "0 bytes"), (900, "900 bytes"), (1536, "1.5 KB"), (8 * MB, "8 MB"), (3 << 30, "3 GB")]
)
def test_sizes_as_people_write_them(size, text):
    assert size_text(size) == text
