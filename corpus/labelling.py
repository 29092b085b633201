"""A labelling session: what is offered to whom, what an answer makes of a label, the journal, undo.

Every answer is on disk before the next report is shown: one line of the journal, which lies beside the labels, is only
ever appended to, and holds the label before and after the answer. The labels themselves are written when a session
ends. A session that was killed is finished by the next one: what the journal holds since its last `merged` line is
applied first, and applying a line twice changes nothing. Names of annotators are in the journal alone.
"""

from __future__ import annotations

import json
import os
import stat
from collections.abc import Callable, Iterable, Sequence
from datetime import datetime, timezone
from pathlib import Path
from types import TracebackType

import msgspec

from ..edges.files import check_writable_path, read_file
from ..edges.limits import get_limits
from .report import BugReport, CorpusError, Label, find_faults, find_repository, read_labels, write_rows

Suggest = Callable[[str, str], tuple[str, dict[str, float]]]
"""Title and body to the likeliest label and the probability of each. Raises UserError."""
MODES = ("first", "second", "disagreements")
"""first: reports without a label. second: those with one annotator. disagreements: what two left disputed."""
DISPUTED = "disputed"
WHY_LIMIT = 200
"""Most characters of a `why`: a reason in a few words."""
_JOURNAL = os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_CLOEXEC | getattr(os, "O_NOFOLLOW", 0) | os.O_NONBLOCK


class GivenLabel(msgspec.Struct, frozen=True):
    """One person's answer. kind is None for labels without kinds."""

    label: str
    kind: str | None
    phase: str
    why: str


class JournalEvent(msgspec.Struct, frozen=True, omit_defaults=True):
    """One line of the journal.

    event: `answer`, `undo` (of the answer with the same before and after) or `merged` (all lines up to here are in the
    labels file). at: the UTC second. mode: one of MODES. suggested: whether the classifier's suggestion was looked at
    first. before, after: the row of the labels file, None where there is none.
    """

    event: str
    at: str = ""
    annotator: str = ""
    mode: str = ""
    id: str = ""
    given: GivenLabel | None = None
    suggested: bool = False
    before: Label | None = None
    after: Label | None = None


def find_journal(labels_file: Path) -> Path:
    """The journal beside a labels file: `labels.jsonl` has `labels.journal.jsonl`."""
    return labels_file.with_name(f"{labels_file.stem}.journal.jsonl")


def read_journal(path: Path) -> list[JournalEvent]:
    """The lines of a journal; empty when there is none. A last line that a crash cut short is left out.

    Raises CorpusError."""
    return _parse_journal(path, _read_bytes(path))[0]


def read_current_labels(labels_file: Path) -> dict[str, Label]:
    """The labels by id, with what the journal holds and the file does not yet. A missing file has no labels.

    Raises CorpusError."""
    labels = {label.id: label for label in read_labels(labels_file)} if labels_file.exists() else {}
    for event in select_unmerged(read_journal(find_journal(labels_file))):
        _apply(labels, event)
    return labels


def select_unmerged(events: Sequence[JournalEvent]) -> list[JournalEvent]:
    """The answers and undos since the last `merged` line."""
    last = max((i for i, event in enumerate(events) if event.event == "merged"), default=-1)
    return list(events[last + 1 :])


def list_valid(events: Iterable[JournalEvent]) -> list[JournalEvent]:
    """The answers that were not taken back, oldest first."""
    found: list[JournalEvent] = []
    for event in events:
        if event.event == "answer":
            found.append(event)
        elif event.event == "undo":
            for i in range(len(found) - 1, -1, -1):
                if found[i].id == event.id and found[i].annotator == event.annotator:
                    del found[i]
                    break
    return found


def select_reports(
    reports: Iterable[BugReport], sources: Sequence[str], repositories: Sequence[str]
) -> list[BugReport]:
    """The reports of these sources and repositories (empty: of all), each once, without migrated copies of another."""
    wanted = {name.lower() for name in repositories}
    found: dict[str, BugReport] = {}
    for report in reports:
        if report.same_as or (sources and report.source not in sources):
            continue
        if not wanted or find_repository(report.id) in wanted:
            found.setdefault(report.id, report)
    return list(found.values())


