"""The message-flow graph for Graphviz: nodes as ellipses, topics as boxes, services and actions with dashed edges."""

from __future__ import annotations

from ...model.flow.graph import Graph
from ...report.report import safe
from ..select import Selection
from .edges import Edge, edges, names_of

COLOURS = {"added": "#1a7f37", "removed": "#cf222e", "changed": "#bf8700", "": ""}
_SHAPES = {"topic": "box", "service": "diamond", "action": "hexagon"}


def render(selection: Selection, base: Graph | None) -> str:
    """A digraph in the DOT language (https://graphviz.org/doc/info/lang.html)."""
    graph = selection.graph
    names = (names_of(base) if base is not None else {}) | names_of(graph)
    found = [edge for edge in edges(graph, base) if edge.node in names]
    lines = ["digraph message_flow {", "  rankdir=LR;", "  node [fontname=Helvetica, fontsize=10];"]
    for node in sorted({edge.node for edge in found} | {node.id for node in graph.nodes}):
        lines.append(f"  {quoted('n ' + node)} [shape=ellipse, label={_label(names[node])}];")
    for kind, name in sorted({(edge.kind, edge.name) for edge in found}):
        types = sorted({t for edge in found if (edge.kind, edge.name) == (kind, name) for t in edge.types})
        label = "\n".join([name, *types])
        lines.append(f"  {quoted(f'{kind} {name}')} [shape={_SHAPES[kind]}, style=rounded, label={_label(label)}];")
    lines.extend(_edge(edge) for edge in found)
    return "\n".join([*lines, "}"]) + "\n"


def _edge(edge: Edge) -> str:
    ends = [quoted("n " + edge.node), quoted(f"{edge.kind} {edge.name}")]
    style = []
    if edge.kind != "topic":
        style.append("style=dashed")
    if edge.mark:
        style += [f'color="{COLOURS[edge.mark]}"', "penwidth=2", f"tooltip={quoted(edge.mark + ' ' + edge.why)}"]
    tail = f" [{', '.join(style)}]" if style else ""
    return f"  {' -> '.join(ends if edge.outward else reversed(ends))}{tail};"


def _label(text: str) -> str:
    """A label: as a string, in which `&amp;` and the like would be one character."""
    return quoted(text.replace("&", "&amp;"))


def quoted(text: str) -> str:
    """A quoted string of DOT: a backslash is itself, a line's end is `\\n`, what moves a cursor is a placeholder."""
    return '"' + safe(text).replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n") + '"'
