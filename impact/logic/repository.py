"""Where the logic of publishing changed across the commits of a repository.

    logic = read("repo", Range(text="v1.0..main"), store)
    for commit, change in logic.changes: ...

Nothing is checked out. What a package says at a commit is kept by the content of its files, and what a commit changed
by the commit, so that a second run reads neither.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import msgspec

from ...edges import processes
from ...edges.memory import cache_method
from ..facts import kinds
from ..facts.store import Store, encode_rows, make_fact_key, pack, unpack
from .changes import LogicChange, ReachedSubscriber, Side
from .history import Commit, CommitHistory, PackageState
from .statements import Before, find_facts_kind
from .states import Digests, compare_sides, compute_stamp, decode_digest, make_digest_row, make_unread_digest

Progress = Callable[[str, int, int], None]
_STATES_AT_ONCE = 24
_COMMITS_AT_ONCE = 24


class Range(NamedTuple):
    """Which commits: text as `A..B` or `B`, the newest so many, those since a day. All must hold."""

    text: str = ""
    number: int | None = None
    since: str = ""


class LogicCoverage(msgspec.Struct, frozen=True):
    """commits: looked at; compared: those that changed C++ or Python of a package; cut_off: those whose parent is not
    in the repository. packages: at the newest commit. statements: publish statements there; unresolved: those of them
    whose topic is not known; unread: files there that were not read in full."""

    commits: int = 0
    compared: int = 0
    cut_off: int = 0
    packages: int = 0
    statements: int = 0
    unresolved: int = 0
    unread: tuple[str, ...] = ()


class Logic(msgspec.Struct, frozen=True):
    """What was found. changes: newest commit first, in a commit by path and line; rewordings included."""

    repository: str
    range: str
    commits: tuple[Commit, ...]
    changes: tuple[tuple[Commit, LogicChange], ...]
    coverage: LogicCoverage


class _Result(msgspec.Struct, frozen=True, array_like=True):
    """A commit's changes as they are remembered. compared: whether any package changed."""

    changes: tuple[LogicChange, ...]
    compared: bool = True
    cut_off: bool = False


def read(
    repository: str, range: Range, store: Store, jobs: int | None = None, progress: Progress | None = None
) -> Logic:
    """All changes of the logic of publishing in some commits of a repository.

    jobs: processes to use, all cores when None. progress: told what is done, how often, and how often in all. Raises
    TreeError for a repository or revision that is not there, ValueError for a date that cannot be read.
    """
    history = CommitHistory(repository)
    commits = history.list_commits(range.text, range.number, range.since)
    run = _Run(history, store, jobs or processes.count_cores(), progress or (lambda what, done, total: None))
    results = run.compute_results(commits)
    found = [(commit, change) for commit in commits for change in results[commit.id].changes]
    coverage = run.count_coverage(commits, results)
    return Logic(history.name, _format_range(range), tuple(commits), tuple(found), coverage)


def select(logic: Logic, packages: Sequence[str] = (), topics: Sequence[str] = (), everything: bool = False) -> Logic:
    """The changes of some packages and topics alone, all when none are given. A topic is named as the code has it or in
    full. everything: conditions that were merely reworded too."""
    wanted = {topic.lstrip("~/") for topic in topics}
    found = tuple(
        (commit, change)
        for commit, change in logic.changes
        if (everything or change.kind != "equivalent")
        and (not packages or change.package in packages)
        and (not wanted or wanted & {name.lstrip("~/") for name in (*change.topics, *change.topic.split(", "))})
    )
    return msgspec.structs.replace(logic, changes=found)


def _format_range(range: Range) -> str:
    parts = [range.text or "HEAD"]
    if range.number is not None:
        parts.append(f"the newest {range.number}")
    if range.since:
        parts.append(f"since {range.since}")
    return ", ".join(parts)


