"""From a tree to the facts of its files: looked up by content, made in parallel where they are not known yet.

What is made is stored chunk by chunk, so an interrupted run keeps all it has parsed. Facts are decoded when asked for.

Workers are forked where that is safe (processes.py), loky elsewhere; a backend chosen through joblib
(`parallel_config`) is given the chunks instead.
"""

import contextlib
import sys
from collections import deque
from collections.abc import Callable, Generator, Iterable, Iterator, Mapping
from contextlib import closing
from functools import cache, partial
from itertools import chain, islice
from typing import Any, TypeVar

import msgspec

from ...edges import processes
from ...edges.limits import format_size
from ..tree import PathProblem, Tree
from . import kinds
from .place import Problem
from .store import Store, make_fact_key, pack, unpack

# Starting workers and importing the parsers in each costs about as much as parsing this many bytes here.
ALONE_BYTES = 400_000
_CHUNK_BYTES = 256_000
_WAVE_PER_JOB = 8
_LFS_POINTER = b"version https://git-lfs.github.com/spec/"

# (path, content id, kinds, bytes) of a file to extract; (content id, kind, packed facts, failure) of facts extracted
_Item = tuple[str, str, tuple[str, ...], bytes]
_Result = tuple[str, str, bytes, str]
_Extract = Callable[[list[_Item]], list[_Result]]
# By the kind of facts: a kind of search, and what to look for.
Searches = Mapping[str, tuple[str, Any]]
# (bytes, path, kinds) of a file to read
_Unread = tuple[int, str, tuple[str, ...]]
_T = TypeVar("_T")


