"""Publish statements whose logic changed since the base, as diagnostics, for the rules of this family."""

from collections.abc import Callable, Iterator

from ...logic.changes import LogicChange
from ...logic.two_states import compare_publishing
from ...model.flow.edges import get_label
from ...model.flow.graph import Endpoint, Graph
from ...model.flow.reach import EVERYWHERE
from ...model.flow.workspace import get_flow
from ..vocabulary import At, Diagnostic, Doubt, Workspace

_LONGEST = 120
# How the message of a changed condition goes on, and how every message of the family ends.
CONDITIONS = "its condition was {old:no condition} and is {new:no condition}"
READERS = "read by {readers:nothing in the workspace}"


def find_changes(workspace: Workspace, base: Workspace, fits: Callable[[LogicChange], bool]) -> Iterator[Diagnostic]:
    """A diagnostic for each publish statement whose change fits, at its place now. Its data: `change` (what changed, in
    a clause), `old` and `new` (conditions), `readers`. Without a reader in the workspace nothing there depends on it.
    """
    for change in compare_publishing(workspace, base):
        if not fits(change) or not EVERYWHERE.isdisjoint(change.topics):
            continue
        readers = _list_node_names(get_flow(workspace).graph, find_readers(get_flow(workspace).graph, change))
        data = {"change": change.why, "old": _quote(change.old), "new": _quote(change.new), "readers": readers}
        doubts = () if readers else (Doubt.CHANGED,)
        yield Diagnostic(At(change.path, change.line), change.topic, change.package, data, doubts=doubts)


def find_readers(graph: Graph, change: LogicChange) -> list[Endpoint]:
    """The subscribers that a change reaches, one for each node and place."""
    place = (change.path, change.line)
    topics = {one.topic for one in graph.publishes if (one.path, one.line) == place and one.topic} | {*change.topics}
    found = [one for one in graph.endpoints if one.role == "subscriber" and one.topic in topics and not one.implied]
    return list({(one.node, one.path, one.line): one for one in found}.values())


def _list_node_names(graph: Graph, readers: list[Endpoint]) -> tuple[str, ...]:
    nodes = {node.id: node for node in graph.nodes}
    return tuple(dict.fromkeys(get_label(nodes[one.node]) if one.node in nodes else one.function for one in readers))


def _quote(condition: str | None) -> tuple[str, ...]:
    """A condition to be shown as code, cut where it is long; empty without one."""
    text = (condition or "").replace("`", "")
    if not text:
        return ()
    return (text if len(text) <= _LONGEST else text[: _LONGEST - 1] + "…",)
