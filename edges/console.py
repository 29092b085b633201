"""How rosimpact speaks: text made fit to be shown anywhere, both output streams, errors in one line, exit statuses.

What comes from a workspace (names, paths, lines of code, values of settings) must not speak for us: not to a terminal
(escape sequences, direction marks), not to the CI system that reads our output (`::error::` at the beginning of a line,
`##[...]` anywhere), not to the reader (a second line that looks like ours). visible() shows such characters escaped,
escape_json() writes them as JSON does. Everything that is printed passes through write(), write_json(), write_exactly()
or say(); the first and the last look once more.
"""

from __future__ import annotations

import codecs
import contextlib
import errno
import json
import os
import re
import sys
from collections.abc import Callable
from typing import Any, TextIO

from .interrupts import run_interruptible
from .limits import LimitError, get_limits

DEBUG = "ROSIMPACT_DEBUG"
"""Set by people who work on rosimpact itself: an unforeseen error then comes with its traceback."""

_HIDDEN = (
    "\x7f-\x9f\xad\u034f\u061c\u115f\u1160\u17b4\u17b5\u180b-\u180f\u200b-\u200f\u2028-\u202e\u2060-\u206f\u3164"
    "\ud800-\udfff\ufeff\uffa0\ufff9-\ufffb\ufffe\uffff\U000e0000-\U000e01ef"
)
"""Control, direction and invisible characters above ASCII, bytes that are no UTF-8, and what XML cannot hold."""
# What CI systems take for a command: the runners of GitHub and Azure look for `##[`, `##vso[` and the like anywhere in
# a line, TeamCity for `##teamcity[`.
_FOR_CI = "#(?=#[A-Za-z]{0,20}\\[)"
_UNSAFE = re.compile(f"[\x00-\x1f{_HIDDEN}]|{_FOR_CI}")
_UNSAFE_IN_BLOCK = re.compile(f"[\x00-\x08\x0b-\x1f{_HIDDEN}]|{_FOR_CI}")
_UNSAFE_IN_PAGE = re.compile(f"[\x00-\x08\x0b-\x1f{_HIDDEN}]")
_UNSAFE_IN_JSON = re.compile(f"[{_HIDDEN}]|{_FOR_CI}")
_NOT_UTF8 = re.compile("[\ud800-\udfff]")
_SHORT = {"\n": "\\n", "\r": "\\r", "\t": "\\t"}
# GitHub's runner strips white space before it looks for `::`.
_COMMAND = re.compile(r"(?m)^([^\S\n]*):(?=:)")
_OBEYED = re.compile(
    "(?m)[\x00-\x08\x0b\x0e-\x1f\x7f-\x9f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]|\r(?!\n)"
    "|##[A-Za-z]{0,20}\\[|^[^\\S\n]*::"
)
# In our own output colours are the only escape sequences.
_COLOUR = re.compile(r"\x1b\[(?:0|2|1|1;3[0-7]|3[0-7])m")


def escape(text: str) -> str:
    """Text on one line in which nothing is hidden: control characters, line ends, direction marks and bytes that are no
    UTF-8 are shown as `\\x1b`, `\\n`, `\\u202e`, `\\xff`; so is the first `#` of what CI systems take for a command."""
    if text.isascii() and text.isprintable() and "##" not in text:
        return text
    return _UNSAFE.sub(_escape_character, text)


def escape_lines(text: str) -> str:
    """The same for text of several lines: line feeds and tabs stay."""
    return _UNSAFE_IN_BLOCK.sub(_escape_character, text)


def escape_page(text: str) -> str:
    """The same for HTML and XML, which have their own way to write what CI systems take for a command."""
    return _UNSAFE_IN_PAGE.sub(_escape_character, text)


