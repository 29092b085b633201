"""Changes of the logic of publishing as hits: shared by the rules of this family."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from ...logic.changes import Change
from ...logic.two_states import publishing
from ...model.cmake.build import At
from ...model.flow.edges import said
from ...model.flow.graph import Endpoint, Graph
from ...model.flow.reach import EVERYWHERE
from ...model.workspace import Workspace
from ..rule import Hit

_LONGEST = 120
_MOST_READERS = 3


def hits(
    workspace: Workspace, base: Workspace, fits: Callable[[Change], bool], says: Callable[[Change], str], cure: str
) -> Iterator[Hit]:
    """A hit for each publish statement whose change fits, at its place now; a note where nothing in the workspace reads
    its topic. says: the change in a clause; cure: the help."""
    for change in publishing(workspace, base):
        if not fits(change) or not EVERYWHERE.isdisjoint(change.topics):
            continue
        readers = readers_of(workspace.flow, change)
        yield Hit(
            At(change.path, change.line),
            change.topic,
            f"{says(change)}; {_read_by(workspace.flow, readers)}",
            cure,
            change.package,
            severity="" if readers else "note",
        )


def conditions(change: Change) -> str:
    """The new and the old condition of a statement in a clause."""
    return f"under {quoted(change.new)}, was under {quoted(change.old)}"


def readers_of(graph: Graph, change: Change) -> list[Endpoint]:
    """The subscribers that a change reaches, one for each node and place."""
    place = (change.path, change.line)
    topics = {one.topic for one in graph.publishes if (one.path, one.line) == place and one.topic} | {*change.topics}
    found = [one for one in graph.endpoints if one.role == "subscriber" and one.topic in topics and not one.implied]
    return list({(one.node, one.path, one.line): one for one in found}.values())


def _read_by(graph: Graph, readers: Sequence[Endpoint]) -> str:
    nodes = {node.id: node for node in graph.nodes}
    told = list(dict.fromkeys(said(nodes[one.node]) if one.node in nodes else one.function for one in readers))
    if not told:
        return "nothing in the workspace reads it"
    more = f" and {len(told) - _MOST_READERS} more" if len(told) > _MOST_READERS else ""
    return "read by " + ", ".join(f"`{name}`" for name in told[:_MOST_READERS]) + more


def quoted(condition: str | None) -> str:
    """A condition as code, cut where it is long."""
    text = (condition or "").replace("`", "")
    if not text:
        return "no condition"
    return f"`{text if len(text) <= _LONGEST else text[: _LONGEST - 1] + '…'}`"
