"""Attacks by git, cache, environment: every row of their tables must hold."""

from __future__ import annotations

from .harness import Attack, Range

GROUPS = (
    "git",
    "cache",
    "environment",
)


def test_attack(shooting_range: Range, attack: Attack) -> None:
    failures = shooting_range.attempt(attack).failures
    assert not failures, "\n".join(failures)
