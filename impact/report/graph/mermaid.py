"""The message-flow graph as a Mermaid flowchart, for Markdown pages."""

from ....edges.console import escape
from ...model.flow.connections import Edge, list_edges, name_nodes
from ...model.flow.graph import Graph
from ...model.flow.select import Selection
from .dot import COLOURS

MOST = 280
"""Edges that Mermaid draws by default are 500 (its maxEdges); beyond a few hundred nobody sees anything."""
ROOM = 50_000
"""Characters that Mermaid reads by default (its maxTextSize)."""
_LINES = 90
"""Characters around the names of an edge and its ends, at most."""


def render(selection: Selection, base: Graph | None) -> str:
    """A flowchart (https://mermaid.js.org/syntax/flowchart.html). What goes beyond MOST edges or ROOM is left out, what
    differs from the base last, and said."""
    graph = selection.graph
    names = (name_nodes(base.nodes) if base is not None else {}) | name_nodes(graph.nodes)
    found = [edge for edge in list_edges(graph, base) if edge.node in names]
    kept = _select_edges(found, names)
    ids: dict[tuple[str, str], str] = {}

    def assign_id(kind: str, name: str) -> str:
        return ids.setdefault((kind, name), f"{kind[0]}{len(ids)}")

    lines = ["flowchart LR"]
    if len(kept) < len(found):
        lines.append(f"  %% {len(found) - len(kept)} of {len(found)} edges are left out: ask for less with --around")
    links, styles = [], []
    for edge in kept:
        node, name = assign_id("node", edge.node), assign_id(edge.kind, edge.name)
        ends = (node, name) if edge.outward else (name, node)
        if edge.mark:
            styles.append(f"  linkStyle {len(links)} stroke:{COLOURS[edge.mark]},stroke-width:3px")
        links.append(f"  {ends[0]} {'-->' if edge.kind == 'topic' else '-.->'} {ends[1]}")
    for (kind, name), short in ids.items():
        label = escape_label(names.get(name, name) if kind == "node" else name)
        lines.append(f'  {short}(["{label}"])' if kind == "node" else f'  {short}["{label}"]')
    return "\n".join([*lines, *links, *styles]) + "\n"


def _select_edges(found: list[Edge], names: dict[str, str]) -> list[Edge]:
    """Edges for which there is room, those that differ from the base before others, in the order given."""
    room = ROOM
    kept: set[int] = set()
    for place in sorted(range(len(found)), key=lambda place: not found[place].mark)[:MOST]:
        room -= len(escape_label(names[found[place].node])) + len(escape_label(found[place].name)) + _LINES
        if room < 0:
            break
        kept.add(place)
    return [edge for place, edge in enumerate(found) if place in kept]


def escape_label(text: str) -> str:
    """A label's text: what Mermaid would read as its own is written as an entity."""
    return "".join(c if c.isalnum() or c in " /_-.:~" else f"#{ord(c)};" for c in escape(text))
