"""The message-flow graph as a Mermaid flowchart, for Markdown pages."""

from __future__ import annotations

from ...model.flow.graph import Graph
from ..select import Selection
from .dot import COLOURS
from .edges import edges, names_of

MOST = 280
"""Edges that Mermaid draws by default are 500 (its maxEdges); beyond a few hundred nobody sees anything."""


def render(selection: Selection, base: Graph | None, everything: bool) -> str:
    """A flowchart (https://mermaid.js.org/syntax/flowchart.html). What goes beyond MOST edges is left out and said."""
    graph = selection.graph
    names = (names_of(base) if base is not None else {}) | names_of(graph)
    found = [edge for edge in edges(graph, base) if edge.node in names]
    kept = found[:MOST]
    ids: dict[tuple[str, str], str] = {}

    def id_of(kind: str, name: str) -> str:
        return ids.setdefault((kind, name), f"{kind[0]}{len(ids)}")

    lines = ["flowchart LR"]
    if len(kept) < len(found):
        lines.append(f"  %% {len(found) - len(kept)} of {len(found)} edges are left out: ask for less with --around")
    links, styles = [], []
    for edge in kept:
        node, name = id_of("node", edge.node), id_of(edge.kind, edge.name)
        ends = (node, name) if edge.outward else (name, node)
        if edge.mark:
            styles.append(f"  linkStyle {len(links)} stroke:{COLOURS[edge.mark]},stroke-width:3px")
        links.append(f"  {ends[0]} {'-->' if edge.kind == 'topic' else '-.->'} {ends[1]}")
    for (kind, name), short in ids.items():
        label = escaped(names.get(name, name) if kind == "node" else name)
        lines.append(f'  {short}(["{label}"])' if kind == "node" else f'  {short}["{label}"]')
    return "\n".join([*lines, *links, *styles]) + "\n"


def escaped(text: str) -> str:
    """A label's text: what Mermaid would read as its own is written as an entity."""
    return "".join(c if c.isalnum() or c in " /_-.:~" else f"#{ord(c)};" for c in text)
