"""All callbacks of a workspace and what publishes to them, explored and joined."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from typing import NamedTuple

from ..model.flow.graph import Graph
from .answers import CallbackAnswer
from .matching import Mismatch, list_mismatches
from .survey import KINDS, Asked, Progress, Survey, get_key


class Joined(NamedTuple):
    """What was explored besides some callbacks for what it publishes, and what does not fit together."""

    others: tuple[CallbackAnswer, ...]
    mismatches: tuple[Mismatch, ...]


def join_publishers(
    survey: Survey, callbacks: Sequence[CallbackAnswer], jobs: int = 1, progress: Progress | None = None
) -> Joined:
    """Explores who publishes what some callbacks receive, and holds both against each other."""
    received = {topic for one in callbacks for topic in one.topics}
    if not received:
        return Joined((), ())
    known = {get_key(one) for one in callbacks}
    graph = survey.graph
    others: list[CallbackAnswer] = []
    topics = received
    # Who publishes what they receive, and who publishes what those receive.
    for _ in range(2):
        places = list_starting_places(survey, graph, topics) - {(one.path, one.line) for one in others}
        if not places:
            break
        found = survey.explore(Asked(kinds=KINDS, places=places), jobs=jobs, progress=progress)
        fresh = [one for one in found.callbacks if get_key(one) not in known]
        known.update(get_key(one) for one in fresh)
        others += fresh
        topics = {topic for one in fresh for topic in one.topics} - topics
        if not topics:
            break
    mismatches = list_mismatches([*callbacks, *others], graph, survey, survey.workspace.ros, jobs)
    asked = {get_key(one) for one in callbacks}
    return Joined(tuple(others), tuple(one for one in mismatches if get_key(one.subscriber) in asked))


def list_starting_places(survey: Survey, graph: Graph, topics: Collection[str]) -> frozenset[tuple[str, int]]:
    """Places of what makes the statements run that publish on some topics: of subscriptions, timers, services, and of
    the programs themselves."""
    statements = [one for one in graph.publishes if one.topic in topics]
    places = {(way.trigger.path, way.trigger.line) for one in statements for way in one.by}
    untold = {one.path for one in statements if not one.by}
    return frozenset(places) | (survey.list_places(untold) if untold else frozenset())
