"""How far the clocks of two machines are apart, from round trips between them."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import NamedTuple

from ...edges.console import UserError

ROUND_TRIPS = 200
SLEWED = 500e-6
"""As much of a second's length as daemons speed a clock up or slow it down (RFC 5905, appendix A.5.5.6)."""


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


def join_offsets(before: ClockOffset, after: ClockOffset, seconds: float) -> ClockOffset:
    """The offset in the middle of a measurement from those before and behind it, which took so many seconds. What it
    moved in between adds to the uncertainty. Raises UserError where it moved further than a clock can that is only
    slewed: one of them was set."""
    moved = abs(after.nanoseconds - before.nanoseconds)
    unsure = max(before.uncertainty, after.uncertainty)
    if moved > before.uncertainty + after.uncertainty + SLEWED * seconds * 1e9:
        raise UserError(
            f"the clocks of both machines moved by {moved / 1e6:.2f} ms against each other in {seconds:.1f} s, so that "
            "latencies cannot be told; let both be synchronised (chrony, ntpd) and settle first"
        )
    return ClockOffset((before.nanoseconds + after.nanoseconds) / 2, unsure + moved / 2)