class ExtractedFacts:
    """The facts of a tree's files, decoded when asked for.

    kinds: kind by path, of every file that was recognised and could be read. ids: content id by path, of the same
    files. problems: what could not be read, the tree's own problems included. extracted: how many contents were parsed
    in this run. second: the facts of the second look at files, None where none was asked for.
    """

    def __init__(self, tree: Tree, store: Store):
        self.tree = tree
        self.store = store
        self.kinds: dict[str, str] = {}
        self.ids: dict[str, str] = {}
        self.problems: list[PathProblem] = []
        self.extracted = 0
        self.second: ExtractedFacts | None = None
        self._packed: dict[tuple[str, str], bytes] = {}
        self._decoded: dict[tuple[str, str], Any] = {}
        self._looked: dict[bytes, Any] = {}
        self._others: dict[str, str] = {}
        self._fresh: list[tuple[bytes, bytes]] = []
        self._deferring = False

    def list_paths(self, *wanted: str) -> list[str]:
        """Paths of these kinds, sorted; of every kind when none is given."""
        return [path for path, kind in self.kinds.items() if not wanted or kind in wanted]

    def get_facts(self, path: str) -> Any:
        """The facts of a file. Raises KeyError when the path is not in `kinds`.

        Files of equal content and kind share one object."""
        key = (self.ids[path], self.kinds[path])
        known = self._decoded.get(key)
        if known is None:
            if key not in self._packed:
                self.preload((path,))
            known = self._decoded[key] = self._decode(path, key)
        return known

    def look(
        self, paths: Iterable[str], kind: str, table: Any = None,
        on_error: Callable[[str, OSError], None] = lambda path, error: None,
    ) -> dict[str, Any]:  # fmt: skip
        """Facts of another kind of files, made when they are first asked for and stored by content as all facts are.

        paths: files of the tree; those that cannot be read are left out, and on_error is told. kind: one of
        kinds.EXTRACTORS. table: of kinds.SEARCHES, whose files have facts, what to look for; its `stamp` differs
        whenever it does.
        """
        version = _find_version(kind) + (table.stamp if table is not None else "")
        rows: dict[str, bytes] = {}
        for path in paths:
            content = self.ids.get(path) or self._others.get(path)
            if content is None:  # of a file that no kind was asked of before
                try:
                    content = self._others[path] = self.tree.find_content_id(path)
                except OSError as error:
                    on_error(path, error)
                    continue
            rows[path] = make_fact_key(content, version)
        known = self._looked
        for row, packed in self.store.get({row for row in rows.values() if row not in known}):
            with contextlib.suppress(ValueError, msgspec.MsgspecError):
                known[row] = kinds.decode(kind, unpack(packed)).facts
        fresh: list[tuple[bytes, bytes]] = []
        for path, row in rows.items():
            if row in known:
                continue
            try:
                data, content = self.tree.read_with_id(path, _largest(kind))
            except OSError as error:
                on_error(path, error)
                continue
            if kind in kinds.SEARCHES:
                found = kinds.search(kind, data, self.get_facts(path).facts, table)
            else:
                found = kinds.extract(kind, data)
            known[row] = found.facts
            if row == make_fact_key(content, version):  # else it has just been written to
                with contextlib.suppress(UnicodeEncodeError, OverflowError, RecursionError):
                    fresh.append((row, pack(kinds.encode(found))))
        self._fresh += fresh
        if not self._deferring:
            self._flush()
        return {path: known[row] for path, row in rows.items() if row in known}

    @contextlib.contextmanager
    def defer_storing(self) -> Iterator[None]:
        """Stores what look() makes meanwhile at once, at the end."""
        self._deferring = True
        try:
            yield
        finally:
            self._deferring = False
            self._flush()

    def _flush(self) -> None:
        if self._fresh:
            self.store.put(self._fresh)
            self._fresh = []

    def preload(self, paths: Iterable[str]) -> None:
        """Reads the stored facts of many files at once, which is faster than one by one. Paths without facts are left
        out."""
        wanted = {}
        for path in paths:
            kind = self.kinds.get(path)
            if kind is not None:
                key = (self.ids[path], kind)
                if key not in self._decoded and key not in self._packed:
                    wanted[_make_key(*key)] = key
        for row, data in self.store.get(wanted):
            self._packed[wanted[row]] = data

    def forget(self, paths: Iterable[str]) -> None:
        """Lets go of decoded facts; they are read again when asked for."""
        for path in paths:
            key = (self.ids.get(path, ""), self.kinds.get(path, ""))
            self._decoded.pop(key, None)
            self._packed.pop(key, None)

    def _decode(self, path: str, key: tuple[str, str]) -> Any:
        packed = self._packed.pop(key, None)
        if packed is not None:
            try:
                return kinds.decode(key[1], unpack(packed))
            except (ValueError, msgspec.MsgspecError):
                pass
        # The store lost it, or holds something else under its name: the file is still there.
        data, content = self.tree.read_with_id(path, _largest(key[1]))
        ((_, ((_, kind, made, failure),)),) = _extract_chunks(iter([[(path, content, (key[1],), data)]]), 1, {})
        if failure:
            return kinds.FileFacts(kind, kinds.make_empty(kind, Problem(1, failure)))
        self.store.put([(_make_key(content, kind), made)])
        return kinds.decode(kind, unpack(made))


