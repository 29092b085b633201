"""Members of the workspace's own interfaces that Python code uses and that these do not have."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ....edges.memory import cache_in_derived
from ...facts.interface import Section, make_full_name
from ...facts.python.uses import ELEMENT, SECTIONS

if TYPE_CHECKING:
    from ..package import FieldOfWorkspace
    from ..workspace import Workspace

# What every class of an interface has that belongs to it, in one generation of ROS or the other.
_OF_ALL = SECTIONS | {
    "Event", "Impl", "SLOT_TYPES", "deserialize", "deserialize_numpy", "get_fields_and_field_types", "serialize",
    "serialize_numpy",
}  # fmt: skip
# What rclpy hands to callbacks of actions wraps these parts; code annotates such an object as the part itself.
# Source: rosidl_parser's definition of an action (SendGoal, GetResult, FeedbackMessage).
_WRAPPERS = {"Goal": ("goal_id", "goal"), "Result": ("status", "result"), "Feedback": ("goal_id", "feedback")}


@cache_in_derived
def get_own_interfaces(workspace: Workspace) -> OwnInterfaces:
    return OwnInterfaces(workspace)


class OwnInterfaces:
    """The interfaces that packages of a workspace define, as far as they were read in full."""

    def __init__(self, workspace: Workspace):
        twice = workspace.outside.twice
        # As Python calls their types: `pkg.msg.Name`, `pkg.srv.Name.Request`.
        self._sections: dict[str, Section] = {}
        for package in workspace:
            for interface in package.linked.interfaces if package.name not in twice else ():
                definition = interface.definition
                for section in definition.sections if definition.kind != "idl" and not definition.problems else ():
                    part = "" if section.name == "message" else f".{section.name.title()}"
                    self._sections[f"{package.name}.{definition.kind}.{interface.name}{part}"] = section

    def find_lacking(self, use: FieldOfWorkspace) -> str:
        """The type of the interface that lacks the last step of a use; empty where none is known to."""
        type_, section = use.type, self._sections.get(use.type)
        several = False
        for step in use.steps[:-1]:
            if several or step == ELEMENT:
                several, section = False, section if several and step == ELEMENT else None
                continue
            field = next((one for one in section.fields if one.name == step), None) if section is not None else None
            if field is None:
                return ""
            package, _, name = make_full_name(field.type, type_.partition(".")[0]).partition("/")
            type_, several = f"{package}.msg.{name}", bool(field.array)
            section = self._sections.get(type_)
        last = use.steps[-1]
        if section is None or several or last == ELEMENT or last.startswith("_") or last in _OF_ALL:
            return ""
        if type_.count(".") > 2 and last in _WRAPPERS.get(type_.rpartition(".")[2], ()):
            return ""
        return "" if any(one.name == last for one in (*section.fields, *section.constants)) else type_
