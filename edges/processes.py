"""Processes that work beside this one: forked, so that they know all that is known here and cost next to nothing.

They are also what contains hostile input: a task that crashes its process, runs for too long or needs too much memory
costs that task alone. The process is replaced, and Died says what became of the task.

On two cores, starting two workers takes 0.01 s, two loky workers 0.31 s and two workers of joblib's multiprocessing
backend 0.08 s and joblib's own import 0.12 s.
"""

from __future__ import annotations

import contextlib
import gc
import mmap
import os
import pickle
import selectors
import signal
import struct
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, NamedTuple, TypeVar

from .console import DEBUG
from .files import write_all
from .limits import format_size, get_limits

_Result = TypeVar("_Result")
_LENGTH = struct.Struct("<Q")
_PLACE = struct.Struct("<q")
_OUT_OF_MEMORY = 3
_NOWHERE = -1


class Died(NamedTuple):
    """What became of a task whose process ended. why: one clause. part: the number that the task last gave to
    begin_part(), -1 without one. fresh: True when the process had done nothing before, so that nothing but this task
    can be the cause. timed: True when the time for that part ran out, of which nothing else can be the cause."""

    why: str
    part: int = _NOWHERE
    fresh: bool = True
    timed: bool = False


def count_cores() -> int:
    """How many processes may run at once on this machine."""
    if hasattr(os, "sched_getaffinity"):
        return max(1, len(os.sched_getaffinity(0)))
    return os.cpu_count() or 1


def may_fork() -> bool:
    """True where a fork is safe: macOS has fork, and libraries there that do not survive it."""
    return sys.platform == "linux"


class Workers:
    """Forked processes that call one function on things, one thing at a time each.

    task: called as task(*what, thing). what: anything, inherited by the processes and never copied to them. Results
    and things are pickled between our own processes. The processes end with this one, leave Ctrl-C to it, and say
    nothing on standard error. Use as a context manager: leaving it ends the processes at once.
    """

    def __init__(self, task: Callable[..., Any], jobs: int, *what: Any):
        self._task, self._what = task, what
        # Whoever asks for 100,000 is not served by as many processes.
        self._jobs = max(1, min(jobs, max(64, 4 * count_cores())))
        self._workers: list[_Worker] = []
        self._selector = selectors.DefaultSelector()

    def __enter__(self) -> Workers:
        return self

    def __exit__(self, *exception: object) -> None:
        for worker in list(self._workers):
            self._end(worker)
        self._selector.close()

    @property
    def free(self) -> bool:
        """True when a thing can be given to a process that has nothing to do, or to a new one."""
        return len(self._workers) < self._jobs or any(not worker.busy for worker in self._workers)

    @property
    def busy(self) -> bool:
        """True while a process works."""
        return any(worker.busy for worker in self._workers)

    def give(self, thing: Any, *, fresh: bool = False) -> None:
        """Has a process that is free work on a thing; fresh: a new process. Raises OSError when none can be started."""
        idle = [worker for worker in self._workers if not worker.busy]
        if fresh:
            for worker in idle:
                self._end(worker)
            idle = []
        while True:
            worker = idle.pop() if idle else self._start()
            worker.busy, worker.thing = True, thing
            try:
                _send(worker.tasks, thing)
                return
            except BrokenPipeError:
                if worker.fresh:
                    return  # it ended while it took the thing: finished() says so
                self._end(worker)  # killed while it had nothing to do

    def wait_for_finished(self) -> list[tuple[Any, Any]]:
        """Waits until at least one thing is done: (thing, result or Died) of all that are. What a task raises is raised
        here."""
        done = []
        for key, _ in self._wait() if self.busy else ():
            worker: _Worker = key.data
            answer = _receive(worker.results)
            thing = worker.thing
            if answer is None:
                was_busy = worker.busy
                died = self._bury(worker)
                if was_busy:
                    done.append((thing, died))
                continue
            worker.busy, worker.fresh, worker.thing = False, False, None
            good, result = pickle.loads(answer)
            if not good:
                raise result
            done.append((thing, result))
        return done

    def _wait(self) -> list[tuple[selectors.SelectorKey, int]]:
        """What the selector says once a process has an answer; until then, the steps of run_meanwhile() are taken."""
        ready = self._selector.select(0)
        while not ready and _take_step():
            ready = self._selector.select(0)
        return ready or self._selector.select()

    def _start(self) -> _Worker:
        with contextlib.ExitStack() as opened:
            pipes = []
            for _ in range(2):
                pipe = os.pipe()
                pipes.extend(pipe)
                for end in pipe:
                    opened.callback(os.close, end)
            task_out, task_in, result_out, result_in = pipes
            shared = mmap.mmap(-1, _PLACE.size)
            shared[:] = _PLACE.pack(_NOWHERE)
            parent = os.getpid()
            child = os.fork()
            if child == 0:
                for end in (task_in, result_out, *(end for one in self._workers for end in (one.tasks, one.results))):
                    os.close(end)
                _serve(self._task, self._what, task_out, result_in, shared, parent)
            opened.pop_all()
            os.close(task_out)
            os.close(result_in)
        worker = _Worker(child, task_in, result_out, shared)
        self._workers.append(worker)
        self._selector.register(result_out, selectors.EVENT_READ, worker)
        return worker

    def _bury(self, worker: _Worker) -> Died:
        """Removes a process that ended by itself. Returns what it died of."""
        (part,) = _PLACE.unpack(worker.shared[:])
        fresh = worker.fresh
        status = self._end(worker, kill=False)
        ended_by = os.WTERMSIG(status) if os.WIFSIGNALED(status) else 0
        if ended_by == signal.SIGPROF:
            return Died("needed too much time", part, fresh, timed=True)
        if os.WIFEXITED(status) and os.WEXITSTATUS(status) == _OUT_OF_MEMORY:
            return Died(f"needed more than {format_size(get_limits().memory)} of memory", part, fresh)
        return Died("crashed", part, fresh)

    def _end(self, worker: _Worker, kill: bool = True) -> int:
        self._workers.remove(worker)
        self._selector.unregister(worker.results)
        if kill:
            with contextlib.suppress(ProcessLookupError):
                os.kill(worker.process, signal.SIGKILL)
        os.close(worker.tasks)
        os.close(worker.results)
        worker.shared.close()
        with contextlib.suppress(ChildProcessError):
            return os.waitpid(worker.process, 0)[1]
        return 0


