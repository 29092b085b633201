"""The labelling screen: the report on one side, guide and keys on the other.

`Screen` turns keys into answers of a session and draws itself; it knows no terminal. `run` joins it with one.
"""

from __future__ import annotations

import io
import sys
from pathlib import Path
from unicodedata import category

from rich.console import Console, ConsoleOptions, Group, RenderableType, RenderResult
from rich.layout import Layout
from rich.markdown import Markdown
from rich.panel import Panel
from rich.segment import Segment
from rich.table import Table
from rich.text import Text

from ..edges.console import escape_lines
from .labelling import WHY_LIMIT, GivenLabel, Session, Suggest
from .report import KINDS, LABELS, PHASES, BugReport, CorpusError

GUIDE_FILE = Path(__file__).parent / "GUIDE.md"
_TITLES = {"first": "first reading", "second": "second reading, blind", "disagreements": "deciding disagreements"}
_KEYS = (
    ("1-5", "choose"),
    ("esc", "one step back"),
    ("\u2193 \u2191 space g G", "scroll the report"),
    ("[ ]", "scroll the guide"),
    ("r", "text as posted"),
    ("s", "show the suggestion"),
    ("n", "put off"),
    ("u", "undo the last answer"),
    ("q", "quit; all is saved"),
)
# Above this, laying out Markdown takes longer than a person waits for a key.
_MARKDOWN_LIMIT = 60_000
_NARROW = 90
# By Unicode category: spaces of all widths, ends of lines, marks of direction and joining.


