"""Attacks by links, pipes, files: every row of their tables must hold."""

from __future__ import annotations

from .harness import Attack, Range

GROUPS = (
    "links",
    "pipes",
    "files",
)


def test_attack(shooting_range: Range, attack: Attack) -> None:
    failures = shooting_range.attempt(attack).failures
    assert not failures, "\n".join(failures)
