"""From records to numbers, and from repetitions to intervals: by hand."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosimpact.edges.console import UserError
from rosimpact.impact.measure.clocks import ClockOffset, RoundTrip, estimate_offset, join_offsets, take_trips
from rosimpact.impact.measure.intervals import (
    MeanInterval,
    PublishReport,
    Window,
    compute_interval,
    compute_result,
    read_samples,
    summarize,
)
from rosimpact.impact.measure.plan import NetworkCell

CELL = NetworkCell(1, 25, 50, "full")
KEPT_UP = PublishReport(50.0, 0.0)
MS = 1_000_000


def records(*rows):
    return np.array(rows, dtype="<i8").reshape(-1, 5)


def arrival(number, sent, time, publisher=0):
    return 0, publisher, number, sent * MS, time * MS


def callback(number, sent, time, publisher=0):
    return 1, publisher, number, sent * MS, time * MS


def compute(samples, window, cell=CELL, **more):
    return compute_result(samples, cell, 0, window, KEPT_UP, bytes=1000, **more)


def test_drops_are_told_apart_and_warm_up_is_left_out():
    samples = records(
        arrival(0, 0, 900), callback(0, 0, 999),  # warm-up
        arrival(2, 10, 12), callback(2, 10, 14),
        arrival(3, 20, 22),  # dropped by the subscriber's queue
        arrival(5, 40, 46), callback(5, 40, 48),
        arrival(6, 50, 950), callback(6, 50, 999),  # behind the window
    )  # fmt: skip
    found = compute(samples, Window(2, 6))
    assert (found.published, found.arrived, found.delivered) == (4, 3, 2)
    assert (found.dropped_percent, found.dropped_publisher_percent, found.dropped_subscriber_percent) == (50, 25, 25)
    assert (found.latency_mean_ms, found.latency_p50_ms, found.latency_max_ms) == (6, 6, 8)
    assert found.waited_ms == 2
    assert found.offered_mbit == 0.4


def test_messages_of_several_publishers_are_not_mixed_up():
    samples = records(
        arrival(0, 0, 5, 0), arrival(0, 0, 7, 1), callback(0, 0, 6, 0), callback(0, 0, 10, 1),
    )  # fmt: skip
    found = compute(samples, Window(0, 1), NetworkCell(2, 25, 50, "full"))
    assert (found.published, found.waited_ms, found.dropped_percent) == (2, 2, 0)


def test_nothing_arrived():
    found = compute(records(), Window(0, 10))
    assert (found.dropped_percent, found.dropped_publisher_percent, found.latency_mean_ms) == (100, 100, None)
    (summary,) = summarize([found])
    assert (summary.latency, summary.dropped) == ({}, MeanInterval(100))


def test_the_offset_of_another_clock_is_taken_off():
    found = compute(records(arrival(0, 0, 103), callback(0, 0, 103)), Window(0, 1), offset=100 * MS, uncertainty=MS)
    assert (found.latency_mean_ms, found.clock_offset_ms, found.clock_uncertainty_ms) == (3, 100, 1)


def test_a_callback_without_an_arrival_is_no_result():
    with pytest.raises(UserError, match="whose arrival was not seen"):
        compute(records(callback(0, 0, 1)), Window(0, 1))


def test_a_file_of_records_that_was_cut_off(tmp_path):
    (tmp_path / "samples").write_bytes(bytes(41))
    with pytest.raises(UserError, match="in the middle of a record"):
        read_samples(tmp_path / "samples")
    (tmp_path / "samples").write_bytes(bytes(80))
    assert read_samples(tmp_path / "samples").shape == (2, 5)


def test_student_by_hand():
    # t(0.975, 2) = 4.30265
    found = compute_interval([1, 2, 3])
    assert found.mean == 2
    assert found.high is not None and found.high - 2 == pytest.approx(4.30265 / math.sqrt(3), abs=1e-4)
    assert compute_interval([1, 2, 3], 0, 4) == MeanInterval(2, 0, 4)
    assert compute_interval([5]) == MeanInterval(5)
    with pytest.raises(ValueError, match="no values"):
        compute_interval([])


@given(st.lists(st.floats(0, 100), min_size=2, max_size=8))
def test_an_interval_holds_its_mean(values):
    found = compute_interval(values, 0, 100)
    assert found.low is not None and found.high is not None
    assert 0 <= found.low <= found.mean + 1e-9 and found.mean - 1e-9 <= found.high <= 100


@pytest.mark.parametrize(
    ("one", "other", "same"),
    [
        (MeanInterval(1, 0, 2), MeanInterval(3, 2, 4), True),
        (MeanInterval(1, 0, 2), MeanInterval(4, 3, 5), False),
        (MeanInterval(1), MeanInterval(1, 0, 2), False),
    ],
)
def test_intervals_that_overlap(one, other, same):
    assert (one.matches(other), other.matches(one)) == (same, same)


def test_the_shortest_way_tells_the_offset():
    # The other clock is 1,000 behind; ways of 10 and 30 are wrong by half of the difference, which is within the bound.
    slow = RoundTrip(asked=5_000, received=4_400, sent_back=4_500, answered=5_900)
    fast = RoundTrip(asked=9_000, received=8_010, sent_back=8_020, answered=9_050)
    found = estimate_offset([slow, fast])
    assert (found.nanoseconds, found.uncertainty) == (1_010, 20)
    assert abs(found.nanoseconds - 1_000) <= found.uncertainty


@given(st.integers(-(10**12), 10**12), st.lists(st.tuples(*[st.integers(0, 10**7)] * 3), min_size=1, max_size=20))
def test_the_true_offset_is_within_the_uncertainty(true, ways):
    now = [0]
    steps = iter(ways)

    def ask():
        there, inside, back = next(steps)
        received = now[0] + there - true
        now[0] += there + inside + back
        return received, received + inside

    found = take_trips(lambda: now[0], ask, len(ways))
    assert abs(found.nanoseconds - true) <= found.uncertainty + 1


@pytest.mark.parametrize(
    ("after", "seconds", "joined"),
    [
        (ClockOffset(5 * MS, 1 * MS), 10, ClockOffset(5 * MS, 1 * MS)),
        (ClockOffset(7 * MS, 2 * MS), 10, ClockOffset(6 * MS, 3 * MS)),  # 200 µs a second: slewed
        (ClockOffset(13 * MS, 1 * MS), 10, None),  # 8 ms in 10 s: no clock is slewed so fast
        (ClockOffset(13 * MS, 1 * MS), 20, ClockOffset(9 * MS, 5 * MS)),
        (ClockOffset(-3_600_000 * MS, 1 * MS), 10, None),
    ],
)
def test_clocks_that_move_against_each_other(after, seconds, joined):
    before = ClockOffset(5 * MS, 1 * MS)
    if joined is None:
        with pytest.raises(UserError, match="let both be synchronised"):
            join_offsets(before, after, seconds)
    else:
        assert join_offsets(before, after, seconds) == joined
