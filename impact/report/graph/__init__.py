"""The message-flow graph drawn: text, JSON, GraphML, DOT, Mermaid and a page; the interfaces of its nodes as NoDL."""

from collections.abc import Mapping, Sequence
from importlib import import_module
from typing import Any

from ...model.flow.definitions import Sections
from ...model.flow.graph import COPIED, LOST_INCLUDE, Graph
from ...model.flow.select import NothingSelected, Selection, extract_part, select_graph, select_whole_nodes
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


def draw_nodes(graph: Graph, *, nodes: Sequence[str] = (), packages: Sequence[str] = ()) -> dict[str, str]:
    """A NoDL document for each node asked for, all when none is, by the path of a file for it. Raises UserError."""
    from .nodl import make_documents

    return make_documents(select_whole_nodes(graph, nodes=nodes, packages=packages))
def list_unknown_names(graph: Graph, **asked: Any) -> list[str]:
    """`path:line: what is not known` of each call whose name or type is not known, or is known in part only; sorted.
    asked: as for draw(); then only of the files of the part that is asked for."""
    selected = select_graph(graph, everything=True, **asked)
    part = selected.graph
    paths = {each.path for each in (*part.endpoints, *part.publishes, *part.parameters)}
    lost = [
        (one.path, one.line, f"{one.what}{f' `{one.written}`' * bool(one.written)}: {one.reason}")
        for one in graph.coverage.unresolved
        if not one.what.startswith(("started ", LOST_INCLUDE)) and not one.what.endswith(" callback")
        if one.what != COPIED
        if not selected.asked or one.path in paths
    ]
    lost += [
        (one.path, one.line, f"{one.role} name `{one.written}`: known in part only, as `{one.topic}`")
        for one in part.endpoints
        if one.how == "partly"
    ]
    return [f"{path}:{line}: {text}" for path, line, text in sorted(set(lost))]


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
