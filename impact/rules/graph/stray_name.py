"""stray-name: a launch or parameter file gives a name that nothing else has, but nearly that of a topic.

What it does
    Reports names of several parts, and words in remappings, that a launch or parameter file has and no other line of
    the workspace, and that differ in one part from a topic that the workspace publishes: by words (`/slow_lift/path`,
    `/lift/path`), or by a letter. Nothing else may publish or read them.

Why it breaks
    Who is given the name talks to nobody. ROS prints no warning.

Example
    <param name="depth_topic" value="sonar/depth_new"/>     <!-- the sonar publishes sonar/depth -->

Use instead
    <param name="depth_topic" value="sonar/depth"/>

Not reported
    Remappings, but for those of a publisher whose name nobody reads while somebody reads the other, or the reverse;
    names that differ in sides and numbers (`left`, `camera2`); names that are close to several topics; names that a
    file gives beside the other one, and so tells apart.
"""

from ....edges.groups import group_pairs
from ...model.flow.edges import Flow, build_system_flow
from ...model.flow.mentions import find_mentions, list_settings_names, normalise_mention
from ...model.flow.misspelling import differs_in_words, is_slip_of_name
from ..vocabulary import At, Diagnostic, Text, Workspace, rule

_KNOWN = ("literal", "given", "launch")


@rule(
    scope="flow",
    severity="note",
    preview=True,
    texts=Text(
        "nothing else in the workspace has the name `{subject}`, but `{place}` has `{replacement}`",
        help="write `{replacement}`, or give the other side the new name",
    ),
)
def stray_name(workspace: Workspace):
    flow = build_system_flow(workspace)
    topics = {
        normalise_mention(one.topic): one for one in flow.graph.endpoints
        if one.topic and not one.implied and one.role in ("publisher", "subscriber") and one.how in _KNOWN
    }  # fmt: skip
    by_parts = group_pairs((name.count("/"), name) for name in topics)
    near: dict[str, tuple[set[tuple[str, int]], str]] = {}
    settings = group_pairs(list_settings_names(workspace))
    files = {name: {place.path for place, _ in found} for name, found in settings.items()}
    for name, found in settings.items():
        if len({line for _, line in found}) > 1 or _has_other_side(flow, name):
            continue
        alike = [known for known in by_parts.get(name.count("/"), ()) if known != name and _is_near(name, known)]
        if len(alike) != 1 or not files[name].isdisjoint(files.get(alike[0], ())):
            continue
        remapped = any("remap" in line for _, line in found)
        if _lacks_each_other(flow, name, alike[0]) if remapped else _has_publisher(flow, alike[0]):
            near[name] = {(place.path, place.line) for place, _ in found}, alike[0]
    mentions = find_mentions(workspace, near)
    for name, (places, known) in near.items():
        if {(each.path, each.line) for each in mentions[name]} <= places:
            one, (path, line) = topics[known], min(places)
            data = {"replacement": one.topic, "place": f"{one.path}:{one.line}"}
            yield Diagnostic(At(path, line), name, workspace.find_owning_package(path), data)


def _is_near(name: str, known: str) -> bool:
    return differs_in_words(name, known) or is_slip_of_name(name, known)


def _has_other_side(flow: Flow, name: str) -> bool:
    """Whether a name is used by more than those whom a launch file gives it."""
    found = flow.known.get(("topic", f"/{name}"), ())
    return any(one.how != "launch" or flow.list_others(one) for one in found)


def _has_publisher(flow: Flow, known: str) -> bool:
    return any(one.role == "publisher" for one in flow.known.get(("topic", f"/{known}"), ()))


def _lacks_each_other(flow: Flow, name: str, known: str) -> bool:
    """Whether one name has a publisher alone, and the other a subscriber alone, of one type."""
    ones, others = (flow.known.get(("topic", f"/{each}"), ()) for each in (name, known))
    sides = {one.role: one.type for one in ones if not flow.list_others(one)}
    return any(
        one.type and one.type in [type_ for role, type_ in sides.items() if role != one.role]
        for one in others
        if not flow.list_others(one)
    )
