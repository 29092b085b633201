"""The nodes of behaviour trees that released packages register, with their ports, by version:
data/tree_nodes.json.zst, see DATA.md."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Sequence
from functools import cache, cached_property

import msgspec

from ..facts.cpp.tree_nodes import COMPUTED, PORTS, NodeClass, PortFunction, RegisteredNode, TreeNodes
from .surface.includes import covers
from .tables import find_table
from .unpacked import read_table
from .version import find_newest_up_to

Spans = tuple[int, ...]
"""The first and last places of versions, over and over; none are all of them."""


class PackageNodes(msgspec.Struct, frozen=True, array_like=True):
    """What versions of a package register for those who load it, oldest first. unsure: names, each with its spans,
    that they register in some builds alone, or COMPUTED where they register what nothing tells. classes: those that
    nodes of others may derive from, too."""

    versions: tuple[str, ...]
    nodes: tuple[tuple[RegisteredNode, Spans], ...] = ()
    classes: tuple[tuple[NodeClass, Spans], ...] = ()
    functions: tuple[tuple[PortFunction, Spans], ...] = ()
    unsure: tuple[tuple[str, Spans], ...] = ()

    def read_version(self, version: str) -> TreeNodes | None:
        """What the newest version up to one has; None where all are newer."""
        found = find_newest_up_to(version, self.versions)
        return self._read_place(self.versions.index(found)) if found is not None else None

    def _read_place(self, place: int) -> TreeNodes:
        def choose(rows):
            return tuple(value for value, spans in rows if covers(spans, place))

        return TreeNodes(choose(self.nodes), choose(self.classes), choose(self.functions))

    def list_unsure(self, version: str) -> frozenset[str]:
        """The names of `unsure` in the newest version up to one."""
        found = find_newest_up_to(version, self.versions)
        place = self.versions.index(found) if found is not None else -1
        return frozenset(name for name, spans in self.unsure if place >= 0 and covers(spans, place))

    def list_all_nodes(self) -> frozenset[str]:
        """The nodes that any version surely registers."""
        return frozenset(node.name for node, _ in self.nodes)

    def iterate_versions(self) -> Iterable[tuple[str, TreeNodes]]:
        """Every version with what it has, oldest first."""
        return ((version, self._read_place(place)) for place, version in enumerate(self.versions))


class TreeNodesTable(msgspec.Struct, frozen=True):
    """packages: those that depend on BehaviorTree.CPP, or on one that does, as far as their sources were read."""

    packages: dict[str, PackageNodes]

    @property
    def libraries(self) -> frozenset[str]:
        """The packages of BehaviorTree.CPP itself."""
        return _list_libraries()

    def list_owners(self, node: str) -> tuple[str, ...]:
        """The packages of which some version surely registers a node."""
        return _index_owners().get(node, ())


@cache
def load_tree_nodes() -> TreeNodesTable:
    """The shipped table. Raises SnapshotError."""
    return read_table(find_table("tree_nodes.json.zst"), TreeNodesTable)


@cache
def _list_libraries() -> frozenset[str]:
    packages = load_tree_nodes().packages.items()
    return frozenset(name for name, package in packages if any(one.name == "TreeNode" for one, _ in package.classes))


@cache
def _index_owners() -> dict[str, tuple[str, ...]]:
    found: dict[str, list[str]] = defaultdict(list)
    for name, package in sorted(load_tree_nodes().packages.items()):
        for node in package.list_all_nodes():
            found[node].append(name)
    return {node: tuple(owners) for node, owners in found.items()}


class PortsFinder:
    """Finds the ports of classes by what some packages tell. scopes: the first that knows a name says what it is; a
    name that one of them has for two classes stands for none."""

    def __init__(self, scopes: Sequence[TreeNodes]):
        self._scopes = tuple(scopes)

    @cached_property
    def _classes(self) -> dict[str, NodeClass | None]:
        found: dict[str, NodeClass | None] = {}
        for scope in reversed(self._scopes):
            here: dict[str, NodeClass | None] = {}
            for one in scope.classes:
                here[one.name] = None if one.name in here and here[one.name] != one else one
            found.update(here)
        return found

    @cached_property
    def _functions(self) -> dict[tuple[str, str], PortFunction | None]:
        found: dict[tuple[str, str], PortFunction | None] = {}
        for scope in reversed(self._scopes):
            here: dict[tuple[str, str], PortFunction | None] = {}
            for one in scope.functions:
                key = one.of, one.name
                here[key] = None if key in here and here[key] != one else one
            found.update(here)
        return found

    def find_ports(self, class_name: str) -> frozenset[str] | None:
        """The ports of a class of a node; None where they are not known."""
        return self._evaluate(class_name, PORTS, ()) if class_name else None

    def _evaluate(self, of: str, name: str, above: tuple[tuple[str, str], ...]) -> frozenset[str] | None:
        """What a function returns that a class has, or one of its bases. above: the functions that ask for it."""
        key = of, name
        if key in above or of == COMPUTED:
            return None
        if key in self._functions:
            function = self._functions[key]
            if function is None:
                return None
            # What a function calls without a class is of the class that it belongs to.
            calls = ((other or of, called) for other, called in function.calls)
            return self._join(function.ports, calls, (*above, key))
        known = self._classes.get(of)
        if known is None or (known.own and name == PORTS) or (not known.bases and name != PORTS):
            return None
        return self._join((), ((base, name) for base in known.bases), (*above, key))

    def _join(
        self, ports: Iterable[str], calls: Iterable[tuple[str, str]], above: tuple[tuple[str, str], ...]
    ) -> frozenset[str] | None:
        found = frozenset(ports)
        for of, name in calls:
            more = self._evaluate(of, name, above)
            if more is None:
                return None
            found |= more
        return found
