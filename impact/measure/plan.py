"""What is measured: the options of a run, checked, and the cells that follow from them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from typing import Any

import msgspec

from ...edges.console import UserError

FULL, PRUNED = "full", "pruned"
NODES = ("roscpp", "rospy", "dds")
SYNTHETIC = "synthetic"
TAIL = 0.5
"""Seconds for which publishers go on behind what is measured, so that the last messages find the queues as full as the
others did."""
OVERHEAD = 1.1
"""Seconds that starting and stopping the nodes of a cell takes, about."""
_MBIT = 1_000_000
_UNITS = {"kbit": 1_000, "mbit": _MBIT, "gbit": 1_000 * _MBIT}
_LINK = re.compile(r"([0-9]{1,6}(?:\.[0-9]{1,3})?)(kbit|mbit|gbit)")
# Beyond these a machine measures itself alone, or a run takes for ever.
_MOST = {
    "publishers": 50, "fields": 10_000, "rates": 10_000, "field-bytes": 10_000_000, "queue": 100_000, "seconds": 3_600,
    "repeat": 1_000, "warm-up": 600, "callback-ms": 60_000,
}  # fmt: skip
_LARGEST = 100_000_000


class Conditions(msgspec.Struct, frozen=True, kw_only=True):
    """What holds for all cells of a file of results; two runs with other conditions are not put together.

    nodes: roscpp, rospy or dds. network: namespaces, loopback or machines. link: bits per second, 0 without shaping.
    queue: length of the queues of publisher and subscriber. seconds: measured in each cell; warm_up: before it.
    callback_ms: how long each callback of the subscriber takes. message: `package/Type`, or `synthetic`. kept: fields
    of a real message that the pruned one has; keep: how many a synthetic one has. contents: SHA-256 of what real
    messages are filled with, and of their definitions.
    """

    nodes: str = "roscpp"
    network: str = "namespaces"
    link: int = 100 * _MBIT
    queue: int = 10
    seconds: float = 10
    warm_up: float = 1
    callback_ms: float = 0
    message: str = SYNTHETIC
    field_bytes: int = 1_000
    keep: int = 5
    kept: tuple[str, ...] = ()
    contents: str = ""


class NetworkCell(msgspec.Struct, frozen=True, order=True):
    """One point of the matrix. fields: 0 for a real message. variant: full or pruned. rate: messages per second of each
    publisher."""

    publishers: int
    fields: int
    rate: float
    variant: str

    def describe(self) -> str:
        """`100 fields, 200 Hz, 5 publishers, pruned`."""
        fields = f"{self.fields} fields, " if self.fields else ""
        publishers = f"{self.publishers} publishers, " if self.publishers > 1 else ""
        return f"{fields}{self.rate:g} Hz, {publishers}{self.variant}"


class NetworkPlan(msgspec.Struct, frozen=True, kw_only=True):
    """A run: its conditions, and the lists whose combinations are its cells."""

    conditions: Conditions
    publishers: tuple[int, ...] = (1, 5)
    fields: tuple[int, ...] = (25, 50, 100)
    rates: tuple[float, ...] = (50, 100, 200)
    repeat: int = 3

    def list_cells(self) -> list[NetworkCell]:
        """All cells, full and pruned next to each other, so that both meet the same machine."""
        sizes = (0,) if self.conditions.message != SYNTHETIC else self.fields
        return [
            NetworkCell(publishers, size, rate, variant)
            for publishers in self.publishers
            for size in sizes
            for rate in self.rates
            for variant in (FULL, PRUNED)
            if variant == FULL or self.has_pruned
        ]

    @property
    def has_pruned(self) -> bool:
        """Whether there is a pruned message to measure."""
        made = self.conditions.message == SYNTHETIC
        return bool(self.conditions.keep if made else self.conditions.kept)

    def list_runs(self) -> Iterator[tuple[int, NetworkCell]]:
        """(repetition, cell) in the order of measuring: a whole pass over all cells for each repetition."""
        return ((number, cell) for number in range(self.repeat) for cell in self.list_cells())

    def estimate_seconds(self, runs: int) -> float:
        """How long so many runs of a cell take."""
        return runs * (self.conditions.seconds + self.conditions.warm_up + TAIL + OVERHEAD)


def parse_link(text: str) -> int:
    """Bits per second of `100mbit`; 0 for `none`. Raises UserError."""
    match = _LINK.fullmatch(text.strip().lower())
    if text.strip().lower() == "none":
        return 0
    if match is None or not (rate := round(float(match[1]) * _UNITS[match[2]])):
        raise UserError(f"--link {text}: not a rate; write for example 100mbit, 1gbit, or none for no limit")
    return rate


def choose_network(loopback: bool, link: str) -> dict[str, Any]:
    """The conditions `network` and `link` of a run on one machine. link: as written, empty for the default. Raises
    UserError."""
    if loopback and link:
        raise UserError("--link: loopback has no link to limit; leave out --link or --loopback")
    if loopback:
        return {"network": "loopback", "link": 0}
    return {"network": "namespaces", "link": parse_link(link or "100mbit")}


def format_link(rate: int) -> str:
    """`100mbit`; `none` for 0."""
    for unit in ("gbit", "mbit", "kbit"):
        if rate and rate % _UNITS[unit] == 0:
            return f"{rate // _UNITS[unit]}{unit}"
    return f"{rate / 1_000:g}kbit" if rate else "none"


def parse_numbers(option: str, texts: Iterable[str], whole: bool = True) -> tuple[float, ...]:
    """The numbers that an option lists, each once, in their order. Raises UserError."""
    found: dict[float, None] = {}
    for text in texts:
        try:
            number = int(text) if whole else float(text)
        except ValueError:
            raise UserError(f"--{option} {text}: not a number; write for example --{option} 10,20") from None
        check_number(option, number)
        found[number] = None
    if not found:
        raise UserError(f"--{option}: is empty; write for example --{option} 10,20")
    return tuple(found)


def check_number(option: str, number: float, least: float = 1e-3) -> float:
    """The number. Raises UserError where it is below `least`, or more than can be measured."""
    if not least <= number <= _MOST[option]:
        raise UserError(f"--{option} {number:g}: has to be from {least:g} to {_MOST[option]:,}")
    return number


def check_plan(plan: NetworkPlan) -> None:
    """Raises UserError where the parts of a plan do not fit each other."""
    conditions = plan.conditions
    if conditions.message == SYNTHETIC:
        if conditions.keep > min(plan.fields):
            raise UserError(
                f"--keep {conditions.keep}: is more than the {min(plan.fields)} fields of the smallest message"
            )
        if max(plan.fields) * conditions.field_bytes > _LARGEST:
            raise UserError(f"--fields, --field-bytes: a message of more than {_LARGEST:,} bytes; give smaller ones")
