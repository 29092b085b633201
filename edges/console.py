"""How rosimpact speaks: text made fit to be shown anywhere, both output streams, errors in one line, exit statuses.

What comes from a workspace (names, paths, lines of code, values of settings) must not speak for us: not to a terminal
(escape sequences, direction marks), not to the CI system that reads our output (`::error::` at the beginning of a line,
`##[...]` anywhere), not to the reader (a second line that looks like ours). visible() shows such characters escaped.
Everything that is printed passes through write() or say(), which look once more.
"""

from __future__ import annotations

import errno
import io
import os
import re
import sys
from collections.abc import Callable
from typing import TextIO

from .limits import LimitError, limits

DEBUG = "ROSIMPACT_DEBUG"
"""Set by people who work on rosimpact itself: an unforeseen error then comes with its traceback."""

_MARKS = "\u061c\u200b-\u200f\u2028-\u202e\u2060-\u206f\ufeff\ufff9-\ufffb\U000e0000-\U000e007f"
# Control, direction and invisible characters, bytes that are no UTF-8, and what CI systems take for a command: the
# runners of GitHub and Azure look for `##[`, `##vso[` and the like anywhere in a line, TeamCity for `##teamcity[`.
_UNSAFE = re.compile(f"[\x00-\x1f\x7f-\x9f\xad\ud800-\udfff{_MARKS}]|#(?=#[A-Za-z]{{0,20}}\\[)")
_UNSAFE_IN_BLOCK = re.compile(f"[\x00-\x08\x0b-\x1f\x7f-\x9f\xad\ud800-\udfff{_MARKS}]|#(?=#[A-Za-z]{{0,20}}\\[)")
_SHORT = {"\n": "\\n", "\r": "\\r", "\t": "\\t"}
# GitHub's runner strips white space before it looks for `::`.
_COMMAND = re.compile(r"(?m)^([^\S\n]*):(?=:)")
# In our own output colours are the only escape sequences.
_COLOUR = re.compile(r"\x1b\[[0-9;]{0,20}m")


def visible(text: str) -> str:
    """Text on one line in which nothing is hidden: control characters, line ends, direction marks and bytes that are no
    UTF-8 are shown as `\\x1b`, `\\n`, `\\u202e`, `\\xff`; so is the first `#` of what CI systems take for a command."""
    if text.isascii() and text.isprintable() and "##" not in text:
        return text
    return _UNSAFE.sub(_escaped, text)


def visible_lines(text: str) -> str:
    """The same for text of several lines: line feeds and tabs stay."""
    return _UNSAFE_IN_BLOCK.sub(_escaped, text)


def _escaped(match: re.Match[str]) -> str:
    character = match[0]
    code = ord(character)
    if character in _SHORT:
        return _SHORT[character]
    if 0xDC80 <= code <= 0xDCFF:
        return f"\\x{code - 0xDC00:02x}"
    if code <= 0xFF:
        return f"\\x{code:02x}"
    return f"\\u{code:04x}" if code <= 0xFFFF else f"\\U{code:08x}"


def without_commands(text: str) -> str:
    """Text of which no line begins with `::`, which GitHub's runner obeys, and in which nothing else is a command."""
    return _COMMAND.sub(r"\1\\x3a", text)


def _finished(text: str) -> str:
    """A text for people as it may be printed: of all escape sequences colours alone are left."""
    if "\x1b" in text:
        parts = _COLOUR.split(text)
        colours = [*_COLOUR.findall(text), ""]
        text = "".join(visible_lines(part) + colour for part, colour in zip(parts, colours, strict=True))
    else:
        text = visible_lines(text)
    return without_commands(text)


def write(text: str, stream: TextIO | None = None) -> None:
    """Prints a text for people on standard output, ended by a line end; what the stream's encoding cannot say is
    escaped. Raises OSError, BrokenPipeError when nobody reads any longer."""
    _put(_finished(text), stream or sys.stdout)


def write_exactly(text: str) -> None:
    """Prints a document for programs (JSON, SARIF, HTML, workflow commands), whose maker has escaped what it holds."""
    _put(text, sys.stdout)


def _put(text: str, stream: TextIO) -> None:
    if text and not text.endswith("\n"):
        text += "\n"
    buffer = getattr(stream, "buffer", None)
    if buffer is None:
        stream.write(text)
        stream.flush()
        return
    stream.flush()
    buffer.write(text.encode(getattr(stream, "encoding", None) or "utf-8", "backslashreplace"))
    stream.flush()