def extract_all(
    tree: Tree, store: Store, *, jobs: int | None = None, progress: Callable[[int, int], None] | None = None,
    kind_of: Callable[[str], str | None] = kinds.find_kind, second: Callable[[str], str | None] | None = None,
    along: Callable[[], Searches] = dict,
) -> ExtractedFacts:  # fmt: skip
    """Finds or makes the facts of every file whose kind is known.

    kind_of: the kind of facts wanted of a path, None for none; by its name when left out. second: the kind wanted of it
    by the second look; a worker makes both facts of a file in one visit. along: gives the searches that a worker makes
    in the same visit, since look() will ask for them; it is called where there is something to extract.
    jobs: processes to use, all available cores when None. progress: called with (done, total) bytes of the files whose
    facts are not known from an earlier run. KeyboardInterrupt passes through; what was parsed before it stays stored.
    """
    extraction = ExtractedFacts(tree, store)
    beside = extraction.second = ExtractedFacts(tree, store) if second is not None else None
    key = tree.make_memory_key()
    entries = tree.list_entries()
    if key is not None:
        memory = store.find_memo("stat", key)
        if memory is not None:
            tree.recall(memory)
    extraction.problems.extend(tree.problems)

    unread: list[_Unread] = []
    known: dict[bytes, tuple[int, str, str]] = {}
    known_id = tree.find_known_id
    for entry in entries:
        path, size = entry.path, entry.size
        kind = kind_of(path)
        other = second(path) if second is not None else None
        if kind is None and other is None:
            continue
        largest = max(_largest(each) for each in (kind, other) if each is not None)
        if size > largest:
            message = f"larger than {format_size(largest)} ({format_size(size)}), taken for generated and not read"
            extraction.problems.append(PathProblem(path, message))
            continue
        content = known_id(path)
        if content is None:
            unread.append((size, path, tuple(each for each in (kind, other) if each is not None)))
        for look, each in ((extraction, kind), (beside, other)):
            if look is not None and each is not None:
                look.kinds[path] = each
                if content is not None:
                    look.ids[path] = content
                    known.setdefault(_make_key(content, each), (size, path, each))
    present = store.find(known)
    lacking: dict[str, tuple[int, list[str]]] = {}
    for row, (size, path, kind) in known.items():
        if row not in present:
            lacking.setdefault(path, (size, []))[1].append(kind)
    unread.extend((size, path, tuple(those)) for path, (size, those) in lacking.items())

    if unread:
        try:
            _make(extraction, unread, jobs or processes.count_cores(), progress, along())
        finally:
            _remember(tree, store, key)
            extraction.problems.sort()
    else:
        _remember(tree, store, key)
    return extraction


def _make_key(content: str, kind: str) -> bytes:
    return make_fact_key(content, _find_version(kind))


_largest = cache(kinds.find_size_limit)


@cache
def _find_version(kind: str) -> str:
    return kinds.make_version(kind)


def _remember(tree: Tree, store: Store, key: bytes | None) -> None:
    memory = tree.make_memory() if key is not None else None
    if key is not None and memory is not None:
        store.remember("stat", [(key, memory)])


def _make(
    extraction: ExtractedFacts, unread: list[_Unread], jobs: int, progress: Callable[[int, int], None] | None,
    along: Searches,
) -> None:  # fmt: skip
    """Reads the files, stores the facts of those whose content is not known, and notes what failed."""
    # Large files first: the last chunks are then small, and no worker is left alone with a large one.
    unread.sort(key=lambda file: (-file[0], file[1]))
    total = sum(size for size, _, _ in unread)
    done = 0
    paths_of: dict[tuple[str, str], list[tuple[ExtractedFacts, str]]] = {}
    for look in _list_looks(extraction):
        for path, content in look.ids.items():
            paths_of.setdefault((content, look.kinds[path]), []).append((look, path))

    def report_progress(size: int) -> None:
        nonlocal done
        done += size
        if progress is not None:
            progress(min(done, total), total)

    chunks = _iterate_batches(_iterate_items(extraction, unread, paths_of, report_progress), lambda item: len(item[3]))
    stamps = {kind: table.stamp for kind, table in along.values()}
    with closing(_extract_chunks(chunks, jobs, along)) as finished:  # an interrupt must reach the workers at once
        for chunk, results in finished:
            rows = []
            for content, kind, packed, failure in results:
                if failure:
                    for look, path in paths_of[content, kind]:
                        _drop(look, path, failure)
                else:
                    rows.append((make_fact_key(content, _find_version(kind) + stamps.get(kind, "")), packed))
                    extraction.extracted += kind not in stamps
            extraction.store.put(rows)
            report_progress(sum(len(item[3]) for item in chunk))


def _list_looks(extraction: ExtractedFacts) -> list[ExtractedFacts]:
    return [extraction] if extraction.second is None else [extraction, extraction.second]


