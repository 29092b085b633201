"""wire-mismatch: two machines of a system have a topic, service or action in different types.

What it does
    Compares the interfaces of the workspace's topics, services and actions between targets whose nodes talk to each
    other, as `[system] talks = ["laptop", "robot"]` in rosimpact.toml says: fields, their types and order, nested
    interfaces included, in the versions that the targets have.

Why it breaks
    ROS 1 refuses the connection. ROS 2 knows a type by its name: nodes connect, and read wrong values or none.

Severity
    warning.

Example
    [system]
    talks = ["laptop", "robot"]                 # jazzy and humble: NavigateToPose has another result

Use instead
    the same distro on both machines, or types of your own workspace

Not reported
    Types of which a target's version is not stored; targets that are not checked in the same run.
"""

from collections.abc import Iterator, Sequence
from itertools import combinations

from ...model.flow.wire import list_wire_differences
from ...model.flow.workspace import get_flow
from ..vocabulary import At, Diagnostic, TargetView, Text, rule


@rule(
    scope="targets",
    severity="warning",
    texts=Text(
        "the {kind} `{subject}` is not of the same type on `{first}` and `{second}`: {why}",
        "keep `{package_of_type}` at one version on both machines",
    ),
)
def wire_mismatch(views: Sequence[TargetView]) -> Iterator[tuple[TargetView, Diagnostic]]:
    talking = [view for view in views if view.target.name in view.config.talks]
    for one, other in combinations(talking, 2):
        workspace, targets = one.workspace, (one.target, other.target)
        if one.target.ros != other.target.ros:
            continue
        for found in list_wire_differences(get_flow(workspace).system, workspace, *targets):
            if not found.places:
                continue
            path, line = found.places[0]
            package = workspace.find_owning_package(path)
            data = {"kind": found.kind, "why": found.why, "package_of_type": found.type.partition("/")[0]}
            data |= {"first": one.target.name, "second": other.target.name}
            for view in (one, other):
                yield view, Diagnostic(At(path, line), found.name, package, data)
