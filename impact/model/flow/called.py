"""Which functions something that runs may call: a method that only methods call which nobody calls, never runs."""

from __future__ import annotations

import re
from collections.abc import Collection, Iterable, Iterator
from functools import cached_property
from typing import NamedTuple

from ....edges.memory import cache_method
from ...facts.cpp.flow_values import ELEMENTS
from ...facts.flow import FlowCall, FlowExpr
from .code import FlowCode, Fn, get_tail

_WORD = re.compile(r"[A-Za-z_]\w*")
_TEXT = re.compile(r"""'[^']*'|"[^"]*\"""")
_ITSELF = frozenset(("this", "super", "super()"))
# What is given to these in Python names a method by a text; other texts do so only where getattr() is given no text.
_BY_NAME = frozenset(("getattr", "hasattr", "methodcaller", "attrgetter", "invokeMethod", "eval", "exec"))


class Mentions(NamedTuple):
    """What a function may call. functions: those that its calls surely mean; names: the last parts of the names of all
    others; any_name: it looks up methods by names that are made when it runs."""

    functions: frozenset[Fn]
    names: frozenset[str]
    any_name: bool


class CalledFunctions:
    """Asks a body of code which functions are called where some are."""

    def __init__(self, code: FlowCode):
        self.code = code

    def find_called(self, roots: Iterable[Fn], functions: Collection[Fn]) -> frozenset[Fn]:
        """Of the functions that a program reaches those that it may call. roots: where it begins."""
        inside = frozenset(functions)
        known = set(roots) & inside
        known.update(fn for fn in inside if not self.is_called_by_code(fn))
        # What else stands beside them may be handed on in ways that are not followed.
        beside = {fn for path in {one.source.path for one in inside} for fn in self.code.functions_in[path]}
        waiting = set(inside | beside) - known
        by_name: dict[str, list[Fn]] = {}
        for fn in waiting:
            by_name.setdefault(get_tail(fn.name), []).append(fn)
        within: dict[Fn, list[Fn]] = {}
        for fn in waiting:
            around = self.code.find_enclosing(fn)
            if around is not None:
                within.setdefault(around, []).append(fn)
        queue = list(known)
        for name in self._declared_names & by_name.keys():
            queue += by_name[name]
        while queue:
            fn = queue.pop()
            waiting.discard(fn)
            found = self._find_mentions(fn)
            if found.any_name:
                return inside
            further = [*within.get(fn, ()), *found.functions]
            further += [one for name in found.names & by_name.keys() for one in by_name[name]]
            fresh = waiting.intersection(further)
            known |= fresh
            waiting -= fresh
            queue += fresh
        return inside - waiting

    @cache_method
    def is_called_by_code(self, fn: Fn) -> bool:
        """Whether a function runs only where the code itself calls it: no constructor, nothing that a language, or a
        class from outside of the code, calls by itself."""
        code, name = self.code, get_tail(fn.name)
        if fn.is_lambda:
            return code.find_enclosing(fn) is not None
        if not name.isidentifier() or name[:2] == name[-2:] == "__" or code.is_class_body(fn):
            return False
        if name == "main" or name in ELEMENTS:
            return False  # facts have an element for such a call
        owner = code.find_owner(fn)
        if owner is None:
            return not fn.facts.owner
        return name != get_tail(owner.name) and code.is_called_by_code(owner, name)

    @cached_property
    def _declared_names(self) -> frozenset[str]:
        """The names in what members and constants are declared with."""
        # In Python these stand in functions, or in what is read like one.
        sources = [source for source in self.code.sources if source.facts.language == "cpp"]
        values = [one.value for source in sources for one in source.facts.constants]
        values += [one.value for source in sources for cls in source.facts.classes for one in cls.members]
        return frozenset(word for value in values if value is not None for word in _list_words(value, True))

    @cache_method
    def _find_mentions(self, fn: Fn) -> Mentions:
        functions: set[Fn] = set()
        names: set[str] = set()
        any_name = False
        python = fn.source.facts.language == "python"
        for call in fn.facts.calls:
            head, _, last = call.callee.rpartition(".") if "." in call.callee else ("", "", call.callee)
            names.update(_WORD.findall(head))
            targets = self.code.list_targets(call.callee, fn)
            if targets and self._is_sure(call, head, fn):
                functions.update(targets)
            else:
                names.update(_WORD.findall(last))
            any_name = any_name or (call.callee == "getattr" and any(one.kind != "text" for one in call.arguments[1:2]))
            by_name = not python or get_tail(call.callee) in _BY_NAME
            for argument in call.arguments:
                names.update(_list_words(argument, by_name))
        for each in fn.facts.assignments:
            names.update(_list_words(each.value, not python))
        for guard in fn.facts.guards:
            names.update(_WORD.findall(_TEXT.sub("", guard.text) if python else guard.text))
        return Mentions(frozenset(functions), frozenset(names), any_name)

    def _is_sure(self, call: FlowCall, head: str, fn: Fn) -> bool:
        """Whether the targets of a call are all that it may reach. head: what a method is called on."""
        if head in _ITSELF or fn.source.facts.language == "cpp":
            return True
        if not head or head.endswith("()"):
            return False
        written = self.code.list_writes(self.code.identify(head, fn))
        return bool(written) and all(each.value.kind == "make" for _, each in written)


def _list_words(value: FlowExpr, texts: bool) -> Iterator[str]:
    """The words in the names of an expression, where a call alone is no mention of what it calls. texts: those in texts
    too."""
    waiting = [value]
    while waiting:
        one = waiting.pop()
        if texts or one.kind != "text":
            yield from _WORD.findall(one.text)
        waiting += one.parts
        if one.receiver is not None:
            waiting.append(one.receiver)
