"""What guards mean: local variables and predicates in them put back into what they stand for.

A condition that was given a name, or moved into a function that returns it, is then the same condition as before.
"""

import re
from collections.abc import Sequence
from functools import cached_property

from ...edges.memory import cache_method
from ..facts.flow import Assignment, DataMember, FlowCall, FlowExpr
from ..model.flow.code import FlowCode, Fn, Variable, find_argument, get_tail
from ..model.flow.endpoints import unparse
from ..model.flow.graph import GuardAt
from .guard_terms import split_outside
from .periods import parse_period

_DEEPEST = 3
_LONGEST = 1000
_CUT = 119
"""An expression as long as this may have been cut off when it was read."""
_IDENTIFIER = re.compile(r"(?<![\w.>:\"'])(?:(?:this->|self\.)?)([A-Za-z_]\w*)(?![\w:\"'])")
_PATH = re.compile(r"(?:this->|self\.)?[A-Za-z_]\w*(?:(?:\.|->)[A-Za-z_]\w*)+(?=\()")
_WORD = re.compile(r"[A-Za-z_]\w*")
_CALL = re.compile(r"\w\s*\(")
_PLAIN = re.compile(r"[\w.:]+(\(\))?")
_OBJECT = re.compile(r"(?:this->)?[A-Za-z_][\w.:]*(?:->\w+)*(?:\([^()]*\))?")
_FOLLOWS = re.compile(r"\.|->|\[")
_UNNAMED = re.compile(r"\[\]|lambda|\{")
_MAY_BE_CONSTANT = re.compile(r"k[A-Z]\w*|[A-Z][A-Z\d_]*|\w*[A-Z]\w*")
_NUMBER = re.compile(r"-?[\d.][\w.]*")
_LITERALS = frozenset(("true", "false", "True", "False", "None", "nullptr", "NULL"))
_EQUATED_AFTER = re.compile(r"\s*[!=]=")
_EQUATED_BEFORE = re.compile(r"[!=]=\s*(?:[\w:.]*(?:::|\.|->))?$|\bcase\s*$")
_CASE_MARKS = (" other than ", " == ")
_NOTHING = frozenset(("None", "nullptr", "NULL", "std::nullopt", "boost::none"))
_OPTIONAL = re.compile(r"\boptional\s*<")
_BRANCHES = frozenset(("if", "unless"))
_PRIMITIVE = frozenset(("bool", "int", "unsigned", "size_t", "float", "double", "char", "long", "short"))
_MOST_RETURNS = 6
_LONGEST_GIVEN = 200
_WORDS = frozenset(
    ("and", "or", "not", "is", "in", "true", "false", "True", "False", "None", "nullptr", "NULL", "this")
)  # fmt: skip

PARAMETER = "__parameter"
"""What stands between the name of a parameter and its place."""
Given = tuple[tuple[str, str], ...]
"""Parameters of a function, each with what it is."""
Asked = tuple[tuple[int, str], ...]
"""Parameters by their places, with their names."""


