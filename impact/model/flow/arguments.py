"""The command line as code reads it: `argv[1]`, copies without ROS's own arguments, `argparse`."""

from __future__ import annotations

import argparse
import contextlib
import io
import re
from collections.abc import Iterator, Sequence
from functools import cached_property

from ....edges.groups import group_pairs
from ...facts.flow import FlowCall, FlowExpr
from .code import FlowCode, Fn, get_outer, get_tail, is_number

# Functions that give argv without what is ROS's; those of C++ put it into their third argument or return it.
_COPIES = frozenset(
    ("myargv", "removeROSArgs", "remove_ros_arguments", "remove_ros_args", "init_and_remove_ros_arguments")
)
_COMPARED = re.compile(r"\(?\s*(?:argc|\w*args?\w*\.size\(\))\s*(==|!=|<=|>=|<|>)\s*(\d{1,18})\s*\)?\Z")
_DEEPEST = 5


class CommandLine:
    """Which expressions of a body of code are the command line, or of it."""

    def __init__(self, code: FlowCode):
        self.code = code

    def start(self, value: FlowExpr, fn: Fn, depth: int = 0) -> int | None:
        """The place in argv at which the list that an expression is begins: 0 for argv itself; None for other lists."""
        if depth > _DEEPEST:
            return None
        if value.kind in ("make", "keyword") and value.parts:
            # `std::vector<std::string> args(argv + 1, argv + argc)`
            return self.start(value.parts[0], fn, depth + 1)
        if value.kind == "index" and len(value.parts) == 2 and value.parts[1].kind == "other":
            first, colon, last = value.parts[1].text.partition(":")
            begun = self.start(value.parts[0], fn, depth + 1) if colon and not last.strip() else None
            return None if begun is None or not is_number(first.strip() or "0") else begun + int(first.strip() or 0)
        if value.kind == "join" and len(value.parts) == 2 and value.parts[1].kind == "number":
            begun = self.start(value.parts[0], fn, depth + 1)
            return begun + int(value.parts[1].text) if begun is not None and is_number(value.parts[1].text) else None
        if value.kind == "call":
            return 0 if get_tail(value.text) in _COPIES else None
        if value.kind != "name":
            return None
        if fn.source.facts.language == "python" and self.code.resolve_name(value.text, fn.source) == "sys.argv":
            return 0
        if fn.name == "main" and [parameter.name for parameter in fn.facts.parameters[1:2]] == [value.text]:
            return 0
        variable = self.code.identify(value.text, fn)
        if any(call.arguments[2] == value for call in self._copies.get(fn, ())):
            return 0
        for writer, each in self.code.list_writes(variable):
            if each.value != value and each.operator == "=":
                begun = self.start(each.value, writer, depth + 1)
                if begun is not None:
                    return begun
        return None

    @cached_property
    def _copies(self) -> dict[Fn, list[FlowCall]]:
        """Calls that put a copy of argv into their third argument, by the function they stand in."""
        return group_pairs((fn, call) for fn, call in self.code.list_calls_named(_COPIES) if len(call.arguments) == 3)

    def find_places(self, container: FlowExpr, index: FlowExpr, fn: Fn) -> range | None:
        """The places of argv that an element may be of, None for what is no element of it; open ended where the index
        is not a number."""
        begun = self.start(container, fn)
        if begun is None:
            return None
        if index.kind == "number":
            if not is_number(index.text):
                return None
            return range(begun + int(index.text), begun + int(index.text) + 1)
        first = 0
        if index.kind == "name":
            for _, each in self.code.list_writes(self.code.identify(index.text, fn)):
                if each.operator == "=" and each.value.kind == "number" and is_number(each.value.text):
                    first = int(each.value.text)
                    break
        return range(begun + first, 10_000)

    def excludes(self, fn: Fn, guard: int, number: int) -> bool:
        """Whether a guard cannot hold with argc being number."""
        guards, seen = fn.facts.guards, 0
        while 0 <= guard < len(guards) and seen < 64:
            one = guards[guard]
            held = [_holds(part, number) for part in one.text.split("&&")] if "||" not in one.text else [None]
            if (one.kind == "if" and False in held) or (one.kind == "unless" and all(each is True for each in held)):
                return True
            guard, seen = one.outer, seen + 1
        return False

    # argparse

    def list_parsed_texts(self, path: str, fn: Fn, arguments: Sequence[str] | None) -> Iterator[tuple[str, str]]:
        """What `args.topic` is: texts with `given` for those of the command line, and `default`.

        arguments: what is given to the program, None where that is not known. Nothing where it is none of argparse's.
        """
        for writer, parser in self._list_parsing(path, fn):
            found = _read(list(self._list_options(parser, writer)), get_tail(path), arguments)
            if found is not None:
                yield found

    def is_parsed(self, path: str, fn: Fn) -> bool:
        """Whether a path is an argument that argparse reads."""
        return any(self._list_parsing(path, fn))

    def _list_parsing(self, path: str, fn: Fn) -> Iterator[tuple[Fn, str]]:
        """The parsers that may give what a path is a member of, and the functions in which they do."""
        head = get_outer(path)
        if not head or fn.source.facts.language != "python":
            return
        for writer, each in self.code.list_writes(self.code.identify(head, fn)):
            value = each.value.parts[0] if each.value.kind == "index" and each.value.parts else each.value
            if value.kind == "call" and get_tail(value.text) in ("parse_args", "parse_known_args"):
                yield writer, get_outer(value.text)

    def _list_options(self, parser: str, fn: Fn) -> Iterator[tuple[tuple[str, ...], dict[str, object]]]:
        """What `parser.add_argument()` is told, as far as it is literal."""
        wanted = self.code.identify(parser, fn)
        for call in fn.facts.calls:
            if get_tail(call.callee) not in ("add_argument", "add_option"):
                continue
            if self.code.identify(get_outer(call.callee), fn) != wanted:
                continue
            names = tuple(a.text for a in call.arguments if a.kind == "text")
            kept = ("dest", "default", "nargs", "action")
            keywords = (a for a in call.arguments if a.kind == "keyword" and a.parts and a.text in kept)
            values = {keyword.text: _evaluate_literal(keyword.parts[0]) for keyword in keywords}
            yield names, {key: value for key, value in values.items() if value is not None}


