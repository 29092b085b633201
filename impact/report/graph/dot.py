"""The message-flow graph for Graphviz: nodes as ellipses, topics as boxes, services and actions with dashed edges."""

from ....edges.console import escape
from ...model.flow.connections import Edge, list_edges, name_nodes
from ...model.flow.graph import Graph
from ...model.flow.select import Selection

COLOURS = {"added": "#1a7f37", "removed": "#cf222e", "changed": "#bf8700", "": ""}
_SHAPES = {"topic": "box", "service": "diamond", "action": "hexagon"}


def render(selection: Selection, base: Graph | None) -> str:
    """A digraph in the DOT language (https://graphviz.org/doc/info/lang.html)."""
    graph = selection.graph
    names = (name_nodes(base.nodes) if base is not None else {}) | name_nodes(graph.nodes)
    found = [edge for edge in list_edges(graph, base) if edge.node in names]
    lines = ["digraph message_flow {", "  rankdir=LR;", "  node [fontname=Helvetica, fontsize=10];"]
    for node in sorted({edge.node for edge in found} | {node.id for node in graph.nodes}):
        lines.append(f"  {quote_text('n ' + node)} [shape=ellipse, label={_format_label(names[node])}];")
    for kind, name in sorted({(edge.kind, edge.name) for edge in found}):
        types = sorted({t for edge in found if (edge.kind, edge.name) == (kind, name) for t in edge.types})
        label = _format_label(name, *types)
        lines.append(f"  {quote_text(f'{kind} {name}')} [shape={_SHAPES[kind]}, style=rounded, label={label}];")
    lines.extend(_render_edge(edge) for edge in found)
    return "\n".join([*lines, "}"]) + "\n"


def _render_edge(edge: Edge) -> str:
    ends = [quote_text("n " + edge.node), quote_text(f"{edge.kind} {edge.name}")]
    style = []
    if edge.kind != "topic":
        style.append("style=dashed")
    if edge.mark:
        style += [f'color="{COLOURS[edge.mark]}"', "penwidth=2", f"tooltip={_format_label(edge.mark + ' ' + edge.why)}"]
    tail = f" [{', '.join(style)}]" if style else ""
    return f"  {' -> '.join(ends if edge.outward else reversed(ends))}{tail};"


def _format_label(*lines: str) -> str:
    """A label: as a string, in which `\\n` ends a line, and `&amp;` and the like would be one character."""
    return '"' + "\\n".join(quote_text(line.replace("&", "&amp;"))[1:-1] for line in lines) + '"'


def quote_text(text: str) -> str:
    """A quoted string of DOT on one line: a backslash is itself, what a terminal or CI obeys is shown escaped."""
    return '"' + escape(text).replace("\\", "\\\\").replace('"', '\\"') + '"'