class Meaning:
    """Meanings of guards in a body of code."""

    def __init__(self, code: FlowCode):
        self.code = code
        # The names that were put back for the guard that is looked at, in order.
        self._used: dict[str, None] = {}

    @cache_method
    def resolve_guard(self, guard: GuardAt) -> tuple[str, tuple[str, ...]]:
        """What a guard's text means, empty when that is what it says; and the names that were put back for it."""
        fn = self.code.by_name.get((guard.path, guard.of))
        if guard.kind not in ("if", "unless", "while", "case") or fn is None:
            return "", ()
        self._used.clear()
        mark = next((mark for mark in _CASE_MARKS if mark in guard.text), "") if guard.kind == "case" else ""
        asked, _, values = guard.text.partition(mark) if mark else (guard.text, "", "")
        found = f"{self._expand_text(asked, fn, 0, guard.line)}{mark}{values}"
        return (found, tuple(self._used)) if found != guard.text and len(found) <= _LONGEST else ("", ())

    def resolve_text(self, text: str, fn: Fn, line: int) -> str:
        """What an expression at a line of a function means."""
        found = self._expand_text(text, fn, 0, line)
        return found[1:-1] if found[:1] == "(" and _find_closing(found, 0) == len(found) - 1 else found

    @cache_method
    def mark_parameters(self, fn: Fn) -> Given:
        """The parameters of a function that something outside the code calls, each with its place behind the name: what
        they are called does not matter."""
        rows = fn.facts.parameters
        return tuple(
            (one.name, f"{one.name}{PARAMETER}{place}")
            for place, one in enumerate(rows)
            if one.name.isidentifier() and one.name not in fn.assigned
        )

    def resolve_arguments(self, call: FlowCall, caller: Fn, callee: Fn, asked: Asked, given: Given) -> Given:
        """What parameters of a function are on a call. asked: their places and names; given: what those of the caller
        are."""
        python = caller.source.facts.language == "python"
        found: list[tuple[str, str]] = []
        for place, name in asked:
            if name in callee.assigned or any(
                one.path == name and one.kind == "write" for one in callee.facts.accesses
            ):
                continue
            value, fn = find_argument(call.arguments, place, name), caller
            if value is None:
                value, fn = self.code.find_default(callee, place, callee.facts.parameters[place]), callee
            text = format_expression(value, python, fn, call.line) if value is not None else None
            if not text or _UNNAMED.search(text):
                continue
            constant = value is not None and value.kind == "name" and self._find_constant(text, fn) is not None
            if fn is caller and not constant:
                text = put_given(self._expand_text(text, caller, 1, call.line), given)
            if len(text) <= _LONGEST_GIVEN:
                found.append((name, text if _PLAIN.fullmatch(text) else f"({text})"))
        return tuple(found)

    def _expand_text(self, text: str, fn: Fn, depth: int, line: int) -> str:
        """A text of a function with names put back. line: where it stands."""
        if depth >= _DEEPEST or len(text) > _LONGEST:
            return text
        python = fn.source.facts.language == "python"
        parts: list[str] = []
        position = 0
        for match in _IDENTIFIER.finditer(text):
            if match.start() < position:
                continue
            end = match.end()
            path = _PATH.match(text, match.start())
            if path or text[end : end + 1] == "(":
                end = path.end() if path else end
                close = _find_closing(text, end)
                callee = text[match.start() : end]
                value = self._expand_predicate(callee, text[end + 1 : close], fn, depth) if close else None
                end = close + 1
            elif match[0] != match[1]:
                value = (
                    self._expand_predicate(match[0], "", fn, depth) if python and match[1] in self._getters else None
                )
            else:
                value = self._find_local_value(match[1], fn, depth, line)
                follows = _FOLLOWS.match(text, end)
                if follows and (value is None or follows[0] == "[" or not _OBJECT.fullmatch(value)):
                    value = None
            if value is None and not path and text[end - 1] != ")" and not _is_equated(text, match.start(), end):
                value = self._find_constant(match[0], fn)
            if value is None:
                continue
            self._used[get_tail(text[match.start() : end].partition("(")[0].replace("->", "."))] = None
            parts += (text[position : match.start()], value)
            position = end
        return "".join((*parts, text[position:]))

    @cached_property
    def _getters(self) -> frozenset[str]:
        """The names of methods in Python that ask for nothing more, which may be properties."""
        return frozenset(
            get_tail(fn.name)
            for fn in self.code.functions
            if fn.facts.owner and fn.source.facts.language == "python" and not fn.facts.parameters
        )

    def _find_local_value(self, name: str, fn: Fn, depth: int, line: int) -> str | None:
        """What a local variable is at a line: what it was initialised with, or what each branch assigned to it."""
        made = fn.assigned.get(name, [])
        if not made or name not in fn.locals or any(p.name == name for p in fn.facts.parameters):
            return None
        if any("static" in row.type.split() for row in made):
            return None  # it keeps what the last call left
        python = fn.source.facts.language == "python"
        changed = {access.kind for access in fn.facts.accesses if access.path == name}
        if _is_primitive(made[0].type) and not self._is_set_inside(name, fn):
            changed.discard("escape")  # what is handed on is a copy
        if len(made) == 1:
            if made[0].operator != "=" or changed - {"pass"}:
                return None
            return self._format_value(made[0].value, fn, depth, made[0].line)
        if changed - {"write"} - ({"pass"} if python else set()) or depth + 1 >= _DEEPEST:
            return None
        return self._merge_values(name, made, fn, depth, line)

    def _is_set_inside(self, name: str, fn: Fn) -> bool:
        """Whether a lambda of a function assigns to a variable of this name."""
        inside = (f"{fn.name}::lambda@", f"{fn.name}.lambda@")
        functions = self.code.functions_in.get(fn.source.path, ())
        return any(name in one.assigned for one in functions if one.name.startswith(inside))

    def _merge_values(self, name: str, rows: Sequence[Assignment], fn: Fn, depth: int, line: int) -> str | None:
        """What a variable is at a line after its assignments, of which each may be under conditions."""
        python = fn.source.facts.language == "python"
        chains = [self._list_chain(row.guard, fn) for row in rows]
        if not rows:
            return None
        # What all of them are under, loops among it, is a matter of the place.
        around = chains[0] if rows[0].type else _find_shared(chains)
        text: str | None = None
        for row, chain in zip(rows, chains, strict=True):
            own = chain[len(around) :]
            if chain[: len(around)] != around or any(kind not in _BRANCHES for kind, _ in own):
                return None
            if row.line > line:
                continue
            value = row.value
            if value.kind == "make" and not value.parts and value.text in _PRIMITIVE and row is rows[0]:
                continue  # declared, and nothing yet
            made = self._format_value(value, fn, depth, row.line - 1, True)
            asked = [self._expand_text(said, fn, depth + 1, row.line - 1) for said in _write_guards(own, python)]
            if made is None or any(re.search(rf"(?<![\w.>]){name}\b", said) for said in (made, *asked)):
                return None
            if row.operator in ("|=", "&="):
                if text is None:
                    return None
                made = _join(row.operator[0], text, made, python)
            elif row.operator != "=":
                return None
            text = choose(_join_all(asked, python), made, text, python)
            if len(text) > _LONGEST:
                return None
        return f"({text})" if text else None

    def _list_chain(self, index: int, fn: Fn) -> list[tuple[str, str]]:
        """Kind and text of the guards at a place of a function, outermost first; `with` left out."""
        rows = fn.facts.guards
        found: list[tuple[str, str]] = []
        while 0 <= index < len(rows) and len(found) < 64:
            if rows[index].kind != "with":
                found.append((rows[index].kind, rows[index].text))
            index = rows[index].outer
        return found[::-1]

    def _find_constant(self, name: str, fn: Fn) -> str | None:
        """The number that a constant is."""
        if name in _WORDS or not _MAY_BE_CONSTANT.fullmatch(name.rpartition(".")[2].rpartition(">")[2]):
            return None
        variable = self.code.identify(name.replace("->", ".").replace("self.", "this."), fn)
        return self._find_number(variable, fn)

    def _find_number(self, variable: Variable, fn: Fn) -> str | None:
        python = fn.source.facts.language == "python"
        if variable.kind == "member":
            rows = [
                (one, cls.source)
                for cls in self.code.list_class_bodies(variable.owner)
                for one in cls.facts.members
                if one.name == variable.name
            ]
        elif variable.kind == "global":
            rows = self.code.list_constants(variable, fn)
        else:
            return None
        values = {unparse(one.value) for one, _ in rows if one.value is not None}
        fixed = all(_is_fixed(one, python) for one, _ in rows)
        if len(values) != 1 or len(rows) != 1 or not fixed or len(self.code.list_writes(variable)) > python:
            return None
        value = values.pop()
        return value if _NUMBER.fullmatch(value) or parse_period(value) is not None else None

    def _expand_predicate(self, callee: str, arguments: str, fn: Fn, depth: int) -> str | None:
        """What a function of the code returns, when returning is all that it does; of the object it is called on."""
        path = callee.replace("->", ".").replace("self.", "this.")
        targets = self.code.list_targets(path, fn)
        if len(targets) != 1:
            return None
        target = targets[0].facts
        value = self._find_returned(targets[0], depth)
        given = split_outside(arguments, ",") if arguments.strip() else []
        if value is None or len(given) != len(target.parameters):
            return None
        owner = callee[: -len(get_tail(path))]
        if owner not in ("", "this->", "self."):
            if _CALL.search(value):
                return None  # what an object of another class computes is its own business
            value = self._put_owner_before(value, owner, targets[0])
        for parameter, argument in zip(target.parameters, given, strict=True):
            said = argument if _PLAIN.fullmatch(argument) else f"({argument})"
            value = re.sub(rf"(?<![\w.>]){re.escape(parameter.name)}\b", lambda _, said=said: said, value)
        return value

    def _find_returned(self, fn: Fn, depth: int) -> str | None:
        """What a function returns: one expression, or one for each of some conditions."""
        rows = [row for row in fn.facts.assignments if row.operator == "return"]
        if not rows or len(rows) > _MOST_RETURNS or depth + 1 >= _DEEPEST:
            return None
        python = fn.source.facts.language == "python"
        last = rows[-1]
        if len(rows) == 1 and last.guard == -1:
            value = self._format_value(last.value, fn, depth, last.line)
            return None if value is None or self._names_local(value, fn) else value
        chains = [self._list_chain(row.guard, fn) for row in rows]
        if any(kind not in _BRANCHES for chain in chains for kind, _ in chain):
            return None
        values = [self._format_value(row.value, fn, depth, row.line, True) for row in rows]
        none = [value in _NOTHING for value in values]
        if any(none) and not all(none):
            if not _OPTIONAL.search(fn.facts.returns):
                return None  # whether something else is returned says no condition
            values = ["false" if nothing else "true" for nothing in none]
        if any(kind == "if" for kind, _ in chains[-1]):
            if not python:
                return None
            rows, chains, values = [*rows, last], [*chains, []], [*values, "False"]
        text: str | None = None
        for row, chain, value in reversed(list(zip(rows, chains, values, strict=True))):
            if value is None:
                return None
            asked = [self._expand_text(said, fn, depth + 1, row.line) for said in _write_guards(chain, python)]
            text = value if text is None else choose(_join_all(asked, python), value, text, python)
            if len(text) > _LONGEST:
                return None
        if not text or text.lower() in ("true", "false") or self._names_local(text, fn):
            return None
        return f"({text})"

    def _names_local(self, text: str, fn: Fn) -> bool:
        """Whether a text names a variable that a function alone knows."""
        own = fn.locals.difference(one.name for one in fn.facts.parameters)
        return bool(own) and any(match[0] == match[1] in own for match in _IDENTIFIER.finditer(text))

    def _put_owner_before(self, value: str, owner: str, fn: Fn) -> str:
        """An expression of a method about the object that the method is called on. owner: it, with the sign behind."""
        python = fn.source.facts.language == "python"
        parameters = {one.name for one in fn.facts.parameters}

        def name(match: re.Match[str]) -> str:
            own = match[0] != match[1]
            other = python or match[1] in parameters or match[1] in _WORDS or match[1].isupper()
            return match[0] if other and not own else f"{owner}{match[1]}"

        return _IDENTIFIER.sub(name, value)

    def _format_value(self, value: FlowExpr, fn: Fn, depth: int, line: int, literal: bool = False) -> str | None:
        """An expression as source in which names are put back too; None for one that decides nothing by itself.
        literal: a value that stands there as it is decides too."""
        if value.kind not in ("other", "call", "choice", "name") and not (literal and value.kind in ("number", "text")):
            return None
        text = format_expression(value, fn.source.facts.language == "python", fn, line)
        if text is None or not text or "lambda" in text or "{" in text or "[]" in text:
            return None
        if text in _LITERALS:
            return text if literal else None
        text = self._expand_text(text, fn, depth + 1, line)
        return text if _PLAIN.fullmatch(text) else f"({text})"


