"""A running system beside the sources, as text and JSON."""

import msgspec

from ....edges.console import format_count, format_json
from ....edges.groups import group_pairs
from ....edges.version import __version__
from ...model.flow.observed import ObservedDifference, ObservedRow
from ..schemas import SCHEMA
from ..style import Style, paint
from .text import VERBS

_SIGNS = {"not in the sources": "+", "not seen": "-", "other type": "~", "may match": "?", "matches": " "}
_ROLES = {"not in the sources": "good", "not seen": "error", "other type": "warning"}
_COUNTED = {
    "matches": "seen and in the sources", "other type": "of another type",
    "not in the sources": "seen and not in the sources", "not seen": "in the sources and not seen",
    "may match": "seen, and of a type for which the sources have a name that is not known",
}  # fmt: skip
_RECORDED = "published by a node that the file does not name"


def render_observed(found: ObservedDifference, format: str, style: Style) -> str:
    """What was seen beside the sources, in a format: text or json."""
    if format == "json":
        return format_json({
            "schema": SCHEMA,
            "tool": {"name": "rosimpact", "version": __version__},
            "differs": found.differs,
            "endpoints": msgspec.to_builtins(found.rows),
            "not_started": found.not_started,
            "others": found.others,
        }) + "\n"  # fmt: skip
    lines: list[str] = []
    for node, rows in group_pairs((row.node, row) for row in found.rows).items():
        lines += [f"node {node}" if node else _RECORDED, *(_render_row(row, style) for row in rows), ""]
    for names, what in (
        (found.not_started, "of the sources not seen"), (found.others, "seen that the sources do not start"),
    ):  # fmt: skip
        if names:
            lines += [f"{format_count(len(names), 'node')} {what}: {', '.join(names)}", ""]
    counts = {state: sum(row.state == state for row in found.rows) for state in _COUNTED}
    said = [f"{number:,} {_COUNTED[state]}" for state, number in counts.items() if number or state == "matches"]
    return "\n".join((*lines, f"endpoints: {', '.join(said)}")) + "\n"


def _render_row(row: ObservedRow, style: Style) -> str:
    place = f"  {row.path}:{row.line}" if row.path else ""
    type_ = f"  {row.type or 'type not known'}"
    notes = [f"in the sources {row.expected}"] if row.expected else []
    notes += [row.state] if row.state in ("not in the sources", "not seen", "may match") else []
    notes += [row.uncertain] if row.uncertain else []
    text = f"{_SIGNS[row.state]} {VERBS[row.role]:11} {row.name}{type_}{place}"
    return paint(style, _ROLES.get(row.state, ""), "  " + text) + (f"  [{'; '.join(notes)}]" if notes else "")
