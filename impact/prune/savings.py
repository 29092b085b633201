"""What a plan saves in a second, at rates and sizes that a recording or the user tells."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ..analysis.bags import BagFacts, BagTopicFacts
from .planner import PrunePlan


class TopicSaving(NamedTuple):
    """What a topic no longer sends. rate: messages a second. full_bytes, saved_bytes: of a message, on average."""

    topic: str
    rate: float
    full_bytes: float
    saved_bytes: float
    saved_bytes_per_second: float


def find_savings(plan: PrunePlan, rate: float | None, bag: BagFacts | None) -> list[TopicSaving]:
    """The savings of the plan's topics whose rate and size are known. rate: of all topics, None for that of the bag.
    bag: tells sizes where it is given; else they are those of the plan."""
    recorded = {(one.topic, one.type): one for one in bag.topics} if bag is not None else {}
    found: list[TopicSaving] = []
    for one in plan.plans:
        for topic in one.topics:
            row = recorded.get((topic, one.type))
            if bag is None:
                full, saved = float(one.full_bytes), float(one.full_bytes - one.light_bytes)
            elif row is not None and row.fields:
                full, saved = row.bytes.mean, _count_saved(row, one.keep)
            else:
                continue
            hertz = rate or (row.rate if row is not None else None)
            if hertz and full:
                found.append(TopicSaving(topic, hertz, full, saved, saved * hertz))
    return found


def _count_saved(row: BagTopicFacts, keep: Sequence[str]) -> float:
    """The bytes of fields that are neither kept nor lead to one that is."""
    paths = [(field.field.replace("[]", ""), field.bytes) for field in row.fields]
    kept = [f"{one}." for one in keep]
    return sum(
        size
        for path, size in paths
        if not any(f"{path}.".startswith(one) or one.startswith(f"{path}.") for one in kept)
    )