def choose(condition: str, value: str, other: str | None, python: bool) -> str:
    """`value` where a condition holds (an empty one does), `other` where not; that is never where it is None."""
    if not condition or other is None:
        return value
    if value.lower() == "true":
        return _join("|", condition, other, python)
    if value.lower() == "false":
        return _join("&", f"not ({condition})" if python else f"!({condition})", other, python)
    if other.lower() == "false":
        return _join("&", condition, value, python)
    if other.lower() == "true":
        return _join("|", f"not ({condition})" if python else f"!({condition})", value, python)
    return f"({value}) if ({condition}) else ({other})" if python else f"({condition}) ? ({value}) : ({other})"


def _join(operator: str, one: str, other: str, python: bool) -> str:
    """Two conditions of which both (`&`) or one (`|`) must hold."""
    short = {("&", "true"): other, ("&", "false"): one, ("|", "false"): other, ("|", "true"): one}
    known = short.get((operator, one.lower()))
    if known is not None:
        return known
    words = {"&": " and ", "|": " or "} if python else {"&": " && ", "|": " || "}
    return f"({one}){words[operator]}({other})"


def _join_all(asked: Sequence[str], python: bool) -> str:
    return asked[0] if len(asked) == 1 else (" and " if python else " && ").join(f"({one})" for one in asked)


