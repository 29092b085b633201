"""A clock whose waits take no time."""

from __future__ import annotations


class Hours:
    """Time that passes only when somebody sleeps. slept: how long, each time."""

    def __init__(self, now: float = 1_700_000_000.0):
        self.time = now
        self.slept: list[float] = []

    def get_time(self) -> float:
        return self.time

    def sleep(self, seconds: float) -> None:
        self.slept.append(seconds)
        self.time += seconds
