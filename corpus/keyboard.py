"""Keys of a POSIX terminal, one at a time; signals come as keys too, so that no write is cut off in the middle."""

from __future__ import annotations

import codecs
import contextlib
import os
import select
import signal
import termios
import tty
from types import TracebackType
from typing import Any

QUIT = "<quit>"
"""Ctrl-C, Ctrl-D, SIGINT, SIGTERM, SIGHUP, or the terminal is gone."""
RESIZE = "<resize>"
PASTE = "<paste>"
"""Starts a key that holds pasted text."""

_NAMES = {
    "\r": "<enter>", "\n": "<enter>", "\x7f": "<backspace>", "\x08": "<backspace>", "\x15": "<clear>", "\t": "<tab>",
    "\x03": QUIT, "\x04": QUIT, "\x1b": "<escape>",
    "\x1b[A": "<up>", "\x1b[B": "<down>", "\x1b[C": "<right>", "\x1b[D": "<left>",
    "\x1bOA": "<up>", "\x1bOB": "<down>", "\x1bOC": "<right>", "\x1bOD": "<left>",
    "\x1bOH": "<home>", "\x1bOF": "<end>",
    "\x1b[H": "<home>", "\x1b[F": "<end>", "\x1b[1~": "<home>", "\x1b[4~": "<end>", "\x1b[7~": "<home>",
    "\x1b[8~": "<end>", "\x1b[5~": "<pageup>", "\x1b[6~": "<pagedown>",
}  # fmt: skip
_PASTE_ON, _PASTE_OFF = b"\x1b[?2004h", b"\x1b[?2004l"
_PASTE_START, _PASTE_END = "\x1b[200~", "\x1b[201~"
# How long the rest of an escape sequence may take; a person's next key takes longer.
_SEQUENCE_SECONDS = 0.05


class Keyboard:
    """The keys of a terminal; use as a context manager, in the main thread. Leaves the terminal as it was.

    input, output: file descriptors of the terminal.
    """

    def __init__(self, input: int, output: int) -> None:
        self._input, self._output = input, output
        self._decoder = codecs.getincrementaldecoder("utf-8")("replace")
        self._waiting = ""
        self._ended = False
        self._handlers: dict[int, Any] = {}

    def __enter__(self) -> Keyboard:
        self._before = termios.tcgetattr(self._input)
        self._signals, self._signalled = os.pipe()
        os.set_blocking(self._signalled, False)
        os.set_blocking(self._signals, False)
        self._old_wakeup = signal.set_wakeup_fd(self._signalled, warn_on_full_buffer=False)
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGWINCH):
            self._handlers[number] = signal.signal(number, _ignore_signal)
        tty.setcbreak(self._input)
        mode = termios.tcgetattr(self._input)
        mode[3] &= ~termios.ISIG
        mode[0] &= ~(termios.ICRNL | termios.IXON)
        termios.tcsetattr(self._input, termios.TCSANOW, mode)
        os.write(self._output, _PASTE_ON)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None):
        with contextlib.suppress(OSError, termios.error):  # the terminal may be gone
            os.write(self._output, _PASTE_OFF)
            termios.tcsetattr(self._input, termios.TCSADRAIN, self._before)
        signal.set_wakeup_fd(self._old_wakeup)
        for number, handler in self._handlers.items():
            signal.signal(number, handler)
        os.close(self._signals)
        os.close(self._signalled)

    def read(self) -> str:
        """The next key: a character, or a name such as `<up>`; pasted text is one key that starts with PASTE."""
        while True:
            key = self._take_key()
            if key:
                return key
            if self._ended:
                return QUIT
            signalled = self._fill(None)
            if signalled:
                return signalled

    def _take_key(self) -> str:
        """A key out of what has arrived; empty when more is needed."""
        if not self._waiting:
            return ""
        if self._waiting[0] != "\x1b":
            return self._take(1)
        while len(self._waiting) < 2 and self._has_arrived():
            pass
        if len(self._waiting) == 1 or self._waiting[1] not in "[O":
            return self._take(1)
        end = 2
        while True:
            while end >= len(self._waiting) and self._has_arrived():
                pass
            if end >= len(self._waiting):
                break
            end += 1
            if "@" <= self._waiting[end - 1] <= "~":
                break
        if self._waiting[:end] == _PASTE_START:
            return self._take_paste()
        return self._take(end)

    def _take_paste(self) -> str:
        while _PASTE_END not in self._waiting and not self._ended:
            self._fill(None)
        text, _, self._waiting = self._waiting.partition(_PASTE_END)
        return PASTE + text[len(_PASTE_START) :]

    def _take(self, count: int) -> str:
        text, self._waiting = self._waiting[:count], self._waiting[count:]
        # An unknown sequence is a name that nobody listens to.
        return _NAMES.get(text, text if len(text) == 1 else "<unknown>")

    def _has_arrived(self) -> bool:
        before = len(self._waiting)
        return not self._fill(_SEQUENCE_SECONDS) and len(self._waiting) > before

    def _fill(self, seconds: float | None) -> str:
        """Waits for bytes. Returns the key that a signal stands for, if one came."""
        ready, _, _ = select.select([self._input, self._signals], [], [], seconds)
        if self._signals in ready:
            numbers = os.read(self._signals, 1024)
            if any(number != signal.SIGWINCH for number in numbers):
                self._ended = True
                return QUIT
            return RESIZE
        if self._input in ready:
            try:
                data = os.read(self._input, 4096)
            except OSError:  # the terminal is gone
                data = b""
            if not data:
                self._ended = True
            self._waiting += self._decoder.decode(data)
        return ""


def _ignore_signal(number: int, frame: object) -> None:
    """The wake-up pipe brings the signal; nothing is to be done here."""