def _write_guards(chain: Sequence[tuple[str, str]], python: bool) -> list[str]:
    deny = "not ({})" if python else "!({})"
    return [text if kind == "if" else deny.format(text) for kind, text in chain]


def _find_shared(chains: Sequence[list[tuple[str, str]]]) -> list[tuple[str, str]]:
    """What lists begin with alike."""
    shared = chains[0]
    for chain in chains[1:]:
        same = next((n for n, (one, other) in enumerate(zip(shared, chain, strict=False)) if one != other), None)
        shared = shared[: min(len(shared), len(chain)) if same is None else same]
    return shared


def put_given(text: str, given: Given) -> str:
    """A text with parameters as what they are."""
    for name, value in given:
        text = re.sub(rf"(?<![\w.>:\"']){re.escape(name)}(?![\w\"':])", lambda _, value=value: value, text)
    return text


def select_given(text: str, given: Given) -> Given:
    """Those of some parameters that a text names."""
    words = set(_WORD.findall(text)) if given else ()
    return tuple(one for one in given if one[0] in words)


def _is_primitive(type_: str) -> bool:
    """Whether a variable of this type is a number or truth value of its own."""
    words = type_.replace("const", "").split()
    return bool(words) and all(word in _PRIMITIVE for word in words)


def _is_equated(text: str, start: int, end: int) -> bool:
    """Whether a name is compared for being equal: which one it is matters then, not its number."""
    return bool(_EQUATED_AFTER.match(text, end) or _EQUATED_BEFORE.search(text[:start]))


