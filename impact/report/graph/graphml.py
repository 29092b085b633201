"""The message-flow graph as GraphML, for graph tools."""

from ....edges.console import escape, escape_page
from ...model.flow.connections import list_edges, name_nodes
from ...model.flow.graph import Graph
from ...model.flow.select import Selection


def render(selection: Selection, base: Graph | None) -> str:
    """A directed graph of nodes and names (http://graphml.graphdrawing.org/), edges with role, place and guards."""
    import networkx

    from ...model.flow.connections import format_guards

    graph = selection.graph
    names = (name_nodes(base.nodes) if base is not None else {}) | name_nodes(graph.nodes)
    drawn: networkx.MultiDiGraph = networkx.MultiDiGraph()
    packages = {node.id: node.package for node in (*(base.nodes if base is not None else ()), *graph.nodes)}
    for node in graph.nodes:
        drawn.add_node(f"node {node.id}", kind="node", name=names[node.id], package=node.package)
    for edge in list_edges(graph, base):
        if edge.node not in names:
            continue
        node, name = f"node {edge.node}", f"{edge.kind} {edge.name}"
        drawn.add_node(node, kind="node", name=names[edge.node], package=packages[edge.node])
        drawn.add_node(name, kind=edge.kind, name=edge.name, type=" ".join(edge.types))
        place = f"{edge.endpoints[0].path}:{edge.endpoints[0].line}"
        guards = " or ".join(text for text in map(format_guards, edge.publishes) if text)
        ends = (node, name) if edge.outward else (name, node)
        drawn.add_edge(*ends, role=edge.role, place=place, guards=guards, change=edge.mark)
    # What stands between the tags has no `#` of ours, so that its entity can stand for it anywhere.
    return "\n".join(networkx.generate_graphml(_clean(drawn))).replace("##", "&#35;&#35;") + "\n"


def _clean(drawn):
    """Without characters that XML cannot hold, in ids and in what is said of them."""
    import networkx

    drawn = networkx.relabel_nodes(drawn, {name: _make_printable(name) for name in drawn})
    for _, data in drawn.nodes(data=True):
        data.update({key: _make_printable(value) for key, value in data.items()})
    for _, _, data in drawn.edges(data=True):
        data.update({key: _make_printable(value) for key, value in data.items()})
    return drawn


def _make_printable(text: str) -> str:
    """Text of one line that XML can hold."""
    return escape_page(text).replace("\n", escape("\n")).replace("\t", escape("\t"))
