"""Ctrl-C and the request to end, from the first moment of the program to its last.

Python raises KeyboardInterrupt wherever it is: while modules are imported, inside callbacks that swallow it, in the
handlers that run at the end. Each of these prints a traceback. So the signal is raised only while a command works, and
once; at any other moment the program ends at once, with one line and the status of an interrupt.
"""

from __future__ import annotations

import atexit
import os
import signal
import sys
import time

TYPE_CHECKING = False
if TYPE_CHECKING:
    from collections.abc import Callable
    from types import FrameType
    from typing import NoReturn

STATUS = 130
_FAILED = 2
_SIGNALS = (signal.SIGINT, signal.SIGTERM)
# `timeout` sends a signal to its child and then to the whole group.
_SAME_SECONDS = 0.5


class _State:
    """raising: a command works, which ends in order. explained: the line is printed. ended: the status that the program
    ends with, once it is known. since: when the first signal came. process: the one that all this is about."""

    raising = False
    explained = False
    ended: int | None = None
    since = 0.0
    process = 0


def install() -> None:
    """Takes over both signals for this process, unless it was started with them ignored (nohup, `&` in a script)."""
    _State.process = os.getpid()
    for number in _SIGNALS:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, _handle)
    sys.unraisablehook = _filter_unraisable
    # What is registered first runs last.
    atexit.register(_ignore)


def _ignore() -> None:
    """From here on Python puts the system's own handlers back, by which a signal would end a program whose report is
    written as one that was killed."""
    if os.getpid() == _State.process:
        for number in _SIGNALS:
            signal.signal(number, signal.SIG_IGN)


def run_interruptible(work: Callable[[], int], explain: Callable[[], None]) -> int:
    """Runs work, in which a signal raises KeyboardInterrupt; gives its result, or STATUS when it was interrupted.

    explain: says so to the user.
    """
    try:
        try:
            _State.raising = True
            return work()
        finally:
            _State.raising = False
    except KeyboardInterrupt:
        _State.raising = False
        if not _State.explained:
            _State.explained = True
            explain()
        _State.ended = STATUS
        return STATUS


def finish(status: int) -> None:
    """Tells that all is done: a signal from now on ends the program with this status, and quietly. What failed after a
    signal failed by it: the signal may have ended a process or a callback that the command waited for."""
    if not (status == _FAILED and _State.since):
        _State.ended = status


def was_interrupted() -> bool:
    """Whether a signal came."""
    return bool(_State.since) or _State.ended == STATUS


def exit_now() -> NoReturn:
    """Ends the program without anything that runs at the end, with a line unless there was one."""
    if _State.ended is None and not _State.explained:
        _State.explained = True
        _write(b"rosimpact: interrupted\n")
    os._exit(STATUS if _State.ended is None else _State.ended)


def _write(line: bytes) -> None:
    # sys.stderr may be in the middle of a line of its own, or not be there yet.
    try:
        os.write(2, line)
    except OSError:
        return


def _handle(number: int, frame: FrameType | None) -> None:
    if os.getpid() != _State.process:
        os._exit(STATUS)  # a process that was forked a moment ago; the one that forked it decides
    now = time.monotonic()
    if _State.since and now - _State.since < _SAME_SECONDS and _State.ended is None:
        return
    first, _State.since = not _State.since, now
    if _State.raising and first:
        _State.raising = False
        raise KeyboardInterrupt
    exit_now()


def _filter_unraisable(error: sys.UnraisableHookArgs) -> None:
    """What is raised where nobody can catch it (destructors, callbacks): an interrupt ends the program there and then,
    anything else is of no use to the reader."""
    if os.getpid() == _State.process and issubclass(error.exc_type, KeyboardInterrupt):
        exit_now()
    if os.environ.get("ROSIMPACT_DEBUG"):
        sys.__unraisablehook__(error)
