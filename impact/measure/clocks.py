"""How far the clocks of two machines are apart, from round trips between them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

ROUND_TRIPS = 200


class RoundTrip(NamedTuple):
    """Four times in nanoseconds: asked and answered by this clock, received and sent back by the other one."""

    asked: int
    received: int
    sent_back: int
    answered: int


class ClockOffset(NamedTuple):
    """What this clock is ahead of the other, in nanoseconds. The truth is within ± uncertainty of it."""

    nanoseconds: float
    uncertainty: float


def estimate_offset(trips: Iterable[RoundTrip]) -> ClockOffset:
    """From the trip that took the shortest time on the way, as NTP does (RFC 5905, section 8): the offset is that of
    ways of equal length, and cannot be wrong by more than half of the time on both. Raises ValueError without trips."""
    best = min(trips, key=_measure_way)
    offset = ((best.asked - best.received) + (best.answered - best.sent_back)) / 2
    return ClockOffset(offset, max(0, _measure_way(best)) / 2)


def _measure_way(trip: RoundTrip) -> int:
    return (trip.answered - trip.asked) - (trip.sent_back - trip.received)


def take_trips(read: Callable[[], int], ask: Callable[[], tuple[int, int]], number: int = ROUND_TRIPS) -> ClockOffset:
    """The offset from so many round trips. read: this clock. ask: has the other side say when it received the question
    and when it answered."""
    trips = []
    for _ in range(number):
        asked = read()
        received, sent_back = ask()
        trips.append(RoundTrip(asked, received, sent_back, read()))
    return estimate_offset(trips)
