"""What the commands that gather do: options to a store that holds more, and an exit status.

Statuses: 0 done; 1 stopped before the end, everything kept, since a service asks for a longer wait than allowed; 2
failed.
"""

from __future__ import annotations

import re
import time
from collections.abc import Callable, Sequence
from datetime import date, datetime, timezone
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from ..edges.console import escape, format_count, run_command, say, write
from .polite import Client, Later, normalize_address
from .progress import Reporter, describe_outcome, format_span
from .report import LABELS_FILE, SOURCES, CorpusError, read_labels, read_reports, write_rows
from .store import CorpusStore, open_reports, store_path

if TYPE_CHECKING:
    from .gather import ReportSource, Service
    from .sources.github import GitHub
    from .sources.stack_exchange import StackExchange

LATER = 1
_INTERRUPTED = "interrupted; what was gathered is kept, and the same command goes on from there"
_TARBALL = "answers-archive.tar.gz"
_TARBALL_SECONDS = 86_400
# Up to so many questions are asked for one by one; for more, the whole archive is the lighter request.
_SINGLE_FILES = 200
_GITHUB_PAGE = re.compile(r"https?://(?:www\.)?github\.com/([\w.-]+/[\w.-]+?)(?:\.git)?(?:/.*)?\Z")


class Manner(NamedTuple):
    """How a command goes about it. wait: minutes to wait in all. api: another address of the service, or nothing."""

    store: Path | None = None
    api: str = ""
    wait: float = 60.0
    verbose: bool = False
    quiet: bool = False


def gather(
    what: str, *, since: str, pulls: bool, search: str, tags: Sequence[str], archive: Path | None, pages: Path | None,
    manner: Manner,
) -> int:  # fmt: skip
    """Gathers from one source. Returns the exit status."""

    def work() -> int:
        day = _parse_day(since)
        with CorpusStore(store_path(manner.store)) as store:
            for source, client in _make_sources(what, day, pulls, search, tags, archive, pages, manner, store):
                _gather_source(source, client, store, manner)
        return 0

    return run_command(lambda: _run_until_later(work), _INTERRUPTED)


def hydrate(labels: Path | None, texts: Path | None, *, archive: Path | None, manner: Manner) -> int:
    """Gathers the texts of all labelled ids again, or takes over those at hand. Returns the exit status."""

    def work() -> int:
        from . import gather as jobs

        ids = [label.id for label in read_labels(labels or LABELS_FILE)]
        with CorpusStore(store_path(manner.store)) as store:
            store.want(ids)
            if texts:
                taken, others = jobs.import_reports(read_reports(texts), store, frozenset(ids))
                left_out = f"; {others:,} without a label left out" if others else ""
                write(f"{escape(str(texts))}: {describe_outcome(taken)}{left_out}")
            try:
                if not texts:
                    _ask_for_missing(jobs.find_missing(store, ids), store, archive, manner)
            finally:
                _tell_hydrated(store, ids)
        return 0

    return run_command(lambda: _run_until_later(work), _INTERRUPTED)


def refresh(sources: Sequence[str], limit: int | None, *, archive: Path | None, manner: Manner) -> int:
    """Asks for everything in the store again. Returns the exit status."""

    def work() -> int:
        from . import gather as jobs

        for source in sources:
            if source not in SOURCES:
                raise CorpusError(f"--source {source}: unknown; choose one of {', '.join(SOURCES)}")
        with CorpusStore(_find_store(manner.store)) as store, Reporter(
            "refresh", verbose=manner.verbose, quiet=manner.quiet
        ) as reporter:  # fmt: skip
            services = _make_service_finder(store, archive, manner, reporter)
            chosen = [source for source in ("ros-answers", "robotics-se", "github") if not sources or source in sources]
            taken = jobs.refresh(services, store, chosen, limit, reporter.report_page)
        write(f"refresh: {describe_outcome(taken)}")
        return 0

    return run_command(lambda: _run_until_later(work), _INTERRUPTED)


def export(file: Path, *, store: Path | None) -> int:
    """Writes all reports to a JSON Lines or Parquet file. Returns the exit status."""

    def work() -> int:
        path = _find_store(store)
        suffix = file.suffix.lower()
        if suffix in (".jsonl", ".ndjson"):
            count = write_rows(file, open_reports(path))
        elif suffix == ".parquet":
            from .parquet import write_parquet

            count = write_parquet(file, open_reports(path))
        else:
            raise CorpusError(f"{file}: of no known format; name it *.jsonl or *.parquet")
        write(f"{escape(str(file))}: {format_count(count, 'report')}")
        return 0

    return run_command(work)


