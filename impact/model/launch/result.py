"""What following a launch gives: the nodes it starts, with all that the launch file gives them, and what is unknown."""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping
from functools import lru_cache
from itertools import chain
from operator import itemgetter
from typing import NamedTuple, Protocol

from ...facts.launch.actions import LaunchFile
from ...facts.launch.parameter_files import ParameterEntry, ParameterFile
from ..flow.names import normalise
from .text import LaunchText, make_either, wrap

EMPTY = wrap("")


class LaunchSources(Protocol):
    """Where launch and parameter files come from. package and path: as in `$(find package)/path`, the path normal and
    without a leading slash. None for what is not there."""

    def find_launch_file(self, package: str, path: str) -> LaunchFile | None:
        """The facts of a launch file."""

    def find_parameter_file(self, package: str, path: str) -> ParameterFile | None:
        """The facts of a file of parameters."""


class ShareLine(NamedTuple):
    """A line of a file in a package's share folder."""

    package: str
    path: str
    line: int


class Remap(NamedTuple):
    """A remapping as given; in ROS 2 old may have a node's name before it (`node:old`). conditions: as in Started."""

    old: LaunchText
    new: LaunchText
    at: ShareLine
    conditions: tuple[str, ...] = ()

    def is_sure(self, given: Collection[str]) -> bool:
        """Whether it holds wherever some conditions do."""
        return set(given).issuperset(self.conditions)


class LaunchParameter(NamedTuple):
    """A parameter. name: private to its node (`scan_topic`), or global on ROS 1's parameter server (`/robot/scan`).
    conditions: as in Started. source: the line of the parameter file that it comes from. type: what its value is made
    into, as the launch file says it; empty where YAML's rules decide."""

    name: str
    text: LaunchText
    at: ShareLine
    conditions: tuple[str, ...] = ()
    source: ShareLine | None = None
    type: str = ""

    def is_sure(self, given: Collection[str]) -> bool:
        """As for Remap."""
        return set(given).issuperset(self.conditions)

    def put_over(self, before: LaunchParameter | None, given: Collection[str]) -> LaunchParameter:
        """The parameter where it is set after another value. given: the conditions that hold."""
        if before is None or self.is_sure(given):
            return self
        if before.text.value is not None and before.text.value == self.text.value:
            return before
        reason = f"set only if {self.conditions[-1]}"
        text = make_either(before.text.shown, self.text.shown, *before.text.reasons, reason)
        return self._replace(text=text, conditions=before.conditions)


class SettingFile(NamedTuple):
    """A parameter file given to a node of ROS 2. entries: None where it could not be had. plain: its entries are
    parameters by themselves, without the name of a node above them. source: package and path of the file that is read,
    None where that is not known."""

    file: LaunchText
    entries: tuple[ParameterEntry, ...] | None
    at: ShareLine
    conditions: tuple[str, ...] = ()
    plain: bool = False
    source: tuple[str, str] | None = None


class Started(NamedTuple):
    """A node, or another program, that the launch starts.

    kind: `node`, `lifecycle`, `test`, `container`, `composable` (ROS 1: a nodelet that is loaded) or `process`; in
    Launched.outside `include`.
    executable or plugin: what runs; arguments: what it is given. name: empty where it is left to the program.
    namespace: absolute; empty where it is left to the program, which then means `/`.
    remaps, settings: in the order in which they are given to the node; of remaps ROS 1 takes the last for a name, ROS 2
    the first; of settings the last holds. settings of ROS 1 are on the server: Launched.values().
    conditions: those that could not be decided, as text. at: the line that starts it. container: the full name of the
    node that a composable node, or a nodelet, is loaded into; empty for what is not loaded.
    """

    kind: str
    generation: int
    at: ShareLine
    conditions: tuple[str, ...]
    package: LaunchText = EMPTY
    executable: LaunchText = EMPTY
    plugin: LaunchText = EMPTY
    name: LaunchText = EMPTY
    namespace: LaunchText = EMPTY
    remaps: tuple[Remap, ...] = ()
    settings: tuple[LaunchParameter | SettingFile, ...] = ()
    arguments: tuple[LaunchText, ...] = ()
    container: LaunchText = EMPTY


