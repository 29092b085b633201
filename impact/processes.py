"""Processes that work beside this one: forked, so that they know all that is known here and cost next to nothing.

On two cores, starting two forked workers takes 0.025 s, two loky workers 0.31 s and two workers of joblib's
multiprocessing backend 0.08 s and joblib's own import 0.12 s.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

if TYPE_CHECKING:
    from concurrent.futures import ProcessPoolExecutor

_Result = TypeVar("_Result")
_WHAT: list[Any] = []
"""What the tasks of forked() work on, in the processes that it forks."""


def cores() -> int:
    """How many processes may run at once on this machine."""
    if hasattr(os, "sched_getaffinity"):
        return max(1, len(os.sched_getaffinity(0)))
    return os.cpu_count() or 1


def may_fork() -> bool:
    """True where a fork is safe: macOS has fork, and libraries there that do not survive it."""
    return sys.platform == "linux"


def pool(jobs: int, *what: Any) -> ProcessPoolExecutor:
    """Forked workers, which end with this process and leave Ctrl-C to it. what: things that tasks find in _WHAT."""
    import multiprocessing
    from concurrent.futures import ProcessPoolExecutor

    context = multiprocessing.get_context("fork")
    return ProcessPoolExecutor(jobs, mp_context=context, initializer=_start, initargs=(os.getpid(), what))


def forked(
    task: Callable[..., _Result], things: Sequence[Any], jobs: int, *what: Any
) -> Iterator[tuple[Any, _Result | None]]:
    """(thing, task(*what, thing)) for each of the things as they come to an end, in forked processes; None for those
    whose process died. what: anything, inherited by the processes and never copied to them.

    What a task raises is raised here.
    """
    from concurrent.futures import as_completed
    from concurrent.futures.process import BrokenProcessPool

    workers = pool(min(jobs, len(things)), *what)
    ended = False
    try:
        running = {workers.submit(_run, task, thing): thing for thing in things}
        for future in as_completed(running):
            try:
                result = future.result()
            except BrokenProcessPool:
                result = None
            yield running[future], result
        ended = True
    finally:
        workers.shutdown(wait=ended, cancel_futures=True)


def _run(task: Callable[..., _Result], thing: Any) -> _Result:
    return task(*_WHAT, thing)


def _start(parent: int, what: tuple[Any, ...]) -> None:
    import signal
    import threading

    _WHAT[:] = what
    # Ctrl-C goes to every process of the terminal; the parent alone decides what it means.
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    threading.Thread(target=_die_with, args=(parent,), daemon=True).start()


def _die_with(parent: int) -> None:
    # A parent that is killed cannot tell its workers, and they would wait for work for ever.
    while os.getppid() == parent:
        time.sleep(0.5)
    os._exit(1)
