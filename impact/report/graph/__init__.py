"""The message-flow graph drawn: text, JSON, GraphML, DOT, Mermaid and a page."""

from collections.abc import Mapping, Sequence
from importlib import import_module
from typing import Any

from ...model.flow.definitions import Sections
from ...model.flow.graph import Graph
from ...model.flow.select import NothingSelected, Selection, extract_part, select_graph
from ..style import Style
from .text import WIDE
from .text import render as as_text


def draw(
    graph: Graph, format: str, base: Graph | None = None, *, nodes: Sequence[str] = (),
    topics: Sequence[str] = (), packages: Sequence[str] = (), around: str = "", hops: int = 2,
    everything: bool = False, style: Style = WIDE, editor: str = "", folder: str = "",
    interfaces: Mapping[str, Sections] | None = None,
) -> str:  # fmt: skip
    """A graph in the format of one of the modules here. base: what it is compared with; what differs is then marked.

    nodes to everything: as for select_graph(). style: how text is written. editor, folder, interfaces: of the page, as
    in PageContext. Raises NothingSelected.
    """
    keep = everything or format in ("json", "html")
    asked: dict[str, Any] = {
        "nodes": nodes, "topics": topics, "packages": packages, "around": around, "hops": hops, "everything": keep,
    }  # fmt: skip
    part, before = (select_graph(graph, **asked), None) if base is None else _select_compared(graph, base, asked)
    if format == "text":
        return as_text(part, before, everything, style)
    if format == "html":
        from .html import PageContext, render  # no other format needs it

        return render(part, before, PageContext(editor, folder, interfaces or {}, everything))
    return import_module(f".{format}", __name__).render(part, before)


def _select_compared(graph: Graph, base: Graph, asked: dict[str, Any]) -> tuple[Selection, Graph]:
    """Parts of a graph and of its base to be compared: what was asked for in either, so that nothing is new or gone
    because the question alone found it on one side. Raises NothingSelected where it finds nothing in both."""
    parts: list[Selection] = []
    missing: list[NothingSelected] = []
    for each in (graph, base):
        try:
            parts.append(select_graph(each, **asked))
        except NothingSelected as nothing:
            missing.append(nothing)
    if not parts:
        raise missing[0]
    nodes = {node.id for part in parts for node in part.graph.nodes}
    nodes |= {endpoint.node for part in parts for endpoint in part.graph.endpoints}
    names = {each.topic for part in parts for each in (*part.graph.endpoints, *part.graph.publishes)}
    now, before = (extract_part(each, nodes, names) for each in (graph, base))
    return Selection(now, max(part.hidden for part in parts), parts[0].asked), before
