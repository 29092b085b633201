"""ungenerated-interface: the definition of a message, service or action is not given to the generator.

What it does
    Compares the files in the folders msg, srv and action of a package that generates interfaces with those that its
    CMake gives to generate_interfaces(), or to add_message_files() and its kin.

Why it breaks
    The interface does not exist: whoever includes its header, imports its type or embeds it in a message stops.

Example
    rosidl_generate_interfaces(${PROJECT_NAME} "msg/Sled.msg")      # and there is msg/Winch.msg

Use instead
    rosidl_generate_interfaces(${PROJECT_NAME} "msg/Sled.msg" "msg/Winch.msg")

Not reported
    Lists of files that cannot be resolved; files in other folders; names that differ from a listed one in case alone.
"""

import posixpath
from collections.abc import Iterator

from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, rule

_FOLDERS = frozenset({"msg", "srv", "action"})


@rule(
    severity="warning",
    preview=True,
    group="missing-message-generation",
    texts=Text("`{subject}` is not given to the generator of interfaces", "add it to the generator's files"),
)
def ungenerated_interface(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    made = [one for one in package.build.generated if one.how in ("rosidl", "catkin")]
    given = {path for one in made for path in one.files} | {path for path, _ in package.build.message_files}
    if not given or package.build.unresolved or any("$" in path or "*" in path for path in given):
        return
    names = {posixpath.basename(path).lower() for path in given}
    for interface in package.linked.interfaces:
        inside = package.strip_path(interface.path)
        folder, _, name = inside.partition("/")
        if folder in _FOLDERS and "/" not in name and name.endswith(f".{folder}") and name.lower() not in names:
            yield Diagnostic(made[-1].at, inside, package.name, doubts=(Doubt.DISTURBS,))