class _Worker:
    def __init__(self, process: int, tasks: int, results: int, shared: mmap.mmap):
        self.process, self.tasks, self.results, self.shared = process, tasks, results, shared
        self.busy, self.fresh = False, True
        self.thing: Any = None


@contextlib.contextmanager
def run_meanwhile(steps: Iterable[object]) -> Iterator[None]:
    """Within it, this process takes the steps one at a time while it has to wait for others, as long as there are any.

    steps: done in iterating over them. They only prepare what comes later: not all of them may be reached, and where
    one fails, what needs it fails again. One should be done in some milliseconds, since no process gets anything to do
    before its end.
    """
    _MEANWHILE.append(iter(steps))
    try:
        yield
    finally:
        _MEANWHILE.pop()


def _take_step() -> bool:
    """Takes a step of run_meanwhile(), of the innermost that has one; False when none has."""
    for steps in reversed(_MEANWHILE):
        with contextlib.suppress(Exception):
            if next(steps, _END) is not _END:
                return True
    return False


_MEANWHILE: list[Iterator[object]] = []
_END = object()


def begin_part(part: int, size: int) -> None:
    """Called by a task before each part of its work: the part's number is known when the process dies in it, and the
    processor time that a part of so many bytes may take is measured from here."""
    if _SHARED:
        _SHARED[0][:] = _PLACE.pack(part)
        signal.setitimer(signal.ITIMER_PROF, compute_seconds(size))


def allow_memory(size: int) -> None:
    """Lets a task need so many bytes more than a process of its own may."""
    if _SHARED:
        import resource

        now, most = resource.getrlimit(resource.RLIMIT_AS)
        if now >= 0:
            with contextlib.suppress(OSError, ValueError):
                resource.setrlimit(resource.RLIMIT_AS, (now + size if most < 0 else min(now + size, most), most))


def reset_memory() -> None:
    """Lets a task need as much memory beyond what its process has by now as the first one may, whatever those before it
    have left. A process that has grown by as much already gives it to a new one, by a MemoryError."""
    if _SHARED:
        allowed = get_limits().memory
        if _measure_memory() > _BEGUN[0] + allowed:
            raise MemoryError
        _allow_further(allowed)


def compute_seconds(size: int) -> float:
    """Seconds of processor time that extracting from so many bytes may take."""
    budget = get_limits()
    return budget.seconds * (1 + size / (1 << 20))


_SHARED: list[mmap.mmap] = []
# Bytes of addresses that this process began with.
_BEGUN = [0]


def run_forked(
    task: Callable[..., _Result], things: Iterable[Any], jobs: int, *what: Any
) -> Iterator[tuple[Any, _Result | Died]]:
    """(thing, task(*what, thing)) for each of the things as they come to an end, in forked processes; Died for those
    that end their process, even when tried once more in a new one. what: anything, inherited by the processes and
    never copied to them.

    What a task raises is raised here.
    """
    waiting = deque(things)
    again: list[Any] = []
    with Workers(task, min(jobs, max(1, len(waiting))), *what) as workers:
        while True:
            while waiting and workers.free:
                workers.give(waiting.popleft())
            if not workers.busy:
                if not again:
                    return
                workers.give(again.pop(), fresh=True)
            for thing, result in workers.wait_for_finished():
                if isinstance(result, Died) and not (result.fresh or result.timed):
                    again.append(thing)
                else:
                    yield thing, result


