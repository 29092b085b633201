"""What the rules of this family share: publishers and subscribers of ROS 2 that meet, with the qualities they tell.

Source of the tables: "Quality of service compatibilities" in
https://docs.ros.org/en/rolling/Concepts/Intermediate/About-Quality-of-Service-Settings.html.
"""

from __future__ import annotations

from collections.abc import Iterator

from ...model.cmake.build import At
from ...model.flow.edges import Pair, met, said
from ...model.flow.graph import Qos
from ...model.workspace import Workspace
from ..rule import Hit

_ROS1 = frozenset(("roscpp", "rospy"))


def meetings(workspace: Workspace) -> Iterator[tuple[Pair, Qos, Qos]]:
    """Publishers and subscribers that meet, with what each asks for; where code may choose among several of one name,
    none is judged."""
    for pair in met(workspace):
        giver, taker = pair.giver.endpoint, pair.taker.endpoint
        if giver.role != "publisher" or giver.qos is None or taker.qos is None or giver.framework in _ROS1:
            continue
        if giver.type != taker.type and "*" not in (giver.type, taker.type):
            continue
        if len(pair.flow.of_node(giver)) == len(pair.flow.of_node(taker)) == 1:
            yield pair, giver.qos, taker.qos


def refused(pair: Pair, offered: str, asked: str, cure: str) -> Hit:
    """The finding at a subscriber. offered, asked: clauses of what the publisher gives and the subscriber wants."""
    giver, taker = pair.giver.endpoint, pair.taker.endpoint
    return Hit(
        At(taker.path, taker.line),
        taker.topic,
        f"the subscriber of `{taker.topic}` {asked}, but the publisher in `{said(pair.giver.node)}` {offered} "
        f"({giver.path}:{giver.line}){pair.together}",
        cure,
        pair.taker.node.package,
    )
