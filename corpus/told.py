"""told: a command of the corpus ends in an exit status and, where it fails, in one line and no traceback."""

from __future__ import annotations

import io
import os
import sys
from collections.abc import Callable

from .report import CorpusError


def told(work: Callable[[], int], interrupted: str = "interrupted") -> int:
    """Runs a command's work and returns its exit status.

    A failure is one line on standard error and the status 2. interrupted: what Ctrl-C leaves, as a clause; its status
    is 130. With ROSIMPACT_DEBUG set, an unforeseen error keeps its traceback.
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
        place = os.fsdecode(error.filename) if isinstance(error.filename, str | bytes) else "the corpus"
        return _failed(f"{place}: {error.strerror or error}; check that it can be read and written")
    except Exception as error:
        if os.environ.get("ROSIMPACT_DEBUG"):
            raise
        return _failed(_unforeseen(error))


def say(text: str) -> None:
    """A line for people, on standard error, whatever signs it can show."""
    print(text.encode("utf-8", "backslashreplace").decode("utf-8"), file=sys.stderr)


def any_sign() -> None:
    """Lets standard output show what its encoding cannot say as `?`, so that no text of a report ends a command."""
    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")


def _failed(message: str) -> int:
    say(f"rosimpact: {message}")
    return 2


def _unforeseen(error: BaseException) -> str:
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    place = f" in {os.path.basename(trace.tb_frame.f_code.co_filename)}:{trace.tb_lineno}" if trace is not None else ""
    text = " ".join(str(error).split())[:200]
    return f"{type(error).__name__}{place}{': ' + text if text else ''}; this is a fault of rosimpact, please report it"
