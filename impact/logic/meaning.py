"""What guards mean: local variables and predicates in them put back into what they stand for.

A condition that was given a name, or moved into a function that returns it, is then the same condition as before.
"""

import re

from ...edges.memory import cache_method
from ..facts.flow import FlowExpr
from ..model.flow.code import FlowCode, Fn, get_tail
from ..model.flow.graph import GuardAt
from .guard_terms import split_outside

_DEEPEST = 3
_LONGEST = 1000
_CUT = 119
"""An expression as long as this may have been cut off when it was read."""
_IDENTIFIER = re.compile(r"(?<![\w.>:\"'])(?:(?:this->|self\.)?)([A-Za-z_]\w*)(?![\w:\"'])")
_PATH = re.compile(r"(?:this->|self\.)?[A-Za-z_]\w*(?:(?:\.|->)[A-Za-z_]\w*)+(?=\()")
_CALL = re.compile(r"\w\s*\(")
_PLAIN = re.compile(r"[\w.:]+(\(\))?")
_WORDS = frozenset(
    ("and", "or", "not", "is", "in", "true", "false", "True", "False", "None", "nullptr", "NULL", "this")
)  # fmt: skip


class Meaning:
    """Meanings of guards in a body of code."""

    def __init__(self, code: FlowCode):
        self.code = code

    @cache_method
    def resolve_guard(self, guard: GuardAt) -> str:
        """What a guard's text means; empty when that is what it says."""
        if guard.kind not in ("if", "unless", "while"):
            return ""
        fn = self.code.by_name.get((guard.path, guard.of))
        found = self._expand_text(guard.text, fn, 0) if fn is not None else guard.text
        return found if found != guard.text and len(found) <= _LONGEST else ""

    def _expand_text(self, text: str, fn: Fn, depth: int) -> str:
        if depth >= _DEEPEST or len(text) > _LONGEST:
            return text
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
            else:
                bare = match[0] == match[1]
                value = (
                    self._find_local_value(match[1], fn, depth)
                    if bare and text[end : end + 2] not in ("->", "[")
                    else None
                )
                if value is not None and text[end : end + 1] in (".", "[", "-") and text[end : end + 2] != "- ":
                    value = None
            if value is None:
                continue
            parts += (text[position : match.start()], value)
            position = end
        return "".join((*parts, text[position:]))

    def _find_local_value(self, name: str, fn: Fn, depth: int) -> str | None:
        """What a local variable was initialised with, when it is never assigned again."""
        made = fn.assigned.get(name, [])
        if len(made) != 1 or made[0].operator != "=" or any(p.name == name for p in fn.facts.parameters):
            return None
        python = fn.source.facts.language == "python"
        if not made[0].type and not python:
            return None
        if any(access.path == name and access.kind != "pass" for access in fn.facts.accesses):
            return None
        return self._format_value(made[0].value, fn, depth)

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
        """What a function returns that does nothing else: one expression, or whether a condition holds."""
        rows, asked = fn.facts.assignments, fn.facts.guards
        last = rows[-1] if rows else None
        if last is None or last.operator != "return" or len(rows) > 4:
            return None
        if not any(row.operator == "return" for row in rows[:-1]):
            return self._format_value(last.value, fn, depth) if last.guard == -1 else None
        if len(rows) != 2 or not 0 <= rows[0].guard < len(asked):
            return None
        first, other = asked[rows[0].guard], asked[rows[1].guard] if rows[1].guard >= 0 else None
        said = [row.value.text.lower() if row.value.kind in ("number", "name") else "" for row in rows]
        if sorted(said) != ["false", "true"] or first.kind != "if" or first.outer != -1 or len(first.text) >= _CUT:
            return None
        if other is not None and (other.kind, other.text, other.outer) != ("unless", first.text, -1):
            return None
        text = self._expand_text(first.text, fn, depth + 1)
        if said[0] == "true":
            return f"({text})"
        return f"(not ({text}))" if fn.source.facts.language == "python" else f"(!({text}))"

    def _put_owner_before(self, value: str, owner: str, fn: Fn) -> str:
        """An expression of a method about the object that the method is called on. owner: it, with the sign behind."""
        python = fn.source.facts.language == "python"
        parameters = {one.name for one in fn.facts.parameters}

        def name(match: re.Match[str]) -> str:
            own = match[0] != match[1]
            other = python or match[1] in parameters or match[1] in _WORDS or match[1].isupper()
            return match[0] if other and not own else f"{owner}{match[1]}"

        return _IDENTIFIER.sub(name, value)

    def _format_value(self, value: FlowExpr, fn: Fn, depth: int) -> str | None:
        """An expression as source in which names are put back too; None for one that decides nothing by itself."""
        if value.kind not in ("other", "call", "choice", "name"):
            return None
        text = format_expression(value, fn.source.facts.language == "python")
        if text is None or not text or "lambda" in text or "{" in text:
            return None
        if value.kind == "name" and text in ("true", "false", "True", "False", "None", "nullptr", "NULL"):
            return None
        text = self._expand_text(text, fn, depth + 1)
        return text if _PLAIN.fullmatch(text) else f"({text})"


def format_expression(value: FlowExpr, python: bool) -> str | None:
    """An expression as source; None where that was cut off or is not known."""
    if value.kind == "other":
        return value.text if len(value.text) < _CUT else None
    if value.kind == "name" or value.kind == "number":
        return value.text.replace("this.", "self." if python else "this->")
    if value.kind == "text":
        return f'"{value.text}"'
    parts = [format_expression(part, python) for part in value.parts]
    given = [part for part in parts if part is not None]
    if len(given) != len(parts):
        return None
    if value.kind == "call":
        return f"{value.text.replace('this.', 'self.' if python else 'this->')}({', '.join(given)})"
    if value.kind == "choice" and len(given) == 3:
        first, second, third = given
        if not python:
            return f"({first}) ? ({second}) : ({third})"
        if first == third:
            return f"({first}) and ({second})"
        return f"({first}) or ({third})" if first == second else f"({second}) if ({first}) else ({third})"
    return None


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