def _evaluate_literal(value: FlowExpr) -> object:
    if value.kind == "text":
        return value.text
    if value.kind == "number":
        named = {"True": True, "False": False, "None": None}
        if value.text in named:
            return named[value.text]
        with contextlib.suppress(ValueError):
            return int(value.text)
        with contextlib.suppress(ValueError):
            return float(value.text)
    if value.kind == "list":
        return [_evaluate_literal(part) for part in value.parts]
    return None


def _read(options, name: str, arguments: Sequence[str] | None) -> tuple[str, str] | None:
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    for names, keywords in options:
        # What cannot be built of literals is left out.
        with contextlib.suppress(Exception):
            parser.add_argument(*names, **keywords)
    default = next((action.default for action in parser._actions if action.dest == name), None)
    if arguments is not None:
        with contextlib.redirect_stderr(io.StringIO()), contextlib.suppress(SystemExit, Exception):
            value = getattr(parser.parse_known_args(list(arguments))[0], name, None)
            if isinstance(value, str):
                return value, "default" if value == default and value not in arguments else "given"
    return (default, "default") if isinstance(default, str) else None


def _holds(text: str, number: int) -> bool | None:
    """Whether a comparison of argc holds; None for what is none."""
    found = _COMPARED.match(text.strip())
    if found is None:
        return None
    other = int(found[2])
    return {
        "==": number == other, "!=": number != other, "<": number < other, ">": number > other,
        "<=": number <= other, ">=": number >= other,
    }[found[1]]  # fmt: skip
