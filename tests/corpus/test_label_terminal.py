"""`rosimpact corpus label` in a real terminal: a pseudo-terminal, a process, and keys pressed one by one."""

from __future__ import annotations

import fcntl
import os
import pty
import re
import select
import signal
import struct
import subprocess
import sys
import termios
import time

import pytest
from rosimpact.corpus.labelling import find_journal, read_journal
from rosimpact.corpus.report import BugReport, Label, read_labels, write_rows

pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminals there")

SEQUENCE = re.compile(r"\x1b\[[0-9;?]*[A-Za-z~]|\x1b[()][A-Z0-9]|\x1b[=>]")
PATIENCE = 120  # seconds until a screen counts as never drawn
LONG = "\n\n".join(f"paragraph {n:03d} of the log" for n in range(200))
REPORTS = [
    BugReport(
        "acme/arm#1",
        "https://github.com/acme/arm/issues/1",
        "github",
        "2024-05-01",
        "Build stops after the upgrade",
        "Since noetic:\n\n```\nfatal error: gone.h\n```\n\n<details>\nhidden evidence\n</details>",
    ),
    BugReport("acme/arm#2", "https://github.com/acme/arm/issues/2", "github", "2024-05-02", "Long one", LONG),
    BugReport(
        "ros-answers:7",
        "https://answers.ros.org/question/7",
        "ros-answers",
        None,
        "Hostile \x1b]0;owned\x07 title",
        "beep \x07 and \x1b[2J clear and caf\u00e9 \u202e turned",
        kind="question",
    ),
]


class Terminal:
    """A person at a terminal of 120 x 40 who waits for what is on the screen before pressing the next key."""

    def __init__(self, *arguments: object, size=(40, 120), **environment: str):
        self.ours, theirs = pty.openpty()
        self.resize(*size)
        self.before = termios.tcgetattr(theirs)
        self.theirs = theirs
        self.process = subprocess.Popen(
            [
                sys.executable,
                "-c",
                "from rosimpact.impact.cli.app import main; main()",
                "corpus",
                "label",
                *map(str, arguments),
            ],
            stdin=theirs,
            stdout=theirs,
            stderr=theirs,
            # What the tests run in may have told its own size.
            env={k: v for k, v in os.environ.items() if k not in ("LINES", "COLUMNS")}
            | {"TERM": "xterm-256color", "LANG": "C.UTF-8", **environment},
            start_new_session=True,
        )
        self.raw = b""
        self.mark = 0

    def resize(self, rows: int, columns: int) -> None:
        fcntl.ioctl(self.ours, termios.TIOCSWINSZ, struct.pack("HHHH", rows, columns, 0, 0))

    @property
    def shown(self) -> str:
        """What was drawn since the last key."""
        return SEQUENCE.sub("", self.raw[self.mark :].decode("utf-8", "replace"))

    def see(self, *texts: str) -> Terminal:
        """Waits until all of the texts have been drawn since the last key."""
        end = time.monotonic() + PATIENCE
        while not all(text in self.shown for text in texts):
            assert self._read(end), f"not seen: {texts}\n{self.shown}"
        return self

    def press(self, keys: str) -> Terminal:
        self.mark = len(self.raw)
        os.write(self.ours, keys.encode())
        return self

    def end(self) -> int:
        """Waits for the process and gives its status."""
        end = time.monotonic() + PATIENCE
        while self._read(end):
            if self.process.poll() is not None and not self._read(time.monotonic()):
                break
        return self.process.wait(PATIENCE)

    def close(self) -> None:
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        os.close(self.ours)
        os.close(self.theirs)

    def _read(self, end: float) -> bool:
        waiting = select.poll()  # select() takes no descriptor above 1023, and a session of tests has many open
        waiting.register(self.ours, select.POLLIN)
        ready = waiting.poll(1000 * max(0.0, min(0.2, end - time.monotonic())))
        if ready:
            self.raw += os.read(self.ours, 65536)
            return True
        return time.monotonic() < end and self.process.poll() is None


@pytest.fixture
def desk(tmp_path):
    """Opens terminals on three reports and one labels file."""
    write_rows(tmp_path / "reports.jsonl", REPORTS)
    opened = []

    def sit(*arguments, who="ann", **more) -> Terminal:
        terminal = Terminal(
            "--reports", tmp_path / "reports.jsonl", "--labels", tmp_path / "labels.jsonl", "--annotator", who,
            *arguments, **more,
        )  # fmt: skip
        opened.append(terminal)
        return terminal

    yield sit
    for terminal in opened:
        terminal.close()


def given(tmp_path):
    return [
        (x.id, x.label, x.kind, x.phase, x.why, x.annotators, x.decided) for x in read_labels(tmp_path / "labels.jsonl")
    ]


