"""A whole run on one machine: the sites, the master, each cell in turn, the results as they come."""

from __future__ import annotations

import contextlib
import datetime
import os
import platform
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Protocol

from ...edges.console import UserError, format_count
from ...edges.processes import count_cores
from ...edges.version import __version__
from . import namespaces, ros1
from .bench import Bench, LocalPublishers, LocalSubscriber, Messages, count_messages
from .children import hold_signals
from .clocks import ClockOffset, join_offsets
from .intervals import NetworkResult, PublishReport, compute_result
from .plan import FULL, PRUNED, SYNTHETIC, Conditions, NetworkCell, NetworkPlan
from .results import ResultsFile, RunHeader

ONE_CLOCK = "one machine: both sides read CLOCK_MONOTONIC, which namespaces share; no offset"
_TRIES = 2
# Beside those that people use, so that nothing of them is disturbed on loopback.
_FIRST_DOMAIN, _DOMAINS = 60, 100

Progress = Callable[[str], None]


class Publishers(Protocol):
    """The publishers of one cell, on this machine or another."""

    def start(self, cell: NetworkCell, topic: str) -> None: ...

    def publish(self) -> PublishReport: ...

    def stop(self) -> None: ...


def check_needs(conditions: Conditions) -> None:
    """Raises UserError, in one message with everything that is missing and what to do about it."""
    missing = namespaces.find_missing() if conditions.network == "namespaces" else []
    if conditions.nodes == "dds":
        from importlib.util import find_spec

        if find_spec("cyclonedds") is None:
            missing.append(
                "cyclonedds: pip install cyclonedds (there are wheels for x86-64 Linux, Python 3.10 to 3.13)"
            )
    else:
        missing += ros1.find_ros1(conditions.nodes)[1]
    if missing:
        raise UserError("the measurement needs\n  " + "\n  ".join(missing))


def make_header(conditions: Conditions, clock: str) -> RunHeader:
    """What the file of results begins with."""
    release = ".".join(platform.release().split(".")[:2])
    machine = {"system": f"{platform.system()} {release}", "machine": platform.machine(),
               "cores": str(count_cores())}  # fmt: skip
    now = datetime.datetime.now(datetime.timezone.utc).isoformat(timespec="seconds")
    return RunHeader(rosimpact=__version__, started=now, conditions=conditions, clock=clock, machine=machine)


def run_network(plan: NetworkPlan, messages: Messages, output: Path, progress: Progress) -> ResultsFile:
    """Measures all cells of a plan on this machine that a file of results does not have yet. progress: gets a line at a
    time. Raises UserError."""
    check_needs(plan.conditions)
    file = ResultsFile(output, make_header(plan.conditions, ONE_CLOCK))
    if removed := namespaces.remove_leftovers():
        progress(f"removed what earlier runs left behind: {', '.join(removed)}")
    left = list_left(plan, file, progress)
    if not left:
        return file
    with namespaces.open_work_folder() as place, _open_until_closed() as opened:
        progress("preparing nodes")
        (place / "logs").mkdir()
        sites = _open_sites(plan.conditions, opened)
        publisher, subscriber = _open_benches(plan.conditions, messages, sites, place, opened)
        for number, (repetition, cell) in enumerate(left, 1):
            progress(f"[{number}/{len(left)}] {cell.describe()}, repetition {repetition + 1}")
            file.add(measure_cell(LocalPublishers(publisher), subscriber, cell, repetition, progress))
    return file


@contextlib.contextmanager
def _open_until_closed() -> Iterator[contextlib.ExitStack]:
    """What is set up within it is removed at its end, which a second Ctrl-C does not cut short."""
    opened = contextlib.ExitStack()
    try:
        yield opened
    finally:
        with hold_signals():
            opened.close()


def list_left(plan: NetworkPlan, file: ResultsFile, progress: Progress) -> list[tuple[int, NetworkCell]]:
    """What remains to be measured, which is told."""
    runs = list(plan.list_runs())
    left = [(repetition, cell) for repetition, cell in runs if not file.has(cell, repetition)]
    done = f", {len(runs) - len(left)} of {len(runs)} are in {file.path} already" if len(left) < len(runs) else ""
    minutes = plan.estimate_seconds(len(left)) / 60
    progress(f"{format_count(len(left), 'run')} of a cell to measure, about {minutes:.1f} minutes{done}")
    return left


