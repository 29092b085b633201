"""removed-interface: a message, service or action of the base is gone.

What it does
    Reports definitions that were removed, renamed, or moved to another package of the workspace.

Why it breaks
    Source that includes or imports it does not build or start; recorded bags name a type that no machine knows.

Severity
    error when a package of the workspace still uses it; warning otherwise.

Example
    my_msgs/msg/Status.msg                      # deleted

Use instead
    Keep the definition for one release, and publish both.
"""

from ...model.cmake.build import At
from ...model.workspace import Workspace
from ..rule import Hit, rule
from .comparison import _users


@rule(severity="error", compares=True)
def removed_interface(workspace: Workspace, base: Workspace):
    now = {}
    for package in workspace:
        for file in package.digest.interfaces:
            now.setdefault((file.name, file.definition.kind), []).append(package.name)
    for before in base:
        package = workspace.packages.get(before.name)
        here = {(i.name, i.definition.kind) for i in package.digest.interfaces} if package else set()
        for file in before.digest.interfaces:
            key = (file.name, file.definition.kind)
            if key in here:
                continue
            users = _users(workspace, before.name, file.name)
            moved = [n for n in now.get(key, ()) if n != before.name]
            at = At(package.digest.manifest_path, 1) if package else At(file.path, 1)
            who = "used by " + ", ".join(f"`{n}`" for n in users[:4]) if users else "nothing in the workspace uses it"
            yield Hit(
                at,
                f"{before.name}/{file.name}",
                f"`{before.name}/{file.name}` is gone; {who}",
                f"use `{moved[0]}/{file.name}`" if moved else "keep it for one release",
                before.name,
                severity="error" if users else "warning",
            )
