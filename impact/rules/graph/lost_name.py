"""lost-name: a name of a topic was replaced by one that nothing else in the workspace has.

What it does
    Compares launch files, parameter files, robot descriptions and names in code with the base, line by line. Reports a
    name that replaces a topic's name which other files still have, and that itself occurs nowhere else. Gives a note
    for a topic that two files named at the base, and only one names now.

Why it breaks
    Who has the old name and who has the new one are no longer connected. ROS prints no warning.

Severity
    warning where nothing else has the new name; note where others have it, and the old name is left with one file.

Example
    <remap from="fix" to="gps/fix_new"/>             <!-- was: gps/fix, which navsat.yaml still names -->

Use instead
    <remap from="fix" to="gps/fix"/>

Not reported
    Lines that differ in more than names; names that were replaced in all files; words that are no topic in the
    workspace; a file that names the old and the new one, as a server of both does.
"""

from ....edges.groups import group_pairs
from ...model.flow.mentions import SETTINGS, find_mentions, list_replaced_names, normalise_mention
from ...model.flow.workspace import get_flow
from ..vocabulary import At, Diagnostic, Doubt, Text, Workspace, rule


@rule(
    scope="flow_change",
    severity="warning",
    preview=True,
    texts={
        "alone": Text(
            "nothing else in the workspace names `{subject}`; this was `{old}` at the base, as it still is in "
            "{places:no other file}",
            help="write `{old}`, or give the other side the new name",
        ),
        "left": Text(
            "only {places:nothing} still names `{subject}`; this line did at the base, and names `{new}` now",
            help="use one name on both sides",
        ),
    },
)
def lost_name(workspace: Workspace, base: Workspace):
    replaced = list(dict.fromkeys(list_replaced_names(workspace, base)))
    if not replaced:
        return
    endpoints, formerly = ([one for one in get_flow(each).system.endpoints if one.topic] for each in (workspace, base))
    topics = group_pairs((normalise_mention(one.topic), one.path) for one in endpoints)
    coded = group_pairs((normalise_mention(one.topic), one.path) for one in endpoints if one.how != "launch")
    former = {normalise_mention(one.topic) for one in formerly}
    own = {(one.path, one.line) for one in endpoints}
    replaced = [
        one for one in replaced
        if (topics.keys() | former) & {normalise_mention(one.old), normalise_mention(one.new)}
        and (one.kind in SETTINGS or (one.path, one.line) in own)
    ]  # fmt: skip
    names = {normalise_mention(name) for one in replaced for name in (one.old, one.new)}
    now, before = find_mentions(workspace, names), find_mentions(base, names)
    for one in replaced:
        old, new = normalise_mention(one.old), normalise_mention(one.new)
        kept = {mention.path for mention in now[old] if mention.whole} & {mention.path for mention in before[old]}
        if not kept - {one.path} and old in former:  # the text has it in pieces, if at all
            kept |= set(topics.get(old, ()))
        others = any((mention.path, mention.line) != (one.path, one.line) for mention in now[new])
        others = others or any(path != one.path for path in coded.get(new, ()))
        at = At(one.path, one.line)
        if not others and kept - {one.path}:
            data = {"old": one.old, "places": tuple(sorted(kept - {one.path}))}
            yield Diagnostic(at, one.new, workspace.find_owning_package(one.path), data, "alone")
        elif others and len(kept) == 1 and "/" in old and kept.isdisjoint({one.path, *(it.path for it in now[new])}):
            data = {"new": one.new, "places": tuple(kept)}
            yield Diagnostic(at, one.old, workspace.find_owning_package(one.path), data, "left", (Doubt.CHANGED,))