def _open_sites(conditions: Conditions, opened: contextlib.ExitStack) -> namespaces.NetworkSites:
    if conditions.network == "loopback":
        return namespaces.LOOPBACK
    return opened.enter_context(namespaces.open_namespaces(conditions.link))


def _open_benches(
    conditions: Conditions,
    messages: Messages,
    sites: namespaces.NetworkSites,
    place: Path,
    opened: contextlib.ExitStack,
) -> tuple[Bench, Bench]:
    """Both sides, with a master where they need one."""
    master = ""
    if conditions.nodes != "dds":
        ros, missing = ros1.find_ros1(conditions.nodes)
        if ros is None:
            raise UserError("; ".join(missing))
        port = ros1.MASTER_PORT if conditions.network == "namespaces" else ros1.find_free_port()
        master = opened.enter_context(ros1.open_master(ros, sites.subscriber, port, place / "logs"))
    domain = _FIRST_DOMAIN + os.getpid() % _DOMAINS if conditions.network == "loopback" else 0
    peers = [sites.publisher.address, sites.subscriber.address]
    publisher, subscriber = (
        Bench(conditions, messages, site, place / name, master=master, peers=peers, domain=domain)
        for name, site in (("publisher", sites.publisher), ("subscriber", sites.subscriber))
    )
    return publisher, subscriber


def measure_cell(
    publishers: Publishers, bench: Bench, cell: NetworkCell, repetition: int, progress: Progress,
    read_offset: Callable[[], ClockOffset] = lambda: ClockOffset(0, 0),
) -> NetworkResult:  # fmt: skip
    """One repetition of a cell, tried once more where a node fails. bench: of the subscriber. read_offset: what its
    clock is ahead of that of the publishers. Raises UserError."""
    for attempt in range(1, _TRIES + 1):
        try:
            return _run_cell(publishers, bench, cell, repetition, read_offset, attempt)
        except UserError as error:
            if attempt == _TRIES:
                raise UserError(
                    f"{cell.describe()}: {error}; what was measured is kept, and the same command continues from there"
                ) from None
            progress(f"{cell.describe()}: {error}; trying again")
    raise AssertionError


def _run_cell(
    publishers: Publishers, bench: Bench, cell: NetworkCell, repetition: int,
    read_offset: Callable[[], ClockOffset], attempt: int,
) -> NetworkResult:  # fmt: skip
    # A topic of its own: of an earlier cell the master may still know nodes that have ended.
    topic = f"/rosimpact_measure/{_name_topic(cell, repetition, attempt)}"
    before, begun = read_offset(), time.monotonic()
    subscriber = LocalSubscriber(bench, cell, topic)
    try:
        publishers.start(cell, topic)
        report = publishers.publish()
        samples = subscriber.finish()
        offset = join_offsets(before, read_offset(), time.monotonic() - begun)
    finally:
        with hold_signals():
            publishers.stop()
            subscriber.stop()
    _, window = count_messages(bench.conditions, cell.rate)
    size = bench.messages[cell.fields, cell.variant].bytes
    return compute_result(
        samples, cell, repetition, window, report, bytes=size, offset=offset.nanoseconds,
        uncertainty=offset.uncertainty,
    )  # fmt: skip


def _name_topic(cell: NetworkCell, repetition: int, attempt: int) -> str:
    rate = f"{cell.rate:g}".replace(".", "_").replace("+", "").replace("-", "m")
    return f"p{cell.publishers}_f{cell.fields}_r{rate}_{cell.variant}_{repetition}_{attempt}_{os.getpid()}"


def list_variants(plan: NetworkPlan) -> Iterator[tuple[int, str]]:
    """The messages that a plan needs: number of fields (0 for a real message) and variant."""
    for size in (0,) if plan.conditions.message != SYNTHETIC else plan.fields:
        yield size, FULL
        if plan.has_pruned:
            yield size, PRUNED
