"""All callbacks of a workspace and what publishes to them, explored and joined."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from ...edges.memory import cache_in_derived
from ...edges.processes import count_cores
from ..model.flow.graph import Graph
from ..model.flow.workspace import get_flow
from ..model.workspace import Workspace
from .answers import CallbackAnswer
from .disk import open_sources
from .matching import UNIT, Mismatch, Sender, list_mismatches
from .outcomes import Bounds
from .survey import Asked, Progress, Survey, get_key
from .units import UnitMismatch, list_unit_mismatches

CHECK_BOUNDS = Bounds(text=16, seconds=10.0)
"""How far checks go: names of frames fit in."""


class Joined(NamedTuple):
    """What was explored besides some callbacks for what it publishes, and what does not fit together."""

    others: tuple[CallbackAnswer, ...]
    mismatches: tuple[Mismatch, ...]


def join_publishers(
    survey: Survey, callbacks: Sequence[CallbackAnswer], publishing: Sequence[CallbackAnswer], jobs: int = 1,
    progress: Progress | None = None,
) -> Joined:  # fmt: skip
    """Holds what some callbacks do against what others publish that they receive. Who publishes to these is explored as
    well."""
    graph = survey.graph
    received = {topic for one in callbacks for topic in one.topics}
    topics = {topic for one in publishing for topic in one.topics} - received
    others = [*publishing, *survey.explore_publishing(topics, jobs, progress)]
    mismatches = list_mismatches([*callbacks, *others], graph, survey, survey.workspace.ros, jobs)
    asked = {get_key(one) for one in callbacks}
    kept = [one for one in mismatches if one.subscriber is not None and get_key(one.subscriber) in asked]
    return Joined(tuple(others), tuple(kept))


def describe_units(
    workspace: Workspace, graph: Graph, callbacks: Sequence[CallbackAnswer] = ()
) -> list[Mismatch]:  # fmt: skip
    """All mismatches of units, as those of values are described. callbacks: those that were explored."""
    return [_describe_unit(one, callbacks) for one in list_unit_mismatches(workspace, graph)]


def _describe_unit(one: UnitMismatch, callbacks: Sequence[CallbackAnswer]) -> Mismatch:
    sender = Sender(one.written.function, (one.written.place,), {}, one.type)
    subscriber = None
    if one.read is not None:
        named = [each for each in callbacks if each.callback == one.read.function and one.topic in each.topics]
        subscriber = named[0] if named else CallbackAnswer(
            one.read.function, "subscriber", "", one.read.place.path, one.read.place.line, one.type, (one.topic,), (),
            Bounds(),
        )  # fmt: skip
    return Mismatch(
        UNIT, "warning", one.topic, one.type, one.written.field, one.written.unit, sender, subscriber,
        place=one.read.place if one.read is not None else None, why=one.expected,
    )  # fmt: skip


@cache_in_derived
def find_unit_mismatches(workspace: Workspace) -> tuple[Mismatch, ...]:
    """All mismatches of units of a workspace, for checks; nothing is explored for them."""
    return tuple(describe_units(workspace, get_flow(workspace).system))


@cache_in_derived
def find_mismatches(workspace: Workspace) -> tuple[Mismatch, ...]:
    """All mismatches of a workspace, for checks. They are looked for once, on all cores."""
    graph = get_flow(workspace).system
    jobs = count_cores()
    with open_sources(workspace.extraction.tree) as root, Survey(root, workspace, graph, CHECK_BOUNDS) as survey:
        report, others = survey.explore(Asked(), publishers=True, jobs=jobs)
        return join_publishers(survey, report.callbacks, others, jobs).mismatches
