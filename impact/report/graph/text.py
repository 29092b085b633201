"""The message-flow graph as text: each topic, service and action with who uses it, and what could not be resolved."""

from collections.abc import Collection, Iterator, Mapping, Sequence
from operator import itemgetter

from ....edges.console import format_count
from ...model.flow.connections import Edge, list_conditions, list_edges, name_nodes
from ...model.flow.graph import Coverage, Endpoint, Graph, OutsideNode, Publish, Unresolved, Way
from ...model.flow.select import Selection
from ..columns import UNBROKEN, LinePart, lay_out
from ..style import PLAIN, Style
from .conditions import ROOM, GuardKey, find_shared, format_when

# Of what a search of the text finds beside what is understood.
_SEARCHED = 5
_SHOWN = 20
_HANG, _NODES = 6, 14
_SIGN = {"added": "+ ", "removed": "- ", "changed": "~ ", "": "  "}
_ROLES = {"added": "good", "removed": "error", "changed": "warning", "": ""}
VERBS = {
    "publisher": "publishes", "subscriber": "subscribes", "server": "serves", "client": "asks",
    "action server": "serves", "action client": "asks",
}  # fmt: skip
WIDE = PLAIN._replace(width=UNBROKEN)


def render(selection: Selection, base: Graph | None, everything: bool = False, style: Style = WIDE) -> str:
    """The graph for people; everything: whole conditions, and all that was not resolved, not the first 20 alone."""
    graph, room = selection.graph, UNBROKEN if everything else ROOM
    names = name_nodes(graph.nodes) | (name_nodes(base.nodes) if base is not None else {})
    found = list_edges(graph, base)
    lines = [*_render_head(found, graph, selection.hidden, style), ""]
    groups: dict[tuple[str, str], list[Edge]] = {}
    for edge in found:
        groups.setdefault((edge.name, edge.kind), []).append(edge)
    for group in groups.values():
        lines += [*_render_name(group, names, style, room), ""]
    alone = {names[node.id] for node in graph.nodes} - {names.get(edge.node, "") for edge in found}
    lost = alone & {names.get(each.node, "") for each in (*graph.endpoints, *graph.publishes) if not each.topic}
    verb = "talks" if len(lost) == 1 else "talk"
    unknown = f"that {verb} under names that are not known"
    for what, which in ((unknown, lost), ("with none of these", alone - lost)):
        if which:
            said = f"{format_count(len(which), 'node')} {what}: {', '.join(sorted(which))}"
            lines += [*lay_out([LinePart(said)], style, 0, 2), ""]
    lines += _render_uncertain(graph, names, everything, style)
    lines += _render_outside(graph, everything, style)
    near = graph.coverage.unresolved
    if selection.asked and not everything:
        paths = {each.path for each in (*graph.endpoints, *graph.publishes)}
        near = tuple(one for one in near if one.path in paths)
    lines += render_coverage(graph.coverage, near, everything, style)
    return "\n".join(lines) + "\n"


def _render_uncertain(graph: Graph, names: Mapping[str, str], everything: bool, style: Style) -> Iterator[str]:
    """The nodes that may not be started, or may have another name, with the reasons."""
    why = {names[node.id]: "; ".join(node.uncertain) for node in graph.nodes if node.uncertain and node.id in names}
    if not why:
        return
    said = f"{format_count(len(why), 'node')} that may not be started, or may have another name:"
    yield from lay_out([LinePart(said)], style, 0, 2)
    shown = sorted(why.items())
    for name, reasons in shown if everything else shown[:_SHOWN]:
        yield from lay_out([LinePart(f"{name}: {reasons}")], style, 2, 4)
    if not everything and len(shown) > _SHOWN:
        yield from lay_out([LinePart(f"and {len(shown) - _SHOWN:,} more; --all lists them")], style, 2, _HANG)
    yield ""