class _Run:
    def __init__(self, history: CommitHistory, store: Store, jobs: int, progress: Progress):
        self.history, self.store, self.jobs, self.progress = history, store, jobs, progress
        self.digests = Digests(store)

    def compute_results(self, commits: Sequence[Commit]) -> dict[str, _Result]:
        keys = {_commit_key(commit.id, self.history.folder): commit.id for commit in commits}
        found: dict[str, _Result] = {}
        for key, data in self.store.find_memos("logic", keys).items():
            try:
                found[keys[key]] = msgspec.msgpack.decode(data, type=_Result)
            except msgspec.MsgspecError:
                continue
        todo = [commit for commit in reversed(commits) if commit.id not in found]
        if todo:
            found.update(self._compute_missing(todo))
        return found

    def _compute_missing(self, todo: Sequence[Commit]) -> Iterator[tuple[str, _Result]]:
        plain: list[tuple[str, _Result]] = []
        steps: list[_Step] = []
        for number, commit in enumerate(todo, 1):
            try:
                step = _make_step(self.history, commit)
            except KeyError:
                plain.append((commit.id, _Result((), False, True)))
                continue
            if step is None:
                plain.append((commit.id, _Result((), False)))
            else:
                steps.append(step)
            if number % 50 == 0 or number == len(todo):
                self.progress("looking through commits", number, len(todo))
        self._remember(plain)
        yield from plain
        self._make_digests([state for step in steps for state in (*step.old, *step.new)])
        yield from self._compare(steps)

    def _make_digests(self, states: Iterable[PackageState]) -> None:
        """Makes the digests that are not there yet."""
        wanted = {state.key: state for state in states}
        known = self.digests.load(wanted)
        missing = [state for key, state in wanted.items() if key not in known]
        chunks = _split_states(missing)
        done = 0
        what = (self.history.path, self.store.folder)
        for chunk, made in processes.run_forked_rows(_digest_chunk, chunks, self.jobs, *what):
            lost = [state for state, row in zip(chunk, made, strict=True) if row is None]
            self.digests.add([row for row in made if row is not None], map(make_unread_digest, lost))
            done += len(chunk)
            self.progress("reading packages", done, len(missing))

    def _compare(self, steps: Sequence[_Step]) -> Iterator[tuple[str, _Result]]:
        chunks = [steps[start : start + _COMMITS_AT_ONCE] for start in range(0, len(steps), _COMMITS_AT_ONCE)]
        done = 0
        compared: list[tuple[_Step, tuple[LogicChange, ...]]] = []
        known = self.digests.packed
        for chunk, found in processes.run_forked_rows(_compare_chunk, chunks, self.jobs, self.history.path, known):
            for step, row in zip(chunk, found, strict=True):
                if row is None:
                    # Not remembered: the next run tries again.
                    yield step.commit.id, _Result((), False)
                else:
                    compared.append((step, row))
            done += len(chunk)
            self.progress("comparing commits", done, len(steps))
        reaching = [step for step, found in compared if any(change.topics for change in found)]
        self._make_digests(state for step in reaching for state in self.history.find_packages(step.commit.id).values())
        waiting: list[tuple[str, _Result]] = []
        for step, found in compared:
            if any(change.topics for change in found):
                listeners = self._find_subscribers(step.commit.id)
                found = tuple(_add_subscribers(change, listeners) for change in found)
            waiting.append((step.commit.id, _Result(found)))
        self._remember(waiting)
        yield from waiting

    def count_coverage(self, commits: Sequence[Commit], results: Mapping[str, _Result]) -> LogicCoverage:
        """What was looked at, and what the newest commit's packages hold."""
        if not commits:
            return LogicCoverage()
        compared = sum(result.compared for result in results.values())
        cut_off = sum(result.cut_off for result in results.values())
        try:
            states = self.history.find_packages(commits[0].id)
        except KeyError:
            states = {}
        self._make_digests(states.values())
        statements = unresolved = 0
        unread: list[str] = []
        for state in states.values():
            one = self.digests.decode_state(state.key)
            statements += len(one.statements)
            unresolved += sum(
                not any(one.outlets[place].topic for place in statement.outlets) for statement in one.statements
            )
            unread += [state.locate(path) for path in one.unread]
        return LogicCoverage(
            len(commits), compared, cut_off, len(states), statements, unresolved, tuple(sorted(unread))
        )

    def _find_subscribers(self, commit: str) -> dict[str, list[ReachedSubscriber]]:
        """The subscribers of a commit by their topics."""
        found: dict[str, list[ReachedSubscriber]] = {}
        for state in self.history.find_packages(commit).values():
            for inlet in self._load_inlets(state.key):
                path = state.locate(inlet.path)
                reached = ReachedSubscriber(state.name, inlet.node, inlet.topic, inlet.callback, path, inlet.line)
                found.setdefault(inlet.topic, []).append(reached)
        return found

    @cache_method
    def _load_inlets(self, key: bytes):
        return self.digests.decode_state(key).inlets

    def _remember(self, rows: Iterable[tuple[str, _Result]]) -> None:
        folder = self.history.folder
        self.store.remember("logic", encode_rows((_commit_key(commit, folder), row) for commit, row in rows))


def _add_subscribers(change: LogicChange, listeners: Mapping[str, list[ReachedSubscriber]]) -> LogicChange:
    """The change with its subscribers, each once for all nodes that run it."""
    found: dict[tuple[str, int, str], dict[ReachedSubscriber, None]] = {}
    for topic in change.topics:
        for reached in listeners.get(topic, ()):
            found.setdefault((reached.path, reached.line, reached.callback), {})[reached] = None
    merged = [
        msgspec.structs.replace(
            next(iter(same)),
            node=", ".join(sorted({one.node for one in same if one.node})),
            topic=", ".join(sorted({one.topic for one in same})),
        )
        for same in found.values()
    ]
    return msgspec.structs.replace(change, reaches=tuple(merged)) if merged else change