def _iterate_items(
    extraction: ExtractedFacts,
    unread: list[_Unread],
    paths_of: dict[tuple[str, str], list[tuple[ExtractedFacts, str]]],
    advance: Callable[[int], None],
) -> Iterator[_Item]:
    """Reads files as they are needed and yields those whose content has no facts yet."""
    looks = _list_looks(extraction)
    seen: set[tuple[str, str]] = set()
    for batch in _iterate_batches(unread, lambda file: file[0]):
        rows: set[bytes] = set()
        items: list[tuple[str, str, dict[str, bytes], bytes]] = []
        for expected, path, those in batch:
            try:
                data, content = extraction.tree.read_with_id(path, max(map(_largest, those)))
            except OSError as error:
                reason = error.strerror or type(error).__name__
                message = f"cannot be read: {reason[:1].lower()}{reason[1:]}"
                _mark_unreadable(looks, _list_equal(looks, path, those, paths_of), message)
                advance(expected)
                continue
            if data.startswith(_LFS_POINTER):
                message = "a Git LFS pointer, its content is not here (git lfs pull)"
                _mark_unreadable(looks, _list_equal(looks, path, those, paths_of), message)
                advance(expected)
                continue
            for look in looks:
                if path in look.kinds and look.ids.get(path) != content:
                    look.ids[path] = content
                    paths_of.setdefault((content, look.kinds[path]), []).append((look, path))
            fresh = {kind: _make_key(content, kind) for kind in those if (content, kind) not in seen}
            if not fresh:
                advance(expected)
                continue
            seen.update((content, kind) for kind in fresh)
            rows.update(fresh.values())
            items.append((path, content, fresh, data))
        present = extraction.store.find(rows)
        for path, content, fresh, data in items:
            lacking = tuple(kind for kind, row in fresh.items() if row not in present)
            if not lacking:
                advance(len(data))
                continue
            yield path, content, lacking, data


def _iterate_batches(files: Iterable[_T], size_of: Callable[[_T], int]) -> Iterator[list[_T]]:
    """Files, read or not, about _CHUNK_BYTES at a time."""
    batch: list[_T] = []
    size = 0
    for file in files:
        batch.append(file)
        size += size_of(file)
        if size >= _CHUNK_BYTES:
            yield batch
            batch, size = [], 0
    if batch:
        yield batch


def _list_equal(
    looks: list[ExtractedFacts],
    path: str,
    those: Iterable[str],
    paths_of: dict[tuple[str, str], list[tuple[ExtractedFacts, str]]],
) -> list[str]:
    """A path and all others of the same content, of which it alone is read."""
    contents = {look.ids[path] for look in looks if path in look.ids}
    equal = {each for content in contents for kind in those for _, each in paths_of.get((content, kind), ())}
    return sorted(equal | {path})


def _mark_unreadable(looks: list[ExtractedFacts], paths: Iterable[str], message: str) -> None:
    """Leaves paths out of every look; the first names them."""
    for path in paths:
        _drop(looks[0], path, message)
        for look in looks[1:]:
            look.kinds.pop(path, None)
            look.ids.pop(path, None)


def _drop(extraction: ExtractedFacts, path: str, message: str) -> None:
    extraction.problems.append(PathProblem(path, message))
    extraction.kinds.pop(path, None)
    extraction.ids.pop(path, None)


def _extract(along: Searches, chunk: list[_Item]) -> list[_Result]:
    """What a worker does: bytes to packed facts, a file that its extractor fails on named and not fatal."""
    results: list[_Result] = []
    part = 0
    for _, content, those, data in chunk:
        for kind in those:
            processes.begin_part(part, len(data))
            part += 1
            try:
                found = kinds.extract(kind, data)
                results.append((content, kind, pack(kinds.encode(found)), ""))
                if kind in along:
                    search, table = along[kind]
                    also = kinds.search(search, data, found.facts, table)
                    results.append((content, search, pack(kinds.encode(also)), ""))
            except MemoryError:
                raise
            except Exception as error:
                reason = f"the {kind} extractor failed: {type(error).__name__}: {error}"
                results.append((content, kind, b"", reason[:300]))
    return results