def print_status(*, store: Path | None) -> int:
    """Prints what is in the store. Returns the exit status."""

    def work() -> int:
        with CorpusStore(_find_store(store)) as opened:
            write(f"{opened.path}: {opened.path.stat().st_size / 1e6:.1f} MB")
            for source, here, labelled, gone in opened.count_reports():
                write(f"  {source}: {format_count(here, 'report')}, {labelled:,} of them labelled; {gone:,} gone")
            copied = opened.count_copied()
            if copied:
                write(f"  {copied:,} left out of the export, as copies of others")
            gatherings = opened.list_gatherings()
            if gatherings:
                write("gatherings:")
            for name, finished, updated in gatherings:
                day = datetime.fromtimestamp(updated, timezone.utc).strftime("%Y-%m-%d %H:%M UTC")
                write(f"  {name}: {'up to date' if finished else 'not finished'}, {day}")
        return 0

    return run_command(work)


def _run_until_later(work: Callable[[], int]) -> int:
    try:
        return work()
    except Later as later:
        say(f"rosimpact: {later}")
        return LATER


def _make_sources(
    what: str, since: str, pulls: bool, search: str, tags: Sequence[str], archive: Path | None, pages: Path | None,
    manner: Manner, store: CorpusStore,
) -> list[tuple[ReportSource, Client | None]]:  # fmt: skip
    """The sources that a command names, each with the client it speaks through."""
    from .sources import ros_answers

    if ros_answers.is_live_site(what) or ros_answers.is_live_site(manner.api):
        raise CorpusError(ros_answers.GONE)
    page = _GITHUB_PAGE.match(what)
    service = f"github:{page[1]}" if page else what
    name, _, repository = service.partition(":")
    _refuse_stray_options(name, pulls=pulls, search=search, tags=tags, archive=archive, pages=pages)
    if name == "github":
        from .sources.github import Listed, Searched

        server = _make_github(manner)
        kinds = ("issue", "pull") if pulls else ("issue",)
        if search:
            query = f"repo:{repository} {search}" if repository else search
            return [(Searched(server, query, since=since, kinds=kinds), server.client)]
        if not repository:
            raise CorpusError("github: names no repository; write github:owner/name, or give --search")
        return [(Listed(server, repository, since=since, kinds=kinds), server.client)]
    if service == "stack-exchange":
        from .sources.stack_exchange import TaggedQuestions

        exchange = _make_stack_exchange(manner)
        return [(TaggedQuestions(exchange, tag, since=since), exchange.client) for tag in tags or ("ros", "ros2")]
    if service == "ros-answers":
        if pages:
            return [(ros_answers.SavedPages(pages, since=since), None)]
        if manner.api:
            client = _make_client("Askbot", manner, spacing=0.5)
            return [(ros_answers.Askbot(client, manner.api, since=since), client)]
        place = archive or _fetch_tarball(store, manner, say)
        return [(ros_answers.Archive(place, since=since, known=store.read_digest), None)]
    raise CorpusError(f"{what}: is no source; write github:owner/name, ros-answers or stack-exchange")


def _refuse_stray_options(name: str, **given: object) -> None:
    """An option that a source does not know is named, rather than passed over."""
    known = {"github": ("pulls", "search"), "stack-exchange": ("tags",), "ros-answers": ("archive", "pages")}
    for option, value in given.items():
        if value and name in known and option not in known[name]:
            flag = "tag" if option == "tags" else option
            raise CorpusError(f"--{flag}: says nothing to {name}; leave it out")


def _gather_source(source: ReportSource, client: Client | None, store: CorpusStore, manner: Manner) -> None:
    from . import gather as jobs

    with Reporter(source.name, verbose=manner.verbose, quiet=manner.quiet) as reporter:
        if client is not None:
            client.tell = reporter.print_line
        taken = jobs.gather(source, store, reporter.report_page)
    for line in getattr(source, "unread", ()):
        say(f"rosimpact: left out: {line}")
    write(f"{source.name}: {describe_outcome(taken)}")


