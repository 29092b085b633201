"""The message-flow graph as text: each topic, service and action with who uses it, and what could not be resolved."""

from __future__ import annotations

from collections.abc import Iterator

from ...model.flow.graph import Coverage, Endpoint, Graph, Publish
from ...report.report import one_line
from ..select import Selection
from .edges import Edge, edges, guard_text, names_of

_SHOWN = 20
_SIGN = {"added": "+ ", "removed": "- ", "changed": "~ ", "": "  "}
_VERBS = {
    "publisher": "publishes", "subscriber": "subscribes", "server": "serves", "client": "asks",
    "action server": "serves", "action client": "asks",
}  # fmt: skip


def render(selection: Selection, base: Graph | None, everything: bool) -> str:
    """The graph for people; everything: all that was not resolved, not the first 20 alone."""
    graph = selection.graph
    names = names_of(graph) | (names_of(base) if base is not None else {})
    lines = [_head(graph, selection.hidden), ""]
    group: list[Edge] = []
    for edge in [*edges(graph, base), None]:
        if group and (edge is None or (edge.name, edge.kind) != (group[0].name, group[0].kind)):
            lines += [*_name(group, names), ""]
            group = []
        if edge is not None:
            group.append(edge)
    lines += _coverage(graph.coverage, everything)
    return "\n".join(map(one_line, lines)) + "\n"


def _head(graph: Graph, hidden: int) -> str:
    kinds: dict[str, set[str]] = {"topic": set(), "service": set(), "action": set()}
    for edge in edges(graph):
        kinds[edge.kind].add(edge.name)
    said = [f"{len(graph.nodes)} {'node' if len(graph.nodes) == 1 else 'nodes'}"]
    said += [f"{len(found)} {kind}{'' if len(found) == 1 else 's'}" for kind, found in kinds.items() if found]
    return ", ".join(said) + (f" ({hidden} that most nodes have are hidden; --all shows them)" if hidden else "")


def _name(group: list[Edge], names: dict[str, str]) -> Iterator[str]:
    types = sorted({kind for edge in group for kind in edge.types})
    shown = " or ".join(types) if types else "type not known"
    kind = "" if group[0].kind == "topic" else f" ({group[0].kind})"
    yield f"{group[0].name}{kind}  {shown}"
    for edge in group:
        for place, endpoint in enumerate(_distinct(edge.endpoints)):
            who = names.get(edge.node, edge.node) or "(no node)"
            head = f"{_SIGN[edge.mark]}{_VERBS[edge.role]:10s} {who}" if place == 0 else f"{'':12s} "
            yield f"{head}  {endpoint.path}:{endpoint.line}{_beside(endpoint, edge)}"
        for publish in edge.publishes:
            yield from _publish(publish)


def _distinct(endpoints: tuple[Endpoint, ...]) -> list[Endpoint]:
    return list({(endpoint.path, endpoint.line): endpoint for endpoint in endpoints}.values())


def _beside(endpoint: Endpoint, edge: Edge) -> str:
    said = []
    if edge.why:
        said.append(f"changed: {edge.why}")
    if endpoint.how == "default":
        said.append("name: a parameter's default")
    if endpoint.callback is not None:
        said.append(f"→ {endpoint.callback.name}")
    qos = endpoint.qos
    if qos is not None:
        said += [value for value in (qos.reliability, qos.durability) if value not in ("", "reliable", "volatile")]
    return f"  [{'; '.join(said)}]" if said else ""


def _publish(publish: Publish) -> Iterator[str]:
    guards = guard_text(publish)
    triggers = ", ".join(dict.fromkeys(f"{t.kind} {t.detail}".strip() for t in publish.triggers if t.kind != "unknown"))
    said = [f"when {guards}"] if guards else []
    said += [f"on {triggers}"] if triggers else []
    said += [f"{publish.ways} ways"] if publish.ways > 1 else []
    yield f"{'':14s}publish at {publish.path}:{publish.line}{'  ' + '; '.join(said) if said else ''}"


def _coverage(coverage: Coverage, everything: bool) -> Iterator[str]:
    share = f", {coverage.by_default} by a parameter's default" if coverage.by_default else ""
    yield f"{coverage.resolved} of {coverage.calls} API calls resolved{share}; {coverage.files} files read"
    if coverage.unread:
        yield f"{len(coverage.unread)} of them in part: {', '.join(coverage.unread[:5])}"
    rest = coverage.unresolved if everything else coverage.unresolved[:_SHOWN]
    for one in rest:
        written = f" `{one.written}`" if one.written else ""
        yield f"  {one.path}:{one.line}: {one.what}{written}: {one.reason}"
    if len(rest) < len(coverage.unresolved):
        yield f"  and {len(coverage.unresolved) - len(rest)} more; --all lists them"
