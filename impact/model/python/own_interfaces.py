"""The workspace's own interfaces as Python code uses them: members that these do not have, and what a package may
have."""

from __future__ import annotations

import posixpath
from typing import TYPE_CHECKING

from ....edges.memory import cache_in_derived
from ...facts.interface import Section, make_full_name
from ...facts.python.uses import ELEMENT, SECTIONS
from ...targets.surface.fields import load_fields

if TYPE_CHECKING:
    from ..package import FieldOfWorkspace
    from ..workspace import Package, Workspace

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
    """The interfaces that packages of a workspace define, as far as they were read in full. member_names: of the fields
    and constants of all of them, however they were read."""

    def __init__(self, workspace: Workspace):
        twice = workspace.outside.twice
        # As Python calls their types: `pkg.msg.Name`, `pkg.srv.Name.Request`.
        self._sections: dict[str, Section] = {}
        self.member_names: set[str] = set()
        for package in workspace:
            for interface in package.linked.interfaces:
                definition = interface.definition
                sections = definition.sections
                self.member_names.update(one.name for each in sections for one in (*each.fields, *each.constants))
                whole = package.name not in twice and definition.kind != "idl" and not definition.problems
                for section in sections if whole else ():
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
        # What a field has by default is an attribute of the class. Source: the template of rosidl_generator_py.
        names = {f"{one.name.upper()}__DEFAULT": one.name for one in section.fields}
        last = names.get(last, last)
        return "" if any(one.name == last for one in (*section.fields, *section.constants)) else type_


def may_generate(package: Package, kind: str, ros: int) -> bool:
    """Whether a package without interfaces, as far as was read, may have some, or a module that is called as their kind
    is."""
    if package.build.unresolved or package.build.starts or package.build.generated or kind in package.linked.modules:
        return True
    # A release of it that has some may be installed beside.
    return load_fields().find_history(package.name, ros) is not None


def may_have_interface(package: Package, name: str) -> bool:
    """Whether a package with interfaces may have one, or something that is made of one."""
    kinds = {one.name: one.definition.kind for one in package.linked.interfaces}
    listed = [path for made in package.build.generated for path in made.files]
    if not name[:1].isupper() or package.build.unresolved or not listed or "idl" in kinds.values():
        return True
    if package.build.starts:
        return True  # what configuring runs may write interfaces
    if any("$" in path or posixpath.basename(path).partition(".")[0] not in kinds for path in listed):
        return True
    return name in package.linked.modules or any(name.startswith(one) for one in kinds)