def test_label_kind_phase_and_why(desk, tmp_path):
    at = desk()
    at.see(
        "Build stops after the upgrade", "fatal error: gone.h", "hidden evidence", "label?", "library-update", "guide"
    )
    at.press("1").see("library-update \u203a kind?", "system")
    at.press("2").see("system \u203a phase?", "install")
    at.press("1").see("why, in a few words")
    at.press("header went\x7fT with\u00e9 \r").see("Long one", "1 done, 2 to go")
    at.press("5").see("other \u203a phase?").press("4").see("why").press("a wish\r").see("2 done, 1 to go")
    at.press("q")
    assert at.end() == 0
    assert "2 answered, 1 left" in at.shown
    assert given(tmp_path) == [
        ("acme/arm#1", "library-update", "system", "build", "header wenT with\u00e9", ("library-update",), "single"),
        ("acme/arm#2", "other", None, "none", "a wish", ("other",), "single"),
    ]


def test_going_back_wrong_numbers_and_an_empty_why(desk, tmp_path):
    at = desk()
    at.see("label?").press("9").see("press 1 to 5")
    at.press("2").see("dependency \u203a kind?").press("\x1b").see("inconsistency")
    at.press("4").see("message-logic \u203a phase?").press("3").see("why")
    at.press("\r").see("say why in a few words")
    at.press("\x1b").see("message-logic \u203a phase?").press("3").see("why").press("too late\r").see("1 done")
    at.press("q")
    assert at.end() == 0
    assert given(tmp_path)[0][1:5] == ("message-logic", None, "run", "too late")


def test_scrolling_and_the_text_as_posted(desk):
    at = desk()
    at.see("label?").press("n").see("paragraph 000")
    at.press(" ").see("paragraph 020")
    at.press("\x1b[F").see("paragraph 199", "end")
    at.press("\x1b[H").see("paragraph 000")
    at.press("\x1b[6~").see("paragraph 020")
    at.press("g").see("paragraph 000").press("r").see("paragraph 001")
    at.press("]]").see("Signs")
    at.press("q")
    assert at.end() == 0


def test_a_hostile_text_does_nothing_to_the_terminal(desk):
    at = desk("--source", "ros-answers")
    at.see("title", "caf\u00e9", "clear").press("q")
    assert at.end() == 0
    assert b"\x1b]0;" not in at.raw and b"\x07" not in at.raw and "\u202e" not in at.shown


def test_a_terminal_that_knows_only_ascii(desk):
    at = desk(PYTHONIOENCODING="ascii", PYTHONUTF8="0")
    at.see("label?", "Build stops").press("1").see("kind?").press("q")
    assert at.end() == 0


def test_undo_and_the_next_session_goes_on(desk, tmp_path):
    at = desk()
    at.see("label?").press("5").see("phase?").press("4").see("why").press("one\r").see("1 done")
    at.press("u").see("taken back: acme/arm#1 (other)", "0 done, 3 to go")
    at.press("5").see("phase?").press("3").see("why").press("two\r").see("1 done").press("q")
    assert at.end() == 0
    assert [row[4] for row in given(tmp_path)] == ["two"]
    later = desk()
    later.see("Long one", "0 done, 2 to go").press("q")
    assert later.end() == 0


def test_the_second_annotator_reads_blind_and_a_third_decides(desk, tmp_path):
    first = desk()
    first.see("label?").press("1").see("kind?").press("2").see("phase?").press("1").see("why")
    first.press("secret\r").see("1 done").press("q")
    assert first.end() == 0
    second = desk("--second", who="bob")
    second.see("second reading, blind", "Build stops")
    assert "secret" not in second.shown and "suggestion:" not in second.shown
    second.press("2").see("kind?").press("1").see("phase?").press("1").see("why").press("undone\r").see(
        "Nothing is left"
    )
    assert "secret" not in second.shown
    second.press("q")
    assert second.end() == 0
    assert given(tmp_path)[0][5:] == (("library-update", "dependency"), "disputed")
    third = desk("--disagreements", who="eve")
    third.see("secret", "undone", "label?")
    third.press("b").see("undeclared", "why").press("\r").see("Nothing is left").press("q")
    assert third.end() == 0
    assert given(tmp_path) == [
        (
            "acme/arm#1",
            "dependency",
            "undeclared",
            "build",
            "undone",
            ("library-update", "dependency"),
            "adjudicated",
        )
    ]


@pytest.mark.parametrize("way", ["ctrl-c", "ctrl-d", "interrupt", "terminate", "hang up", "kill"])
def test_however_it_ends_no_answer_is_lost(desk, tmp_path, way):
    at = desk()
    at.see("label?").press("5").see("phase?").press("4").see("why").press("kept\r").see("1 done")
    at.press("2").see("kind?")  # in the middle of the next answer
    keys = {"ctrl-c": "\x03", "ctrl-d": "\x04"}
    signals = {
        "interrupt": signal.SIGINT,
        "terminate": signal.SIGTERM,
        "hang up": signal.SIGHUP,
        "kill": signal.SIGKILL,
    }
    if way in keys:
        at.press(keys[way])
    else:
        at.process.send_signal(signals[way])
    status = at.end()
    if way == "kill":
        assert [event.event for event in read_journal(find_journal(tmp_path / "labels.jsonl"))] == ["answer"]
        again = desk()
        again.see("Long one", "2 to go").press("q")
        assert again.end() == 0
    else:
        assert status == 0
        # The terminal is as it was: echo, lines, and Ctrl-C as a signal.
        assert termios.tcgetattr(at.theirs)[:4] == at.before[:4]
        assert b"\x1b[?1049l" in at.raw and b"\x1b[?2004l" in at.raw
    assert [row[4] for row in given(tmp_path)] == ["kept"]


