"""What every command does with its answer: checks formats, prints or saves, says notes, shows progress."""

import os
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from functools import wraps
from pathlib import Path
from typing import Any

from ...edges.console import UserError, escape, rewrite, run_command, say, write, write_exactly, write_json
from ...edges.files import check_writable_path, find_outermost, write_file
from ..report.style import PLAIN, Style, choose_style
from ..tree.ignore import find_enclosing_repository

READ_SO_FAR = "interrupted; what was read is kept, and the next run continues from there"
PARSED_SO_FAR = "interrupted; what was parsed is kept, and the next run continues from there"


Answer = str | Mapping[str, str]
"""A text, or texts by the path of a file for each."""


def make_command(
    *formats: str, about: str = "path", folders: Sequence[str] = ()
) -> Callable[[Callable[..., Answer | tuple[Answer, int]]], Callable[..., int]]:
    """Makes a command of a function that gives its answer, or the answer and the exit status: the answer is delivered,
    an error told in one line. The command returns the exit status: 0 or what is given, 2 (failed), 130 (interrupted).

    formats: those of the command. about: the argument that an error without a file of its own is about. folders: those
    formats whose answer is a file for each of several things, so that --output is a folder.
    """

    def wrap_answer(answer: Callable[..., Answer | tuple[Answer, int]]) -> Callable[..., int]:
        @wraps(answer)
        def run_answer(**given: Any) -> int:
            format, output, path = given.get("format", "text"), given.get("output"), given.get(about) or ""

            def write_answer() -> int:
                validate_choice("--format", format, formats or ("text",))
                check_output(output / "a" if output is not None and format in folders else output, path)
                found = answer(**given)
                text, status = found if isinstance(found, tuple) else (found, 0)
                deliver(text, output, format, path)
                return status

            return run_command(write_answer, READ_SO_FAR, path)

        return run_answer

    return wrap_answer


def validate_choice(option: str, given: str, known: Sequence[str]) -> None:
    """Raises UserError when an option has a value that it does not know."""
    if given not in known:
        raise UserError(f"{option} {given}: unknown; choose one of {', '.join(known)}")


def say_notes(notes: Iterable[str]) -> None:
    for note in notes:
        say(f"rosimpact: {note}")


def deliver(text: Answer, output: Path | None, format: str, path: object = "") -> None:
    """Writes a text to the file asked for, several to files in the folder asked for, or all to standard output. Raises
    UserError when that cannot be written."""
    if output is None:
        print_answer(text if isinstance(text, str) else "".join(f"---\n{one}" for one in text.values()), format)
        return
    for file, one in ((output, text),) if isinstance(text, str) else ((output / name, t) for name, t in text.items()):
        save(file, one, path)


def save(file: Path, text: str, path: object) -> None:
    """Writes a file that the user named. path: the workspace. Raises UserError."""
    place, beneath = _place_of(file, path)
    try:
        write_file(place, _encode(text), beneath=beneath)
    except OSError as error:
        raise _make_write_error(file, error) from None


def check_output(file: Path | None, path: object) -> None:
    """Raises UserError where a file that the user named would be refused, before long work is done for nothing."""
    if file is not None:
        place, beneath = _place_of(file, path)
        try:
            check_writable_path(place, beneath=beneath)
        except OSError as error:
            raise _make_write_error(file, error) from None


def _make_write_error(file: Path, error: OSError) -> UserError:
    return UserError(f"{escape(str(file))}: cannot be written: {error.strerror}; give another file")


def _place_of(file: Path, path: object) -> tuple[str, str | None]:
    """(path to write to, folder that must hold it without links in between).

    What lies in the workspace, or in the repository around it, around the current folder or around the file itself, was
    made by whoever made those: a link in them must not say where a report goes. None elsewhere, where folders are the
    user's own.
    """
    name = os.fspath(file)
    if not os.path.isabs(name):
        name = os.path.join(os.getcwd(), name)
    folders = [os.fspath(path)] if isinstance(path, str | os.PathLike) and path != "" else []
    folders += [found for folder in (*folders, ".") if (found := find_enclosing_repository(os.path.realpath(folder)))]
    folders += [found] if (found := find_enclosing_repository(os.path.dirname(os.path.abspath(name)))) else []
    beneath = find_outermost(name, folders)
    return (name, None) if beneath is None else (os.path.abspath(name), beneath)


def _encode(text: str) -> bytes:
    return (text if text.endswith("\n") or not text else text + "\n").encode("utf-8", "surrogateescape")


_PRINTERS: dict[str, Callable[[str], None]] = {
    "json": write_json, "sarif": write_json, "html": write_exactly, "graphml": write_exactly, "dot": write_exactly,
    "github": write_exactly, "patch": write_exactly,
}  # fmt: skip
"""Formats whose makers escape what they hold; all others are for people."""


def print_answer(text: str, format: str) -> None:
    """Prints a text on standard output. Who reads no further has read enough: the exit status stays what it is. Raises
    UserError when it cannot be written."""
    with suppress(BrokenPipeError):
        _PRINTERS.get(format, write)(text)


def make_progress_bar() -> Callable[[int, int], None] | None:
    """A line on standard error that is rewritten while files are parsed; None when nobody watches."""
    if sys.stderr is None or not sys.stderr.isatty():
        return None

    def show(done: int, total: int) -> None:
        share = 100 * done // max(1, total)
        rewrite("" if done >= total else f"parsing {share:3d} % of {total / 1e6:.1f} MB", ended=False)

    return show


def find_style(output: Path | None) -> Style:
    """How text is written: for the terminal that reads it; in a file or a pipe, lines are as long as they are."""
    from ..report.columns import UNBROKEN

    if output is not None:
        return PLAIN._replace(width=UNBROKEN)
    style = choose_style(sys.stdout)
    return style if sys.stdout.isatty() else style._replace(width=UNBROKEN)