def cut_visibly(text: str, *offsets: int) -> list[str]:
    """escape_lines() of a text, cut where these ascending offsets of the text itself have come to lie."""
    pieces: list[str] = [""]
    cuts, last = list(offsets), 0
    for match in _UNSAFE_IN_BLOCK.finditer(text):
        while cuts and cuts[0] <= match.start():
            pieces[-1] += text[last : cuts[0]]
            pieces.append("")
            last = max(last, cuts.pop(0))
        pieces[-1] += text[last : match.start()] + _escape_character(match)
        last = match.end()
    for cut in cuts:
        pieces[-1] += text[last:cut]
        pieces.append("")
        last = max(last, cut)
    pieces[-1] += text[last:]
    return pieces


def _escape_character(match: re.Match[str]) -> str:
    character = match[0]
    code = ord(character)
    if character in _SHORT:
        return _SHORT[character]
    if 0xDC80 <= code <= 0xDCFF:
        return f"\\x{code - 0xDC00:02x}"
    if code <= 0xFF:
        return f"\\x{code:02x}"
    return f"\\u{code:04x}" if code <= 0xFFFF else f"\\U{code:08x}"


def format_json(value: Any, indent: int | None = 1) -> str:
    """A value as JSON text that can be shown anywhere, see escape_json(). indent: None for all on one line."""
    separators = (",", ":") if indent is None else None
    return escape_json(json.dumps(value, ensure_ascii=False, indent=indent, separators=separators))


def escape_json(text: str) -> str:
    """JSON text that says the same and hides nothing: what visible() would escape is written as `\\u202e`.

    Bytes of names that are no UTF-8 are lone surrogates, such as `\\udcff` for 0xff, which Python's json reads back as
    os.fsdecode() gives them.
    """
    if text.isascii() and "##" not in text and "\x7f" not in text:
        return text
    return _UNSAFE_IN_JSON.sub(lambda match: _escape_for_json(match[0]), text)


def escape_bytes_in_json(text: str) -> str:
    """JSON text in which bytes that are no UTF-8 are shown as visible() does: many readers refuse lone surrogates."""
    return text if text.isascii() else _NOT_UTF8.sub(lambda match: "\\" + _escape_character(match), text)


def _escape_for_json(text: str) -> str:
    return "".join(
        f"\\u{code:04x}" if code <= 0xFFFF else f"\\u{0xD7C0 + (code >> 10):04x}\\u{0xDC00 + (code & 0x3FF):04x}"
        for code in map(ord, text)
    )


def _replace_unencodable(error: UnicodeError) -> tuple[str, int]:
    if not isinstance(error, UnicodeEncodeError):
        raise error
    return _escape_for_json(error.object[error.start : error.end]), error.end


codecs.register_error("rosimpact.json", _replace_unencodable)


def is_obeyed(text: str) -> bool:
    """Whether a terminal or CI would obey something in a document that has to be printed as it is, such as a patch."""
    return _OBEYED.search(text) is not None


def escape_commands(text: str) -> str:
    """Text of which no line begins with `::`, which GitHub's runner obeys."""
    return _COMMAND.sub(r"\1\\x3a", text) if "::" in text else text


def _finish_text(text: str) -> str:
    """A text for people as it may be printed: of all escape sequences colours alone are left."""
    if "\x1b" in text:
        parts = _COLOUR.split(text)
        colours = [*_COLOUR.findall(text), ""]
        text = "".join(escape_lines(part) + colour for part, colour in zip(parts, colours, strict=True))
    else:
        text = escape_lines(text)
    return escape_commands(text)


def write(text: str, stream: TextIO | None = None) -> None:
    """Prints a text for people on standard output, ended by a line end; what the stream's encoding cannot say is
    escaped. Raises UserError where it cannot be written, BrokenPipeError when nobody reads any longer."""
    _put(_finish_text(text), stream or sys.stdout, "backslashreplace")


def write_json(text: str) -> None:
    """Prints JSON on standard output, in ASCII with JSON's own escapes where that is not UTF-8. Raises as write()
    does."""
    encoding = getattr(sys.stdout, "encoding", None) or "utf-8"
    if codecs.lookup(encoding).name != "utf-8" and not text.isascii():
        text = text.encode("ascii", "rosimpact.json").decode("ascii")
    _put(text, sys.stdout, "backslashreplace")


