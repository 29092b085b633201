"""Definitions before and after a change, and the packages that use them, for the rules of this family."""

from collections.abc import Container, Iterator
from functools import lru_cache
from typing import NamedTuple

from ...facts.interface import Field, Section
from ...model.package import InterfaceFile
from ...model.workspace import is_interface_header
from ..vocabulary import At, Diagnostic, Doubt, Package, Value, Workspace

# How the message of a changed definition ends: what it means for nodes and bags from before, and who uses it.
UNMATCHED = "its {hash} changes, so older nodes and bags no longer match; used by {users:nothing in the workspace}"


class SectionPair(NamedTuple):
    """One section of a definition before and after the change. name: `package/Name`, plus the section where several."""

    package: Package
    name: str
    old: Section
    new: Section
    file: InterfaceFile

    def make_place(self, line: int, column: int = 0) -> At:
        """A place in the new file."""
        return At(self.file.path, line, column)


def find_changed_sections(workspace: Workspace, base: Workspace) -> Iterator[SectionPair]:
    """Sections of definitions that are in both workspaces and differ."""
    for package in workspace:
        before = base.packages.get(package.name)
        if before is None:
            continue
        paths = {file.path for file in package.linked.interfaces}
        for file in package.linked.interfaces:
            old = _find_old(before, file, paths)
            if old is None or old.definition == file.definition:
                continue
            sections = {s.name: s for s in old.definition.sections}
            for section in file.definition.sections:
                if section.name in sections:
                    label = f"{package.name}/{file.name}" + (
                        f" ({section.name})" if len(file.definition.sections) > 1 else ""
                    )
                    yield SectionPair(package, label, sections[section.name], section, file)


def _find_old(before: Package, file: InterfaceFile, paths: Container[str]) -> InterfaceFile | None:
    """The file at the base that a definition was: the one at its place, else one of its name and kind whose place no
    file has any more. A package for both generations has two of a name (msg/X.msg and msg/ros2/X.msg). paths: of the
    package's definitions now."""
    alike = [i for i in before.linked.interfaces if (i.name, i.definition.kind) == (file.name, file.definition.kind)]
    here = next((one for one in alike if one.path == file.path), None)
    return here or next((one for one in alike if one.path not in paths), None)


def format_type(field: Field) -> str:
    """A field's type as a person writes it."""
    return field.type + field.array


@lru_cache(maxsize=256)
def find_users(workspace: Workspace, package: str, name: str) -> tuple[str, ...]:
    """The packages of the workspace that use a definition of a package."""
    found = []
    for other in workspace:
        if other.name == package and not other.build.targets:
            continue
        includes = any(
            i.path.startswith(package + "/") and is_interface_header(i.path.partition("/")[2], (name,))
            for i in other.linked.includes
        )
        imports = any(
            i.module.split(".")[0] == package and (name in i.names or not i.names) for i in other.linked.imports
        )
        fields = any(
            f.type in (f"{package}/{name}", f"{package}/msg/{name}") or (other.name == package and f.type == name)
            for i in other.linked.interfaces
            for s in i.definition.sections
            for f in s.fields
        )
        if includes or imports or fields:
            found.append(other.name)
    return tuple(found)


def diagnose(
    workspace: Workspace, pair: SectionPair, at: At, subject: str, kind: str = "", **data: Value
) -> Diagnostic:
    """A diagnostic about one name of a definition. Where nothing in the workspace uses the definition, a change of it
    can only break others. Beside the data given it has `definition`, `users`, and `hash`: what nodes compare when they
    connect, by its name in the workspace's generation of ROS."""
    users = find_users(workspace, pair.package.name, pair.file.name)
    hash = "md5 sum" if workspace.ros == 1 else "type hash"
    data = {"definition": pair.name, "users": users, "hash": hash, **data}
    return Diagnostic(at, subject, pair.package.name, data, kind, doubts=() if users else (Doubt.DISTURBS,))
