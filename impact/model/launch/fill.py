"""Substitutions of a launch filled in where it stands, and the parameter files it names, changed as it asks."""

from __future__ import annotations

import math
import posixpath
import re
from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import Any, NamedTuple

import msgspec

from ....edges.dispatch import methods_of
from ...facts.launch.actions import Action, Value, ValuePart, literal
from ...facts.launch.flow import substitutions
from ...facts.launch.parameter_files import ParameterEntry, scalar
from .result import LaunchParameter, LaunchSources, Remap, SettingFile, ShareLine, UnresolvedPart
from .text import (
    CannotTell,
    LaunchText,
    evaluate,
    every,
    flag,
    known,
    ros1_value,
    show,
    text_method,
    together,
    truth_of,
    unknown,
    yaml_value,
)


class ActionScope(msgspec.Struct, eq=False):
    """What holds where an action runs. open: how many undecided conditions stood when it began."""

    arguments: dict[str, LaunchText]
    environment: dict[str, LaunchText]
    open: int
    namespace: LaunchText = known("")
    remaps: list[Remap] = []
    settings: list[LaunchParameter | SettingFile] = []
    private: list[Action] = []
    constants: set[str] = set()

    def inner(self, open_: int) -> ActionScope:
        """A copy, whose changes do not reach this one."""
        return ActionScope(
            dict(self.arguments), dict(self.environment), open_, self.namespace, list(self.remaps),
            list(self.settings), list(self.private), set(self.constants),
        )  # fmt: skip


class Rewrite(NamedTuple):
    """A parameter file that is changed before it is read. root: the key all is put below, empty for none. changes: old
    and new, which are keys and the values they get or, where is_text, texts wherever they stand."""

    source: LaunchText
    root: LaunchText
    changes: tuple[tuple[LaunchText, LaunchText], ...]
    is_text: bool


class ChangedFiles:
    """What becomes of the entries of parameter files, by the id() of the entries that it is made from: the same in all
    launches of the same sources. rewritten: those entries and what a rewrite makes of them; filled: those entries, the
    places of those that hold a substitution, and all of them by what those are filled in as."""

    def __init__(self) -> None:
        self.rewritten: dict[tuple[int, Rewrite], tuple[tuple[ParameterEntry, ...], tuple[ParameterEntry, ...]]] = {}
        self.filled: dict[int, tuple[tuple[ParameterEntry, ...], list[int], dict[str, tuple[ParameterEntry, ...]]]] = {}