def _ask_for_missing(todo: dict[str, list[str]], store: CorpusStore, archive: Path | None, manner: Manner) -> None:
    from . import gather as jobs

    for id in todo.get("", ()):
        say(f"rosimpact: {id}: is the id of no known source, and left out")
    for source in ("ros-answers", "robotics-se", "github"):
        ids = todo.get(source)
        if not ids:
            continue
        with Reporter(f"hydrate {source}", verbose=manner.verbose, quiet=manner.quiet) as reporter:
            service = _make_service_finder(store, archive, manner, reporter)(source, len(ids))
            jobs.hydrate(service, source, ids, store, reporter.report_page)


def _tell_hydrated(store: CorpusStore, ids: list[str]) -> None:
    kept = {id: store.find_kept(id) for id in ids}
    gone = [id for id, known in kept.items() if known is not None and known.gone]
    here = sum(known is not None and not known.gone for known in kept.values())
    for id in gone:
        write(f"gone: {id}")
    rest = len(ids) - here - len(gone)
    write(f"{len(ids):,} labelled: {here:,} at hand, {len(gone):,} gone, {rest:,} to be gathered")


def _make_service_finder(
    store: CorpusStore, archive: Path | None, manner: Manner, reporter: Reporter
) -> Callable[[str, int], Service]:
    """Who is asked for reports of a source, by its name and how many they are."""

    def make_service(source: str, count: int) -> Service:
        if source == "github":
            server = _make_github(manner)
            server.client.tell = reporter.print_line
            _tell_quota(server, count, reporter)
            return server
        if source == "robotics-se":
            exchange = _make_stack_exchange(manner._replace(api=""))
            exchange.client.tell = reporter.print_line
            return exchange
        from .sources import ros_answers

        if archive is None and count <= _SINGLE_FILES:
            client = _make_client("the archive of ROS Answers", manner, tell=reporter.print_line)
            return ros_answers.ArchivedFiles(client, ros_answers.FILES)
        return ros_answers.Archive(archive or _fetch_tarball(store, manner, reporter.print_line))

    return make_service


def _tell_quota(server: GitHub, count: int, reporter: Reporter) -> None:
    """Says beforehand when the quota will not do, and what helps."""
    quota = server.fetch_quota()
    if quota is None or quota.remaining >= count:
        return
    hours = (count - quota.remaining) / max(1, quota.limit)
    remedy = "" if server.has_token else "; GITHUB_TOKEN raises it to 5,000"
    reporter.print_line(
        f"GitHub: {format_count(count, 'report')} to ask for, {format_count(quota.remaining, 'request')} left of "
        f"{quota.limit:,} an hour: that is {format_span(hours * 3600)} or more{remedy}"
    )


def _make_client(service: str, manner: Manner, **more) -> Client:
    return Client(service, patience=manner.wait * 60, **more)


def _make_github(manner: Manner) -> GitHub:
    from .sources import github
    from .tokens import find_github_token

    api = normalize_address(manner.api or github.API, github.API)
    token = find_github_token(api)
    return github.GitHub(_make_client("GitHub", manner, secrets=[token]), api, token)


def _make_stack_exchange(manner: Manner) -> StackExchange:
    from .sources import stack_exchange
    from .tokens import find_stack_exchange_key

    api = normalize_address(manner.api or stack_exchange.API, stack_exchange.API)
    key = find_stack_exchange_key(api)
    return stack_exchange.StackExchange(_make_client("Stack Exchange", manner, spacing=0.1, secrets=[key]), api, key)


def _fetch_tarball(store: CorpusStore, manner: Manner, tell: Callable[[str], None]) -> Path:
    """The archive as a file beside the store, fetched anew once a day. tell: called with a line for each wait, too."""
    from .sources import ros_answers

    file = store.path.resolve().parent / _TARBALL
    if not file.exists() or time.time() - file.stat().st_mtime > _TARBALL_SECONDS:
        if not manner.quiet:
            tell("fetching the archive of ROS Answers")
        client = _make_client("the archive of ROS Answers", manner, tell=tell)
        ros_answers.fetch_archive(client, file, ros_answers.TARBALL)
    return file


def _find_store(chosen: Path | None) -> Path:
    path = store_path(chosen)
    if not path.exists():
        raise CorpusError(f"{path}: is not there; gather something first with `rosimpact corpus gather`")
    return path


def _parse_day(since: str) -> str:
    if not since:
        return ""
    try:
        return date.fromisoformat(since).isoformat()
    except ValueError:
        raise CorpusError(f"--since {since}: is no day; write it like 2024-01-31") from None
