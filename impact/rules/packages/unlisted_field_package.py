"""unlisted-field-package: the type of a message's field is unknown to the generator of the message.

What it does
    Looks up the types of the fields of messages, services and actions that a package generates: those of other packages
    are given to the generator (DEPENDENCIES), messages of this name exist, and every line is a field or a constant.

Why it breaks
    The generator stops: it finds no definition of the field's type, or cannot read the line.

Severity
    error; warning for `Header` in ROS 1, which some generators know by themselves, and where the generator is called
    under a condition that is not known.

Example
    rosidl_generate_interfaces(${PROJECT_NAME} "msg/Dose.msg")      # which has a field of geometry_msgs/Point

Use instead
    rosidl_generate_interfaces(${PROJECT_NAME} "msg/Dose.msg" DEPENDENCIES geometry_msgs)

Not reported
    Packages that come with one that is given; what rosidl adds itself for actions and services; definitions that no
    generator is given.
"""

from ...facts.interface import PRIMITIVES, TIMES, make_full_name
from ..vocabulary import At, Diagnostic, Doubt, Package, TargetView, Text, rule

_FROM_ROS1 = TIMES | {"Header"}
_ROS1_PRIMITIVE = PRIMITIVES | _FROM_ROS1 | {"float", "double"}


@rule(
    group="missing-interface-wiring",
    texts={
        "no field": Text(
            "the line that begins with `{subject}` is neither a field nor a constant",
            "write `package/Type name`",
        ),
        "own type": Text(
            "`{package}` has no message `{subject}`", "correct the type, or name its package[[: `{replacement}`]]"
        ),
        "other type": Text("`{owner}` has no message `{name}`", "correct the type"),
        "dependency": Text(
            "`{type}` is a field type, but `{subject}` is not given to the generator",
            "add `{subject}` to DEPENDENCIES of {generator}",
        ),
    },
)
def unlisted_field_package(view: TargetView, package: Package):
    # Of a package for both generations the files of the other one are not generated.
    how = "rosidl" if view.target.ros == 2 else "catkin"
    generated = [g for g in package.build.generated if g.how == how and view.applies(g.conditions)]
    if not generated:
        return
    sure = {file for g in generated if view.is_sure(g.conditions) for file in g.files}
    listed = {file for g in generated for file in g.files}
    given = {name for g in generated for name, _ in g.dependencies} | _list_implied(view, listed)
    seen = set()
    for interface in package.linked.interfaces:
        if interface.path not in listed:
            continue
        certain = interface.path in sure or Doubt.CONDITIONAL
        for line, text in interface.definition.unread:
            at = At(interface.path, line)
            yield Diagnostic(at, text.split()[0], package.name, kind="no field", doubts=(certain,))
        adapted = package.build_type != "catkin" and interface.definition.kind != "idl"
        primitive = PRIMITIVES if adapted else _ROS1_PRIMITIVE
        for section in interface.definition.sections:
            for field in section.fields:
                at = At(interface.path, field.line, field.column)
                owner, name = find_field_owner(package, field.type), field.type.rpartition("/")[2]
                if not owner and field.type not in primitive and "<" not in field.type:
                    names = {i.name for i in package.linked.interfaces}
                    if field.type not in names and field.type not in seen:
                        seen.add(field.type)
                        data = {"replacement": make_full_name(field.type, "") if field.type in _FROM_ROS1 else ""}
                        yield Diagnostic(at, field.type, package.name, data, "own type", (certain,))
                    continue
                if not owner or owner == package.name or owner in seen:
                    continue
                names = view.workspace.interface_names.get(owner)
                if owner in given:
                    if names and name not in names and (owner, name) not in seen:
                        seen.add((owner, name))
                        data = {"owner": owner, "name": name}
                        yield Diagnostic(at, f"{owner}/{name}", package.name, data, "other type", (certain,))
                    continue
                if owner in view.list_transitive(given):
                    continue
                seen.add(owner)
                rosidl = generated[0].how == "rosidl"
                generator = "rosidl_generate_interfaces" if rosidl else "generate_messages"
                data = {"type": field.type, "generator": generator}
                doubts = (certain, rosidl or field.type != "Header" or Doubt.INCOMPLETE)
                yield Diagnostic(at, owner, package.name, data, "dependency", doubts)


def find_field_owner(package: Package, type_: str) -> str:
    """The package that the type of a field names; empty for primitive types and those of the package itself."""
    owner = type_.rpartition("/")[0].split("/")[0]
    return "std_msgs" if type_ == "Header" and package.build_type == "catkin" else owner


def _list_implied(view: TargetView, files: set[str]) -> set[str]:
    """Packages that rosidl gives to the generator by itself for actions, and for services where they have events.
    Source: rosidl_generate_interfaces.cmake."""
    kinds = {file.rpartition(".")[2] for file in files}
    names = {"action_msgs", "service_msgs"} if "action" in kinds else {"service_msgs"} if "srv" in kinds else set()
    return {name for name in names if view.target.ros == 2 and view.is_available(name)}
