"""Lighter message definitions: the fields that are kept, with all else of the file as it was written."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

from ...edges.console import UserError, escape
from ..facts.interface import PRIMITIVES, TIMES, Field, Section, extract, make_full_name

_PATH = re.compile(r"[A-Za-z]\w*(?:\[[0-9]*\])?(?:\.[A-Za-z]\w*(?:\[[0-9]*\])?)*", re.ASCII)
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_LEVELS = 50
_MARK = "\ufeff"
_NO_UTF8 = re.compile("[\ud800-\udfff]")

Kept = dict[str, "Kept | None"]
"""The fields that are kept of a message, each with what is kept of its own fields; None for all of it."""
FindDefinition = Callable[[str], "bytes | None"]
"""Gives the text of the message `package/Name`, None where it is not known."""


class LightenError(UserError):
    """A definition cannot be made lighter as asked; the text says why and what to do."""


class LightDefinition(NamedTuple):
    """A lighter definition. origin: `package/Name` of the one it is made of. text: of its file. fields: the names of
    those that are kept. dropped: of those that are not."""

    origin: str
    text: bytes
    fields: tuple[str, ...]
    dropped: tuple[str, ...]


class _Written(NamedTuple):
    """A definition as it was written. lines: with their ends. section: its facts, whose places are in lines."""

    mark: str
    lines: list[str]
    section: Section


def lighten(
    find_definition: FindDefinition, origin: str, keep: Iterable[str], name: str = "",
    taken: Mapping[str, bytes] | None = None, package: str = "",
) -> dict[str, LightDefinition]:  # fmt: skip
    """The lighter definition of a message by its new name, followed by those of the messages nested in it that are kept
    in part. All belong into the package of the message, or another.

    origin: `package/Name`. keep: paths of fields, such as `pose.position.x`; of an array of messages, `points.x` (or
    `points[].x`) keeps x of each element. name: of the lighter message, `NameLight` by default. taken: texts of the
    package's other messages by their names: none is replaced by something else. package: that they belong into.

    Fields stay in order. Constants, comments and blank lines stay as they are written, but for the comment right above
    a field that is dropped and that behind it. Only the type of a field that gets another one is written anew.
    Raises LightenError.
    """
    home, _, old_name = origin.rpartition("/")
    package = package or home
    if name and not _NAME.fullmatch(name):
        raise LightenError(f"--name {escape(name)}: is no name of a message; write one such as {old_name}Light")
    kept = _parse_paths(keep)
    if not kept:
        raise LightenError("--keep: names no field; name those to keep, such as `header.stamp,pose.position`")
    maker = _Maker(find_definition, package, name or f"{old_name}Light", taken or {})
    lines, fields, dropped = maker.rewrite(origin, maker.reduce(origin, kept, ""), package)
    own = LightDefinition(origin, lines, fields, dropped)
    replaced = home == package and maker.name == old_name
    if maker.taken.get(maker.name.lower()) not in (None, own.text) and not replaced:
        raise LightenError(f"{maker.name}: there is another message of this name; choose one with --name")
    return {maker.name: own, **maker.made}


def _parse_paths(paths: Iterable[str]) -> Kept:
    kept: Kept = {}
    for path in paths:
        if not _PATH.fullmatch(path):
            raise LightenError(f"--keep {escape(path)}: is no path of a field; write one such as pose.position.x")
        parts = re.sub(r"\[[0-9]*\]", "", path).split(".")
        if len(parts) > _LEVELS:
            raise LightenError(f"--keep {escape(path[:60])}...: has more than {_LEVELS} levels; keep a field above it")
        place = kept
        for part in parts[:-1]:
            inner = place.setdefault(part, {})
            if inner is None:
                break
            place = inner
        else:
            place[parts[-1]] = None
    return kept


class _Maker:
    """Makes the lighter definitions of one message. made: those of nested messages, by their names."""

    def __init__(self, find_definition: FindDefinition, package: str, name: str, taken: Mapping[str, bytes]):
        self.find_definition = find_definition
        self.package = package
        self.name = name
        # Generated files of names that differ in case alone are the same on some machines.
        self.taken = {other.lower(): text for other, text in taken.items()}
        self.made: dict[str, LightDefinition] = {}
        self.read: dict[str, _Written] = {}

    def get_definition(self, full_name: str, path: str) -> _Written:
        """The definition of a message. path: the field that needs it. Raises LightenError."""
        if full_name not in self.read:
            text = self.find_definition(full_name)
            if text is None:
                raise LightenError(
                    f"{path}: the definition of {full_name} is not known; name the folder that has it as well "
                    f"(a workspace, or the share folder of an installation), or keep all of {path}"
                )
            self.read[full_name] = read_definition(text, full_name)
        return self.read[full_name]

    def reduce(self, full_name: str, kept: Kept, path: str) -> Kept:
        """What is kept of a message, with None in place of all that is kept whole. Raises LightenError."""
        fields = {field.name: field for field in self.get_definition(full_name, path).section.fields}
        reduced: Kept = {}
        for name, inner in kept.items():
            place = f"{path}.{name}" if path else name
            field = fields.get(name)
            if field is None:
                near = difflib.get_close_matches(name, fields, 1) if len(fields) < 1_000 else ()
                hint = f"did you mean `{near[0]}`?" if near else f"it has {_list_names(fields)}"
                raise LightenError(f"--keep {place}: {full_name} has no field `{name}`; {hint}")
            reduced[name] = None
            if inner is not None:
                nested = _find_nested(field, full_name)
                if not nested:
                    raise LightenError(f"--keep {place}: is a {field.type}, which has no fields; keep `{place}` itself")
                below = self.reduce(nested, inner, place)
                others = self.get_definition(nested, place).section.fields
                whole = len(below) == len(others) and not any(part is not None for part in below.values())
                reduced[name] = None if whole else below
        return reduced

    def rewrite(self, full_name: str, kept: Kept, package: str) -> tuple[bytes, tuple[str, ...], tuple[str, ...]]:
        """(text, names of the fields kept, of those dropped) of a lighter definition. package: where it is to stand."""
        written = self.get_definition(full_name, "")
        home = full_name.rpartition("/")[0]
        types: dict[int, tuple[Field, str]] = {}
        for field in written.section.fields:
            if field.name not in kept:
                continue
            inner = kept[field.name]
            nested = _find_nested(field, full_name)
            if inner is not None:
                types[field.line - 1] = field, self.name_nested(nested, inner)
            elif nested and home != package and "/" not in field.type:
                types[field.line - 1] = field, nested
        dropped = [field for field in written.section.fields if field.name not in kept]
        lines = list(written.lines)
        for at, (field, type_) in types.items():
            start = field.column - 1
            lines[at] = lines[at][:start] + type_ + lines[at][start + len(field.type) :]
        text = written.mark + "".join(_drop_lines(lines, written.section, dropped))
        names = tuple(field.name for field in written.section.fields if field.name in kept)
        return text.encode("utf-8", "surrogateescape"), names, tuple(field.name for field in dropped)

    def name_nested(self, full_name: str, kept: Kept) -> str:
        """Makes the lighter definition of a nested message, and gives its name; the same for the same fields."""
        text, fields, dropped = self.rewrite(full_name, kept, self.package)
        made = LightDefinition(full_name, text, fields, dropped)
        base = self.name + full_name.rpartition("/")[2]
        name, number = base, 2
        while not self._is_free(name, made):
            name, number = f"{base}{number}", number + 1
        self.made[name] = made
        return name

    def _is_free(self, name: str, made: LightDefinition) -> bool:
        if name.lower() == self.name.lower():
            return False
        mine = {other.lower(): one for other, one in self.made.items()}
        if name.lower() in mine:
            return self.made.get(name) == made
        return self.taken.get(name.lower(), made.text) == made.text


def read_definition(data: bytes, full_name: str) -> _Written:
    """A definition with its lines and facts. Raises LightenError where a part of it cannot be read."""
    if data[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise LightenError(f"{full_name}: is written in UTF-16; save it as UTF-8")
    text = data.decode("utf-8", "surrogateescape")
    mark = _MARK if text.startswith(_MARK) else ""
    text = text.removeprefix(_MARK)
    facts = extract(_NO_UTF8.sub("?", text).encode(), "msg")
    for problem in facts.problems:
        raise LightenError(f"{full_name}, line {problem.line}: {escape(problem.message)}; mend it first")
    section = facts.sections[0]
    seen: set[str] = set()
    for field in section.fields:
        if field.name in seen:
            raise LightenError(f"{full_name}, line {field.line}: a second field `{field.name}`; mend it first")
        seen.add(field.name)
    return _Written(mark, _split_lines(text), section)


def _split_lines(text: str) -> list[str]:
    """Lines with their ends, where nothing but a line feed ends one."""
    lines = [line + "\n" for line in text.split("\n")]
    lines[-1] = lines[-1][:-1]
    return lines if lines[-1] else lines[:-1]


def _find_nested(field: Field, full_name: str) -> str:
    """`package/Name` of the message that a field is made of, or empty. full_name: whose field it is."""
    plain = field.type.partition("<=")[0]
    return "" if plain in PRIMITIVES or plain in TIMES else make_full_name(plain, full_name.rpartition("/")[0])


def _drop_lines(lines: list[str], section: Section, dropped: list[Field]) -> list[str]:
    """The lines without those of some fields, of the comment right above each, and of its annotations. Of two blank
    lines that come together this way, one stays."""
    declared = {each.line - 1 for each in (*section.fields, *section.constants)}
    gone: set[int] = set()
    for field in dropped:
        at = field.line - 1
        gone.add(at)
        joined = True
        while (at := at - 1) >= 0 and at not in declared:
            line = lines[at].strip()
            joined = joined and bool(line)
            if joined or line.startswith("@"):
                gone.add(at)
    kept: list[str] = []
    passed = False
    for at, line in enumerate(lines):
        if at in gone:
            passed = True
        elif not (passed and not line.strip() and (not kept or not kept[-1].strip())):
            kept.append(line)
            passed = False
    return kept


def _list_names(names: Iterable[str]) -> str:
    every = list(names)
    return ", ".join(every[:12]) + (f" and {len(every) - 12} more" if len(every) > 12 else "") or "none"