def say(text: str) -> None:
    """A line for people, on standard error, whatever signs it can show. A stream that is closed or full is let alone:
    there is nobody to tell."""
    if sys.stderr is None:
        return
    try:
        _put(_finished(text), sys.stderr)
    except (OSError, ValueError):
        return


class UserError(Exception):
    """What was asked for cannot be done; the text names the file or place and what to do."""


def run_command(
    work: Callable[[], int],
    interrupted: str = "interrupted",
    about: object = "the corpus",
    fail: Callable[[str], int] | None = None,
) -> int:
    """Runs a command's work and returns its exit status.

    A failure is one line on standard error and the status 2. interrupted: what Ctrl-C leaves, as a clause; its status
    is 130. about: what an error of the system without a file of its own is about. fail: says why the work failed, and
    returns the status, where that takes more than a line. Raises BrokenPipeError when nobody reads any longer.
    """
    try:
        try:
            limits()
            return work()
        except BrokenPipeError:
            raise
        except Exception as error:
            if os.environ.get(DEBUG) and not isinstance(error, (UserError, LimitError, OSError)):
                raise
            message = describe(error, about)
        # Outside the handler, where what the work held is free again.
        return (fail or _failed)(message)
    except KeyboardInterrupt:
        say(f"rosimpact: {interrupted}")
        return 130


def describe(error: Exception, about: object = "") -> str:
    """Why something failed and what to do, as a clause. about: what an error without a file of its own is about."""
    if isinstance(error, (UserError, LimitError)):
        return str(error)
    if isinstance(error, OSError) and not _shortage(error):
        place = error.filename if isinstance(error.filename, str | bytes) else str(about)
        reason = f"{visible(os.fsdecode(place))}: {error.strerror or error}".removeprefix(": ")
        if error.errno in (errno.ENOSPC, errno.EDQUOT):
            return f"{reason}; make room there"
        return f"{reason}; check that it can be read and written"
    return unforeseen(error)


def _shortage(error: BaseException) -> str:
    """What the process ran out of, and what to do, as a clause; empty for other errors."""
    number = error.errno if isinstance(error, OSError) else 0
    if number in (errno.EMFILE, errno.ENFILE):
        return "too many open files; allow more with `ulimit -n 4096`, or use fewer processes with --jobs"
    if isinstance(error, MemoryError) or number == errno.ENOMEM:
        return "not enough memory; give it more, or use fewer processes with --jobs 1"
    if number == errno.EAGAIN or (isinstance(error, RuntimeError) and "start new thread" in str(error)):
        return "the system allows no more processes or threads; use fewer with --jobs 1, or allow more with `ulimit -u`"
    if isinstance(error, RecursionError):
        return f"something is nested too deeply to be read{_place(error)}; leave it out, or nest it less"
    if any(kind.__name__ == "BrokenExecutor" for kind in type(error).__mro__):
        return "a process that worked for this one died; give it more memory, or use fewer with --jobs 1"
    return ""


def steps() -> Callable[[str, int, int], None]:
    """Tells how far long work is, given what is done, how often it was and how often in all (0: nobody knows): in a
    line of standard error that is rewritten on a terminal, in one line for each thing done elsewhere."""
    last = ""

    def show(what: str, done: int, total: int) -> None:
        nonlocal last
        if sys.stderr.isatty():
            count = f" {done}/{total}" if total else ""
            sys.stderr.write(f"\r\x1b[K{visible(what)}{count}" + ("\n" if 0 < total <= done else ""))
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
    """An error that nobody foresaw as a clause: its kind, where it was raised, its text, and what to do. Running out of
    memory, open files or the like is no fault of rosimpact, and is said as it is."""
    if shortage := _shortage(error):
        return shortage
    text = visible(" ".join(str(error).split())[:200])
    what = f"{type(error).__name__}{_place(error)}{': ' + text if text else ''}"
    return f"{what}; this is a fault of rosimpact, please report it"


def _place(error: BaseException) -> str:
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    return f" in {os.path.basename(trace.tb_frame.f_code.co_filename)}:{trace.tb_lineno}" if trace is not None else ""


def _failed(message: str) -> int:
    say(f"rosimpact: {message}")
    return 2
