"""Nodes that launch files start and whose code is not in the workspace: possible ones, since nothing tells their names
and what they publish."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from msgspec import structs

from ..launch.result import Launched, ShareLine, Started
from .graph import Graph, OutsideNode
from .names import make_open_part
from .started import make_instance

# Programs of no node of their own: containers are there for what is loaded into them.
_PLAIN = frozenset(("process", "container", "test"))


def list_outside(
    launch: Launched, known: Iterable[Started], locate: Callable[[ShareLine], tuple[str, int]]
) -> Iterator[OutsideNode]:
    """The nodes and launch files of other packages that a launch starts. known: what it starts of the workspace;
    locate: the workspace path of a line in a package's share folder."""
    here = {id(started) for started in known}
    for started in launch.started:
        if id(started) not in here and started.kind not in _PLAIN:
            program = started.plugin if started.plugin.shown else started.executable
            own = program.shown.rpartition("::")[2].rpartition("/")[2]
            instance = make_instance(launch, make_open_part(f"<{own}>"), started)
            names = dict.fromkeys(remap.new.shown for remap in started.remaps if remap.new.shown)
            yield OutsideNode(
                instance.name, started.package.shown, program.shown, "node", _spell_place(locate(started.at)),
                instance.uncertain, tuple(names),
            )  # fmt: skip
    for include in launch.outside:
        yield OutsideNode(
            "", include.package.shown, include.executable.shown, "launch file", _spell_place(locate(include.at)),
            include.conditions,
        )  # fmt: skip


def _spell_place(place: tuple[str, int]) -> str:
    return f"{place[0]}:{place[1]}"


def drop_known(graph: Graph) -> Graph:
    """A graph without possible nodes that are nodes of it all the same, as bridges are."""
    started = {node.started for node in graph.nodes}
    left = tuple(one for one in graph.outside if one.started not in started)
    return graph if len(left) == len(graph.outside) else structs.replace(graph, outside=left)