def run_forked_rows(
    task: Callable[..., Sequence[Any]], chunks: Sequence[Sequence[Any]], jobs: int, *what: Any
) -> Iterator[tuple[Sequence[Any], Sequence[Any]]]:
    """(chunk, task(*what, chunk)) for each of the chunks as they come to an end, in forked processes where that is
    safe. The task gives one row for each item of a chunk. Where it ends its process, the items are tried one by one,
    and None is the row of those that end it again. Chunks and what else is given are inherited, never copied."""
    if not may_fork():
        yield from ((chunk, task(*what, chunk)) for chunk in chunks)
        return
    for number, rows in run_forked(_run_chunk, range(len(chunks)), jobs, task, chunks, what):
        chunk = chunks[number]
        if isinstance(rows, Died):
            alone = [[item] for item in chunk]
            found = dict(run_forked(_run_chunk, range(len(alone)), 1, task, alone, what))
            rows = [None if isinstance(row := found[at], Died) else row[0] for at in range(len(alone))]
        yield chunk, rows


def _run_chunk(task: Callable[..., Any], chunks: Sequence[Any], what: Sequence[Any], number: int) -> Any:
    return task(*what, chunks[number])


def _serve(
    task: Callable[..., Any], what: Sequence[Any], tasks: int, results: int, shared: mmap.mmap, parent: int
) -> None:
    """The life of a worker; never returns."""
    try:
        gc.freeze()
        _SHARED[:] = [shared]
        _MEANWHILE.clear()
        # Ctrl-C goes to every process of the terminal; the parent alone decides what it means.
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        signal.signal(signal.SIGPROF, signal.SIG_DFL)
        threading.Thread(target=_die_with, args=(parent,), daemon=True).start()
        _be_silent()
        _BEGUN[0] = _measure_memory()
        _limit_memory()
        while (packed := _receive(tasks)) is not None:
            try:
                answer = pickle.dumps((True, task(*what, pickle.loads(packed))))
            except MemoryError:
                os._exit(_OUT_OF_MEMORY)
            except BaseException as error:
                answer = _pickle_error(error)
            signal.setitimer(signal.ITIMER_PROF, 0)
            shared[:] = _PLACE.pack(_NOWHERE)
            write_all(results, _LENGTH.pack(len(answer)))
            write_all(results, answer)
        os._exit(0)
    except MemoryError:
        os._exit(_OUT_OF_MEMORY)
    except BaseException:
        os._exit(1)


def _pickle_error(error: BaseException) -> bytes:
    try:
        packed = pickle.dumps((False, error))
        pickle.loads(packed)
        return packed
    except Exception:  # an exception that cannot be copied, or not be made anew
        return pickle.dumps((False, RuntimeError(f"{type(error).__name__}: {error}")))


def _be_silent() -> None:
    """What a library says when it gives up is of no use to anybody."""
    if os.environ.get(DEBUG):
        return
    if "faulthandler" in sys.modules:
        sys.modules["faulthandler"].disable()
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 2)
    os.close(nowhere)


def _limit_memory() -> None:
    import resource

    _allow_further(get_limits().memory)
    with contextlib.suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


@contextlib.contextmanager
def limit_memory(size: int) -> Iterator[None]:
    """Lets this process need so many bytes more than it has, where the system can tell; a MemoryError, or what a
    library makes of it, comes of more."""
    import resource

    before = resource.getrlimit(resource.RLIMIT_AS)
    if before[0] < 0:
        _allow_further(size)
    try:
        yield
    finally:
        with contextlib.suppress(OSError, ValueError):
            resource.setrlimit(resource.RLIMIT_AS, before)


def _measure_memory() -> int:
    """Bytes of addresses that this process has; 0 where the system does not tell."""
    try:
        with open("/proc/self/statm", "rb") as file:
            return int(file.read(200).split()[0]) * os.sysconf("SC_PAGESIZE")
    except (OSError, ValueError):
        return 0


def _allow_further(size: int) -> None:
    import resource

    has = _measure_memory()
    if not has:
        return
    _, most = resource.getrlimit(resource.RLIMIT_AS)
    wanted = has + size
    with contextlib.suppress(OSError, ValueError):
        resource.setrlimit(resource.RLIMIT_AS, (wanted if most < 0 else min(wanted, most), most))


def _send(descriptor: int, thing: Any) -> None:
    packed = pickle.dumps(thing)
    write_all(descriptor, _LENGTH.pack(len(packed)))
    write_all(descriptor, packed)


def _receive(descriptor: int) -> bytes | bytearray | None:
    """One message; None when the other side ended."""
    head = _read_exactly(descriptor, _LENGTH.size)
    return None if head is None else _read_exactly(descriptor, _LENGTH.unpack(head)[0])


def _read_exactly(descriptor: int, size: int) -> bytes | bytearray | None:
    data = bytearray(size)
    view = memoryview(data)
    have = 0
    while have < size:
        count = os.readv(descriptor, [view[have:]])
        if not count:
            return None
        have += count
    return data


def _die_with(parent: int) -> None:
    # A parent that is killed cannot tell its workers, and they would wait for work for ever.
    while os.getppid() == parent:
        time.sleep(0.5)
    os._exit(1)
