"""What fuzzing has found, and what must hold since: inputs that once ended a reader, or took it for ever."""

from __future__ import annotations

import time

import pytest
from fuzz_targets import TARGETS

# Processor time that no row needs a tenth of.
SECONDS = 5

_ALIASES = "".join(f"a{n + 1}: &a{n + 1} {{x: *a{n}, y: *a{n}}}\n" for n in range(40)).encode()
_PARAMETERS = "facts_extract.parameters:yaml"

# (target, what was found, the input)
FOUND: list[tuple[str, str, bytes]] = [
    (_PARAMETERS, "libyaml's composer ended the process", b"[" * 200_000),
    (_PARAMETERS, "aliases doubled the work in each line", b"a0: &a0 {k: {type: int}}\n" + _ALIASES),
    ("facts_pyproject", "ValueError for an integer of 4,400 digits", b"[project]\nx = " + b"9" * 4_400),
    ("facts_pyproject", "dotted keys take quadratic time", b"a" + b".a" * 100_000 + b" = 1"),
    ("facts_cpp", "quadratic in includes that are not closed", b"#include <" * 20_000),
    ("facts_cpp", "quadratic in calls on one line", b'nh.subscribe("' * 6_000),
    ("facts_xml", "quadratic in a tag that is not closed", b"<n" + b"9" * 60_000),
    ("archived", "libyaml's composer ended the process", b"---\n" + b"[" * 200_000 + b"\n---\nx"),
    ("pages", "RecursionError", b"<b>" * 5_000),
    ("memories", "UnicodeDecodeError", b"\x92\x91\x9b\xa1\xa5\xa0\0\0\xa0\xa0\xa0\xa0\xa0\x90\xc0\x80"),
]


@pytest.mark.parametrize(("target", "found", "data"), FOUND, ids=[f"{row[0]}: {row[1]}" for row in FOUND])
def test_found(target, found, data):
    started = time.thread_time()
    TARGETS[target].check(data)
    assert time.thread_time() - started < SECONDS


@pytest.mark.parametrize("name", TARGETS)
def test_seeds(name):
    """Every target holds for what its mutations begin with, and has such."""
    target = TARGETS[name]
    seeds = target.seeds()
    assert seeds and target.promise
    for data in (*seeds.values(), b"", b"\0", b"\xff\xfe", b"\n" * 1000):
        target.check(data)