def select_offered(
    reports: Iterable[BugReport], labels: dict[str, Label], events: Sequence[JournalEvent], mode: str, annotator: str
) -> list[BugReport]:
    """The reports that a session in this mode would show to this annotator, in the order of the reports.

    Nobody reads second what they read first, as far as the journal knows.
    """
    own = {event.id for event in list_valid(events) if event.annotator == annotator and event.mode != "disagreements"}

    def open_for(id: str) -> bool:
        label = labels.get(id)
        if mode == "first":
            return label is None
        if label is None:
            return False
        if mode == "second":
            return not label.twice and label.decided in ("single", "imported") and id not in own
        return label.decided == DISPUTED

    return [report for report in reports if open_for(report.id)]


def apply_answer(before: Label | None, id: str, given: GivenLabel, mode: str) -> Label:
    """The label that an answer makes. before: the row so far, None for a first reading.

    Two readings agree when label, kind and phase are the same; else the first one stands for now, as `disputed`.
    Raises ValueError when the answer breaks the guide's rules.
    """
    if before is None or mode == "first":
        label = Label(id, given.label, given.kind, given.phase, given.why, (given.label,), "single")
    elif mode == "second":
        same = (before.label, before.kind, before.phase) == (given.label, given.kind, given.phase)
        both = (*before.annotators[:1], given.label)
        label = msgspec.structs.replace(before, annotators=both, decided="agreed" if same else DISPUTED)
        _check(Label(id, given.label, given.kind, given.phase, given.why, both, label.decided))
    else:
        label = Label(id, given.label, given.kind, given.phase, given.why, before.annotators, "adjudicated")
    _check(label)
    if not given.why.strip():
        raise ValueError("needs a reason in a few words")
    return label


def list_opinions(label: Label, events: Sequence[JournalEvent]) -> list[GivenLabel]:
    """What each annotator said of a disputed report, first and second, without names. Kind, phase and reason are empty
    where only the label is at hand."""
    answers = [event for event in list_valid(events) if event.id == label.id and event.given]
    first = next((event.given for event in reversed(answers) if event.mode == "first"), None)
    second = next((event.given for event in reversed(answers) if event.mode == "second"), None)
    found = [first or GivenLabel(label.label, label.kind, label.phase, label.why)]
    if label.twice:
        found.append(second or GivenLabel(label.annotators[1], None, "", ""))
    return found


class Session:
    """An open session; use as a context manager.

    queue: the reports still to be shown, the current one first. done: answers given so far. labels: all labels, with
    the answers. Raises CorpusError when the files cannot be read or written, or another session has them.
    """

    def __init__(self, labels_file: Path, annotator: str, mode: str, reports: Sequence[BugReport]) -> None:
        # Through a link, so that the file it leads to is written and the link stays.
        self.labels_file = labels_file.resolve()
        self.annotator = annotator
        self.mode = mode
        self._journal = _Journal(find_journal(self.labels_file))
        try:
            self.labels = read_current_labels(self.labels_file)
            self._merge()
            self._reports = {report.id: report for report in reports}
            self.queue = select_offered(reports, self.labels, self._journal.events, mode, annotator)
        except BaseException:
            self._journal.close()
            raise
        self.done = 0
        own = [event for event in self._journal.events if event.annotator == annotator]
        self._suggested = {event.id for event in own if event.suggested}

    def __enter__(self) -> Session:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None):
        try:
            self._merge()
        finally:
            self._journal.close()

    @property
    def current(self) -> BugReport | None:
        """The report to judge now; None when all are done."""
        return self.queue[0] if self.queue else None

    @property
    def opinions(self) -> list[GivenLabel]:
        """What the annotators said of the current report; only when disagreements are decided, else empty."""
        if self.mode != "disagreements" or not self.queue:
            return []
        return list_opinions(self.labels[self.queue[0].id], self._journal.events)

    def note_suggestion_seen(self) -> None:
        """Remembers that the classifier's suggestion on the current report was looked at."""
        if self.queue:
            self._suggested.add(self.queue[0].id)

    def record_answer(self, given: GivenLabel) -> None:
        """Takes the answer on the current report; it is on disk when this returns. Raises ValueError, CorpusError."""
        id = self.queue[0].id
        before = self.labels.get(id)
        after = apply_answer(before, id, given, self.mode)
        event = JournalEvent(
            "answer", _format_now(), self.annotator, self.mode, id, given, id in self._suggested, before, after
        )
        self._journal.append(event)
        _apply(self.labels, event)
        self.queue.pop(0)
        self.done += 1

    def skip(self) -> None:
        """Puts the current report off until the next session."""
        del self.queue[:1]

    def undo(self) -> JournalEvent | None:
        """Takes this annotator's last answer in this mode back, of an earlier session too. The report is shown again.

        Returns the answer taken back, or None when there is none, or when the label has been changed since.
        """
        last = next(
            (
                event
                for event in reversed(list_valid(self._journal.events))
                if event.annotator == self.annotator and event.mode == self.mode
            ),
            None,
        )
        if last is None or self.labels.get(last.id) != last.after:
            return None
        event = msgspec.structs.replace(last, event="undo", at=_format_now())
        self._journal.append(event)
        _apply(self.labels, event)
        self.done = max(0, self.done - 1)
        report = self._reports.get(last.id)
        if report is not None:
            self.queue = [report, *(other for other in self.queue if other.id != last.id)]
        return last

    def _merge(self) -> None:
        """Writes the labels when the journal holds more than they do."""
        if not select_unmerged(self._journal.events):
            return
        write_rows(self.labels_file, _make_rows(self.labels_file, self.labels))
        self._journal.append(JournalEvent("merged", _format_now()))