def write_exactly(text: str) -> None:
    """Prints a document for programs (HTML, SVG, GraphML, a patch, workflow commands), whose maker has escaped what it
    holds, in UTF-8 whatever the stream's encoding is: that is what such documents say of themselves. Raises as write()
    does."""
    try:
        data = _end_line(text).encode("utf-8", "surrogateescape")
    except UnicodeEncodeError:
        data = _end_line(text).encode("utf-8", "backslashreplace")
    stream = sys.stdout
    with _convert_failures(stream):
        buffer = getattr(stream, "buffer", None)
        if buffer is None:
            stream.write(_end_line(text))
        else:
            stream.flush()
            buffer.write(data)
        stream.flush()


def _put(text: str, stream: TextIO | None, errors: str) -> None:
    """Writes a text in the encoding of a stream. errors: how to encode what that cannot say."""
    with _convert_failures(stream):
        assert stream is not None
        encoding = getattr(stream, "encoding", None) or "utf-8"
        # The stream encodes, since it alone knows whether a byte-order mark was written yet.
        stream.write(_end_line(text).encode(encoding, errors).decode(encoding))
        stream.flush()


def _end_line(text: str) -> str:
    return text + "\n" if text and not text.endswith("\n") else text


@contextlib.contextmanager
def _convert_failures(stream: TextIO | None):
    """What a stream that cannot be written raises as UserError; it is let alone from then on, so that Python does not
    complain of it once more at its end."""
    if stream is None:
        raise UserError(_describe_unwritable(None))
    try:
        yield
    except (OSError, ValueError) as error:
        _silence(stream)
        if isinstance(error, BrokenPipeError):
            raise
        raise UserError(_describe_unwritable(error)) from None


def _describe_unwritable(error: OSError | ValueError | None) -> str:
    closed = error is None or (isinstance(error, OSError) and error.errno == errno.EBADF)
    reason = "it is closed" if closed else getattr(error, "strerror", None) or error
    return f"standard output cannot be written: {reason}; check where it goes, or name a file with --output"


def _silence(stream: TextIO) -> None:
    """Lets a stream end in nothing."""
    with contextlib.suppress(OSError, ValueError):
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, stream.fileno())
        os.close(null)


def report_output_failure(error: OSError) -> int:
    """Says that standard output cannot be written and gives the exit status; nothing more is written there."""
    _silence(sys.stdout)
    return _report_failure(_describe_unwritable(error))


def hold_streams() -> None:
    """Keeps the places of standard streams that are closed, so that no file that is opened gets its place and with it
    what is printed; a closed standard output fails at the first text."""
    for place, way in enumerate((os.O_RDONLY, os.O_RDONLY, os.O_WRONLY)):
        try:
            os.fstat(place)
        except OSError:
            os.open(os.devnull, way)
    if sys.stdout is None:
        sys.stdout = os.fdopen(1, "w", encoding="utf-8", closefd=False)


def say(text: str) -> None:
    """A line for people, on standard error, whatever signs it can show. A stream that is closed or full is let alone:
    there is nobody to tell."""
    with contextlib.suppress(UserError, BrokenPipeError):
        _put(escape_commands(escape(text)), sys.stderr, "backslashreplace")


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

    def run_contained() -> int:
        try:
            get_limits()
            return work()
        except BrokenPipeError:
            raise
        except Exception as error:
            if os.environ.get(DEBUG) and not isinstance(error, (UserError, LimitError, OSError)):
                raise
            message = describe(error, about)
        # Outside the handler, where what the work held is free again.
        return (fail or _report_failure)(message)

    return run_interruptible(run_contained, lambda: say(f"rosimpact: {interrupted}"))


def describe(error: Exception, about: object = "") -> str:
    """Why something failed and what to do, as a clause. about: what an error without a file of its own is about."""
    if isinstance(error, (UserError, LimitError)):
        return str(error)
    if isinstance(error, OSError) and not _describe_shortage(error):
        place = error.filename if isinstance(error.filename, str | bytes) else str(about)
        reason = f"{escape(os.fsdecode(place))}: {error.strerror or error}".removeprefix(": ")
        if error.errno in (errno.ENOSPC, errno.EDQUOT):
            return f"{reason}; make room there"
        return f"{reason}; check that it can be read and written"
    return describe_unforeseen(error)