def _extract_chunks(
    chunks: Iterator[list[_Item]], jobs: int, along: Searches
) -> Generator[tuple[list[_Item], list[_Result]], None, None]:
    """Chunks with their results, from one process when there is little to do, else from several."""
    first: list[list[_Item]] = []
    size = 0
    for chunk in chunks:
        first.append(chunk)
        size += sum(len(item[3]) for item in chunk)
        if size > ALONE_BYTES and jobs > 1:
            break
    else:
        jobs = 1
    everything = chain(first, chunks)
    if processes.may_fork() and not (jobs > 1 and _is_in_joblib_context()):
        yield from _extract_in_workers(everything, jobs, partial(_extract, along))
    elif jobs > 1:
        yield from _extract_by_joblib(everything, jobs, partial(_extract, along))
    else:
        for chunk in everything:
            for item in chunk:
                yield [item], _extract(along, [item])


def _is_in_joblib_context() -> bool:
    """True inside joblib.parallel_config(...): whoever calls us has decided where work runs."""
    if "joblib" not in sys.modules:
        return False
    from joblib.parallel import get_active_backend

    return type(get_active_backend()[0]).__name__ not in ("LokyBackend", "SequentialBackend")


def _extract_by_joblib(
    chunks: Iterator[list[_Item]], jobs: int, extract: _Extract
) -> Iterator[tuple[list[_Item], list[_Result]]]:
    """Chunks in whatever joblib runs. In waves: joblib would take from the iterator in a thread of its own, and reading
    and storing belong to this one."""
    from joblib import Parallel, delayed, effective_n_jobs

    if _is_in_joblib_context():
        jobs = effective_n_jobs(-1)
    with Parallel(n_jobs=jobs) as parallel:
        while wave := list(islice(chunks, _WAVE_PER_JOB * jobs)):
            results: Any = parallel(delayed(extract)(chunk) for chunk in wave)
            yield from zip(wave, results, strict=True)


def _extract_in_workers(
    chunks: Iterator[list[_Item]], jobs: int, extract: _Extract
) -> Iterator[tuple[list[_Item], list[_Result]]]:
    """Chunks in forked processes. A file that kills its process, or that takes too much time or memory, is found, named
    and left out."""
    waiting: deque[list[_Item]] = deque()
    alone: deque[list[_Item]] = deque()
    with processes.Workers(extract, jobs) as workers:
        while True:
            while workers.free:
                chunk = waiting.popleft() if waiting else next(chunks, None)
                if chunk is None:
                    break
                workers.give(chunk)
            while workers.free and alone and not waiting:
                workers.give(alone.popleft(), fresh=True)
            if not workers.busy:
                return
            for chunk, results in workers.wait_for_finished():
                if not isinstance(results, processes.Died):
                    yield chunk, results
                    continue
                parts = [(item, kind) for item in chunk for kind in item[2]]
                first = results.fresh and results.part == 0
                if not 0 <= results.part < len(parts) or not (results.timed or first):
                    suspects = parts if results.part < 0 else parts[results.part : results.part + 1]
                    if len(parts) == 1 and results.fresh:
                        yield chunk, [_make_failure(*parts[0], results.why)]
                        continue
                    alone.extend([(*item[:2], (kind,), item[3])] for item, kind in suspects)
                else:
                    suspects = parts[results.part : results.part + 1]
                    item, kind = suspects[0]
                    yield [(*item[:2], (kind,), b"")], [_make_failure(item, kind, results.why)]
                rest = _drop_kinds(chunk, suspects)
                if rest:
                    waiting.append(rest)


def _make_failure(item: _Item, kind: str, why: str) -> _Result:
    return item[1], kind, b"", f"the {kind} extractor {why} on this file"


def _drop_kinds(chunk: list[_Item], parts: list[tuple[_Item, str]]) -> list[_Item]:
    """A chunk without some kinds of facts of its files."""
    done = {(item[1], kind) for item, kind in parts}
    rest = ((*item[:2], tuple(kind for kind in item[2] if (item[1], kind) not in done), item[3]) for item in chunk)
    return [item for item in rest if item[2]]
