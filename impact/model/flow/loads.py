"""Nodelets that a program loads itself: their names, classes and remappings, as `nodelet::Loader::load` is given them.

One load in a function that is called several times, each time with other arguments, is several loads.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from ...facts.flow import FlowCall
from .calls import Calls, FrameworkCall
from .code import Fn
from .names import remap_ros1_name
from .values import NODE, FlowValues

_DEEPEST = 4
_MOST = 64


class Loaded(NamedTuple):
    """A nodelet in a node. name: full. plugin: as pluginlib knows it (`image_proc/rectify`). remaps: pairs of names as
    written, resolved as the nodelet's own are."""

    name: str
    plugin: str
    remaps: tuple[tuple[str, str], ...]

    def remap_name(self, name: str) -> str:
        """The full name of a name that the nodelet uses."""
        return remap_ros1_name(name, self.name, self.remaps)


def list_loaded(calls: Calls, functions: set[Fn], values: FlowValues, node: str) -> Iterator[Loaded]:
    """What a program loads. functions: those it runs; values: what expressions are worth in it; node: the full
    name of its node."""
    for use in calls.select_uses("load"):
        if use.fn not in functions:
            continue
        for way in _list_ways(calls, use.fn, functions):
            inside = values.limit_to_calls(way)
            for name in inside.evaluate(calls.find_argument(use, use.row.topic), use.fn, use.call.line):
                for plugin in inside.evaluate(calls.find_argument(use, use.row.type), use.fn, use.call.line):
                    if name.text and plugin.text:
                        full = name.text.replace(NODE, node)
                        full = full if full.startswith("/") else f"{node.rpartition('/')[0]}/{full}"
                        yield Loaded(full, plugin.text, tuple(_list_remaps(calls, use, inside)))


def _list_ways(calls: Calls, fn: Fn, functions: set[Fn], depth: int = 0) -> Iterator[dict[Fn, FlowCall]]:
    """The calls through which a function is reached: for each way, the call by the function called."""
    number = 0
    for caller, call in calls.code.callers.get(fn, ()) if depth < _DEEPEST else ():
        if caller in functions and number < _MOST:
            for way in _list_ways(calls, caller, functions, depth + 1):
                number += 1
                yield {**way, fn: call}
    if not number:
        yield {}


def _list_remaps(calls: Calls, use: FrameworkCall, values: FlowValues) -> Iterator[tuple[str, str]]:
    """What the map of remappings holds where it is given away: elements written since it was last emptied."""
    given = calls.find_argument(use, use.row.remaps)
    if given is None or given.kind != "name":
        return
    emptying = f"{given.text}.clear"
    before = [call.line for call in use.fn.facts.calls if call.callee == emptying and call.line < use.call.line]
    emptied = max(before, default=0)
    for each in use.fn.facts.assignments:
        if each.target == f"{given.text}.[]" and each.key is not None and emptied < each.line < use.call.line:
            for old in values.evaluate(each.key, use.fn, each.line)[:1]:
                for new in values.evaluate(each.value, use.fn, each.line)[:1]:
                    if old.text and new.text:
                        yield old.text, new.text