def test_pasted_text_presses_no_keys(desk, tmp_path):
    at = desk()
    at.see("label?").press("\x1b[200~555 q u\x1b[201~").press("5").see("phase?")
    at.press("4").see("why").press("\x1b[200~two\nlines\x1b[201~").see("two lines")
    at.press("\r").see("1 done").press("q")
    assert at.end() == 0
    assert given(tmp_path)[0][4] == "two lines"


def test_it_fits_narrow_terminals_and_follows_their_size(desk):
    at = desk(size=(24, 60))
    at.see("Build stops", "label?")
    at.mark = len(at.raw)
    at.resize(40, 140)
    os.kill(at.process.pid, signal.SIGWINCH)
    at.see("guide", "Build stops")
    at.mark = len(at.raw)
    at.resize(5, 20)
    os.kill(at.process.pid, signal.SIGWINCH)
    at.press("q")
    assert at.end() == 0


def test_the_suggestion_is_hidden_until_asked_for_and_noted(desk, tmp_path):
    (tmp_path / "sitecustomize.py").write_text(
        "import sys, types\n"
        "triage = types.ModuleType('rosimpact.classifier.triage')\n"
        "triage.suggest = lambda title, body: ('dependency', {'other': 0.3, 'dependency': 0.7})\n"
        "sys.modules['rosimpact.classifier.triage'] = triage\n"
    )
    at = desk(PYTHONPATH=str(tmp_path))
    at.see("label?", "show the suggestion")
    assert "0.70" not in at.raw.decode()
    at.press("s").see("suggestion: dependency", "dependency 0.70")
    at.press("5").see("phase?").press("4").see("why").press("w\r").see("1 done")
    assert "0.70" not in at.shown.split("1 done")[-1]
    at.press("q")
    assert at.end() == 0
    (answer,) = [event for event in read_journal(find_journal(tmp_path / "labels.jsonl")) if event.event == "answer"]
    assert answer.suggested


def test_without_a_classifier_labelling_goes_on(desk, tmp_path):
    (tmp_path / "sitecustomize.py").write_text("import sys\nsys.modules['rosimpact.classifier.triage'] = None\n")
    at = desk(PYTHONPATH=str(tmp_path))
    at.see("label?").press("s").see("no suggestion")
    at.press("5").see("phase?").press("q")
    assert at.end() == 0


# -- without a terminal ------------------------------------------------------------------------------------------------


@pytest.fixture
def files(tmp_path):
    write_rows(tmp_path / "reports.jsonl", REPORTS)
    return "--reports", tmp_path / "reports.jsonl", "--labels", tmp_path / "labels.jsonl"


def test_no_terminal_is_a_clear_error(say, files):
    said = say("corpus", "label", *files)
    assert (said.status, said.err) == (
        2,
        "rosimpact: label: needs a terminal; run it in one, or see what it would show with --list\n",
    )


def test_list_says_what_would_be_shown(say, files, tmp_path):
    said = say("corpus", "label", *files, "--list")
    assert said.status == 0
    assert said.out.splitlines()[0] == "acme/arm#1\tBuild stops after the upgrade"
    assert said.err == "3 of 3 reports\n"
    assert not (tmp_path / "labels.journal.jsonl").exists()
    assert say("corpus", "label", *files, "--list", "--repository", "ACME/arm").err == "2 of 2 reports\n"


def test_list_of_disagreements(say, files, tmp_path):
    write_rows(
        tmp_path / "labels.jsonl",
        [Label("acme/arm#1", "other", None, "none", "w", ("other", "dependency"), "disputed")],
    )
    said = say("corpus", "label", *files, "--list", "--disagreements")
    assert said.out == "acme/arm#1\tother / dependency\tBuild stops after the upgrade\n"


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--second", "--disagreements", "--list"], "exclude each other"),
        (["--source", "gitlab", "--list"], "choose one of github, ros-answers, robotics-se"),
        (["--reports", "nowhere.jsonl", "--list"], "nowhere.jsonl: cannot be read"),
        (["--labels", "{tmp}/bad.jsonl", "--list"], "bad.jsonl:1"),
    ],
)
def test_errors_are_one_line_that_says_what_to_do(say, files, tmp_path, arguments, told):
    (tmp_path / "bad.jsonl").write_text("{}\n")
    said = say("corpus", "label", *files, *[a.replace("{tmp}", str(tmp_path)) for a in arguments])
    assert said.status == 2
    assert told in said.err
    assert "Traceback" not in said.text
