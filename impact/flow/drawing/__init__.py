"""The message-flow graph drawn: text, JSON, GraphML, DOT, Mermaid and a page."""

from __future__ import annotations

from collections.abc import Sequence
from importlib import import_module

from ...model.flow.graph import Graph
from ..select import selected

FORMATS = ("text", "json", "graphml", "dot", "mermaid", "html")


def draw(
    graph: Graph, format: str, base: Graph | None = None, *, nodes: Sequence[str] = (), topics: Sequence[str] = (),
    packages: Sequence[str] = (), around: str = "", hops: int = 2, everything: bool = False,
) -> str:  # fmt: skip
    """A graph in one of FORMATS. base: what it is compared with: then what is new, gone and changed is marked.

    nodes to everything: as for selected(). Raises NothingSelected.
    """
    asked = {"topics": topics, "packages": packages, "around": around, "hops": hops}
    keep = everything or format == "json"
    part = selected(graph, nodes=nodes, everything=keep, **asked)
    before = None
    if base is not None:
        names = [node.id for node in part.graph.nodes]
        before = _of_base(base, names, topics, keep) if nodes or topics or packages or around else base
    module = import_module(f".{format}", __name__)
    return module.render(part, before, everything)


def _of_base(base: Graph, nodes: Sequence[str], topics: Sequence[str], everything: bool) -> Graph:
    """The part of a base that a part of the graph is compared with: the same nodes, or the same topics."""
    from msgspec import structs

    from ..select import fitting

    kept = tuple(node for node in base.nodes if node.id in set(nodes))
    known = {node.id for node in kept}
    return structs.replace(
        base,
        nodes=kept,
        endpoints=tuple(e for e in base.endpoints if e.node in known and fitting(e.topic, topics, everything)),
        publishes=tuple(p for p in base.publishes if p.node in known and fitting(p.topic, topics, everything)),
    )