def _is_fixed(member: DataMember, python: bool) -> bool:
    """Whether a variable is a constant."""
    if python:
        return member.name.isupper()
    words = member.type.split()
    return not member.type or "constexpr" in words or ("const" in words and "*" not in member.type)


def format_expression(value: FlowExpr, python: bool, fn: Fn, line: int) -> str | None:
    """An expression of a function and line as source; None where that was cut off or is not known."""
    this = "self." if python else "this->"
    if value.kind == "other":
        return value.text if len(value.text) < _CUT else None
    if value.kind in ("name", "number"):
        return _fill_calls(value.text.replace("this.", this), python, fn, line)
    if value.kind == "text":
        return f'"{value.text}"'
    parts = [format_expression(part, python, fn, line) for part in value.parts]
    given = [part for part in parts if part is not None]
    if len(given) != len(parts):
        return None
    if value.kind == "keyword":
        return f"{value.text}={given[0]}" if given and value.text not in ("*", "**") else None
    if value.kind == "call":
        callee = value.text.replace("this.", this)
        if value.receiver is not None:
            receiver = format_expression(value.receiver, python, fn, line)
            callee = f"{receiver}.{get_tail(value.text)}" if receiver else None
        else:
            callee = _fill_calls(callee, python, fn, line)
        return f"{callee}({', '.join(given)})" if callee else None
    if value.kind == "choice" and len(given) == 3:
        first, second, third = given
        if not python:
            return f"({first}) ? ({second}) : ({third})"
        if first == third:
            return f"({first}) and ({second})"
        return f"({first}) or ({third})" if first == second else f"({second}) if ({first}) else ({third})"
    return None


def _fill_calls(path: str, python: bool, fn: Fn, line: int) -> str | None:
    """A path in which something is called, with what that is given; None where that is not known."""
    if "()" not in path:
        return None if "[]" in path else path
    filled, rest = "", path
    plain = ""
    while "()" in rest:
        callee, _, rest = rest.partition("()")
        plain += callee
        wanted = plain.replace("self.", "this.").replace("this->", "this.")
        given = {call.arguments for call in fn.facts.calls if call.callee == wanted and call.line == line}
        said = [format_expression(one, python, fn, line) for one in next(iter(given))] if len(given) == 1 else [None]
        if any(one is None for one in said):
            return None
        filled += f"{callee}({', '.join(one for one in said if one is not None)})"
        plain += "()"
    return filled + rest


def _find_closing(text: str, start: int) -> int:
    """Where the bracket that opens at `start` closes, 0 when it does not."""
    depth = 0
    for place in range(start, len(text)):
        if text[place] in "([{":
            depth += 1
        elif text[place] in ")]}":
            depth -= 1
            if depth == 0:
                return place
    return 0


def split_conjuncts(text: str) -> list[str]:
    """What a condition asks for at once, split at its outermost `&&` or `and`; the whole where an `||` stands there."""
    return [text] if len(split_outside(text, r"\|\|| or ")) > 1 else split_outside(text, "&&| and ")
