"""Plugins that a program of the workspace loads into itself through pluginlib, as its code and its parameters say.

Source: pluginlib's class_loader.hpp.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Iterator, Mapping
from typing import NamedTuple

from ...facts.flow import FlowCall
from .calls import Calls
from .code import MAKES_PLUGIN, Fn, get_tail
from .values import FlowValues

_EVERY = "getDeclaredClasses"
_MOST_WAYS = 8
# The last part of a parameter's name that tells what a plugin is.
_TELLS = frozenset(("plugin", "type", "plugin_type"))


class HostedPlugin(NamedTuple):
    """A plugin in a program. name: as pluginlib knows it, or the tail of a base class of all that may be loaded.
    is_base: whether it is that. only_if: the condition under which it is loaded, empty where that is sure."""

    name: str
    is_base: bool = False
    only_if: str = ""


class PluginHosts:
    """Asks a body of code which plugins its programs load. plugins: the names by which pluginlib knows classes here."""

    def __init__(self, calls: Calls, plugins: Mapping[str, str]):
        self.calls, self.code, self.plugins = calls, calls.code, plugins

    def list_hosted(self, functions: set[Fn], values: FlowValues, settings: Mapping[str, str]) -> list[HostedPlugin]:
        """The plugins that a program loads. functions: those that it runs; values: what expressions are worth in it;
        settings: its parameters, by their names, as far as a launch sets them."""
        if not self.plugins:
            return []
        found: dict[tuple[str, bool], HostedPlugin] = {}
        named = self.code.list_calls_named(MAKES_PLUGIN)
        calls = [(fn, call) for fn, call in named if fn in functions and "." in call.callee]
        for fn, call in calls:
            for one in self._list_made(fn, call.callee, call.arguments, call.line, values.run(functions), functions):
                known = found.setdefault((one.name, one.is_base), one)
                if known.only_if and not one.only_if:
                    found[one.name, one.is_base] = one
        if calls:
            for name, text in settings.items():
                if get_tail(name.replace("/", ".")) in _TELLS and text in self.plugins:
                    found.setdefault((text, False), HostedPlugin(text))
        return list(found.values())

    def list_ways(
        self, functions: set[Fn], values: FlowValues, own: set[Fn], is_named: Callable[[str], bool]
    ) -> list[dict[Fn, FlowCall]]:
        """The ways in which a program calls methods of one of its plugins, without the calls that are surely made on
        other plugins: the call by the method. functions: those of the program; own: of the plugin; is_named: whether
        pluginlib calls it by a name."""
        found: list[dict[Fn, FlowCall]] = [{}]
        for fn in sorted(own, key=lambda one: one.place):
            rows = [row for row in self.code.callers.get(fn, ()) if row[0] in functions] if fn.facts.parameters else []
            may = [call for caller, call in rows if self._may_be_on(caller, call, values, is_named)]
            if may and len(may) < len(rows):
                found = [{**way, fn: call} for way in found for call in may][:_MOST_WAYS]
        return found

    def _may_be_on(
        self, fn: Fn, call: FlowCall, values: FlowValues, is_named: Callable[[str], bool]
    ) -> bool:  # fmt: skip
        """Whether a call may be made on a plugin."""
        held = self.code.identify(call.callee.rpartition(".")[0], fn)
        made = [row for row in self.code.list_results(held) if get_tail(row[1].callee) in MAKES_PLUGIN]
        # Of one variable that holds several in turn, that of the last line before.
        before = [row for row in made if row[0] is fn and row[1].line <= call.line]
        made = before[-1:] or made
        for maker, making in made:
            for one in values.evaluate(making.arguments[0], maker, making.line) if making.arguments else ():
                if one.text is None or one.text not in self.plugins or is_named(one.text):
                    return True
        return not made

    def _list_made(
        self, fn: Fn, callee: str, arguments: tuple, line: int, values: FlowValues, functions: set[Fn]
    ) -> Iterator[HostedPlugin]:
        """What one call makes."""
        known = False
        for value in values.evaluate(arguments[0], fn, line) if arguments else ():
            if value.text in self.plugins:
                known = True
                sure = value.how in ("literal", "launch") and not value.only_if
                yield HostedPlugin(value.text or "", only_if="" if sure else f"`{value.text}` is loaded")
        if known:
            return
        loader = self.code.identify(callee.rpartition(".")[0], fn)
        asks = (row for row in self.code.list_calls_named((_EVERY,)) if row[0] in functions)
        if any(self.code.identify(call.callee.rpartition(".")[0], asker) == loader for asker, call in asks):
            kind = self.code.resolve_variable_type(loader, fn)
            base = get_tail(kind.arguments[0]) if kind.arguments else ""
            if base:
                yield HostedPlugin(base, True, "it is among the plugins that are loaded")


def select_own(settings: Mapping[str, str], is_named: Callable[[str], bool]) -> dict[str, str]:
    """The parameters of a program as far as they are about one of its plugins: lists of names without those that others
    are called by (`plugins: [a, b]`, `a.plugin: pkg/A`). is_named: whether pluginlib calls it by a name."""
    others = {
        name.rpartition(".")[0]
        for name, text in settings.items()
        if name.rpartition(".")[2] in _TELLS and "." in name and not is_named(text)
    }
    found = dict(settings)
    for name, text in settings.items() if others else ():
        if text[:1] != "[":
            continue
        try:
            listed = ast.literal_eval(text)
        except (ValueError, SyntaxError, MemoryError, RecursionError):
            continue
        if isinstance(listed, list) and not others.isdisjoint(each for each in listed if isinstance(each, str)):
            found[name] = str([each for each in listed if each not in others])
    return found
