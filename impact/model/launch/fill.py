"""Substitutions of a launch filled in where it stands, and the parameter files it names, changed as it asks."""

from __future__ import annotations

import math
import posixpath
import re
from collections.abc import Callable, Sequence
from functools import cache, partial
from typing import Any, NamedTuple

import msgspec

from ....edges.dispatch import collect_methods
from ...facts.launch.actions import Action, Value, ValuePart, make_literal
from ...facts.launch.flow import parse_substitutions
from ...facts.launch.parameter_files import ParameterEntry, parse_scalar
from .result import LaunchParameter, LaunchSources, Remap, SettingFile, ShareLine
from .text import (
    CannotTell,
    LaunchText,
    call_text_method,
    evaluate,
    format_flag,
    join_texts,
    make_either,
    make_unknown,
    merge_reasons,
    parse_ros1_value,
    parse_truth,
    parse_yaml_value,
    show,
    wrap,
)


class ActionScope(msgspec.Struct, eq=False):
    """What holds where an action runs. open: how many undecided conditions stood when it began. maybe: values of
    arguments that may not have been set."""

    arguments: dict[str, LaunchText]
    environment: dict[str, LaunchText]
    open: int
    namespace: LaunchText = wrap("")
    remaps: list[Remap] = []
    settings: list[LaunchParameter | SettingFile] = []
    private: list[Action] = []
    maybe: dict[str, LaunchText] = {}

    def make_inner(self, open_: int) -> ActionScope:
        """A copy, whose changes do not reach this one."""
        return ActionScope(
            dict(self.arguments), dict(self.environment), open_, self.namespace, list(self.remaps),
            list(self.settings), list(self.private), dict(self.maybe),
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
    places of those that hold a substitution, and all of them by what those are filled in as; texts: those entries, and
    the places of them by the keys and texts that stand in them."""

    def __init__(self) -> None:
        self.texts: dict[int, tuple[tuple[ParameterEntry, ...], dict[str, list[int]]]] = {}
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
        # Those that are read, or would be if they were there.
        self.parameter_files: dict[tuple[str, str], None] = {}

    def locate_line(self, line: int) -> ShareLine:
        return ShareLine(self.package, self.path, line)

    def substitute_entries(self, entries: tuple[ParameterEntry, ...]) -> tuple[ParameterEntry, ...]:
        """Entries whose keys or values may hold substitutions, filled in where that can be done."""
        known = self.changed.filled.get(id(entries))
        if known is None:
            places = [at for at, entry in enumerate(entries) if _holds_substitution(entry)]
            known = self.changed.filled[id(entries)] = entries, places, {"[]": entries}
        _, places, made = known
        filled = [self._substitute_entry(entries[at]) for at in places]
        # Values that cannot be hashed are told apart by how they are written, and so are 1 and True.
        written = repr(filled)
        if written not in made:
            changed = list(entries)
            for at, entry in zip(places, filled, strict=True):
                changed[at] = entry
            made[written] = tuple(changed)
        return made[written]

    def _substitute_entry(self, entry: ParameterEntry) -> ParameterEntry:
        path = tuple(self.substitute_text(part) if "$(" in part else part for part in entry.path)
        return ParameterEntry(path, self.substitute_value(entry.value), entry.line)

    def substitute_text(self, text: str) -> str:
        made = self.fill(parse_substitutions(text, self.generation))
        return text if made.value is None else made.value

    def substitute_value(self, value: Any) -> Any:
        if isinstance(value, str) and "$(" in value:
            return parse_yaml_value(self.substitute_text(value))
        if isinstance(value, list):
            return [self.substitute_value(item) for item in value]
        if isinstance(value, dict):
            return {self.substitute_text(key): self.substitute_value(item) for key, item in value.items()}
        return value

    def read_entries(self, file: str) -> tuple[ParameterEntry, ...] | None:
        """The entries of a parameter file, changed as it is before it is read; None where it cannot be had."""
        rewrite = self.rewrites.get(file)
        if rewrite is not None:
            entries = self.read_entries(rewrite.source.value) if rewrite.source.value is not None else None
            return None if entries is None else self._rewrite_shared(entries, rewrite)
        place = self.split_share_path(file)
        if place is None:
            return None
        self.parameter_files[place] = None
        found = self.sources.find_parameter_file(*place)
        return None if found is None else found.entries

    def find_source(self, file: str) -> tuple[str, str] | None:
        """Package and path of the file that the entries of a parameter file come from."""
        rewrite = self.rewrites.get(file)
        if rewrite is not None:
            return self.find_source(rewrite.source.value) if rewrite.source.value is not None else None
        return self.split_share_path(file)

    def _rewrite_shared(self, entries: tuple[ParameterEntry, ...], rewrite: Rewrite) -> tuple[ParameterEntry, ...]:
        """The same for all nodes that are given one file with one rewrite."""
        key = id(entries), rewrite
        known = self.changed.rewritten.get(key)
        if known is None:
            made = self._replace_texts(entries, rewrite) if rewrite.is_text else _rewrite_entries(entries, rewrite)
            known = self.changed.rewritten[key] = entries, made
        return known[1]

    def _replace_texts(self, entries: tuple[ParameterEntry, ...], rewrite: Rewrite) -> tuple[ParameterEntry, ...]:
        """Entries as ReplaceString of nav2_common would leave them."""
        known = self.changed.texts.get(id(entries))
        if known is None:
            known = self.changed.texts[id(entries)] = entries, _index_texts(entries)
        change = _make_change(rewrite.changes)
        # A key that is empty is left out.
        changed = (places for text, places in known[1].items() if not text or change(text) != text)
        made = list(entries)
        for at in {at for places in changed for at in places}:
            made[at] = _replace_in_entry(entries[at], change)
        return tuple(made)

    def split_share_path(self, path: str) -> tuple[str, str] | None:
        """Package and path in it of a file below a package's share folder."""
        m = _PLACE.match(path)
        if m is None:
            return None
        inner = posixpath.normpath(m[2].lstrip("/")) if m[2].strip("/") else ""
        return None if inner.startswith("..") or not inner else (m[1], inner)

    def fill(self, value: Value) -> LaunchText:
        """A value with its substitutions filled in."""
        if len(value) == 1:
            return self.evaluate_piece(value[0])
        return join_texts([self.evaluate_piece(piece) for piece in value])

    def evaluate_piece(self, piece: ValuePart) -> LaunchText:
        if piece.kind == "text":
            return wrap(piece.text)
        if piece.kind == "other":
            return make_unknown(piece.text, "it is only known when it runs")
        maker = _FILLING.get(piece.kind.replace("-", "_"))
        if maker is None or len(piece.parts) < _PARTS.get(piece.kind, 0):
            return make_unknown(piece.kind, f"`{piece.kind}` is not filled in")
        text = maker(self, piece)
        return text if text.chosen or not self._is_chosen(piece) else text._replace(chosen=True)

    def _is_chosen(self, piece: ValuePart) -> bool:
        """Whether a launch argument of a substitution has its default, as LaunchText has it."""
        if piece.kind == "arg":
            text = self.scope.arguments.get(self.evaluate_named(piece)[0].value or "")
            return text is not None and text.chosen
        return any(self._is_chosen(inner) for part in piece.parts for inner in part)

    def evaluate_named(self, piece: ValuePart) -> tuple[LaunchText, tuple[Value, ...]]:
        """A piece's name, and its other parts."""
        if piece.text:
            return wrap(piece.text), piece.parts
        return (self.fill(piece.parts[0]), piece.parts[1:]) if piece.parts else (wrap(""), ())

    def fill_arg(self, piece: ValuePart) -> LaunchText:
        """A launch argument or an environment variable."""
        name, rest = self.evaluate_named(piece)
        if name.value is None:
            return make_unknown(name.shown, *name.reasons)
        is_argument = piece.kind == "arg"
        text = (self.scope.arguments if is_argument else self.scope.environment).get(name.value)
        if text is not None:
            return text
        if rest:
            return self.fill(rest[0])
        if is_argument:
            return make_unknown(name.value, f"argument `{name.value}` has no value")
        return make_unknown(f"${name.value}", f"the environment variable `{name.value}` is not known")

    fill_env = fill_arg

    def fill_find(self, piece: ValuePart) -> LaunchText:
        name, _ = self.evaluate_named(piece)
        if name.value is None:
            return make_unknown(f"$({piece.kind} {name.shown})", *name.reasons)
        return wrap(f"$({piece.kind} {name.value})")

    fill_prefix = fill_find

    def fill_executable(self, piece: ValuePart) -> LaunchText:
        name, package = (self.fill(part) for part in piece.parts[:2])
        return join_texts((wrap("$(prefix "), package, wrap(")/lib/"), package, wrap("/"), name))

    def fill_program(self, piece: ValuePart) -> LaunchText:
        return self.evaluate_named(piece)[0]

    def fill_dirname(self, piece: ValuePart) -> LaunchText:
        folder = posixpath.dirname(self.path)
        return wrap(f"$(find {self.package})" + (f"/{folder}" if folder else ""))

    def fill_filename(self, piece: ValuePart) -> LaunchText:
        return wrap(f"$(find {self.package})/{self.path}")

    def fill_anon(self, piece: ValuePart) -> LaunchText:
        name, _ = self.evaluate_named(piece)
        return LaunchText(None, f"{name.shown}_<anonymous>", ("an anonymous name is made up at every start",))

    def fill_command(self, piece: ValuePart) -> LaunchText:
        parts = " ".join(self.fill(part).shown for part in piece.parts)
        return make_unknown(f"$({piece.kind} {parts})", f"it is {OF_RUNNING[piece.kind]}")

    fill_content = fill_command

    def fill_join(self, piece: ValuePart) -> LaunchText:
        texts: list[LaunchText] = []
        for part in piece.parts:
            text = self.fill(part)
            if (text.value is not None and text.value[:1] == "/") or (text.value or "").startswith("$("):
                texts = []
            texts.append(text)
        if not texts:
            return wrap("")
        done = [t._replace(value=t.value.rstrip("/") if t.value is not None else None, shown=t.shown.rstrip("/"))
                for t in texts[:-1]]  # fmt: skip
        return join_texts([*done, texts[-1]], "/")

    def fill_in(self, piece: ValuePart) -> LaunchText:
        """`in` and `equals`: whether the first is one of the others."""
        texts = [self.fill(part) for part in (piece.parts[:2] if piece.kind == "equals" else piece.parts)]
        both = join_texts(texts)
        if both.value is None:
            return both._replace(shown=show((piece,)))
        return wrap(format_flag(texts[0].value in [t.value for t in texts[1:]]))

    fill_equals = fill_in

    def fill_not(self, piece: ValuePart) -> LaunchText:
        text = self.fill(piece.parts[0]) if piece.parts else wrap("")
        truth = parse_truth(text)
        if truth is None:
            return make_unknown(show((piece,)), *(text.reasons or (f"`{text.value}` is neither true nor false",)))
        return wrap(format_flag(not truth))

    def fill_and(self, piece: ValuePart) -> LaunchText:
        """`and` and `or`: what decides them alone is enough."""
        deciding = piece.kind == "or"
        texts = [self.fill(part) for part in piece.parts]
        truths = [parse_truth(text) for text in texts]
        if deciding not in truths and None in truths:
            return make_unknown(show((piece,)), *merge_reasons(t.reasons for t in texts))
        return wrap(format_flag(deciding == (deciding in truths)))

    fill_or = fill_and

    def fill_choose(self, piece: ValuePart) -> LaunchText:
        asked = self.fill(piece.parts[0])
        truth = parse_truth(asked)
        if truth is None:
            yes, no = (self.fill(part) for part in piece.parts[1:3])
            if yes.value is not None and yes.value == no.value:
                return yes
            reasons = asked.reasons or (f"`{asked.value}` is neither true nor false",)
            return make_either(yes.shown, no.shown, *reasons)
        return self.fill(piece.parts[1 if truth else 2])

    def fill_method(self, piece: ValuePart) -> LaunchText:
        texts = [self.fill(part) for part in piece.parts]
        both = join_texts(texts)
        if both.value is None:
            return make_unknown(show((piece,)), *both.reasons)
        try:
            result = call_text_method(texts[0].value or "", piece.text, [t.value for t in texts[1:]])
        except CannotTell as error:
            return make_unknown(show((piece,)), str(error))
        return wrap(format_flag(result) if isinstance(result, bool) else str(result))

    def fill_rewritten(self, piece: ValuePart) -> LaunchText:
        """A changed parameter file: its name stands for it until it is read."""
        texts = [self.fill(part) for part in piece.parts]
        is_text = piece.kind == "replaced"
        source, rest = texts[0], texts[1:] if is_text else texts[2:]
        pairs = tuple(zip(rest[::2], rest[1::2], strict=False))
        rewrite = Rewrite(source, wrap("") if is_text else texts[1], pairs, is_text)
        name = f"$({piece.kind} {source.shown} {len(self.rewrites)})"
        self.rewrites[name] = rewrite
        return wrap(name)

    fill_replaced = fill_rewritten

    def fill_has_node(self, piece: ValuePart) -> LaunchText:
        file, node = (self.fill(part) for part in piece.parts[:2])
        both = join_texts((file, node))
        entries = self.read_entries(file.value) if both.value is not None and file.value is not None else None
        if entries is None:
            return make_unknown(show((piece,)), *(both.reasons or ("the file is not in the workspace",)))
        return wrap(format_flag(any(entry.path[:1] == (node.value,) for entry in entries)))

    def fill_yaml(self, piece: ValuePart) -> LaunchText:
        """What a YAML file that the launch file reads holds at some keys: a text or a number."""
        texts = [self.fill(part) for part in piece.parts]
        reasons = merge_reasons(text.reasons for text in texts)
        entries = self.read_entries(texts[0].value) if texts[0].value is not None and not reasons else None
        path = tuple(text.value for text in texts[1:])
        found = [entry.value for entry in entries or () if entry.path == path]
        if not found or not isinstance(found[-1], (str, int, float)) or isinstance(found[-1], bool):
            return make_unknown(show((piece,)), *(reasons or ("what a YAML file holds there is not known",)))
        return wrap(str(found[-1]))

    def fill_eval(self, piece: ValuePart) -> LaunchText:
        expression = self.fill(piece.parts[0])
        if expression.value is None:
            return make_unknown(f"$(eval {expression.shown})", *expression.reasons)

        def read_value(kind: str, name: str, *default: str) -> str:
            text = self.fill_arg(ValuePart(kind, name, tuple(map(make_literal, default))))
            if text.value is None:
                raise CannotTell(*text.reasons)
            return text.value

        def read_argument(name: str) -> Any:
            return parse_ros1_value(read_value("arg", name))

        functions: dict[str, Any] = {}
        names: dict[str, Any] = {"pi": math.pi}
        if piece.text == "roslaunch":
            functions = {
                "arg": read_argument,
                "env": partial(read_value, "env"),
                "optenv": lambda name, default="": read_value("env", name, default),
                "find": lambda package: f"$(find {package})",
                "dirname": lambda: self.fill_dirname(piece).value,
            }
            names |= {"true": True, "false": False}
            names = {name: partial(read_argument, name) for name in self.scope.arguments} | names
        try:
            result = evaluate(expression.value, names, functions)
        except CannotTell as error:
            return make_unknown(f"$(eval {expression.value[:80]})", str(error))
        return wrap(str(result))


OF_RUNNING: dict[str, str] = {
    **dict.fromkeys(("textfile", "binfile", "content"), "the content of a file"),
    "command": "the output of a command",
}
"""What is only known when the launch runs, by the piece or attribute that asks for it."""
_PLACE = re.compile(r"\$\(find ([\w.-]+)\)(/.*|)\Z", re.DOTALL)
_FILLING = collect_methods(Filling, "fill_")
# How many parts a piece needs before it can be filled in.
_PARTS = {"executable": 2, "equals": 2, "in": 1, "choose": 3, "method": 1, "rewritten": 2, "replaced": 1, "yaml": 2,
          "has-node": 2, "eval": 1}  # fmt: skip


def _rewrite_entries(entries: Sequence[ParameterEntry], rewrite: Rewrite) -> tuple[ParameterEntry, ...]:
    """Entries as RewrittenYaml of nav2_common would leave them."""
    changes = {old.value: new for old, new in rewrite.changes if old.value is not None}
    root = (rewrite.root.value,) if rewrite.root.value else ()
    made: list[ParameterEntry] = []
    for entry in entries:
        new = changes.get(".".join(entry.path), changes.get(entry.path[-1] if entry.path else ""))
        if new is None and not root:
            made.append(entry)
            continue
        value = entry.value
        if new is not None:
            value = parse_scalar(new.value) if new.value else new.shown
        made.append(ParameterEntry((*root, *entry.path), value, entry.line))
    return tuple(made)


def _holds_substitution(entry: ParameterEntry) -> bool:
    """Whether a key or the value of an entry may hold a substitution."""
    value = entry.value
    written = value if isinstance(value, str) else str(value) if isinstance(value, (list, dict)) else ""
    return "$(" in written or any("$(" in part for part in entry.path)


def _index_texts(entries: Sequence[ParameterEntry]) -> dict[str, list[int]]:
    """The places of entries by the keys and texts that stand in them."""
    found: dict[str, list[int]] = {}
    for at, entry in enumerate(entries):
        value = entry.value
        texts = value if isinstance(value, list) else (value,)
        for text in (*entry.path, *texts):
            if isinstance(text, str):
                found.setdefault(text, []).append(at)
    return found


def _make_change(changes: tuple[tuple[LaunchText, LaunchText], ...]) -> Callable[[str], str]:
    """What makes these changes in a text. The same keys stand in most entries of a file."""

    @cache
    def change(text: str) -> str:
        for old, new in changes:
            if old.value:
                text = text.replace(old.value, new.value if new.value is not None else new.shown)
        return text

    return change


def _replace_in_entry(entry: ParameterEntry, change: Callable[[str], str]) -> ParameterEntry:
    value = entry.value
    if isinstance(value, str):
        # The text is changed before it is read as YAML, so that what comes of it may be a number or a bool.
        changed = change(value)
        value = value if changed == value else parse_scalar(changed)
    elif isinstance(value, list):
        value = [change(item) if isinstance(item, str) else item for item in value]
    path = tuple(filter(None, map(change, entry.path)))
    return ParameterEntry(path, value, entry.line)
