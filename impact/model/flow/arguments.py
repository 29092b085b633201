"""The command line as code reads it: `argv[1]`, copies without ROS's own arguments, `argparse`."""

from __future__ import annotations

import argparse
import contextlib
import io
import re
from collections.abc import Iterator, Sequence
from functools import cached_property

from ....edges.groups import group_pairs
from ....edges.memory import cache_method
from ...facts.flow import FlowCall, FlowExpr, Guard
from .code import FlowCode, Fn, find_parameter, get_outer, get_tail, is_number

# Functions that give argv without what is ROS's; those of C++ put it into their third argument or return it.
_COPIES = frozenset(
    ("myargv", "removeROSArgs", "remove_ros_arguments", "remove_ros_args", "init_and_remove_ros_arguments")
)
_COMPARED = re.compile(r"\(?\s*(?:argc|\w*args?\w*\.size\(\))\s*(==|!=|<=|>=|<|>)\s*(\d{1,18})\s*\)?\Z")
# `sys.argv[i] == "-x"`, `std::string(argv[i]) == "-x"`; `strcmp(argv[i], "-x") == 0`, `!strcmp(argv[i], "-x")`
_ELEMENT = r"(?P<list>[A-Za-z_][\w.]*)\[(?P<counter>[A-Za-z_]\w*)\]"
_TEXT = r"""["'](?P<flag>[^"']+)["']"""
_EQUAL = re.compile(rf"\(?(?:(?:std::)?string\(|str\()?{_ELEMENT}\)? == {_TEXT}\)?\Z")
_NOT_DIFFERENT = re.compile(rf"\(?(?P<not>!)?(?:std::)?strcmp\({_ELEMENT}, {_TEXT}\)(?P<zero> == 0)?\)?\Z")
_ALTERNATIVES = re.compile(r" or |\|\|")
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

    def has_own(self, value: FlowExpr, fn: Fn, depth: int = 0) -> bool:
        """Whether a list is argv with what ROS adds to it where a launch starts the program: `--ros-args` in ROS 2, and
        `__name:=` and `__log:=` in ROS 1, whose roscpp takes them out of the argv that it is given."""
        if depth > _DEEPEST:
            return False
        if value.kind in ("make", "keyword", "index", "join") and value.parts:
            return self.has_own(value.parts[0], fn, depth + 1)
        if value.kind != "name":
            return False
        if fn.source.facts.language == "python" and self.code.resolve_name(value.text, fn.source) == "sys.argv":
            return True
        if fn.name == "main" and [parameter.name for parameter in fn.facts.parameters[1:2]] == [value.text]:
            return _has_unfiltered_argv(fn)
        if any(call.arguments[2] == value for call in self._copies.get(fn, ())):
            return False
        written = self.code.list_writes(self.code.identify(value.text, fn))
        return any(
            each.operator == "=" and each.value != value and self.has_own(each.value, writer, depth + 1)
            for writer, each in written
        )

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

    def excludes(self, fn: Fn, guard: int, arguments: Sequence[str]) -> bool:
        """Whether a guard cannot hold with some arguments: by how many there are, or for want of an option."""
        number, more = len(arguments) + 1, _has_unfiltered_argv(fn)
        for one in list_guards(fn, guard):
            held = [_holds(part, number, more) for part in one.text.split("&&")] if "||" not in one.text else [None]
            if (one.kind == "if" and False in held) or (one.kind == "unless" and all(each is True for each in held)):
                return True
        wanted = self._find_flags(fn, guard)
        return wanted is not None and wanted.isdisjoint(arguments)

    @cache_method
    def is_asked(self, fn: Fn, guard: int) -> bool:
        """Whether a guard of a function, or one around it, asks for arguments: how many there are, or for an option."""
        parts = (part for one in list_guards(fn, guard) for part in one.text.split("&&"))
        return any(_COMPARED.match(part.strip()) for part in parts) or self._find_flags(fn, guard) is not None

    def decide_number(self, guard: Guard, fn: Fn, arguments: Sequence[str]) -> bool | None:
        """Whether a guard that asks how many arguments there are holds; None for those that ask something else."""
        if guard.kind not in ("if", "unless"):
            return None
        holds = _holds(guard.text, len(arguments) + 1, _has_unfiltered_argv(fn))
        return not holds if guard.kind == "unless" and holds is not None else holds

    def is_option_given(self, fn: Fn, guard: int, arguments: Sequence[str]) -> bool:
        """Whether a guard holds because an option is among the arguments: `if argv[i] == "-x"`."""
        wanted = self._find_flags(fn, guard)
        return wanted is not None and not wanted.isdisjoint(arguments)

    def list_following(self, index: FlowExpr, fn: Fn, guard: int, arguments: Sequence[str]) -> list[str] | None:
        """The arguments behind an option that a guard has recognised, for an index such as `i + 1`; None where it is
        another index, or no option is recognised by its first part."""
        if index.kind != "join" or index.text not in ("", "+") or len(index.parts) != 2:
            return None
        counter, step = index.parts
        wanted = self._find_flags(fn, guard, counter.text) if counter.kind == "name" and step.kind == "number" else None
        if wanted is None or not is_number(step.text):
            return None
        places = [at + int(step.text) for at, argument in enumerate(arguments) if argument in wanted]
        return [arguments[at] for at in places if at < len(arguments)]

    def _find_flags(self, fn: Fn, guard: int, counter: str = "") -> frozenset[str] | None:
        """The options of which one has been found in argv where a guard holds; None where that is not asked. counter:
        of the place in argv, empty for any."""
        for one in list_guards(fn, guard):
            asked = [_match_flag(part.strip()) for part in _ALTERNATIVES.split(one.text)] if one.kind == "if" else []
            known = [found for found in asked if found is not None and self._is_argument(found, fn)]
            if known and len(known) == len(asked) and all(counter in ("", found["counter"]) for found in known):
                return frozenset(found["flag"] for found in known)
        return None

    def _is_argument(self, found: re.Match[str], fn: Fn) -> bool:
        """Whether what is compared with an option is an element of argv."""
        return self.start(FlowExpr("name", found["list"]), fn) is not None

    # argparse

    def list_parsed_texts(self, path: str, fn: Fn, arguments: Sequence[str] | None) -> Iterator[tuple[str | None, str]]:
        """What `args.topic` is: texts with `given` for those of the command line, and `default`; None for what has no
        text where it is not given.

        arguments: what is given to the program, None where that is not known. Nothing where it is none of argparse's.
        """
        for writer, parser in self._list_parsing(path, fn):
            found = _read(list(self._list_options(parser, writer)), get_tail(path), arguments)
            if found is not None:
                yield found

    @cache_method
    def is_parsed(self, path: str, fn: Fn) -> bool:
        """Whether a path is an argument that argparse reads."""
        return any(self._list_parsing(path, fn))

    def _list_parsing(self, path: str, fn: Fn) -> Iterator[tuple[Fn, str]]:
        """The parsers that may give what a path is a member of, and the functions in which they do."""
        head = get_outer(path)
        if not head or fn.source.facts.language != "python":
            return
        for value, writer in self._list_parsings(head, fn):
            yield writer, get_outer(value.text)

    def _list_parsings(self, path: str, fn: Fn, depth: int = 0) -> Iterator[tuple[FlowExpr, Fn]]:
        """The calls of `parse_args()` whose result a variable keeps, also through a function that returns it, another
        variable, or who gives it for a parameter."""
        variable = self.code.identify(path, fn)
        kept = [(each.value, writer) for writer, each in self.code.list_writes(variable)]
        parameter = find_parameter(fn, path)
        given = self.code.list_given(fn, parameter[0], path) if parameter is not None else ()
        for value, writer in (*kept, *given):
            value = value.parts[0] if value.kind == "index" and value.parts else value
            if value.kind == "name" and (value.text, writer) != (path, fn) and depth < _DEEPEST:
                yield from self._list_parsings(value.text, writer, depth + 1)
            if value.kind != "call":
                continue
            targets = self.code.list_targets(value.text, writer)
            returned = [(a.value, target) for target in targets for a in target.facts.assignments if not a.target]
            for call, place in returned or [(value, writer)]:
                if call.kind == "call" and get_tail(call.text) in ("parse_args", "parse_known_args"):
                    yield call, place

    def _list_options(self, parser: str, fn: Fn) -> Iterator[tuple[tuple[str, ...], dict[str, object]]]:
        """What `parser.add_argument()` is told, as far as it is literal, or a constant."""
        wanted = self.code.identify(parser, fn)
        for call in fn.facts.calls:
            if get_tail(call.callee) not in ("add_argument", "add_option"):
                continue
            if self.code.identify(get_outer(call.callee), fn) != wanted:
                continue
            names = tuple(a.text for a in call.arguments if a.kind == "text")
            kept = ("dest", "default", "nargs", "action")
            keywords = (a for a in call.arguments if a.kind == "keyword" and a.parts and a.text in kept)
            values = {
                keyword.text: _evaluate_literal(self._find_constant(keyword.parts[0], fn)) for keyword in keywords
            }
            yield names, {key: value for key, value in values.items() if value is not None}

    def _find_constant(self, value: FlowExpr, fn: Fn) -> FlowExpr:
        """The value of a constant, where an expression is one that is written once; else the expression."""
        if value.kind != "name":
            return value
        written = self.code.list_writes(self.code.identify(value.text, fn))
        only = written[0][1] if len(written) == 1 else None
        return only.value if only is not None and only.guard < 0 and only.operator == "=" else value


