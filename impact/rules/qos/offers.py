"""Publishers and subscribers of ROS 2 that meet, and the quality of service of each, for the rules of this family.

Source of the tables: "Quality of service compatibilities" in
https://docs.ros.org/en/rolling/Concepts/Intermediate/About-Quality-of-Service-Settings.html.
"""

from collections.abc import Iterator

from ...model.flow.edges import FlowPair, get_label, list_met_pairs
from ...model.flow.graph import Qos
from ..vocabulary import At, Diagnostic, Text, Value, Workspace

_ROS1 = frozenset(("roscpp", "rospy"))


def iterate_qos_pairs(workspace: Workspace) -> Iterator[tuple[FlowPair, Qos, Qos]]:
    """Publishers and subscribers of one topic, with what is offered and what is asked for. Where a node has several of
    the same name, it is not known which of them is used, and none is returned."""
    for pair in list_met_pairs(workspace):
        giver, taker = pair.giver.endpoint, pair.taker.endpoint
        if giver.role != "publisher" or giver.qos is None or taker.qos is None or giver.framework in _ROS1:
            continue
        if giver.type != taker.type and "*" not in (giver.type, taker.type):
            continue
        if len(pair.flow.list_alternatives(giver)) == len(pair.flow.list_alternatives(taker)) == 1:
            yield pair, giver.qos, taker.qos


def build_qos_text(asks: str, offers: str, help: str) -> Text:
    """The text of a diagnostic of this family. asks, offers: what the subscriber asks for and the publisher offers, as
    clauses that begin with a verb."""
    return Text(
        f"the subscriber of `{{subject}}` {asks}, but the publisher in `{{node}}` {offers} ({{place}})"
        "[[; `{launch}` starts both]]",
        help,
    )


def make_diagnostic(pair: FlowPair, kind: str = "", **data: Value) -> Diagnostic:
    """The diagnostic at a subscriber. Its data also has `node` and `place` of the publisher, and `launch`."""
    giver, taker = pair.giver.endpoint, pair.taker.endpoint
    data = {
        "node": get_label(pair.giver.node),
        "place": f"{giver.path}:{giver.line}",
        "launch": pair.launch,
        **data,
    }
    return Diagnostic(At(taker.path, taker.line), taker.topic, pair.taker.node.package, data, kind)