def _render_outside(graph: Graph, everything: bool, style: Style) -> Iterator[str]:
    """What launch files start whose code is not here."""
    if not graph.outside:
        return
    said = f"{format_count(len(graph.outside), 'possible node')}, started by launch files, whose code is not here:"
    yield from lay_out([LinePart(said)], style, 0, 2)
    rows: dict[tuple[str, ...], OutsideNode] = {}
    for one in graph.outside:
        rows.setdefault((one.name, one.package, one.executable), one)
    shown = sorted(rows.items())
    for (name, package, executable), one in shown if everything else shown[:_SHOWN]:
        what = f"{name or 'any of'}  {package or '(no package)'}/{executable}"
        beside = [f"uses {', '.join(one.names)}"] if one.names else []
        beside += [f"only if {'; '.join(one.uncertain)}"] if one.uncertain else []
        line = [LinePart(what), LinePart("", path=one.started)]
        line += [LinePart(f"[{'; '.join(beside)}]", "dim")] if beside else []
        yield from lay_out(line, style, 2, 4)
    if not everything and len(shown) > _SHOWN:
        yield from lay_out([LinePart(f"and {len(shown) - _SHOWN:,} more; --all lists them")], style, 2, _HANG)
    yield ""


def _render_head(found: Sequence[Edge], graph: Graph, hidden: int, style: Style) -> Iterator[str]:
    said = [format_count(len({node.id for node in graph.nodes}), "node")]
    for kind in ("topic", "service", "action"):
        names = {edge.name for edge in found if edge.kind == kind and edge.mark != "removed"}
        said += [format_count(len(names), kind)] if names else []
    text = ", ".join(said)
    if hidden:
        are, them = ("is", "it") if hidden == 1 else ("are", "them")
        text += f" ({format_count(hidden, 'name')} that most nodes have {are} hidden; --all shows {them})"
    return lay_out([LinePart(text)], style, 0, _HANG)


def _render_name(group: Sequence[Edge], names: dict[str, str], style: Style, room: int) -> Iterator[str]:
    types = sorted({kind for edge in group for kind in edge.types})
    # No name begins a line: CI systems read what is there.
    name = LinePart(f"{group[0].kind} {group[0].name}", "bold")
    yield from lay_out([name, LinePart(" or ".join(types) if types else "type not known")], style, 0, _HANG)
    for same in _group_alike(group):
        yield from _render_edge(same, names, style, room)


def _group_alike(group: Sequence[Edge]) -> list[list[Edge]]:
    """Edges that the same lines of code make stand together: one library is used by many nodes."""
    found: dict[tuple, list[Edge]] = {}
    for edge in group:
        found.setdefault(
            (edge.mark, edge.why, edge.role, _make_edge_key(edge), edge.before and _make_edge_key(edge.before)), []
        ).append(edge)
    return list(found.values())


def _make_edge_key(edge: Edge) -> tuple:
    """All that is written of an edge but its node."""
    places = tuple((each.path, each.line, each.how, each.callback, each.qos) for each in edge.endpoints)
    return edge.types, places, tuple(_list_statements(edge.publishes))


def _render_edge(same: Sequence[Edge], names: dict[str, str], style: Style, room: int) -> Iterator[str]:
    edge, mark = same[0], _ROLES[same[0].mark]
    who = ", ".join(dict.fromkeys(names.get(each.node, each.node) or "(no node)" for each in same))
    line = [LinePart(f"{_SIGN[edge.mark]}{VERBS[edge.role]:10s}", mark), LinePart(who, mark, hang=_NODES)]
    for endpoint in _remove_duplicates(edge.endpoints):
        line.append(LinePart("", path=f"{endpoint.path}:{endpoint.line}"))
        beside = _format_note(endpoint, edge, style)
        line += [LinePart(beside, mark or "dim")] if beside else []
        yield from lay_out(line, style, _HANG if line[0].path else 0, _HANG)
        line = []
    if edge.before is not None:
        yield from _render_differences(edge, edge.before, style, room)
        return
    statements = _list_statements(edge.publishes).values()
    shared = find_shared(publish.guards for publish in statements)
    for publish in statements:
        yield from lay_out(_render_publish(publish, room, shared), style, _HANG, _HANG + 2)