class _Step(NamedTuple):
    """A commit with the packages that differ from its parent's."""

    commit: Commit
    old: tuple[PackageState, ...]
    new: tuple[PackageState, ...]


def _make_step(history: CommitHistory, commit: Commit) -> _Step | None:
    """None where no package differs. Raises KeyError when the parent is not in the repository."""
    if history.has_same_tree(commit.parent, commit.id):
        return None
    old, new = history.find_packages(commit.parent), history.find_packages(commit.id)
    differ = [name for name in {**old, **new} if name not in old or name not in new or old[name].key != new[name].key]
    step = _Step(
        commit,
        tuple(old[name] for name in differ if name in old),
        tuple(new[name] for name in differ if name in new),
    )
    return step if differ else None


def _compare_chunk(
    repository: str, digests: Mapping[bytes, bytes], steps: Sequence[_Step]
) -> list[tuple[LogicChange, ...]]:
    history = CommitHistory(repository)
    return [tuple(_compare_step(history, step, digests)) for step in steps]


def _compare_step(history: CommitHistory, step: _Step, digests: Mapping[bytes, bytes]) -> list[LogicChange]:
    old = Side([(state, decode_digest(digests.get(state.key))) for state in step.old])
    new = Side([(state, decode_digest(digests.get(state.key))) for state in step.new])
    return compare_sides(old, new, lambda: _find_renamed_files(history, step), lambda file: history.read(file.id))


def _find_renamed_files(history: CommitHistory, step: _Step) -> dict[str, str]:
    old = {state.locate(file.path) for state in step.old for file in state.files}
    new = {state.locate(file.path) for state in step.new for file in state.files}
    if not old - new or not new - old:
        return {}
    return history.find_renames(step.commit.parent, step.commit.id)


def _split_states(states: Iterable[PackageState]) -> list[list[PackageState]]:
    """States in pieces of one package each, in the order of time; the largest first."""
    by_name: dict[str, list[PackageState]] = {}
    for state in states:
        by_name.setdefault(state.name, []).append(state)
    chunks = [
        mine[start : start + _STATES_AT_ONCE]
        for mine in by_name.values()
        for start in range(0, len(mine), _STATES_AT_ONCE)
    ]
    return sorted(chunks, key=lambda chunk: -sum(len(state.files) for state in chunk))


# The digest of a package may take as much time as a file of this size.
_JOIN_BYTES = 10_000_000


def _digest_chunk(repository: str, folder: str, states: Sequence[PackageState]) -> list[tuple[bytes, bytes]]:
    """(key, packed digest) of states of one package. folder: of the store of facts."""
    history = CommitHistory(repository)
    known: dict[tuple[str, str], Any] = {}
    rows: list[tuple[bytes, bytes]] = []
    before = Before()
    with Store(folder) as store:
        for state in states:
            wanted = {(file.id, find_facts_kind(file)) for file in state.files}
            known = {key: facts for key, facts in known.items() if key in wanted}
            known.update(_load_facts(history, store, [key for key in wanted if key not in known]))
            facts = {file.path: known.get((file.id, find_facts_kind(file))) for file in state.files}
            processes.begin_part(0, _JOIN_BYTES)
            rows.append(make_digest_row(state, facts, before))
    return rows


def _load_facts(
    history: CommitHistory, store: Store, wanted: Sequence[tuple[str, str]]
) -> Iterator[tuple[tuple[str, str], Any]]:
    """Facts of contents, from the store or made now."""
    rows = {make_fact_key(content, kinds.make_version(kind)): (content, kind) for content, kind in wanted}
    missing = dict(rows)
    for row, data in store.get(rows):
        try:
            facts = kinds.decode(rows[row][1], unpack(data)).facts
        except (ValueError, msgspec.MsgspecError):
            continue
        del missing[row]
        yield rows[row], facts
    fresh: list[tuple[bytes, bytes]] = []
    for row, (content, kind) in missing.items():
        try:
            source = history.tree.read_blob(content)
        except OSError:
            continue  # what is known of a content is of its bytes
        processes.begin_part(0, len(source))
        extracted = kinds.extract(kind, source)
        fresh.append((row, pack(kinds.encode(extracted))))
        yield (content, kind), extracted.facts
    store.put(fresh)


def _commit_key(commit: str, folder: str) -> bytes:
    return bytes.fromhex(commit) + folder.encode("utf-8", "surrogateescape") + compute_stamp(__name__)