class Filling:
    """Where a launch stands: the file it reads, and what holds there. package and path: of that file."""

    def __init__(self, sources: LaunchSources, scope: ActionScope, generation: int, changed: ChangedFiles):
        self.sources = sources
        self.changed = changed
        self.scope = scope
        self.generation = generation
        self.package = ""
        self.path = ""
        self.rewrites: dict[str, Rewrite] = {}
        self.unresolved: list[UnresolvedPart] = []

    def at(self, line: int) -> ShareLine:
        return ShareLine(self.package, self.path, line)

    def miss(self, line: int, what: str, *reasons: str) -> None:
        """Lists what could not be followed, once."""
        unresolved = UnresolvedPart(self.at(line), what, reasons)
        if unresolved not in self.unresolved[-20:]:
            self.unresolved.append(unresolved)

    def note_unknown(self, text: LaunchText, line: int, what: str) -> LaunchText:
        """The text; where it is not known that is listed."""
        if text.value is None:
            self.miss(line, f"{what} `{text.shown}`", *text.reasons)
        return text

    def substituted(self, entries: tuple[ParameterEntry, ...]) -> tuple[ParameterEntry, ...]:
        """Entries whose keys or values may hold substitutions, filled in where that can be done."""
        known = self.changed.filled.get(id(entries))
        if known is None:
            places = [at for at, entry in enumerate(entries) if "$(" in f"{entry.path}{entry.value}"]
            known = self.changed.filled[id(entries)] = entries, places, {"[]": entries}
        _, places, made = known
        filled = [self._substituted(entries[at]) for at in places]
        # Values that cannot be hashed are told apart by how they are written, and so are 1 and True.
        written = repr(filled)
        if written not in made:
            changed = list(entries)
            for at, entry in zip(places, filled, strict=True):
                changed[at] = entry
            made[written] = tuple(changed)
        return made[written]

    def _substituted(self, entry: ParameterEntry) -> ParameterEntry:
        path = tuple(self.filled(part) if "$(" in part else part for part in entry.path)
        return ParameterEntry(path, self.filled_value(entry.value), entry.line)

    def filled(self, text: str) -> str:
        made = self.text(substitutions(text, self.generation))
        return text if made.value is None else made.value

    def filled_value(self, value: Any) -> Any:
        if isinstance(value, str) and "$(" in value:
            return yaml_value(self.filled(value))
        if isinstance(value, list):
            return [self.filled_value(item) for item in value]
        if isinstance(value, dict):
            return {self.filled(key): self.filled_value(item) for key, item in value.items()}
        return value

    def entries(self, file: str, line: int) -> tuple[ParameterEntry, ...] | None:
        """The entries of a parameter file, changed as it is before it is read; None where it cannot be had."""
        rewrite = self.rewrites.get(file)
        if rewrite is not None:
            if rewrite.source.value is None:
                self.miss(line, f"parameters `{rewrite.source.shown}`", *rewrite.source.reasons)
                return None
            entries = self.entries(rewrite.source.value, line)
            return None if entries is None else self._rewritten(entries, rewrite)
        place = self.place(file)
        if place is None:
            self.miss(line, f"parameters `{file}`", "the file lies in no package that is named")
            return None
        found = self.sources.parameters(*place)
        if found is None:
            self.miss(line, f"parameters `{file}`", "the file is not in the workspace")
            return None
        for problem in found.problems:
            self.miss(line, f"parameters `{file}`, line {problem.line}", problem.message)
        return found.entries

    def _rewritten(self, entries: tuple[ParameterEntry, ...], rewrite: Rewrite) -> tuple[ParameterEntry, ...]:
        """The same for all nodes that are given one file with one rewrite."""
        key = id(entries), rewrite
        known = self.changed.rewritten.get(key)
        if known is None:
            known = self.changed.rewritten[key] = entries, _rewritten(entries, rewrite)
        return known[1]

    def place(self, path: str) -> tuple[str, str] | None:
        """Package and path in it of a file below a package's share folder."""
        m = _PLACE.match(path)
        if m is None:
            return None
        inner = posixpath.normpath(m[2].lstrip("/")) if m[2].strip("/") else ""
        return None if inner.startswith("..") or not inner else (m[1], inner)

    def text(self, value: Value) -> LaunchText:
        """A value with its substitutions filled in."""
        if len(value) == 1:
            return self.piece(value[0])
        return together([self.piece(piece) for piece in value])

    def piece(self, piece: ValuePart) -> LaunchText:
        if piece.kind == "text":
            return known(piece.text)
        if piece.kind == "other":
            return unknown(piece.text, "it is only known when it runs")
        maker = _FILLING.get(piece.kind.replace("-", "_"))
        if maker is None or len(piece.parts) < _PARTS.get(piece.kind, 0):
            return unknown(piece.kind, f"`{piece.kind}` is not filled in")
        return maker(self, piece)

    def named(self, piece: ValuePart) -> tuple[LaunchText, tuple[Value, ...]]:
        """A piece's name, and its other parts."""
        if piece.text:
            return known(piece.text), piece.parts
        return (self.text(piece.parts[0]), piece.parts[1:]) if piece.parts else (known(""), ())

    def fill_arg(self, piece: ValuePart) -> LaunchText:
        """A launch argument or an environment variable."""
        name, rest = self.named(piece)
        if name.value is None:
            return unknown(name.shown, *name.reasons)
        is_argument = piece.kind == "arg"
        text = (self.scope.arguments if is_argument else self.scope.environment).get(name.value)
        if text is not None:
            return text._replace(assumed=every((text.assumed, name.assumed))) if is_argument else text
        shown = name.value if is_argument else f"${name.value}"
        if rest:
            default = self.text(rest[0])
            return default._replace(assumed=every((default.assumed, (shown,))))
        reason = "argument `{}` has no value" if is_argument else "the environment variable `{}` is not known"
        return unknown(shown, reason.format(name.value))

    fill_env = fill_arg

    def fill_find(self, piece: ValuePart) -> LaunchText:
        name, _ = self.named(piece)
        if name.value is None:
            return unknown(f"$({piece.kind} {name.shown})", *name.reasons)
        return known(f"$({piece.kind} {name.value})", name.assumed)

    fill_prefix = fill_find

    def fill_executable(self, piece: ValuePart) -> LaunchText:
        name, package = (self.text(part) for part in piece.parts[:2])
        return together((known("$(prefix "), package, known(")/lib/"), package, known("/"), name))

    def fill_program(self, piece: ValuePart) -> LaunchText:
        return self.named(piece)[0]

    def fill_dirname(self, piece: ValuePart) -> LaunchText:
        folder = posixpath.dirname(self.path)
        return known(f"$(find {self.package})" + (f"/{folder}" if folder else ""))

    def fill_filename(self, piece: ValuePart) -> LaunchText:
        return known(f"$(find {self.package})/{self.path}")

    def fill_anon(self, piece: ValuePart) -> LaunchText:
        name, _ = self.named(piece)
        return LaunchText(None, f"{name.shown}_<anonymous>", ("an anonymous name is made up at every start",))

    def fill_command(self, piece: ValuePart) -> LaunchText:
        return unknown(show((piece,)), f"it is {OF_RUNNING[piece.kind]}")

    fill_content = fill_command

    def fill_join(self, piece: ValuePart) -> LaunchText:
        texts: list[LaunchText] = []
        for part in piece.parts:
            text = self.text(part)
            if (text.value is not None and text.value[:1] == "/") or (text.value or "").startswith("$("):
                texts = []
            texts.append(text)
        if not texts:
            return known("")
        done = [t._replace(value=t.value.rstrip("/") if t.value is not None else None, shown=t.shown.rstrip("/"))
                for t in texts[:-1]]  # fmt: skip
        return together([*done, texts[-1]], "/")

    def fill_in(self, piece: ValuePart) -> LaunchText:
        """`in` and `equals`: whether the first is one of the others."""
        texts = [self.text(part) for part in (piece.parts[:2] if piece.kind == "equals" else piece.parts)]
        both = together(texts)
        if both.value is None:
            return both._replace(shown=show((piece,)))
        return known(flag(texts[0].value in [t.value for t in texts[1:]]), both.assumed)

    fill_equals = fill_in

    def fill_not(self, piece: ValuePart) -> LaunchText:
        text = self.text(piece.parts[0]) if piece.parts else known("")
        truth = truth_of(text)
        if truth is None:
            return unknown(show((piece,)), *(text.reasons or (f"`{text.value}` is neither true nor false",)))
        return known(flag(not truth), text.assumed)

    def fill_and(self, piece: ValuePart) -> LaunchText:
        """`and` and `or`: what decides them alone is enough."""
        deciding = piece.kind == "or"
        texts = [self.text(part) for part in piece.parts]
        truths = [truth_of(text) for text in texts]
        for text, truth in zip(texts, truths, strict=True):
            if truth is deciding:
                return known(flag(deciding), text.assumed)
        if None in truths:
            return unknown(show((piece,)), *every(t.reasons for t in texts))
        return known(flag(not deciding), every(t.assumed for t in texts))

    fill_or = fill_and

    def fill_choose(self, piece: ValuePart) -> LaunchText:
        asked = self.text(piece.parts[0])
        truth = truth_of(asked)
        if truth is None:
            yes, no = (self.text(part) for part in piece.parts[1:3])
            if yes.value is not None and yes.value == no.value:
                return yes
            reasons = asked.reasons or (f"`{asked.value}` is neither true nor false",)
            return unknown(f"{yes.shown} or {no.shown}", *reasons)
        text = self.text(piece.parts[1 if truth else 2])
        return text._replace(assumed=every((text.assumed, asked.assumed)))

    def fill_method(self, piece: ValuePart) -> LaunchText:
        texts = [self.text(part) for part in piece.parts]
        both = together(texts)
        if both.value is None:
            return unknown(show((piece,)), *both.reasons)
        try:
            result = text_method(texts[0].value or "", piece.text, [t.value for t in texts[1:]])
        except CannotTell as error:
            return unknown(show((piece,)), str(error))
        return known(flag(result) if isinstance(result, bool) else str(result), both.assumed)

    def fill_rewritten(self, piece: ValuePart) -> LaunchText:
        """A changed parameter file: its name stands for it until it is read."""
        texts = [self.text(part) for part in piece.parts]
        is_text = piece.kind == "replaced"
        source, rest = texts[0], texts[1:] if is_text else texts[2:]
        pairs = tuple(zip(rest[::2], rest[1::2], strict=False))
        rewrite = Rewrite(source, known("") if is_text else texts[1], pairs, is_text)
        name = f"$({piece.kind} {source.shown} {len(self.rewrites)})"
        self.rewrites[name] = rewrite
        return known(name, source.assumed)

    fill_replaced = fill_rewritten

    def fill_has_node(self, piece: ValuePart) -> LaunchText:
        file, node = (self.text(part) for part in piece.parts[:2])
        both = together((file, node))
        entries = self.entries(file.value, 0) if both.value is not None and file.value is not None else None
        if entries is None:
            return unknown(show((piece,)), *(both.reasons or ("the file is not in the workspace",)))
        return known(flag(any(entry.path[:1] == (node.value,) for entry in entries)), both.assumed)

    def fill_eval(self, piece: ValuePart) -> LaunchText:
        expression = self.text(piece.parts[0])
        if expression.value is None:
            return unknown(f"$(eval {expression.shown})", *expression.reasons, assumed=expression.assumed)
        used: list[tuple[str, ...]] = [expression.assumed]

        def read_value(kind: str, name: str, *default: str) -> str:
            text = self.fill_arg(ValuePart(kind, name, tuple(map(literal, default))))
            if text.value is None:
                raise CannotTell(*text.reasons)
            used.append(text.assumed)
            return text.value

        def argument(name: str) -> Any:
            return ros1_value(read_value("arg", name))

        functions: dict[str, Any] = {}
        names: dict[str, Any] = {"pi": math.pi}
        if piece.text == "roslaunch":
            functions = {
                "arg": argument,
                "env": partial(read_value, "env"),
                "optenv": lambda name, default="": read_value("env", name, default),
                "find": lambda package: f"$(find {package})",
                "dirname": lambda: self.fill_dirname(piece).value,
            }
            names |= {"true": True, "false": False}
            names = {name: partial(argument, name) for name in self.scope.arguments} | names
        try:
            result = evaluate(expression.value, names, functions)
        except CannotTell as error:
            return unknown(f"$(eval {expression.value[:80]})", str(error), assumed=every(used))
        return known(str(result), every(used))