def _describe_shortage(error: BaseException) -> str:
    """What the process ran out of, and what to do, as a clause; empty for other errors."""
    number = error.errno if isinstance(error, OSError) else 0
    if number in (errno.EMFILE, errno.ENFILE):
        return "too many open files; allow more with `ulimit -n 4096`, or use fewer processes with --jobs"
    # What the dynamic loader says when a module is imported.
    unloaded = isinstance(error, ImportError) and ("failed to map" in str(error) or "allocate" in str(error))
    # What Python itself says where it could not make the exception.
    unmade = isinstance(error, SystemError) and "without exception set" in str(error)
    # What the solver says, which is not imported here.
    unsolved = type(error).__name__ == "Z3Exception" and "out of memory" in str(error)
    if isinstance(error, MemoryError) or unloaded or unmade or unsolved or number == errno.ENOMEM:
        return "not enough memory; give it more, or use fewer processes with --jobs 1"
    if number == errno.EAGAIN or (isinstance(error, RuntimeError) and "start new thread" in str(error)):
        return "the system allows no more processes or threads; use fewer with --jobs 1, or allow more with `ulimit -u`"
    if isinstance(error, RecursionError):
        return f"something is nested too deeply to be read{_find_place(error)}; leave it out, or nest it less"
    if any(kind.__name__ == "BrokenExecutor" for kind in type(error).__mro__):
        return "a process that worked for this one died; give it more memory, or use fewer with --jobs 1"
    return ""


def make_step_reporter() -> Callable[[str, int, int], None]:
    """Tells how far long work is, given what is done, how often it was and how often in all (0: nobody knows): in a
    line of standard error that is rewritten on a terminal, in one line for each thing done elsewhere."""
    last = ""

    def show(what: str, done: int, total: int) -> None:
        nonlocal last
        if sys.stderr is not None and sys.stderr.isatty():
            count = f" {done}/{total}" if total else ""
            rewrite(f"{what}{count}", ended=0 < total <= done)
        elif what != last:
            say(what)
        last = what

    return show


def rewrite(text: str, *, ended: bool) -> None:
    """Writes the line of standard error anew that says how far the work is. ended: the next text goes below it."""
    with contextlib.suppress(OSError, ValueError):
        encoding = sys.stderr.encoding or "utf-8"
        line = escape(text).encode(encoding, "backslashreplace").decode(encoding)
        sys.stderr.write(f"\r\x1b[K{line}" + ("\n" if ended else ""))
        sys.stderr.flush()


def format_count(number: int, noun: str) -> str:
    """`1 error`, `2 errors`, `2 dependencies`."""
    if number == 1:
        return f"1 {noun}"
    plural = noun[:-1] + "ies" if noun.endswith("y") and noun[-2:-1] not in "aeiou" else noun + "s"
    return f"{number:,} {plural}"


def describe_unforeseen(error: BaseException) -> str:
    """An error that nobody foresaw as a clause: its kind, where it was raised, its text, and what to do. Running out of
    memory, open files or the like is no fault of rosimpact, and is said as it is."""
    if shortage := _describe_shortage(error):
        return shortage
    text = escape(" ".join(str(error).split())[:200])
    what = f"{type(error).__name__}{_find_place(error)}{': ' + text if text else ''}"
    return f"{what}; this is a fault of rosimpact, please report it"


def _find_place(error: BaseException) -> str:
    trace = error.__traceback__
    while trace is not None and trace.tb_next is not None:
        trace = trace.tb_next
    return f" in {os.path.basename(trace.tb_frame.f_code.co_filename)}:{trace.tb_lineno}" if trace is not None else ""


def _report_failure(message: str) -> int:
    say(f"rosimpact: {message}")
    return 2
