"""Where the program starts: as little as possible before interrupts and failures of the start itself are answered."""

import gc
import os
import sys

from ...edges import interrupts


def main() -> None:
    """Runs the command line and ends the process with its status: a line and 130 after Ctrl-C at any moment, a line and
    2 where not even the command line can be loaded."""
    interrupts.install()
    status = 2
    try:
        from ...edges.console import hold_streams

        hold_streams()
        from .app import main as command_line

        command_line()
        status = 0
    except SystemExit as ended:
        status = ended.code if isinstance(ended.code, int) else 2 * bool(ended.code)
        if isinstance(ended.code, str):
            _say(ended.code)
    except KeyboardInterrupt:
        interrupts.exit_now()
    except BrokenPipeError:
        status = 0
    except Exception as error:
        if os.environ.get("ROSIMPACT_DEBUG"):
            raise
        _say(_describe_error(error))
    interrupts.finish(status)
    _flush()
    if interrupts.was_interrupted() or status == 2:
        # What other processes and threads still do is of no use by now, and where files or processes ran out they may
        # never end.
        interrupts.exit_now()
    gc.freeze()  # an interpreter that ends collects several times, and all of it ends anyway
    raise SystemExit(status)


def _describe_error(error: Exception) -> str:
    try:
        from ...edges.console import describe

        return describe(error, "rosimpact")
    except Exception:
        return f"{type(error).__name__}: {error}"


def _say(text: str) -> None:
    try:
        from ...edges.console import say

        say(f"rosimpact: {text}")
    except Exception:
        os.write(2, f"rosimpact: {text}\n".encode("utf-8", "backslashreplace"))


def _flush() -> None:
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except (AttributeError, OSError, ValueError):
            continue
