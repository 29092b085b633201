"""ungenerated-interface: the definition of a message, service or action is not given to the generator.

What it does
    Compares the files in the folders msg, srv and action of a package that generates interfaces with those that its
    CMake gives to generate_interfaces(), or to add_message_files() and its kin.

Why it breaks
    The interface does not exist: whoever includes its header, imports its type or embeds it in a message stops.

Severity
    warning where a definition that is generated has a field of the type, or a target compiles its header, and where one
    or two definitions are left out; note for all but one of more, and in packages for tests.

Example
    rosidl_generate_interfaces(${PROJECT_NAME} "msg/Sled.msg")      # and there is msg/Winch.msg

Use instead
    rosidl_generate_interfaces(${PROJECT_NAME} "msg/Sled.msg" "msg/Winch.msg")

Not reported
    Lists of files that cannot be resolved; files in other folders; names that differ from a listed one in case alone.
"""

import posixpath
from collections.abc import Iterator

from ...model.package import find_folder_role
from ...model.workspace import is_interface_header
from ..vocabulary import Diagnostic, Doubt, Package, TargetView, Text, Together, rule

_FOLDERS = frozenset({"msg", "srv", "action"})
_LEFT_OUT = (Together("left out", few=2),)


@rule(
    severity="warning",
    group="missing-message-generation",
    texts={
        "": Text(
            "`{subject}` is not given to the generator of interfaces, so nobody can use it",
            "add it to the generator's files, or remove it",
        ),
        "used": Text(
            "`{subject}` is not given to the generator of interfaces, but `{by}` uses it",
            "add it to the generator's files",
        ),
    },
)
def ungenerated_interface(view: TargetView, package: Package) -> Iterator[Diagnostic]:
    made = [one for one in package.build.generated if one.how in ("rosidl", "catkin")]
    given = {file.path for file in package.build.message_files}
    if not made or not given or package.build.unresolved or any("$" in path or "*" in path for path in given):
        return
    names = {posixpath.basename(path).lower() for path in given}
    unused = Doubt.UNCHECKED if find_folder_role(f"{package.path}/") else Doubt.DISTURBS
    for interface in package.linked.interfaces:
        inside = package.strip_path(interface.path)
        folder, _, name = inside.partition("/")
        if folder in _FOLDERS and "/" not in name and name.endswith(f".{folder}") and name.lower() not in names:
            by = next(_list_users(view, package, interface.name), "")
            kind, doubts, together = ("used", (), ()) if by else ("", (unused,), _LEFT_OUT)
            yield Diagnostic(made[-1].at, inside, package.name, {"by": by}, kind, doubts, together=together)


def _list_users(view: TargetView, package: Package, name: str) -> Iterator[str]:
    """The files that surely do not compile without an interface: definitions that are generated, and sources."""
    given = {posixpath.basename(file.path) for file in package.build.message_files}
    if not given.isdisjoint(f"{name}.{folder}" for folder in _FOLDERS):
        return  # an interface of another kind with the same header in ROS 1
    for user in view.list_built():
        made = {path for one in user.build.generated if view.is_sure(one.conditions) for path in one.files}
        types = {name} if user.name == package.name else set()
        types.update((f"{package.name}/{name}", f"{package.name}/msg/{name}"))
        for interface in user.linked.interfaces:
            fields = (field for section in interface.definition.sections for field in section.fields)
            if interface.path in made and any(field.type in types for field in fields):
                yield interface.path
        for use in user.linked.includes:
            head, _, rest = use.path.partition("/")
            if head == package.name and use.role == "build" and use.targets and view.is_sure(use.conditions):
                own = any(header.endswith(f"/{use.path}") for header in package.linked.headers)
                if is_interface_header(rest, (name,)) and not own:
                    yield use.at.path