def _render_differences(edge: Edge, before: Edge, style: Style, room: int) -> Iterator[str]:
    """What a changed edge was in the base (`-`) and is now (`+`), then its publish statements that are as they were."""
    for said in (_list_types, _list_qos):
        old, now = said(before), said(edge)
        for sign, role, lines in (("-", "error", old - now), ("+", "good", now - old)):
            for line in sorted(lines):
                yield from lay_out([LinePart(f"{sign} {line}", role)], style, _HANG - 2, _HANG + 2)
    old, now = (
        {line[1:]: (line, publish) for line, publish in _list_statements(each.publishes).items()}
        for each in (before, edge)
    )
    gone, new = (
        [publish for _, publish in sorted((one[line] for line in one.keys() - other.keys()), key=itemgetter(0))]
        for one, other in ((old, now), (now, old))
    )
    shared = find_shared(publish.guards for publish in (*gone, *new))
    for sign, role, publishes, others in (("- ", "error", gone, new), ("+ ", "good", new, gone)):
        beside = {text for other in others for text in list_conditions(other.guards)}
        for publish in publishes:
            first, *rest = _render_publish(publish, room, shared, beside)
            painted = [piece._replace(role=role) for piece in (first._replace(text=sign + first.text), *rest)]
            yield from lay_out(painted, style, _HANG - 2, _HANG + 2)
    for line in sorted(now.keys() & old.keys(), key=lambda line: now[line][0]):
        yield from lay_out(_render_publish(now[line][1], room), style, _HANG, _HANG + 2)
        was, is_now = (_collect_ways(each.publishes, line) for each in (before, edge))
        differing = {way: ways[way] for ways in (was, is_now) for way in was.keys() ^ is_now.keys() if way in ways}
        shared = find_shared(way.guards for way in differing.values())
        for sign, role, ways, others in (("-", "error", was, is_now), ("+", "good", is_now, was)):
            beside = {text for way in others.values() for text in list_conditions(way.guards)}
            for text in sorted(ways.keys() - others.keys()):
                said = format_when(ways[text].guards, (ways[text].trigger,), room, shared, beside) or text
                yield from lay_out([LinePart(f"{sign} {said}", role)], style, _HANG + 2, _HANG + 4)


def _collect_ways(publishes: Sequence[Publish], line: tuple[LinePart, ...]) -> dict[str, Way]:
    """Of the publish statements that are written as this line, the ways that lead there, by what is said in full."""
    return {
        format_when(way.guards, (way.trigger,)) or "always": way
        for publish in publishes
        if _render_publish(publish)[1:] == line
        for way in publish.by
    }


def _list_types(edge: Edge) -> set[str]:
    return {f"type {kind}" for kind in edge.types}


def _list_qos(edge: Edge) -> set[str]:
    return {f"QoS {each.qos.written}" for each in edge.endpoints if each.qos is not None and each.qos.written}


def _remove_duplicates(endpoints: Sequence[Endpoint]) -> list[Endpoint]:
    return list({(endpoint.path, endpoint.line): endpoint for endpoint in endpoints}.values())


def _format_note(endpoint: Endpoint, edge: Edge, style: Style) -> str:
    said = []
    if edge.why:
        said.append(f"changed: {edge.why}")
    if endpoint.how == "default":
        said.append("name: a parameter's default")
    if endpoint.only_if:
        said.append(f"only if {endpoint.only_if}")
    if endpoint.callback is not None:
        said.append(f"{style.symbols[3]} {endpoint.callback.name}")
    qos = endpoint.qos
    if qos is not None:
        said += [value for value in (qos.reliability, qos.durability) if value not in ("", "reliable", "volatile")]
    return f"[{'; '.join(said)}]" if said else ""


