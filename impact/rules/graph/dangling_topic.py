"""dangling-topic: what one node publishes and what another one waits for are of one type, and have different names.

What it does
    Reports a subscriber that nothing feeds and a publisher that nothing reads, if a launch file starts both, they are
    of one type, and no other topic of this type lacks a side there. Their names have to tell that they belong together:
    they have the same last part in different namespaces, differ in words (`scan`, `scan_filtered`), or are one name in
    the code that a remapping tells apart. Of a message that the workspace itself defines, any two names do.

Why it breaks
    The subscriber never receives a message. ROS prints no warning.

Example
    <node pkg="tide" exec="gauge">                         <!-- publishes level -->
      <remap from="level" to="level_raw"/>
    </node>
    <node pkg="tide" exec="board"/>                        <!-- reads level -->

Use instead
    <node pkg="tide" exec="board">
      <remap from="level" to="level_raw"/>
    </node>

Not reported
    Messages of std_msgs and others that are sent for any purpose; topics that another launch file, a program outside of
    the workspace or a name that is not known may connect; names that a misspelling or a namespace tells apart
    (near-miss-name); messages of other packages where the launch file starts programs outside of the workspace.
"""

from __future__ import annotations

from collections.abc import Iterator

from ...model.flow.edges import Flow, Sure, build_launched_flow, build_system_flow, build_whole_flow, get_label
from ...model.flow.launches import Launch
from ...model.flow.misspelling import differs_in_words, is_in_namespace, is_slip_of_name
from ...model.flow.workspace import get_flow
from ..vocabulary import At, Diagnostic, Text, Workspace, rule

# Packages of messages that say nothing of what is sent.
_GENERIC = frozenset(("std_msgs", "visualization_msgs", "diagnostic_msgs", "builtin_interfaces", "rosgraph_msgs"))
_SIDES = ("publisher", "subscriber")


@rule(
    scope="flow",
    severity="warning",
    preview=True,
    texts=Text(
        "nothing that {launch:the launch file} starts publishes `{subject}`, but `{node}` publishes `{replacement}` of "
        "the same type ({place}), which nothing reads",
        help="give both the same name",
    ),
)
def dangling_topic(workspace: Workspace):
    whole, system = build_whole_flow(workspace), build_system_flow(workspace)
    reported = set()
    for launch in get_flow(workspace).launches:
        flow = build_launched_flow(whole, launch)
        for taker, giver in _find_loose_pairs(flow, system, launch, workspace):
            one, other = taker.endpoint, giver.endpoint
            if (one.path, one.line) in reported:
                continue
            reported.add((one.path, one.line))
            data = {
                "launch": (launch.path,),
                "node": get_label(giver.node),
                "replacement": other.topic,
                "place": f"{other.path}:{other.line}",
            }
            yield Diagnostic(At(one.path, one.line), one.topic, taker.node.package, data)


def _find_loose_pairs(flow: Flow, system: Flow, launch: Launch, workspace: Workspace) -> Iterator[tuple[Sure, Sure]]:
    """Of each type of which a launch has one topic that nobody feeds and one that nobody reads, a subscriber of the one
    and a publisher of the other."""
    loose: dict[str, dict[str, dict[str, Sure]]] = {}
    for role in _SIDES:
        for one in flow.list_sure(role):
            endpoint = one.endpoint
            if not endpoint.implied and not flow.list_others(endpoint):
                topics = loose.setdefault(flow.find_type(endpoint), {}).setdefault(role, {})
                topics.setdefault(endpoint.topic, one)
    for type_, found in loose.items():
        package = type_.partition("/")[0]
        own = package in workspace.interface_names
        if package in ("", *_GENERIC) or len(found) != len(_SIDES) or (launch.missing and not own):
            continue
        (giver, *givers), (taker, *takers) = (found[role].values() for role in _SIDES)
        sides = (giver, taker)
        if givers or takers or giver.node.id == taker.node.id or any(flow.may_have(role, type_) for role in _SIDES):
            continue
        if any(system.list_others(side.endpoint) or _is_mentioned(side.endpoint.topic, launch) for side in sides):
            continue
        if not _is_near_miss(taker, giver) and (own or _matches_by_name(taker, giver)):
            yield taker, giver


def _is_mentioned(topic: str, launch: Launch) -> bool:
    """Whether a program outside of the workspace is given a topic's name."""
    last = topic.rpartition("/")[2]
    return any(last in text for text in launch.told)


def _is_near_miss(taker: Sure, giver: Sure) -> bool:
    """Whether near-miss-name says it."""
    names = taker.endpoint.topic, giver.endpoint.topic
    return is_slip_of_name(*names) or is_in_namespace(*names)


def _matches_by_name(taker: Sure, giver: Sure) -> bool:
    """Whether the names of two sides show that they were one."""
    one, other = taker.endpoint, giver.endpoint
    if one.code_name and one.code_name == other.code_name:
        return True
    return one.topic.rpartition("/")[2] == other.topic.rpartition("/")[2] or differs_in_words(one.topic, other.topic)