def list_guards(fn: Fn, guard: int) -> Iterator[Guard]:
    """A guard of a function, by its place, and those around it."""
    for _ in range(64):
        if not 0 <= guard < len(fn.facts.guards):
            return
        yield fn.facts.guards[guard]
        guard = fn.facts.guards[guard].outer


def _match_flag(text: str) -> re.Match[str] | None:
    """A comparison of an element with an option, by its parts; None for what is none."""
    found = _NOT_DIFFERENT.match(text)
    return _EQUAL.match(text) if found is None else found if (found["not"] is None) == bool(found["zero"]) else None


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


def _read(options, name: str, arguments: Sequence[str] | None) -> tuple[str | None, str] | None:
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    for names, keywords in options:
        # What cannot be built of literals is left out.
        with contextlib.suppress(Exception):
            parser.add_argument(*names, **keywords)
    known = [action.default for action in parser._actions if action.dest == name]
    default = known[0] if known else None
    if arguments is not None:
        with contextlib.redirect_stderr(io.StringIO()), contextlib.suppress(SystemExit, Exception):
            value = getattr(parser.parse_known_args(list(arguments))[0], name, None)
            if isinstance(value, str):
                return value, "default" if value == default and value not in arguments else "given"
    return (default, "default") if isinstance(default, str) or (known and default is None) else None


def _has_unfiltered_argv(fn: Fn) -> bool:
    """Whether a function's argv has what ROS adds to it: `rclcpp::init` leaves it there, and `ros::init` does not."""
    return fn.name == "main" and any(call.callee.endswith("rclcpp::init") for call in fn.facts.calls)


def _holds(text: str, number: int, more: bool = False) -> bool | None:
    """Whether a comparison of argc holds; None for what is none. more: ROS adds at least one to the number."""
    found = _COMPARED.match(text.strip())
    if found is None:
        return None
    other = int(found[2])
    if more and "argc" in text:
        # So many, or more of them.
        least = number + 1
        sure = {">": least > other, ">=": least >= other, "!=": least > other}
        never = {"<": least >= other, "<=": least > other, "==": least > other}
        return True if sure.get(found[1]) else False if never.get(found[1]) else None
    return {
        "==": number == other, "!=": number != other, "<": number < other, ">": number > other,
        "<=": number <= other, ">=": number >= other,
    }[found[1]]  # fmt: skip
