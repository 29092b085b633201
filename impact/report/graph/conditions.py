"""When a publish statement runs, in one line: its conditions, loops and triggers, cut to what differs and fits."""

from collections.abc import Collection, Iterable, Sequence
from itertools import takewhile

from ...model.flow.connections import format_loops, list_conditions
from ...model.flow.graph import GuardAt, Trigger
from ..columns import UNBROKEN

ROOM = 100
"""Characters of conditions in a line that is cut."""
_MOST_TRIGGERS = 4
_BEFORE = 24

GuardKey = tuple[str, str]
"""Kind and text of a guard."""


def find_shared(lists: Iterable[Sequence[GuardAt]]) -> frozenset[GuardKey]:
    """The guards that stand in each of several lists; none for fewer than two lists."""
    sets = [{(guard.kind, guard.text) for guard in guards} for guards in lists]
    return frozenset(set.intersection(*sets)) if len(sets) > 1 else frozenset()


def format_when(
    guards: Sequence[GuardAt], triggers: Sequence[Trigger], room: int = UNBROKEN,
    shared: Collection[GuardKey] = (), beside: Collection[str] = (),
) -> str:  # fmt: skip
    """Under which conditions, in which loops, and on what; empty for nothing.

    room: characters for the conditions, and for the loops; of more, those nearest to the statement are kept, those that
    are not shared first. beside: the conditions that these are compared with: a long one is cut to where it differs.
    """
    on = list(dict.fromkeys(f"{each.kind} {each.detail}".strip() for each in triggers if each.kind != "unknown"))
    shown = on if room == UNBROKEN else on[:_MOST_TRIGGERS]
    said = {
        "when": _shorten(guards, room, shared, beside),
        "in": _cut(format_loops(guards), room, ()),
        "on": ", ".join(shown) + (f" and {len(on) - len(shown)} more" if len(shown) < len(on) else ""),
    }
    return "; ".join(f"{word} {text}" for word, text in said.items() if text)


def _shorten(guards: Sequence[GuardAt], room: int, shared: Collection[GuardKey], beside: Collection[str]) -> str:
    asked = [guard for guard in guards if guard.kind in ("if", "unless")]
    conditions = list_conditions(guards)
    if len(" and ".join(conditions)) <= room:
        return " and ".join(conditions)
    order = sorted(range(len(asked)), key=lambda at: ((asked[at].kind, asked[at].text) in shared, -at))
    kept = {order[0]: _cut(conditions[order[0]], room, beside)}
    left = room - len(kept[order[0]])
    for at in order[1:]:
        if len(conditions[at]) <= left:
            kept[at] = conditions[at]
            left -= len(conditions[at])
    more = len(conditions) - len(kept)
    return " and ".join([*(kept[at] for at in sorted(kept)), *([f"{more} more (--all)"] if more else [])])


def _cut(text: str, room: int, beside: Collection[str]) -> str:
    """The text, or as much of it as has room: from its beginning, or from a little before it differs from another."""
    if len(text) <= room:
        return text
    pairs = (zip(text, other, strict=False) for other in beside if other != text)
    same = max((sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], pair)) for pair in pairs), default=0)
    start = max(0, min(same - _BEFORE, len(text) - room))
    end = start + room
    return f"{'…' if start else ''}{text[start:end]}{'…' if end < len(text) else ''}"
