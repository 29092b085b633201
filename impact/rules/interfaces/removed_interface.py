"""removed-interface: a message, service or action was removed since the base.

What it does
    Reports definitions that were removed, renamed, or moved to another package of the workspace.

Why it breaks
    Source that includes or imports it does not build or start; recorded bags contain a type that no machine knows.

Severity
    error when a package of the workspace still uses it; warning otherwise.

Example
    my_msgs/msg/Status.msg                      # deleted

Use instead
    Keep the definition for one release, and publish both.
"""

from ..vocabulary import At, Diagnostic, Doubt, Text, Workspace, rule
from .comparison import find_users

_REMOVED = "`{subject}` was removed; used by {users:nothing in the workspace}"


@rule(
    scope="change",
    texts={
        "removed": Text(_REMOVED, help="keep the definition for one release"),
        "moved": Text(_REMOVED, help="use `{replacement}`"),
    },
)
def removed_interface(workspace: Workspace, base: Workspace):
    packages_with: dict[tuple[str, str], list[str]] = {}
    for package in workspace:
        for file in package.linked.interfaces:
            packages_with.setdefault((file.name, file.definition.kind), []).append(package.name)
    for before in base:
        package = workspace.packages.get(before.name)
        for file in before.linked.interfaces:
            others = packages_with.get((file.name, file.definition.kind), [])
            if package is not None and package.name in others:
                continue
            users = find_users(workspace, before.name, file.name)
            replacement = f"{others[0]}/{file.name}" if others else ""
            yield Diagnostic(
                At(package.linked.manifest_path, 1) if package else At(file.path, 1),
                f"{before.name}/{file.name}",
                before.name,
                {"users": users, "replacement": replacement},
                kind="moved" if others else "removed",
                doubts=() if users else (Doubt.DISTURBS,),
            )