class Screen:
    """What is on the screen of a session, and what keys do.

    step: what is asked for: `label`, `kind`, `phase`, `why`, or `done` when no report is left. ended: the user wants
    to go.
    """

    def __init__(self, session: Session, suggest: Suggest, guide: str) -> None:
        self.session = session
        self.ended = False
        self.message = ""
        self._suggest = suggest
        self._guide = guide
        self._guide_top = 0
        self._page = 10
        self._lines: dict[tuple[str, int, bool], list[list[Segment]]] = {}
        self._start_report()

    def press(self, key: str) -> None:
        """Does what a key asks for. Raises CorpusError when an answer cannot be written."""
        from .keyboard import PASTE, QUIT, RESIZE

        if key == RESIZE:
            return
        if key == QUIT:
            self.ended = True
            return
        self.message = ""
        if self.step == "why":
            self._write(key[len(PASTE) :] if key.startswith(PASTE) else key)
        elif not key.startswith(PASTE):  # pasted text is no row of commands
            self._apply_key(key)

    def _start_report(self) -> None:
        """Starts on the current report."""
        self._reset_answer()
        self._suggestion = ""
        self._top = 0
        self._raw = False

    def _reset_answer(self) -> None:
        self.step = "label" if self.session.current else "done"
        self._label, self._kind, self._phase, self._why = "", None, "", ""

    def _apply_key(self, key: str) -> None:
        if key == "q":
            self.ended = True
        elif key == "u":
            self._undo()
        elif key in ("[", "]"):
            self._guide_top = max(0, self._guide_top + (self._page // 2 if key == "]" else -self._page // 2))
        elif self.step == "done":
            return
        elif key == "<escape>":
            self._go_back()
        elif key == "n":
            self.session.skip()
            self._start_report()
        elif key == "r":
            self._raw, self._top = not self._raw, 0
        elif key == "s":
            self._show_suggestion()
        elif key in ("a", "b") and self.step == "label":
            self._take(key)
        elif key.isdigit():
            self._choose(int(key))
        else:
            self._scroll(key)

    def _scroll(self, key: str) -> None:
        moves = {"<down>": 1, "j": 1, "<up>": -1, "k": -1, " ": self._page, "<pagedown>": self._page,
                 "<pageup>": -self._page, "<home>": -(10**9), "g": -(10**9), "<end>": 10**9, "G": 10**9}  # fmt: skip
        self._top = max(0, self._top + moves.get(key, 0))

    def _list_choices(self) -> tuple[str, ...]:
        if self.step == "kind":
            return KINDS[self._label]
        return PHASES if self.step == "phase" else LABELS

    def _choose(self, number: int) -> None:
        choices = self._list_choices()
        if not 1 <= number <= len(choices):
            self.message = f"{number} stands for nothing here; press 1 to {len(choices)}"
            return
        choice = choices[number - 1]
        if self.step == "label":
            self._label, self._kind = choice, None
            self.step = "kind" if choice in KINDS else "phase"
        elif self.step == "kind":
            self._kind, self.step = choice, "phase"
        else:
            self._phase, self.step = choice, "why"

    def _go_back(self) -> None:
        if self.step == "why":
            self.step, self._phase = "phase", ""
        elif self.step == "phase" and self._label in KINDS:
            self.step, self._kind = "kind", None
        else:
            self.step, self._label, self._kind = "label", "", None

    def _take(self, key: str) -> None:
        """Takes over one annotator's whole answer, to be confirmed or reworded."""
        given = self.session.opinions["ab".index(key) :][:1]
        if not given:
            self.message = "there is no answer to take over here; press 1 to 5"
        elif not given[0].phase:
            self.message = "only the label of this answer is at hand; press 1 to 5"
        else:
            self._label, self._kind, self._phase, self._why = (
                given[0].label, given[0].kind, given[0].phase, given[0].why,
            )  # fmt: skip
            self.step = "why"

    def _write(self, key: str) -> None:
        """Edits the reason."""
        if key == "<enter>":
            self._submit_answer()
        elif key == "<escape>":
            self._go_back()
        elif key == "<backspace>":
            self._why = self._why[:-1]
        elif key == "<clear>":
            self._why = ""
        elif not (key.startswith("<") and key.endswith(">") and len(key) > 2):
            text = "".join(sign if sign.isprintable() else " " for sign in key)
            self._why = (self._why + text)[:WHY_LIMIT]

    def _submit_answer(self) -> None:
        if not self._why.strip():
            self.message = "say why in a few words of your own, then press Enter"
            return
        given = GivenLabel(self._label, self._kind, self._phase, " ".join(self._why.split()))
        try:
            self.session.record_answer(given)
        except ValueError as error:
            self.message = f"the answer {error}; choose again"
            self._reset_answer()
            return
        self._start_report()

    def _undo(self) -> None:
        undone = self.session.undo()
        if undone is None:
            self.message = "nothing of yours to take back, or it has been changed since"
            return
        self._start_report()
        given = undone.given.label if undone.given else ""
        self.message = f"taken back: {undone.id} ({given})"
        if self.session.current is None or self.session.current.id != undone.id:
            self.message += "; it is not among these reports"

    def _show_suggestion(self) -> None:
        report = self.session.current
        if report is None or self._suggestion:
            return
        try:
            label, shares = self._suggest(report.title, report.body)
        except Exception as error:  # whatever is wrong with the classifier, labelling goes on
            self.message = f"no suggestion: {' '.join(str(error).split())[:150]}"
            return
        self.session.note_suggestion_seen()
        ranked = sorted(shares.items(), key=lambda item: -item[1])
        self._suggestion = f"{label}   " + "  ".join(f"{name} {share:.2f}" for name, share in ranked)

    # -- drawing -------------------------------------------------------------------------------------------------------

    def draw(self, console: Console) -> RenderableType:
        """The whole screen for a console of this size."""
        width, height = console.size
        layout, side, report = Layout(), Layout(name="side"), Layout(name="report")
        if width >= _NARROW:
            layout.split_row(report, side)
            side.size = max(38, width * 2 // 5)
            self._page = max(1, height - 2)
            report_width, side_width = width - side.size, side.size
        else:
            layout.split_column(report, side)
            side.size = max(12, height * 3 // 5)
            self._page = max(1, height - side.size - 2)
            report_width = side_width = width
        question = self._render_question()
        tall = len(console.render_lines(question, console.options.update(width=side_width - 4, height=None))) + 2
        side_height = height if width >= _NARROW else side.size
        guide = Layout(name="guide")
        asked = Layout(Panel(question, title=self._format_progress(), border_style="cyan"), size=min(tall, side_height))
        if side_height - tall >= 5:
            side.split_column(asked, guide)
            guide.update(self._render_guide(console, side_width - 4, side_height - tall - 2))
        else:
            side.split_column(asked)
        report.update(self._report_panel(console, report_width - 4))
        return layout

    def _format_progress(self) -> str:
        return f"{_TITLES[self.session.mode]}: {self.session.done:,} done, {len(self.session.queue):,} to go"

    def _report_panel(self, console: Console, width: int) -> Panel:
        report = self.session.current
        if report is None:
            return Panel(Text("Nothing is left to read here. u takes the last answer back, q ends."), title="done")
        lines = self._lay_out(report, console, width)
        self._top = max(0, min(self._top, len(lines) - self._page))
        shown = lines[self._top : self._top + self._page]
        below = len(lines) - self._top - len(shown)
        more = f"{below:,} more lines" if below else "end"
        return Panel(_Lines(shown), title=Text(clean(report.id)), subtitle=more, border_style="green")

    def _lay_out(self, report: BugReport, console: Console, width: int) -> list[list[Segment]]:
        key = (report.id, width, self._raw)
        if key not in self._lines:
            self._lines.clear()
            facts = [report.source, report.kind, report.date or "undated", report.wording, *report.tags]
            head = Group(
                Text(clean(report.title), style="bold"),
                Text(clean(report.url), style="dim"),
                Text(clean(" \u00b7 ".join(facts)), style="dim"),
                Text(),
            )
            options = console.options.update(width=max(10, width), height=None)
            plain = self._raw or len(report.body) > _MARKDOWN_LIMIT
            body = Text(clean(report.body)) if plain else make_markdown(report.body)
            try:
                laid = console.render_lines(body, options, pad=False)
            except Exception:  # no text may stop the work: as posted, it can always be shown
                laid = console.render_lines(Text(clean(report.body)), options, pad=False)
            self._lines[key] = [*console.render_lines(head, options, pad=False), *laid]
        return self._lines[key]

    def _render_guide(self, console: Console, width: int, height: int) -> Panel:
        lines = console.render_lines(make_markdown(self._guide), console.options.update(width=width, height=None))
        self._guide_top = max(0, min(self._guide_top, len(lines) - height))
        return Panel(_Lines(lines[self._guide_top : self._guide_top + height]), title="guide", border_style="dim")

    def _render_question(self) -> RenderableType:
        parts: list[RenderableType] = []
        if self.session.mode == "disagreements" and self.session.current:
            for key, given in zip("ab", self.session.opinions, strict=False):
                told = ", ".join(part for part in (given.label, given.kind, given.phase) if part)
                parts.append(Text(clean(f"{key}  {told}: {given.why or 'no reason at hand'}"), style="magenta"))
        chosen = " \u203a ".join(part for part in (self._label, self._kind, self._phase) if part)
        if self.step == "why":
            parts += [
                Text(chosen, style="bold"),
                Text("why, in a few words of your own:"),
                Text(clean(f"{self._why}\u2588")),
            ]
            parts.append(Text("Enter saves, esc goes back", style="dim"))
        elif self.step != "done":
            parts.append(Text(f"{chosen} \u203a {self.step}?" if chosen else f"{self.step}?", style="bold"))
            parts += [Text(f" {i}  {choice}") for i, choice in enumerate(self._list_choices(), 1)]
        if self._suggestion:
            parts.append(Text(clean(f"suggestion: {self._suggestion}"), style="yellow"))
        if self.message:
            parts.append(Text(clean(self.message), style="red"))
        if self.step != "why":
            keys = Table.grid(padding=(0, 2))
            for name, does in _KEYS:
                keys.add_row(Text(name, style="cyan"), Text(does, style="dim"))
            parts += [Text(), keys]
        return Group(*parts)


class _Lines:
    """Lines that are laid out already."""

    def __init__(self, lines: list[list[Segment]]) -> None:
        self._lines = lines

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        for line in self._lines:
            yield from line
            yield Segment.line()


def clean(text: str) -> str:
    """A text that changes nothing on a terminal: control characters, marks of direction and what has no known width are
    shown escaped."""
    return "".join(
        sign
        if sign == "\n" or sign.isprintable()
        else " "
        if category(sign) == "Zs"
        else sign.encode("unicode_escape").decode()
        for sign in escape_lines(text.replace("\r\n", "\n").replace("\r", "\n").expandtabs(4))
    )


def make_markdown(text: str) -> Markdown:
    """A text as Markdown in which HTML is shown as it stands; rich would leave it out, and the evidence with it."""
    from markdown_it import MarkdownIt

    cleaned = clean(text)
    shown = Markdown("", code_theme="ansi_dark", hyperlinks=False)
    shown.markup = cleaned
    shown.parsed = MarkdownIt("commonmark", {"html": False}).enable(["table", "strikethrough"]).parse(cleaned)
    return shown


def run(session: Session, suggest: Suggest) -> None:
    """Shows a session on the terminal until it is done or the user goes. Raises CorpusError where there is none."""
    need_terminal()
    from .keyboard import Keyboard

    if isinstance(sys.stdout, io.TextIOWrapper):
        sys.stdout.reconfigure(errors="replace")  # one column for each sign that the terminal's encoding lacks
    console = Console()
    screen = Screen(session, suggest, GUIDE_FILE.read_text(encoding="utf-8"))
    with Keyboard(sys.stdin.fileno(), sys.stdout.fileno()) as keyboard, console.screen() as shown:
        while not screen.ended:
            shown.update(screen.draw(console))
            screen.press(keyboard.read())


def need_terminal() -> None:
    """Raises CorpusError unless both ends of this process are a terminal that can be drawn on."""
    import os

    if not (sys.stdin.isatty() and sys.stdout.isatty()) or os.environ.get("TERM") == "dumb":
        raise CorpusError("label: needs a terminal; run it in one, or see what it would show with --list")
