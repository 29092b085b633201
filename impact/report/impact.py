"""What a change reaches, as text, JSON and Markdown."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from typing import Any

import msgspec

from ...edges.console import format_count, format_json
from ..analysis.downstream import ImpactResult
from ..analysis.effects import KINDS, Effect, Hop, Impact
from ..model.flow.connections import name_nodes
from .columns import LinePart, lay_out
from .graph.text import WIDE, render_coverage
from .markdown_text import escape_markdown, quote
from .schemas import SCHEMA, STABLE, generate_schema
from .style import Style, paint

SHOWN = 8
"""As many reached nodes as are shown of a change, the nearest ones."""
_MOST_NODES = 3
_MOST_EFFECTS = 6
_MOST_NODES = 20
_ROLES = {"tightened": "error", "gone": "error", "removed": "error", "new": "good", "added": "good"}
_ALONE = {
    "publisher": "subscribes to", "subscriber": "publishes", "server": "asks for", "client": "serves",
    "action server": "asks for", "action client": "serves",
}  # fmt: skip
_HEADS = {
    "message": "messages", "topic": "topics", "condition": "publish conditions", "trigger": "triggers",
    "callback": "callbacks", "launch": "launch settings", "parameter": "parameters",
}  # fmt: skip


def render_text(impact: Impact, everything: bool = False, style: Style = WIDE) -> str:
    """The changes by kind, each with what it reaches as a tree, nearest first. everything: nothing is cut."""
    lines: list[str] = []
    names = name_nodes(impact.nodes)
    for kind, same in groupby(group_effects(impact.effects), key=lambda group: group[0].kind):
        lines += [*([""] if lines else []), paint(style, "bold", _HEADS[kind])]
        for group in same:
            for one in group:
                lines += [*_render_head(one, names, style), *_render_alone(one, names, style)]
            lines += _render_tree(group[0], names, everything, style)
    lines += [*([""] if lines else []), *_render([LinePart(summarize(impact))], style, 0, 2)]
    if impact.of:
        paths = {effect.path for effect in impact.effects}
        paths |= {hop.path for effect in impact.effects for hop in effect.reaches}
        near = [one for one in impact.coverage.unresolved if everything or one.path in paths]
        lines += render_coverage(impact.coverage, near, everything, style)
    return "\n".join(lines) + "\n"


def summarize(impact: Impact) -> str:
    """What was found, on one line."""
    silent = f"; nothing known to be sent because of {format_count(impact.silent, 'changed function')}"
    silent = silent if impact.silent else ""
    if not impact.effects:
        return f"no change that message flow knows of{silent}"
    counts = Counter(effect.kind for effect in impact.effects)
    reported = ", ".join(format_count(counts[kind], _HEADS[kind].removesuffix("s")) for kind in KINDS if counts[kind])
    unnamed = impact.coverage.calls - impact.coverage.resolved
    more = f"; {format_count(unnamed, 'API call')} not resolved, and may be reached too" if unnamed else ""
    return f"{reported} changed; {format_count(len(impact.reached), 'node')} of {impact.of:,} reached{silent}{more}"


def group_effects(effects: Iterable[Effect]) -> list[list[Effect]]:
    """Changes that stand one after the other, of one kind and package, and reach the same."""
    found: list[list[Effect]] = []
    for effect in effects:
        last = found[-1][0] if found else None
        if last is not None and _make_group_key(last) == _make_group_key(effect):
            found[-1].append(effect)
        else:
            found.append([effect])
    return found


def _make_group_key(effect: Effect) -> tuple:
    return effect.kind, effect.package, effect.reaches, bool(effect.topics)


def _render(pieces: Sequence[LinePart], style: Style, indent: int, hang: int) -> Iterator[str]:
    return lay_out([one for one in pieces if one.text or one.path], style, indent, hang)


def _render_head(effect: Effect, names: dict[str, str], style: Style) -> Iterator[str]:
    nodes = _format_names([names.get(node, node) for node in effect.nodes])
    line = [
        LinePart(effect.change, _ROLES.get(effect.change, "warning")), LinePart(effect.subject, "bold"),
        LinePart(f"({nodes})" if nodes else ""), LinePart("", path=f"{effect.path}:{effect.line}"),
    ]  # fmt: skip
    yield from _render(line, style, 2, 6)
    if effect.why:
        yield from _render([LinePart(effect.why)], style, 6, 8)


def _render_alone(effect: Effect, names: dict[str, str], style: Style) -> Iterator[str]:
    for (role, name), same in groupby(effect.alone, key=lambda one: (one.role, one.name)):
        left = _format_names(list(dict.fromkeys(names.get(one.node, one.node) for one in same)))
        said = f"nothing in the workspace {_ALONE[role]} {name} of {left} any more"
        yield from _render([LinePart(said, "warning")], style, 6, 8)


def _format_names(names: Sequence[str]) -> str:
    more = f" and {len(names) - _MOST_NODES} more" if len(names) > _MOST_NODES else ""
    return ", ".join(names[:_MOST_NODES]) + more


def _render_tree(effect: Effect, names: dict[str, str], everything: bool, style: Style) -> Iterator[str]:
    """The nearest nodes, each below the one it is reached from; those on one line that are one place of the code."""
    hops = effect.reaches
    kept = hops if everything else hops[:SHOWN]
    if not kept:
        yield f"      {_explain_none(effect)}"
        return
    present = {hop.node for hop in kept}
    below: dict[str, dict[tuple[str, str, int], list[Hop]]] = {}
    for hop in kept:
        came = hop.came if hop.came in present else ""
        below.setdefault(came, {}).setdefault((hop.name, hop.path, hop.line), []).append(hop)
    done: set[str] = set()

    def walk(came: str, depth: int) -> Iterator[str]:
        for same in below.get(came, {}).values():
            fresh = [hop for hop in same if hop.node not in done]
            if not fresh:
                continue
            done.update(hop.node for hop in fresh)
            kind = "" if fresh[0].kind == "topic" else f" ({fresh[0].kind})"
            reported = _format_names([names.get(hop.node, hop.node) for hop in fresh])
            place = LinePart("", path=f"{fresh[0].path}:{fresh[0].line}")
            indent = 6 + 2 * min(depth, 8)
            line = [LinePart(f"{style.symbols[3]} {reported}"), LinePart(f"{fresh[0].name}{kind}"), place]
            yield from _render(line, style, indent, indent + 4)
            for hop in fresh:
                yield from walk(hop.node, depth + 1)

    yield from walk("", 0)
    if len(kept) < len(hops):
        yield f"      and {format_count(len(hops) - len(kept), 'node')} further downstream"


def render_short(impact: Impact, style: Style, base: str) -> list[str]:
    """Lines for the end of another report: each change with the nearest nodes that it reaches. base: what it is
    compared with."""
    names = name_nodes(impact.nodes)
    lines: list[str] = []
    for group in group_effects(impact.effects)[:_MOST_EFFECTS]:
        for effect in group[:_MOST_NODES]:
            reported = effect if len(group) == 1 else msgspec.structs.replace(effect, why="")
            lines += [*_render_head(reported, names, style), *_render_alone(effect, names, style)]
        if len(group) > _MOST_NODES:
            lines.append(f"  and {len(group) - _MOST_NODES} more")
        near = list(dict.fromkeys(names.get(hop.node, hop.node) for hop in group[0].reaches))
        lines += _render([LinePart(f"reaches {_format_names(near)}" if near else _explain_none(group[0]))], style, 6, 8)
    left = sum(map(len, group_effects(impact.effects)[_MOST_EFFECTS:]))
    if left:
        said = f"and {format_count(left, 'further change')}; `rosimpact impact --base {base}` shows all"
        lines += _render([LinePart(said)], style, 2, 4)
    return [*lines, *_render([LinePart(summarize(impact))], style, 2, 4)]


def build_compact_data(impact: Impact) -> dict[str, Any]:
    """The same as data, with as many of the nodes that each change reaches, the nearest ones."""
    rows = []
    for effect in impact.effects:
        row = msgspec.to_builtins(effect)
        row["reaches"] = [hop.node for hop in effect.reaches[:_MOST_NODES]]
        row["reached"] = len(effect.reaches)
        rows.append(row)
    return {"changes": rows, "reached": len(impact.reached), "nodes": impact.of, "silent": impact.silent}


def _explain_none(effect: Effect) -> str:
    """What is said of a change that reaches no node."""
    if effect.kind in ("launch", "parameter"):
        return "reaches no other node that is known"
    return "reaches nothing in the workspace" if effect.topics else "no topic of it is known"


def render_markdown(impact: Impact) -> str:
    """The same in short, for a comment: a line for each change."""
    names = name_nodes(impact.nodes)
    rows = []
    for effect in impact.effects[:_MOST_EFFECTS]:
        near = [names.get(hop.node, hop.node) for hop in effect.reaches]
        reaches = f"reaches {escape_markdown(_format_names(near))}" if near else _explain_none(effect)
        place = quote(f"{effect.path}:{effect.line}")
        rows.append(f"- {effect.kind} {escape_markdown(effect.change)} {quote(effect.subject)} {place}: {reaches}")
    if len(impact.effects) > _MOST_EFFECTS:
        rows.append(f"- and {len(impact.effects) - _MOST_EFFECTS} more")
    return "\n".join([*rows, "", f"<sub>{escape_markdown(summarize(impact))}</sub>"]) + "\n"


def render_json(found: ImpactResult, version: str) -> str:
    """All of it, or of the part that was chosen, as JSON; docs/impact.schema.json describes it."""
    impact = found.impact
    document: dict[str, Any] = {
        "schema": SCHEMA,
        "tool": {"name": "rosimpact", "version": version},
        "workspace": found.root,
        "rev": found.rev,
        "base": found.base,
        "changes": msgspec.to_builtins(impact.effects),
        "nodes": msgspec.to_builtins(impact.nodes),
        "silent": impact.silent,
        "coverage": msgspec.to_builtins(impact.coverage),
    }
    return format_json(document) + "\n"


def render_schema() -> str:
    """The JSON schema (draft 2020-12) of what render_json() gives; docs/impact.schema.json holds it."""
    from ..model.flow.graph import Coverage, Node

    (effect, node, coverage), parts = msgspec.json.schema_components(
        [Effect, Node, Coverage], ref_template="#/$defs/{name}"
    )
    string = {"type": "string"}
    properties: dict[str, Any] = {
        "workspace": string,
        "rev": string,
        "base": string,
        "changes": {"type": "array", "items": effect},
        "nodes": {"type": "array", "items": node},
        "silent": {"type": "integer"},
        "coverage": coverage,
    }
    described = f"What `rosimpact impact --format json` prints. {STABLE}"
    return generate_schema("impact", described, properties, parts, {})