def _list_statements(publishes: Sequence[Publish]) -> dict[tuple[LinePart, ...], Publish]:
    """Publish statements by their whole lines. One that publishes to several publishers is there once."""
    found: dict[tuple[LinePart, ...], Publish] = {}
    for publish in publishes:
        found.setdefault(_render_publish(publish), publish)
    return found


def _render_publish(
    publish: Publish, room: int = UNBROKEN, shared: Collection[GuardKey] = (), beside: Collection[str] = ()
) -> tuple[LinePart, ...]:
    """Where, when and on what a statement publishes. room, shared, beside: as for format_when()."""
    place = LinePart("publish at ", path=f"{publish.path}:{publish.line}")
    said = [format_when(publish.guards, publish.triggers, room, shared, beside)]
    said += [f"{publish.ways} ways lead there"] * (publish.ways > 1)
    text = "; ".join(filter(None, said))
    return (place, LinePart(text)) if text else (place,)


def render_coverage(
    coverage: Coverage, near: Sequence[Unresolved], everything: bool, style: Style
) -> Iterator[str]:  # fmt: skip
    """How much was resolved, and what was not. near: of that, what may be listed; everything: all of it, not the first
    20 alone."""
    share = f", {coverage.by_default:,} by a parameter's default" if coverage.by_default else ""
    share += f", {coverage.in_part:,} more known in part" if coverage.in_part else ""
    yield from lay_out(
        [LinePart(f"{coverage.resolved:,} of {format_count(coverage.calls, 'API call')} resolved{share}; "
               f"{format_count(coverage.files, 'file')} read")], style, 0, 2,
    )  # fmt: skip
    lacking = "left out, since nothing compiles them"
    for paths, what in ((coverage.unread, "of them in part"), (coverage.uncompiled, lacking)):
        if paths:
            shown = paths if everything else paths[:5]
            rest = f" and {len(paths) - len(shown)} more" if len(shown) < len(paths) else ""
            yield from lay_out([LinePart(f"{len(paths)} {what}: {', '.join(shown)}{rest}")], style, 0, 2)
    if coverage.missed:
        found = sum(one.found for one in coverage.by_text)
        calls = format_count(found, "call")
        said = f"{len(coverage.missed):,} of {calls} that a search of the text finds not understood:"
        yield from lay_out([LinePart(said)], style, 0, 2)
        for one in coverage.missed if everything else coverage.missed[:_SEARCHED]:
            pieces = [LinePart("", path=f"{one.path}:{one.line}:"), LinePart(f"`{one.written}`")]
            yield from lay_out(pieces, style, 2, 4)
        if not everything and len(coverage.missed) > _SEARCHED:
            said = f"and {len(coverage.missed) - _SEARCHED:,} more; --all lists them"
            yield from lay_out([LinePart(said)], style, 2, _HANG)
        worst = [one for one in coverage.by_text if one.found >= 4 and 2 * one.understood < one.found]
        for one in worst:
            said = f"of package `{one.package}` alone {one.understood} of {one.found}"
            yield from lay_out([LinePart(said)], style, 2, 4)
    shown = near if everything else near[:_SHOWN]
    for one in shown:
        written = f" `{one.written}`" if one.written else ""
        written += f", known as `{one.pattern}`" if one.pattern else ""
        pieces = [LinePart("", path=f"{one.path}:{one.line}:"), LinePart(f"{one.what}{written}: {one.reason}")]
        yield from lay_out(pieces, style, 2, 4)
    more = len(coverage.unresolved) - len(shown)
    if more:
        said = f"and {more:,} more" if shown else f"{more:,} {'is' if more == 1 else 'are'} not resolved"
        yield from lay_out([LinePart(f"{said}; --all lists {'it' if more == 1 else 'them'}")], style, 2, _HANG)
