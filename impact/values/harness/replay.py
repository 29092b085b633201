"""Witnesses run for real: the harness as a native program with sanitizers, in a process of its own.

The program runs with limits of time, memory and file size, without network where the system allows to cut it off, in a
temporary folder, with a clean environment.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from ....edges.files import read_text, write_file
from ..outcomes import NOWHERE, CodeLine, CrashKind, Observable, Reaction, Witness
from ..sandbox import end_group, find_isolation, make_limiter
from .toolchain import run_compiler

SECONDS = 2
"""Of one witness, from which on a callback counts as endless."""
_MEMORY_MB = 2_000
_FILE_BYTES = 50_000_000
_OUTPUT_BYTES = 20_000_000
_UNKNOWN, _IMPOSSIBLE, _ENDLESS = 77, 78, 79
_FRAME = re.compile(r"^\s*#\d+ 0x[0-9a-f]+ in (?P<function>.*?) (?P<path>/[^:\s]+):(?P<line>\d+)", re.MULTILINE)
_FILE_FRAME = re.compile(
    r"^\s*#\d+ 0x[0-9a-f]+ in (?P<function>.*?) (?P<path>/[^:\s()]+)(?::(?P<line>\d+))?", re.MULTILINE
)
_TRACE = re.compile(r"^(?=\s*#0 0x)", re.MULTILINE)
_BARE_FRAME = re.compile(
    r"^(?P<start>\s*#\d+ 0x[0-9a-f]+ in .*?) \((?P<module>/[^()\s]+)\+(?P<offset>0x[0-9a-f]+)\).*$", re.MULTILINE
)
_HAS_LINE = re.compile(r"/[^:]+:[1-9][0-9]*( |$)")
_MOST_FRAMES = 16
_RUNTIME_ERROR = re.compile(r"^(?P<path>[^\s:]+):(?P<line>\d+):\d+: runtime error: (?P<text>.*)$", re.MULTILINE)
_ASSERTION = re.compile(r"(?P<path>[^\s:]+):(?P<line>\d+): .*?: Assertion [`'](?P<text>.*)' failed")
_THROWN = re.compile(
    r"terminate called after throwing an instance of '(?P<type>[^']*)'(?:\s*what\(\):\s*(?P<what>.*))?"
)
_ADDRESS = re.compile(r"ERROR: AddressSanitizer: (?P<kind>[\w-]+)(?P<rest>[^\n]*)")
_NEAR_NULL = re.compile(r"unknown address 0x0000000(?P<address>[0-9a-f]+)")


class SentMessage(NamedTuple):
    """A message as it was published. values: field path to bits; kinds: field path to kind, bits and whether signed."""

    publisher: str
    values: dict[str, int]
    kinds: dict[str, tuple[str, int, bool]]


class Replayed(NamedTuple):
    """What a run showed. begun: the callback was reached. reason: why the result is UNKNOWN. is_isolated: the network
    was cut off."""

    result: Reaction
    crash: CrashKind | None = None
    place: CodeLine = NOWHERE
    detail: str = ""
    effects: tuple[Observable, ...] = ()
    logs: tuple[str, ...] = ()
    sent: tuple[SentMessage, ...] = ()
    reason: str = ""
    begun: bool = True
    is_isolated: bool = True


def is_confirmed(witness: Witness, replayed: Replayed) -> bool:
    """Whether a replay shows what a witness says: the same result, and for a crash the same kind at the same line."""
    if witness.result is not replayed.result:
        return False
    if witness.result is not Reaction.CRASH:
        return True
    same_kind = witness.crash is replayed.crash
    # A loop without an end is stopped on any of its lines.
    same_line = witness.place.line == replayed.place.line or witness.crash is CrashKind.ENDLESS
    return same_kind and same_line and _is_same_file(witness.place, replayed.place)


def _is_same_file(one: CodeLine, other: CodeLine) -> bool:
    return one.path == other.path or one.path.endswith(f"/{other.path}") or other.path.endswith(f"/{one.path}")


def replay(
    program: Path, entry: str, witnesses: Sequence[Mapping[str, int]], root: Path, seconds: int = SECONDS
) -> list[Replayed]:
    """Runs an entry of a program for each of some inputs (path to bits). root: of the workspace, for lines."""
    if not witnesses:
        return []
    with tempfile.TemporaryDirectory(prefix="rosimpact-replay-") as folder:
        given, out = Path(folder, "witnesses"), Path(folder, "results")
        lines = [line for one in witnesses for line in (*(f"{path}={bits}" for path, bits in one.items()), "---")]
        write_file(given, "\n".join([*lines, ""]).encode(errors="surrogateescape"))
        isolation = find_isolation()
        command = [*isolation, str(program), entry, str(given), str(out), str(seconds)]
        why = run_limited(command, Path(folder), seconds * len(witnesses) + 20)
        found = _read_results(out, root, program)
        outside = Replayed(Reaction.UNKNOWN, reason=why or "the replay ended early", begun=False)
        return [found.get(at, outside)._replace(is_isolated=bool(isolation)) for at in range(len(witnesses))]


def run_limited(
    command: Sequence[str],
    folder: Path,
    seconds: float,
    settings: Mapping[str, str] | None = None,
    out: Path | None = None,
) -> str:
    """Runs a program within limits; gives why it did not end by itself. settings: of its environment, besides what
    the sanitizers need. out: the file that its errors are written to."""
    environment = {
        "PATH": "/usr/bin:/bin", "HOME": str(folder), "TMPDIR": str(folder), "LC_ALL": "C",
        "ASAN_OPTIONS": f"detect_leaks=0:handle_abort=1:hard_rss_limit_mb={_MEMORY_MB}:max_allocation_size_mb=1000:"
        "allocator_may_return_null=0:detect_stack_use_after_return=1:print_legend=0:print_full_thread_history=0:"
        "disable_coredump=1:symbolize=1",
        "UBSAN_OPTIONS": "print_stacktrace=1:symbolize=1", **(settings or {}),
    }  # fmt: skip
    with open(out or os.devnull, "wb") as errors:
        try:
            process = subprocess.Popen(
                list(command), cwd=folder, env=environment, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL,
                stderr=errors, start_new_session=True,
                preexec_fn=make_limiter(int(seconds) + 5, _FILE_BYTES, files=256),
            )  # fmt: skip
        except OSError as error:
            return f"cannot be run: {error.strerror or error}"
        try:
            process.wait(seconds)
        except subprocess.TimeoutExpired:
            return "took too long"
        finally:
            end_group(process)
    return ""


class _Case:
    def __init__(self):
        self.effects: list[Observable] = []
        self.logs: list[str] = []
        self.sent: list[SentMessage] = []
        self.begun = self.ended = False
        self.unknown = ""
        self.status = -1


def _read_results(out: Path, root: Path, program: Path) -> dict[int, Replayed]:
    try:
        text = read_text(out, _OUTPUT_BYTES, "replace")
    except OSError:
        return {}
    found: dict[int, Replayed] = {}
    case, number = _Case(), -1
    for line in text.split("\n"):
        word, *rest = line.split("\t")
        if word == "case":
            case, number = _Case(), int(rest[0])
        elif word == "status":
            case.status = int(rest[0])
            found[number] = _judge(case, fill_frames(_read_errors(out, number), program), root)
        else:
            _note(case, word, rest)
    return found


def _note(case: _Case, word: str, rest: list[str]) -> None:
    if word == "effect":
        case.effects.append(Observable(rest[0], rest[1] if len(rest) > 1 else "", NOWHERE))
    elif word == "log":
        case.logs.append(rest[0])
    elif word == "sent":
        case.sent.append(SentMessage(rest[0], {}, {}))
    elif word == "value" and case.sent and len(rest) == 5:
        path = rest[0].replace(".[", "[").replace("..size", ".size")
        case.sent[-1].values[path] = int(rest[4])
        case.sent[-1].kinds[path] = rest[1], int(rest[2]), rest[3] == "1"
    elif word == "begin":
        case.begun = True
    elif word == "end":
        case.ended = True
    elif word == "unknown":
        case.unknown = rest[0]


def _read_errors(out: Path, number: int) -> str:
    try:
        return read_text(Path(f"{out}.{number}"), _FILE_BYTES, "replace")
    except OSError:
        return ""


def _judge(case: _Case, errors: str, root: Path) -> Replayed:
    """What a run was, from its status and what the sanitizers wrote."""
    shown = tuple(dict.fromkeys(case.effects)), tuple(dict.fromkeys(case.logs)), tuple(case.sent)
    if case.status == 0 and case.ended:
        result = Reaction.HANDLED if shown[0] else Reaction.LOG_ONLY if shown[1] else Reaction.IGNORED
        return Replayed(result, None, NOWHERE, "", *shown, begun=case.begun)
    if case.status == _UNKNOWN:
        return Replayed(Reaction.UNKNOWN, None, NOWHERE, "", *shown, reason=case.unknown, begun=case.begun)
    if case.status == _IMPOSSIBLE:
        return Replayed(Reaction.UNKNOWN, None, NOWHERE, "", *shown, reason="cannot happen", begun=case.begun)
    kind, place, detail = classify_crash(errors, case.status == _ENDLESS, root)
    if not case.begun:
        return Replayed(
            Reaction.UNKNOWN, kind, place, detail, *shown, reason="ended before the callback began", begun=False
        )
    return Replayed(Reaction.CRASH, kind, place, detail, *shown)


def classify_crash(errors: str, is_endless: bool, root: Path) -> tuple[CrashKind, CodeLine, str]:
    """Kind, line and text of a crash, from what the sanitizers, libstdc++ and the C library wrote."""
    if is_endless:
        return CrashKind.ENDLESS, _find_looping(errors, root), ""
    place = _find_frame(errors, root)
    if (found := _RUNTIME_ERROR.search(errors)) is not None:
        here = _make_line(found["path"], int(found["line"]), root)
        return _classify_runtime_error(found["text"]), here or place, found["text"]
    if (found := _ASSERTION.search(errors)) is not None:
        own = _make_line(found["path"], int(found["line"]), root)
        kind = (
            CrashKind.ASSERTION
            if "bits/" not in found["path"] and "/c++/" not in found["path"]
            else classify_condition(found["text"])
        )
        return kind, own or place, found["text"]
    if (found := _THROWN.search(errors)) is not None:
        return CrashKind.EXCEPTION, place, ": ".join(filter(None, (found["type"], (found["what"] or "").strip())))
    if (found := _ADDRESS.search(errors)) is not None:
        return _classify_address(found["kind"], errors), place, found["kind"]
    if "terminate called" in errors:
        return CrashKind.EXCEPTION, place, ""
    return CrashKind.ABORT, place, errors.strip().split("\n")[0][:200]


def classify_condition(condition: str) -> CrashKind:
    """What a failed assertion of libstdc++ says, from its condition."""
    if "empty()" in condition or "_M_is_engaged" in condition or "has_value" in condition:
        return CrashKind.EMPTY
    if "size()" in condition or "__n <" in condition:
        return CrashKind.INDEX
    if "nullptr" in condition or "pointer()" in condition or "_M_get()" in condition:
        return CrashKind.NULL
    return CrashKind.ASSERTION


def _classify_runtime_error(text: str) -> CrashKind:
    for part, kind in _RUNTIME_ERRORS:
        if part in text:
            return kind
    return CrashKind.ABORT


_RUNTIME_ERRORS = (
    ("division by zero", CrashKind.DIVISION), ("outside the range of representable", CrashKind.FLOAT_TO_INTEGER),
    ("shift", CrashKind.SHIFT), ("out of bounds", CrashKind.INDEX), ("null pointer", CrashKind.NULL),
    ("reached the end of a value-returning", CrashKind.UNREACHABLE), ("unreachable", CrashKind.UNREACHABLE),
    ("cannot be represented", CrashKind.OVERFLOW), ("overflow", CrashKind.OVERFLOW),
    ("variable length array", CrashKind.INDEX),
)  # fmt: skip
_ADDRESSES = {
    "heap-use-after-free": CrashKind.DANGLING, "stack-use-after-return": CrashKind.DANGLING,
    "stack-use-after-scope": CrashKind.DANGLING, "attempting": CrashKind.DANGLING, "stack-overflow": CrashKind.ENDLESS,
    "FPE": CrashKind.DIVISION, "ABRT": CrashKind.ABORT, "allocation-size-too-big": CrashKind.EXCEPTION,
    "out-of-memory": CrashKind.EXCEPTION, "requested": CrashKind.EXCEPTION, "hard": CrashKind.EXCEPTION,
}  # fmt: skip


def _classify_address(kind: str, errors: str) -> CrashKind:
    if kind == "SEGV":
        found = _NEAR_NULL.search(errors)
        is_null = found is not None and int(found["address"], 16) < 0x10000
        return CrashKind.NULL if is_null or "zero page" in errors else CrashKind.INDEX
    return _ADDRESSES.get(kind, CrashKind.INDEX)


def fill_frames(errors: str, program: Path) -> str:
    """A stack trace with the lines of those calls in a program that the sanitizer's own reader has no line of: it loses
    some at the ends of functions."""
    bare = [found for found in _BARE_FRAME.finditer(errors) if found["module"] == str(program)][:_MOST_FRAMES]
    tool = shutil.which("addr2line")
    if not bare or not tool or _RUNTIME_ERROR.search(errors) is not None:
        return errors
    offsets = list(dict.fromkeys(found["offset"] for found in bare))
    run = run_compiler([tool, "-a", "-i", "-e", str(program), *offsets], program.parent, 60)
    lines: dict[int, list[str]] = {}
    rows: list[str] = []
    for row in run.out.splitlines():
        if row.startswith("0x"):
            rows = lines.setdefault(int(row, 16), [])
        elif _HAS_LINE.match(row):
            rows.append(row.partition(" (")[0])
    for found in bare:
        known = [f"{found['start']} {row}" for row in lines.get(int(found["offset"], 16), ())]
        if known:
            errors = errors.replace(found[0], "\n".join(known))
    return errors


def _find_frame(errors: str, root: Path) -> CodeLine:
    """The innermost line of the workspace in the first stack trace."""
    for found in _FRAME.finditer(errors):
        line = _make_line(found["path"], int(found["line"]), root)
        if line is not None:
            return line
    return NOWHERE


def _find_looping(errors: str, root: Path) -> CodeLine:
    """The innermost line of the workspace in the first of several stack traces that has one there; the file alone where
    none has."""
    found = NOWHERE
    for trace in _TRACE.split(errors):
        rows = ((each["path"], int(each["line"] or 0)) for each in _FILE_FRAME.finditer(trace))
        inner = next(filter(None, (_make_line(path, line, root) for path, line in rows)), NOWHERE)
        if inner.line:
            return inner
        found = inner if found is NOWHERE else found
    return found


def _make_line(path: str, line: int, root: Path) -> CodeLine | None:
    try:
        inner = Path(os.path.normpath(path)).relative_to(root)
    except ValueError:
        return None
    return CodeLine(inner.as_posix(), line)
