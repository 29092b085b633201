"""duplicate-package: two packages of the workspace have the same name.

What it does
    Reports a package that is not analysed because another package of the workspace has its name.

Why it breaks
    colcon and catkin stop with an error when a workspace has two packages of one name.

Severity
    warning: build tools refuse the workspace, unless one of the packages is left out on the command line.

Example
    src/gripper/package.xml             <name>gripper</name>
    src/gripper_copy/package.xml        <name>gripper</name>

Use instead
    src/gripper_copy/package.xml        <name>gripper_copy</name>
"""

from ..vocabulary import At, Diagnostic, Text, Workspace, rule


@rule(
    scope="workspace",
    severity="warning",
    group="unreadable-file",
    texts=Text(
        "not analysed, because another package named `{name}` is in {folder}",
        help="rename one of the packages, or put a COLCON_IGNORE into the folder of one of them",
    ),
)
def duplicate_package(workspace: Workspace):
    folders = {package.name: package.path for package in workspace}
    for place in workspace.hidden:
        owner = workspace.discovered.find_owner(place.manifest_path)
        data = {"name": place.name, "folder": folders.get(place.name) or "."}
        yield Diagnostic(At(place.manifest_path, 1), place.manifest_path, owner.name if owner else "", data)