class _Journal:
    """A journal open for appending, locked against a second session."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.events: list[JournalEvent] = []
        try:
            check_writable_path(path)
            path.parent.mkdir(parents=True, exist_ok=True)
            self._file = os.open(path, _JOURNAL, 0o666)
        except OSError as error:
            raise CorpusError(f"{path}: cannot be written: {error.strerror}; give another file with --labels") from None
        try:
            if not stat.S_ISREG(os.fstat(self._file).st_mode):
                raise CorpusError(f"{path}: is no regular file; give another file with --labels")
            _lock(self._file, path)
            data = _read_bytes(path)
            self.events, whole = _parse_journal(path, data)
            if whole < len(data):
                os.ftruncate(self._file, whole)
            elif data and not data.endswith(b"\n"):
                os.write(self._file, b"\n")
        except BaseException:
            os.close(self._file)
            raise

    def append(self, event: JournalEvent) -> None:
        line = msgspec.json.encode(event) + b"\n"
        try:
            if os.write(self._file, line) != len(line):
                raise OSError(28, "no space left")
            os.fsync(self._file)
        except OSError as error:
            raise CorpusError(f"{self.path}: cannot be written: {error.strerror}; make room and start again") from None
        self.events.append(event)

    def close(self) -> None:
        os.close(self._file)


def _lock(file: int, path: Path) -> None:
    try:
        import fcntl
    except ImportError:
        raise CorpusError(f"{path}: labelling needs a POSIX system; use Linux, macOS or WSL") from None
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise CorpusError(f"{path}: another session is labelling here; end it, or give another --labels") from None


def _read_bytes(path: Path) -> bytes:
    try:
        return read_file(path, get_limits().report)
    except FileNotFoundError:
        return b""
    except OSError as error:
        raise CorpusError(f"{path}: cannot be read: {error.strerror}; make it readable") from None


def _parse_journal(path: Path, data: bytes) -> tuple[list[JournalEvent], int]:
    """The events in a journal's bytes, and the length of what is whole."""
    decoder = msgspec.json.Decoder(JournalEvent)
    events: list[JournalEvent] = []
    at = 0
    for number, line in enumerate(data.splitlines(keepends=True), 1):
        try:
            if line.strip():
                events.append(decoder.decode(line))
        except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
            if at + len(line) == len(data) and not line.endswith(b"\n"):
                break
            raise CorpusError(f"{path}:{number}: is no line of a journal ({error}); mend or remove it") from None
        at += len(line)
    return events, at


def _apply(labels: dict[str, Label], event: JournalEvent) -> None:
    row = event.after if event.event == "answer" else event.before
    if row is None:
        labels.pop(event.id, None)
    else:
        labels[event.id] = row


def _make_rows(file: Path, labels: dict[str, Label]) -> list[msgspec.Raw]:
    """The lines of a labels file. A label that did not change keeps its line to the byte, so that a diff is small."""
    lines: dict[str, tuple[Label, bytes]] = {}
    if file.exists():
        kept = [line for line in _read_bytes(file).splitlines() if line.strip()]
        lines = {label.id: (label, line) for label, line in zip(read_labels(file), kept, strict=True)}
    order = [*(id for id in lines if id in labels), *(id for id in labels if id not in lines)]
    return [
        msgspec.Raw(lines[id][1] if id in lines and lines[id][0] == labels[id] else _encode(labels[id])) for id in order
    ]


def _encode(label: Label) -> bytes:
    return json.dumps(msgspec.to_builtins(label), ensure_ascii=False).encode()


def _check(label: Label) -> None:
    fault = find_faults(label)
    if fault:
        raise ValueError(fault)


def _format_now() -> str:
    return datetime.now(timezone.utc).isoformat(timespec="seconds")
