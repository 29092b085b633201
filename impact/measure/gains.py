"""What pruning gains: the full and the lighter message of each pruned topic, measured side by side."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from ...edges.console import UserError
from ..analysis.fields import collect_fields
from ..analysis.session import CheckError
from ..model.fields.report import FieldReport, PublisherFields
from ..prune.planner import TopicPlan
from ..prune.session import Prepared
from . import ros1
from .contents import MessageFilling, RealMessages, add_contents, make_real_messages
from .intervals import CellSummary, summarize
from .plan import FULL, PRUNED, Conditions, NetworkPlan
from .results import RunHeader, load_results
from .run import Progress, check_needs, run_network

RATE = 50.0
"""Messages per second of a topic whose rate neither the user nor a bag tells."""


class TopicGain(NamedTuple):
    """What a topic's message costs on the link, whole and pruned. rate: in Hz. notes: on how messages are filled.
    failure: why it was not measured, empty where it was; then both summaries and the header are there."""

    topic: str
    type: str
    rate: float
    notes: tuple[str, ...] = ()
    failure: str = ""
    header: RunHeader | None = None
    full: CellSummary | None = None
    pruned: CellSummary | None = None


class _Prepared(NamedTuple):
    """A topic that can be measured."""

    topic: str
    plan: TopicPlan
    found: RealMessages
    rate: float


def list_publishers(path: Path, type_: str) -> tuple[PublisherFields, ...]:
    """The statements of a workspace that publish the message `package/Name`; none of what is no workspace."""
    try:
        return _select_publishers(collect_fields(path).report, type_)
    except CheckError:
        return ()


def _select_publishers(report: FieldReport, type_: str, topic: str = "") -> tuple[PublisherFields, ...]:
    rows = (one for one in report.topics if one.type == type_ and topic in ("", one.topic))
    return tuple({(each.path, each.line): each for one in rows for each in one.publishers}.values())


def measure_gains(
    path: Path, prepared: Prepared, conditions: Conditions, *, rate: float, repeat: int, bag: Path | None, length: int,
    folder: Path, progress: Progress,
) -> list[TopicGain]:  # fmt: skip
    """Measures the messages of all topics of a plan, one topic after the other.

    path: the workspace. rate: of all topics, 0 for that of the bag, or RATE. bag: whose messages are sent; without one
    they are filled as the topic's publishers do, with length where these do not tell it. folder: keeps the results, a
    file for each topic, which a later run continues. Raises UserError.
    """
    check_needs(conditions)
    gains: list[TopicGain] = []
    ready: list[_Prepared] = []
    for plan, topic in ((each, topic) for each in prepared.plan.plans for topic in each.topics):
        publishers = _select_publishers(prepared.report, plan.type, topic)
        filling = MessageFilling(bag=bag, topic=topic, publishers=publishers, length=length)
        try:
            found = make_real_messages(plan.type, plan.keep, path, filling, 2 if conditions.nodes == "dds" else 1)
        except UserError as error:
            gains.append(TopicGain(topic, plan.type, rate, failure=str(error)))
        else:
            ready.append(_Prepared(topic, plan, found, rate or round(found.rate or RATE, 2)))
    _prepare_nodes(conditions, ready)
    for one in ready:
        progress(f"{one.topic}:")
        gains.append(_measure(one, conditions, repeat, folder, progress))
    return gains


def _prepare_nodes(conditions: Conditions, ready: Sequence[_Prepared]) -> None:
    """Makes the nodes of all topics at once, which takes a part of the time."""
    ros = ros1.find_ros1(conditions.nodes)[0] if conditions.nodes != "dds" else None
    if ros is not None and ready:
        schemas = [message.schema for one in ready for message in one.found.messages.values()]
        ros1.prepare_nodes(ros, conditions.nodes, schemas)


def _measure(one: _Prepared, conditions: Conditions, repeat: int, folder: Path, progress: Progress) -> TopicGain:
    plan = NetworkPlan(
        conditions=add_contents(conditions, one.plan.type, one.plan.keep, one.found.messages), publishers=(1,),
        fields=(), rates=(one.rate,), repeat=repeat,
    )  # fmt: skip
    output = folder / f"{re.sub(r'[^A-Za-z0-9_]+', '.', one.topic).strip('.')}.jsonl"
    run_network(plan, one.found.messages, output, progress)
    header, results = load_results(output)
    cells = {each.cell.variant: each for each in summarize(results) if each.cell.rate == one.rate}
    return TopicGain(one.topic, one.plan.type, one.rate, tuple(one.found.notes), "", header, cells[FULL], cells[PRUNED])
