"""The message-flow graph as JSON, see docs/graph.schema.json."""

from typing import Any

import msgspec

from ....edges.console import format_json
from ....edges.version import __version__
from ...model.flow.connections import list_edges
from ...model.flow.graph import Coverage, Endpoint, Graph, Node, OutsideNode, ParameterUse, Publish, Timer
from ...model.flow.select import Selection, group_endpoints
from ..schemas import SCHEMA, STABLE, generate_schema

_LISTS = {
    "publisher": "publishers", "subscriber": "subscribers", "server": "servers", "client": "clients",
    "action server": "action_servers", "action client": "action_clients",
}  # fmt: skip


def render(selection: Selection, base: Graph | None) -> str:
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
    for (kind, name), endpoints in group_endpoints(graph).items():
        row: dict[str, Any] = {"name": name, "types": sorted({e.type for e in endpoints if e.type})}
        for role in dict.fromkeys(endpoint.role for endpoint in endpoints):
            row[_LISTS[role]] = sorted({e.node for e in endpoints if e.role == role})
        found[f"{kind}s"].append(row)
    for role, name in _LISTS.items():
        found[name] = [_build_endpoint(endpoint) for endpoint in graph.endpoints if endpoint.role == role]
    found["publishes"] = msgspec.to_builtins(graph.publishes)
    found["timers"] = msgspec.to_builtins(graph.timers)
    found["parameters"] = msgspec.to_builtins(graph.parameters)
    found["possible_nodes"] = msgspec.to_builtins(graph.outside)
    found["coverage"] = msgspec.to_builtins(graph.coverage)
    if base is not None:
        found["base"] = base.rev
        found["changes"] = [
            {"change": edge.mark, "why": edge.why, "node": edge.node, "name": edge.name, "kind": edge.kind,
             "role": edge.role, "path": edge.endpoints[0].path, "line": edge.endpoints[0].line}
            for edge in list_edges(graph, base)
            if edge.mark
        ]  # fmt: skip
    return format_json(found) + "\n"


def render_schema() -> str:
    """The JSON schema (draft 2020-12) of what render() gives; docs/graph.schema.json holds it."""
    kinds = [Node, Endpoint, Publish, Timer, ParameterUse, OutsideNode, Coverage]
    (node, endpoint, publish, timer, parameter, outside, coverage), parts = msgspec.json.schema_components(
        kinds, ref_template="#/$defs/{name}"
    )
    parts["Endpoint"]["properties"].pop("role")
    parts["Endpoint"]["required"].remove("role")
    text, texts = {"type": "string"}, {"type": "array", "items": {"type": "string"}}
    change = dict.fromkeys(("why", "node", "name", "kind", "role", "path"), text)
    change |= {"change": {"enum": ["added", "removed", "changed"]}, "line": {"type": "integer"}}
    name = {"name": text, "types": texts} | {each: texts for each in _LISTS.values()}
    properties: dict[str, Any] = {
        "workspace": text,
        "rev": text,
        "ros": {"enum": [1, 2]},
        "nodes": {"type": "array", "items": node},
        **{kind: {"type": "array", "items": {"$ref": "#/$defs/Name"}} for kind in ("topics", "services", "actions")},
        **{each: {"type": "array", "items": endpoint} for each in _LISTS.values()},
        "publishes": {"type": "array", "items": publish},
        "timers": {"type": "array", "items": timer},
        "parameters": {"type": "array", "items": parameter},
        "possible_nodes": {"type": "array", "items": outside},
        "coverage": coverage,
    }
    parts["Name"] = {
        "description": "A topic, service or action: its types, and the ids of the nodes that use it, by role.",
        "type": "object", "required": ["name", "types"], "properties": name,
    }  # fmt: skip
    described = (
        f"What `rosimpact graph --format json` prints. {STABLE} `base` and `changes` are there with --base alone."
    )
    further = {"base": text, "changes": {"type": "array", "items": {"type": "object", "properties": change}}}
    return generate_schema("message-flow graph", described, properties, parts, further)


def _build_endpoint(endpoint: Endpoint) -> dict[str, Any]:
    row = msgspec.to_builtins(endpoint)
    del row["role"]
    return row
