"""The message-flow graph as one self-contained, interactive page: it works from a file and loads nothing.

The page lays the graph out itself, so that what a filter leaves is laid out anew.
"""

import json
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any, NamedTuple

import msgspec

from ....edges.version import __version__
from ...model.flow.connections import Edge, list_edges, name_nodes
from ...model.flow.definitions import Sections, make_key
from ...model.flow.graph import Endpoint, Graph, GuardAt, ParameterUse, Publish
from ...model.flow.names import is_open
from ...model.flow.select import Selection, is_standard
from ..page import render_page
from .rates import find_rate

_WAYS = 12
_LONGEST = 2000


class PageContext(NamedTuple):
    """What the page has besides the graph. editor: the address of a place in an editor, with `{path}` and `{line}`,
    empty for no links; folder: the full path of the workspace; interfaces: as describe_interfaces() gives them;
    everything: names that most nodes have are shown at first."""

    editor: str = ""
    folder: str = ""
    interfaces: Mapping[str, Sections] = {}
    everything: bool = False


def render(selection: Selection, base: Graph | None, context: PageContext) -> str:
    """The page as text."""
    template = Path(__file__).with_name("assets") / "graph.html"
    return render_page(template, f"rosimpact graph: {selection.graph.root}", _build_data(selection, base, context))


def _build_data(selection: Selection, base: Graph | None, context: PageContext) -> dict[str, Any]:
    graph = selection.graph
    found = list_edges(graph, base)
    nodes = _build_nodes(graph, base, {edge.node for edge in found})
    places = {node["id"]: place for place, node in enumerate(nodes)}
    names = _build_names(found)
    named = {(name["kind"], name["name"]): place for place, name in enumerate(names)}
    return {
        "version": __version__,
        "root": graph.root,
        "rev": graph.rev,
        "base": None if base is None else base.rev or "the base",
        "ros": graph.ros,
        "editor": context.editor,
        "folder": context.folder,
        "everything": context.everything,
        "interfaces": _select_interfaces(context.interfaces, names),
        "nodes": nodes,
        "names": names,
        "edges": [
            _build_edge(edge) | {"node": places.get(edge.node, -1), "name": named[edge.kind, edge.name]}
            for edge in found
        ],
        "outside": msgspec.to_builtins(graph.outside),
        "coverage": msgspec.to_builtins(graph.coverage),
    }


def _build_nodes(graph: Graph, base: Graph | None, used: set[str]) -> list[dict[str, Any]]:
    """The nodes of the graph, then those of the base alone that have edges, with what is no edge."""
    old = {} if base is None else {node.id: node for node in base.nodes}
    now = {node.id for node in graph.nodes}
    labels = (name_nodes(base.nodes) if base is not None else {}) | name_nodes(graph.nodes)
    rows: dict[str, dict[str, Any]] = {}
    for node in (*graph.nodes, *(node for name, node in old.items() if name in used and name not in now)):
        mark = "" if base is None else "removed" if node.id not in now else "" if node.id in old else "added"
        row = msgspec.to_builtins(node) | {"label": labels[node.id], "mark": mark}
        rows[node.id] = row | {"timers": [], "parameters": [], "unnamed": []}
    for timer in graph.timers:
        if timer.node in rows:
            rows[timer.node]["timers"].append(msgspec.to_builtins(timer))
    for (node, name), uses in _collect_parameters(graph).items():
        if node in rows:
            first = next((use for use in uses if use.kind == "declared"), uses[0])
            kinds = ", ".join(dict.fromkeys(use.kind for use in uses))
            rows[node]["parameters"].append([name, first.default, kinds, first.path, first.line, len(uses) - 1])
    for one in (*graph.endpoints, *graph.publishes):
        if not one.topic and one.node in rows:
            rows[one.node]["unnamed"].append(_build_unnamed(one))
    return [row | {key: _remove_duplicates(row[key]) for key in ("timers", "unnamed")} for row in rows.values()]


def _collect_parameters(graph: Graph) -> dict[tuple[str, str], list[ParameterUse]]:
    """The uses of each parameter of each node: one that many functions read is one all the same."""
    found: dict[tuple[str, str], list[ParameterUse]] = {}
    for use in dict.fromkeys(graph.parameters):
        found.setdefault((use.node, use.name), []).append(use)
    return found


