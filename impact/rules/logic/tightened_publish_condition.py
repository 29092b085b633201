"""tightened-publish-condition: a message is published in fewer cases than at the base.

What it does
    Compares the conditions of every publish statement with the base: nested branches, early returns, loops, and those
    of the functions that call it. Reports statements whose new condition implies the old one and is not equivalent.

Why it breaks
    Subscribers wait for messages that no longer arrive. Everything compiles, and nothing warns about it.

Severity
    warning; note when nothing in the workspace subscribes to the topic.

Example
    if (range_max <= 0.0) { return; }        // new
    cloud_pub_.publish(cloud);               // a viewer waits for it

Use instead
    cloud_pub_.publish(cloud);               // as before, perhaps empty; or inform the users of the topic

Not reported
    Conditions that were reworded, moved into functions or given names; statements whose trigger is not known; new and
    removed statements, and conditions of which neither implies the other (`rosimpact impact` lists them).
"""

from ..vocabulary import Text, Workspace, rule
from .statements import CONDITIONS, READERS, find_changes


@rule(
    scope="change",
    severity="warning",
    texts=Text(
        f"`{{subject}}` is published in fewer cases ({{change}}): {CONDITIONS}; {READERS}",
        help="check that the subscribers work without these messages",
    ),
)
def tightened_publish_condition(workspace: Workspace, base: Workspace):
    return find_changes(workspace, base, lambda change: change.kind == "tightened" and not change.unreachable)
