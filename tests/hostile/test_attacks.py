"""Every attack of the tables must be held off. In one file, so that all of them share one warm process."""

from __future__ import annotations

from .harness import Attack, Range


def test_attack(shooting_range: Range, attack: Attack) -> None:
    failures = shooting_range.attempt(attack).failures
    assert not failures, "\n".join(failures)
