"""The message-flow graph as JSON, see docs/graph.schema.json."""

from __future__ import annotations

import json
from typing import Any

import msgspec

from ....corpus import __version__
from ...model.flow.graph import Endpoint, Graph
from ..select import Selection, endpoints_of
from .edges import edges

SCHEMA = 1
_LISTS = {
    "publisher": "publishers", "subscriber": "subscribers", "server": "servers", "client": "clients",
    "action server": "action_servers", "action client": "action_clients",
}  # fmt: skip


def render(selection: Selection, base: Graph | None, everything: bool) -> str:
    """The graph as one JSON object."""
    graph = selection.graph
    found: dict[str, Any] = {
        "schema": SCHEMA,
        "tool": {"name": "rosimpact", "version": __version__},
        "workspace": graph.root,
        "rev": graph.rev,
        "ros": graph.ros,
        "nodes": msgspec.to_builtins(graph.nodes),
        "topics": [],
        "services": [],
        "actions": [],
    }
    for (kind, name), endpoints in endpoints_of(graph).items():
        row: dict[str, Any] = {"name": name, "types": sorted({e.type for e in endpoints if e.type})}
        for role in dict.fromkeys(endpoint.role for endpoint in endpoints):
            row[_LISTS[role]] = sorted({e.node for e in endpoints if e.role == role})
        found[f"{kind}s"].append(row)
    for role, name in _LISTS.items():
        found[name] = [_endpoint(endpoint) for endpoint in graph.endpoints if endpoint.role == role]
    found["publishes"] = msgspec.to_builtins(graph.publishes)
    found["timers"] = msgspec.to_builtins(graph.timers)
    found["parameters"] = msgspec.to_builtins(graph.parameters)
    found["coverage"] = msgspec.to_builtins(graph.coverage)
    if base is not None:
        found["base"] = base.rev
        found["changes"] = [
            {"change": edge.mark, "why": edge.why, "node": edge.node, "name": edge.name, "kind": edge.kind,
             "role": edge.role, "path": edge.endpoints[0].path, "line": edge.endpoints[0].line}
            for edge in edges(graph, base)
            if edge.mark
        ]  # fmt: skip
    return json.dumps(found, indent=1, ensure_ascii=False) + "\n"


def _endpoint(endpoint: Endpoint) -> dict[str, Any]:
    row = msgspec.to_builtins(endpoint)
    del row["role"]
    return row
