"""From sources into the store: gatherings, hydrating the labelled ids, refreshing what is there."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple, Protocol

from .report import BugReport, find_repository
from .store import AskedReport, CorpusStore, GatheredPage, GatheredReport, ReportCounts

_NUMBER = re.compile("[0-9]{1,12}")
_REFRESH = "refresh"
_AT_ONCE = 100


class ReportSource(Protocol):
    """Where reports come from in pages. name: unique to what is asked for; its state is kept under it."""

    @property
    def name(self) -> str: ...

    def read_pages(self, state: dict[str, Any] | None) -> Iterator[GatheredPage]:
        """The pages that follow a state; from the first one for None."""
        ...


class Service(Protocol):
    """Where reports can be asked for by their ids."""

    def ask(self, known: Iterable[tuple[str, str]]) -> Iterator[AskedReport]:
        """known: (id, ETag of what is at hand, or nothing). The answers come in any order, each id's once."""
        ...


class Progress(NamedTuple):
    """How far a job is. of: None where nobody knows."""

    done: int
    of: int | None
    taken: ReportCounts


def gather(
    source: ReportSource, store: CorpusStore, tell: Callable[[Progress], None] = lambda progress: None
) -> ReportCounts:
    """Reads a source to its end, from where it was left. Whatever is raised on the way, the pages told are stored."""
    taken = ReportCounts()
    for page in source.read_pages(store.read_state(source.name)):
        taken = taken.add(store.take(source.name, page))
        tell(Progress(page.done, page.of, taken))
    return taken


def find_service(id: str) -> str:
    """Which of report.SOURCES has a report of that id; empty when none has."""
    if find_repository(id):
        return "github"
    name, _, number = id.partition(":")
    return name if name in ("ros-answers", "robotics-se") and _NUMBER.fullmatch(number) else ""


def find_missing(store: CorpusStore, ids: Iterable[str]) -> dict[str, list[str]]:
    """Those ids, by service, that the store knows nothing of; what is known to be gone is not missing."""
    found: dict[str, list[str]] = {}
    for id in ids:
        if store.find_kept(id) is None:
            found.setdefault(find_service(id), []).append(id)
    return found


def hydrate(
    service: Service,
    source: str,
    ids: list[str],
    store: CorpusStore,
    tell: Callable[[Progress], None] = lambda progress: None,
) -> ReportCounts:
    """Asks a service for ids and stores each answer as it comes. source: one of report.SOURCES."""
    taken = ReportCounts()
    for done, asked in enumerate(service.ask((id, "") for id in ids), 1):
        taken = taken.add(_settle(asked, source, store))
        tell(Progress(done, len(ids), taken))
    return taken


def import_reports(reports: Iterable[BugReport], store: CorpusStore, ids: frozenset[str]) -> tuple[ReportCounts, int]:
    """Stores the texts of ids that are at hand already; those that the store has are left as they are. Returns what
    became of them, and how many reports were of no such id."""
    taken, others = ReportCounts(), 0
    part: list[GatheredReport] = []
    for report in reports:
        kept = store.find_kept(report.id)
        if report.id not in ids:
            others += 1
        elif kept is not None and not kept.gone:
            taken = taken.add(ReportCounts(same=1))
        else:
            part.append(GatheredReport(report, origin="import"))
            if len(part) == _AT_ONCE:
                taken, part = taken.add(store.put(part)), []
    return taken.add(store.put(part)), others


def refresh(
    services: Callable[[str, int], Service],
    store: CorpusStore,
    sources: Iterable[str],
    limit: int | None = None,
    tell: Callable[[Progress], None] = lambda progress: None,
) -> ReportCounts:
    """Asks for every report again, longest ago first: edits are taken over, what is deleted loses its text here.

    services: gives the service for a source and a number of reports. limit: of reports to ask for. An earlier refresh
    that was left before its end is gone on with.
    """
    state = store.read_state(_REFRESH) or {}
    started = float(state.get("started") or store.now())
    store.take(_REFRESH, GatheredPage([], {"started": started}))
    sources = list(sources)
    counts = {source: store.count_to_check(source, started) for source in sources}
    total = min(sum(counts.values()), limit if limit is not None else sum(counts.values()))
    taken, done = ReportCounts(), 0
    for source in sources:
        if not counts[source] or done >= total:
            continue
        service = services(source, min(counts[source], total - done))
        # an archive is read through for each asking, so it is asked once
        size = counts[source] if source == "ros-answers" else _AT_ONCE
        while part := store.list_to_check(source, started, min(size, total - done)):
            kept = {known.id: known for known in part}
            for asked in service.ask((known.id, known.etag) for known in part):
                if asked.what == "gone" and source == "ros-answers" and kept[asked.id].origin == "import":
                    # the archive never held all questions: that one is not in it says nothing of its deletion
                    asked = AskedReport(asked.id, "same")
                taken = taken.add(_settle(asked, source, store))
                done += 1
                tell(Progress(done, total, taken))
            if done >= total:
                break
    if all(store.count_to_check(source, started) == 0 for source in sources):
        store.take(_REFRESH, GatheredPage([], {}, finished=True))
    return taken


def _settle(asked: AskedReport, source: str, store: CorpusStore) -> ReportCounts:
    if asked.gathered is not None:
        return store.put([asked.gathered])
    if asked.what == "gone":
        store.forget([(asked.id, source)])
        return ReportCounts(gone=1)
    store.mark_seen([asked.id])
    return ReportCounts(same=1)
