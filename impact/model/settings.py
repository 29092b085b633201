"""Parameters that files of parameters and launch files set for nodes and plugins of other packages, as far as some
versions of those packages declare them and others do not.

Whose a value of a file of ROS 2 parameters is, is told by the `plugin:` beside it, by the `type:` that the controller
manager has for a node of that name, or by the name of the node, which a launch file or the program's own name explains.
"""

import re
from collections.abc import Callable, Collection, Iterator, Mapping
from typing import NamedTuple

from ..facts.launch.actions import Action, LaunchFile, find_literal
from ..facts.launch.parameter_files import ParameterEntry, ParameterFile
from ..facts.launch.references import CLASS
from ..targets.parameters import find_last_part

Changing = Mapping[str, frozenset[str]]
"""Last parts of parameters' names, with the packages of which some versions declare one so called."""


class Setting(NamedTuple):
    """A value that is set. name: below its owner, with dots. package: whose node or plugin it is for; empty where only
    the node's name is known. plugin: the class as written, empty for what is a node's. node: the program where the
    package is known and it is no plugin's, else the node's name. others: packages of plugins that the same node loads.
    value: as read, None where that is not known plainly."""

    name: str
    package: str
    plugin: str
    node: str
    line: int
    others: tuple[str, ...] = ()
    value: object = None


class NamedNode(NamedTuple):
    """A node that a launch file starts, and the name it goes by."""

    package: str
    program: str
    name: str


def mentions_changing(words: Collection[str], changing: Changing) -> bool:
    """Whether a file with these words may set a parameter that changed, of a package that it changed in."""
    return any(not changing[word].isdisjoint(words) for word in changing.keys() & words)


def list_settings(
    file: ParameterFile, changing: Changing, named: Callable[[str, Collection[str]], NamedNode | None]
) -> Iterator[Setting]:
    """What a file of ROS 2 parameters sets, of those that change. named: the node that goes by a name, one of some
    packages first, None where no launch file tells."""
    yield from _list_file_settings(file, changing.get, named)


def list_every_setting(
    file: ParameterFile, named: Callable[[str, Collection[str]], NamedNode | None]
) -> Iterator[Setting]:
    """All that a file of ROS 2 parameters sets. named: as for list_settings()."""
    yield from _list_file_settings(file, lambda _: _EVERY, named)


class _EveryPackage(frozenset[str]):
    """A set that has every package and lists none."""

    def __contains__(self, name: object) -> bool:
        return True


_EVERY = _EveryPackage()
_Losers = Callable[[str], "frozenset[str] | None"]


def _list_file_settings(
    file: ParameterFile, find_losers: _Losers, named: Callable[[str, Collection[str]], NamedNode | None]
) -> Iterator[Setting]:
    nodes: dict[tuple[str, ...], list[tuple[list[str], ParameterEntry]]] = {}
    for entry in file.entries:
        if "ros__parameters" in entry.path:
            place = entry.path.index("ros__parameters")
            key = ".".join(entry.path[place + 1 :]).split(".")
            nodes.setdefault(entry.path[:place], []).append((key, entry))
    controllers = {
        key[0]: entry.value
        for path, entries in nodes.items() if path and path[-1].endswith("controller_manager")
        for key, entry in entries if len(key) == 2 and key[1] == "type" and _is_class(entry.value)
    }  # fmt: skip
    for path, entries in nodes.items():
        yield from _list_settings(path[-1].rpartition("/")[2] if path else "", entries, controllers, find_losers, named)


def _list_settings(
    node: str,
    entries: list[tuple[list[str], ParameterEntry]],
    controllers: Mapping[str, str],
    find_losers: _Losers,
    named: Callable[[str, Collection[str]], NamedNode | None],
) -> Iterator[Setting]:
    plugins = {tuple(key[:-1]): entry.value for key, entry in entries if key[-1] == "plugin" and _is_class(entry.value)}
    others = tuple(sorted({get_plugin_package(name) for name in plugins.values()}))
    for key, entry in entries:
        losers = find_losers(key[-1])
        if losers is None or key[-1] == "plugin":
            continue
        owner = next((tuple(key[:end]) for end in range(len(key) - 1, -1, -1) if tuple(key[:end]) in plugins), None)
        class_, name = (plugins[owner], key[len(owner) :]) if owner is not None else (controllers.get(node, ""), key)
        if class_:
            if get_plugin_package(class_) in losers:
                yield Setting(".".join(name), get_plugin_package(class_), class_, node, entry.line, others, entry.value)
        elif node and "*" not in node:
            known = named(node, losers)
            if known is not None and known.package not in losers:
                continue  # another node of that name
            package, program = (known.package, known.program) if known is not None else ("", node)
            yield Setting(".".join(name), package, "", program, entry.line, others, entry.value)


def _is_class(value: object) -> bool:
    return isinstance(value, str) and CLASS.match(value) is not None


def get_plugin_package(class_: str) -> str:
    """The package that a class of a plugin is called after."""
    return re.split(r"/|::", class_)[0]


def list_launch_settings(file: LaunchFile, changing: Changing) -> Iterator[Setting]:
    """What a launch file itself sets for the nodes and components that it starts."""
    for action in _list_actions(file.actions):
        package = find_literal(action.get("package")) or ""
        plugin, program = find_literal(action.get("plugin")) or "", find_literal(action.get("executable")) or ""
        if not package or not (plugin or program):
            continue
        for child in action.children:
            name = (find_literal(child.get("name")) or "").lstrip("~/") if child.kind == "parameter" else ""
            if package in changing.get(find_last_part(name), ()):
                program = "" if plugin else program
                value = find_literal(child.get("value"))
                yield Setting(name.replace("/", "."), package, plugin, program, child.line, value=value)


def list_named_nodes(file: LaunchFile) -> Iterator[NamedNode]:
    """The nodes that a launch file starts, as far as they are known plainly; one that it gives no name goes by that of
    its program."""
    for action in _list_actions(file.actions):
        package, program = find_literal(action.get("package")), find_literal(action.get("executable"))
        if package and program:
            yield NamedNode(package, program, find_literal(action.get("name")) or program)


def _list_actions(actions: Collection[Action]) -> Iterator[Action]:
    for action in actions:
        yield action
        yield from _list_actions(action.children)
