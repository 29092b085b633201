"""unread-field: no subscriber of a topic reads some fields of its message.

What it does
    Reports topics whose subscribers are all known, with the fields that none of them reads, for messages that the
    workspace itself defines. One note for each topic.

Why it matters
    The fields are filled and sent for nothing: larger messages take longer, and are dropped sooner.

Example
    float32 level
    uint8[] diagnosis        # sent with every message, and read by nobody

Use instead
    Remove the field, or give the topic a lighter message: `rosimpact prune` writes it.

Not reported
    Topics that somebody who is not seen may read: names that are not certain, programs of other packages that a launch
    file starts, messages that are published again, recorded, printed or handed to other libraries.
"""

from ...model.fields.topics import list_topic_fields
from ..vocabulary import At, Diagnostic, Text, Workspace, rule

_SHOWN = 8


@rule(
    scope="flow",
    severity="note",
    preview=True,
    texts=Text(
        "no subscriber of `{subject}` reads {fields} of `{type}`",
        help="remove what nobody needs, or let `rosimpact prune --topic {subject}` write a lighter message",
    ),
)
def unread_field(workspace: Workspace):
    for topic in list_topic_fields(workspace):
        package = topic.type.partition("/")[0]
        if topic.unread and topic.publishers and package in workspace.interface_names:
            first = topic.publishers[0]
            names = [f"`{name}`" for name in topic.unread[:_SHOWN]]
            more = f" and {len(topic.unread) - _SHOWN} more fields" if len(topic.unread) > _SHOWN else ""
            data = {"fields": ", ".join(names) + more, "type": topic.type}
            yield Diagnostic(At(first.path, first.line), topic.topic, package, data)
