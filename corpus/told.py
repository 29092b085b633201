"""told: a command ends in an exit status and, where it fails, in one line and no traceback; how it speaks to people."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Callable

from .report import CorpusError

DEBUG = "ROSIMPACT_DEBUG"
"""Set by people who work on rosimpact itself: an unforeseen error then comes with its traceback."""


def told(work: Callable[[], int], interrupted: str = "interrupted", about: str = "the corpus") -> int:
    """Runs a command's work and returns its exit status.

    A failure is one line on standard error and the status 2. interrupted: what Ctrl-C leaves, as a clause; its status
    is 130. about: what an error of the system without a file of its own is about.
    """
    try:
        return work()
    except CorpusError as error:
        return _failed(str(error))
    except KeyboardInterrupt:
        say(f"rosimpact: {interrupted}")
        return 130
    except BrokenPipeError:
        raise
    except OSError as error:
        place = os.fsdecode(error.filename) if isinstance(error.filename, str | bytes) else about
        return _failed(f"{place}: {error.strerror or error}; check that it can be read and written")
    except Exception as error:
        if os.environ.get(DEBUG):
            raise
        return _failed(unforeseen(error))


def say(text: str) -> None:
    """A line for people, on standard error, whatever signs it can show."""
    print(text.encode("utf-8", "backslashreplace").decode("utf-8"), file=sys.stderr)


def steps() -> Callable[[str, int, int], None]:
    """Tells how far long work is, given what is done, how often it was and how often in all (0: nobody knows): in a
    line of standard error that is rewritten on a terminal, in one line for each thing done elsewhere."""
    last = ""

    def show(what: str, done: int, total: int) -> None:
        nonlocal last
        if sys.stderr.isatty():
            count = f" {done}/{total}" if total else ""
            sys.stderr.write(f"\r\x1b[K{what}{count}" + ("\n" if 0 < total <= done else ""))
            sys.stderr.flush()
        elif what != last:
            say(what)
        last = what

    return show


def counted(number: int, noun: str) -> str:
    """`1 error`, `2 errors`, `2 dependencies`."""
    if number == 1:
        return f"1 {noun}"
    plural = noun[:-1] + "ies" if noun.endswith("y") and noun[-2:-1] not in "aeiou" else noun + "s"
    return f"{number:,} {plural}"


def any_sign() -> None:
    """Lets standard output show what its encoding cannot say as `?`, so that no text of a report ends a command."""
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")


def unforeseen(error: BaseException) -> str:
    """An error that nobody foresaw as a clause: its kind, where it was raised, its text, and what to do."""
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    place = f" in {os.path.basename(trace.tb_frame.f_code.co_filename)}:{trace.tb_lineno}" if trace is not None else ""
    text = " ".join(str(error).split())[:200]
    return f"{type(error).__name__}{place}{': ' + text if text else ''}; this is a fault of rosimpact, please report it"


def _failed(message: str) -> int:
    say(f"rosimpact: {message}")
    return 2