def _build_unnamed(one: Endpoint | Publish) -> dict[str, Any]:
    """What a node does under a name that is not known."""
    role, written = (one.role, one.written) if isinstance(one, Endpoint) else ("publish", one.variable)
    return {"role": role, "written": written, "type": one.type, "path": one.path, "line": one.line, "why": one.reason}


def _build_names(found: Iterable[Edge]) -> list[dict[str, Any]]:
    """Topics, services and actions; one that all its edges mark alike is marked so itself."""
    groups: dict[tuple[str, str], list[Edge]] = {}
    for edge in found:
        groups.setdefault((edge.kind, edge.name), []).append(edge)
    rows = []
    for (kind, name), group in groups.items():
        marks = {edge.mark for edge in group}
        mark = next(iter(marks)) if marks in ({"added"}, {"removed"}) else ""
        types = sorted({t for e in group for t in e.types})
        rows.append({
            "kind": kind, "name": name, "types": types, "keys": [make_key(kind, type_) for type_ in types],
            "mark": mark, "open": is_open(name), "standard": is_standard(name), "rates": _list_rates(group),
        })  # fmt: skip
    return rows


def _list_rates(group: Iterable[Edge]) -> list[list[Any]]:
    """The periods of the timers that publish on a topic, as written, each with how often a second that is."""
    periods = {
        trigger.detail: None
        for edge in group
        if edge.mark != "removed"
        for publish in edge.publishes
        for trigger in publish.triggers
        if trigger.kind == "timer" and trigger.detail
    }
    return [[period[:_LONGEST], find_rate(period)] for period in periods]


def _select_interfaces(known: Mapping[str, Sections], names: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    """Of interfaces, those that the names of the page have, with what is nested in them."""
    found: dict[str, Any] = {}
    left = [key for name in names for key in name["keys"]]
    while left:
        key = left.pop()
        if key in known and key not in found:
            found[key] = known[key]
            left += [member.nested for members in known[key].values() for member in members if member.nested]
    return found


def _build_edge(edge: Edge) -> dict[str, Any]:
    row = {"role": edge.role, "outward": edge.outward, "mark": edge.mark, "why": edge.why, **_describe_edge(edge)}
    return row if edge.before is None else row | {"before": _describe_edge(edge.before)}


def _describe_edge(edge: Edge) -> dict[str, Any]:
    """What the sources say of an edge: types, where it is made, where is published."""
    return {
        "types": edge.types,
        "at": _remove_duplicates(map(_build_endpoint, edge.endpoints)),
        "publishes": _remove_duplicates(map(_build_publish, edge.publishes)),
    }


def _build_endpoint(endpoint: Endpoint) -> dict[str, Any]:
    row = msgspec.to_builtins(endpoint)
    return {
        key: row[key]
        for key in ("path", "line", "type", "written", "how", "qos", "callback", "function", "implied", "only_if")
    }


def _build_publish(publish: Publish) -> dict[str, Any]:
    """A publish statement: what is published, and for each way to it what starts it and its guards, outermost first.

    Where no way is known, the guards around the statement stand alone."""
    ways = [[_format(way.trigger.kind, way.trigger.detail), list(map(_build_guard, way.guards))] for way in publish.by]
    if not ways:
        started = [_format(trigger.kind, trigger.detail) for trigger in publish.triggers]
        ways = [[", ".join(dict.fromkeys(filter(None, started))), list(map(_build_guard, publish.guards))]]
    ways = _remove_duplicates(ways)
    return {
        "path": publish.path,
        "line": publish.line,
        "function": publish.function,
        "expression": publish.expression[:_LONGEST],
        "ways": ways[:_WAYS],
        "more": len(ways) - len(ways[:_WAYS]),
    }


def _format(kind: str, detail: str) -> str:
    return "" if kind == "unknown" else f"{kind} {detail}".strip()


def _build_guard(guard: GuardAt) -> list[Any]:
    """Text, path, line."""
    text = {"if": "{}", "unless": "not ({})"}.get(guard.kind, f"{guard.kind} {{}}").replace("{}", guard.text)
    return [text[:_LONGEST], guard.path, guard.line]


def _remove_duplicates(rows: Iterable[Any]) -> list[Any]:
    """The rows without repetitions, in their order."""
    return list({json.dumps(row, default=str): row for row in rows}.values())
