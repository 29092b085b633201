"""unwritten-field: a subscriber reads a field that no publisher of the topic sets.

What it does
    Reports the first place that reads a field which nothing sets before the message is published, where all publishers
    are known and what they publish is made in the workspace.

Why it breaks
    The subscriber always sees the field's default: zero, an empty string, an empty array.

Example
    if (report->battery < 0.2) { dock(); }        # no publisher sets battery

Use instead
    report.battery = battery_.getCharge();

Not reported
    Topics with a publisher whose message comes from elsewhere, is copied, or is handed to other functions; what ROS
    itself fills.
"""

from ...model.fields.topics import list_topic_fields, list_unset_fields
from ...model.flow.workspace import list_code
from ..vocabulary import At, Diagnostic, Text, Workspace, rule


@rule(
    scope="flow",
    severity="warning",
    preview=True,
    texts=Text(
        "`{subject}` of `{topic}` is read here, and no publisher sets it",
        help="set it before the message is published, or do not read it",
    ),
)
def unwritten_field(workspace: Workspace):
    packages = list_code(workspace)
    for topic in list_topic_fields(workspace):
        for field, place in list_unset_fields(workspace, topic):
            yield Diagnostic(At(place.path, place.line), field, packages[place.path], {"topic": topic.topic})