class Launched(NamedTuple):
    """All that a launch does. server: ROS 1's parameters by their global names. files: (package, path) of the launch
    files read; parameter_files: of the parameter files. arguments: those that they declare. actions: how many were
    done. outside: launch files that are included and cannot be read, as of other packages or by a path that is not
    known: executable is their path, settings are their arguments and the parameter files that these name. left_out:
    something is not started, or not included, since a condition does not hold. possible: what is started if such
    conditions hold, as far as somebody asked for it. unread: names on the server of ROS 1 below which files of
    parameters are put of which the content is not known."""

    started: tuple[Started, ...]
    server: Mapping[str, LaunchParameter]
    files: tuple[tuple[str, str], ...]
    arguments: frozenset[str] = frozenset()
    actions: int = 0
    parameter_files: tuple[tuple[str, str], ...] = ()
    outside: tuple[Started, ...] = ()
    left_out: bool = False
    possible: Launched | None = None
    unread: frozenset[str] = frozenset()

    def collect_parameters(self, started: Started, full: str) -> dict[str, LaunchParameter]:
        """The private parameters of a node. full: its full name; of one that is empty, only what holds for any node."""
        if started.generation == 1:
            below = f"{full}/"
            return {
                key[len(below) :]: setting for key, setting in self.server.items() if full and key.startswith(below)
            }
        found: dict[str, LaunchParameter] = {}
        for setting in started.settings:
            if isinstance(setting, LaunchParameter):
                found[setting.name] = setting.put_over(found.pop(setting.name, None), started.conditions)
                continue
            for key, entry in select_file_values(setting, full).items():
                source = ShareLine(*setting.source, entry.line) if setting.source is not None else None
                one = LaunchParameter(key, wrap(str(entry.value)), setting.at, setting.conditions, source)
                found[key] = one.put_over(found.pop(key, None), started.conditions)
        return found


def select_file_values(setting: SettingFile, full_name: str) -> dict[str, ParameterEntry]:
    """The entries of a ROS 2 parameter file that hold for a node, later ones over earlier ones. full_name: empty for a
    node whose name is not known: then only what is for every node."""
    if setting.plain:
        return {".".join(entry.path): entry for entry in setting.entries or ()}
    groups = _split_by_node(setting.entries) if setting.entries else {}
    meant = [rows for keys, rows in groups.items() if _names_node(keys, full_name)]
    found: dict[str, ParameterEntry] = {}
    for _, name, entry in meant[0] if len(meant) == 1 else sorted(chain(*meant), key=itemgetter(0)):
        found.pop(name, None)
        found[name] = entry
    return found


_Rows = list[tuple[int, str, ParameterEntry]]
"""Entries with their places and the names of their parameters."""
_SPLIT: dict[int, tuple[tuple[ParameterEntry, ...], dict[tuple[str, ...], _Rows]]] = {}
_MOST_SPLIT = 64


def _split_by_node(entries: tuple[ParameterEntry, ...]) -> dict[tuple[str, ...], _Rows]:
    """The entries of a parameter file by the keys above `ros__parameters`. Those of the last files are kept, since many
    nodes are given one file."""
    known = _SPLIT.get(id(entries))
    if known is not None:
        return known[1]
    found: dict[tuple[str, ...], _Rows] = {}
    for place, entry in enumerate(entries):
        path = entry.path
        if "ros__parameters" in path:
            split = path.index("ros__parameters")
            name = ".".join(path[split + 1 :])
            if name:
                found.setdefault(path[:split], []).append((place, name, entry))
    if len(_SPLIT) >= _MOST_SPLIT:
        _SPLIT.clear()
    _SPLIT[id(entries)] = entries, found  # which keeps the entries, so that nothing else comes by the same id
    return found


def _names_node(keys: tuple[str, ...], full_name: str) -> bool:
    """Whether the keys above `ros__parameters` mean a node: `/**` any, `*` one part of a name, `**` any number."""
    pattern = _compile_pattern(keys)
    return pattern is None or (bool(full_name) and pattern.fullmatch(full_name) is not None)


@lru_cache(maxsize=4096)
def _compile_pattern(keys: tuple[str, ...]) -> re.Pattern[str] | None:
    """What names of nodes match some keys; None for any."""
    pattern = normalise("/" + "/".join(keys))
    if pattern == "/**":
        return None
    parts = [r"(?:/\w+)*" if part == "**" else r"/\w+" if part == "*" else "/" + re.escape(part)
             for part in pattern.split("/")[1:]]  # fmt: skip
    return re.compile("".join(parts))