OF_RUNNING: dict[str, str] = {
    **dict.fromkeys(("textfile", "binfile", "content"), "the content of a file"),
    "command": "the output of a command",
}
"""What is only known when the launch runs, by the piece or attribute that asks for it."""
_PLACE = re.compile(r"\$\(find ([\w.-]+)\)(/.*|)\Z", re.DOTALL)
_FILLING = methods_of(Filling, "fill_")
# How many parts a piece needs before it can be filled in.
_PARTS = {"executable": 2, "equals": 2, "in": 1, "choose": 3, "method": 1, "rewritten": 2, "replaced": 1, "has-node": 2,
          "eval": 1}  # fmt: skip


def _rewritten(entries: Sequence[ParameterEntry], rewrite: Rewrite) -> tuple[ParameterEntry, ...]:
    """Entries as RewrittenYaml or ReplaceString of nav2_common would leave them."""
    if rewrite.is_text:
        change = _change_of(rewrite.changes)
        return tuple(_replaced(entry, change) for entry in entries)
    changes = {old.value: new for old, new in rewrite.changes if old.value is not None}
    root = (rewrite.root.value,) if rewrite.root.value else ()
    made: list[ParameterEntry] = []
    for entry in entries:
        new = changes.get(".".join(entry.path), changes.get(entry.path[-1] if entry.path else ""))
        value = entry.value
        if new is not None:
            value = scalar(new.value) if new.value else new.shown
        made.append(ParameterEntry((*root, *entry.path), value, entry.line))
    return tuple(made)


def _change_of(changes: tuple[tuple[LaunchText, LaunchText], ...]) -> Callable[[str], str]:
    """What makes these changes in a text. The same keys stand in most entries of a file."""

    @cache
    def change(text: str) -> str:
        for old, new in changes:
            if old.value:
                text = text.replace(old.value, new.value if new.value is not None else new.shown)
        return text

    return change


def _replaced(entry: ParameterEntry, change: Callable[[str], str]) -> ParameterEntry:
    value = entry.value
    if isinstance(value, str):
        # The text is changed before it is read as YAML, so that what comes of it may be a number or a bool.
        changed = change(value)
        value = value if changed == value else scalar(changed)
    elif isinstance(value, list):
        value = [change(item) if isinstance(item, str) else item for item in value]
    path = tuple(filter(None, map(change, entry.path)))
    return ParameterEntry(path, value, entry.line)
