"""What the rules of this family share: definitions before and after, and who uses them."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from typing import NamedTuple

from ...facts.interface import Field, Section
from ...model.cmake.build import At
from ...model.package import InterfaceFile
from ...model.workspace import Package, Workspace, is_interface_header


class Pair(NamedTuple):
    """One section of a definition before and after the change. name: `package/Name`, plus the section where several."""

    package: Package
    name: str
    old: Section
    new: Section
    file: InterfaceFile

    def at(self, line: int, column: int = 0) -> At:
        """A place in the new file."""
        return At(self.file.path, line, column)


def pairs(workspace: Workspace, base: Workspace) -> Iterator[Pair]:
    """Sections of definitions that are in both workspaces and differ."""
    for package in workspace:
        before = base.packages.get(package.name)
        if before is None:
            continue
        old_files = {(i.name, i.definition.kind): i for i in before.digest.interfaces}
        for file in package.digest.interfaces:
            old = old_files.get((file.name, file.definition.kind))
            if old is None or old.definition == file.definition:
                continue
            sections = {s.name: s for s in old.definition.sections}
            for section in file.definition.sections:
                if section.name in sections:
                    label = f"{package.name}/{file.name}" + (
                        f" ({section.name})" if len(file.definition.sections) > 1 else ""
                    )
                    yield Pair(package, label, sections[section.name], section, file)


def type_of(field: Field) -> str:
    """A field's type as a person writes it."""
    return field.type + field.array


@lru_cache(maxsize=256)
def _users(workspace: Workspace, package: str, name: str) -> tuple[str, ...]:
    found = []
    for other in workspace:
        if other.name == package and not other.build.targets:
            continue
        includes = any(
            i.path.startswith(package + "/") and is_interface_header(i.path.partition("/")[2], (name,))
            for i in other.digest.includes
        )
        imports = any(
            i.module.split(".")[0] == package and (name in i.names or not i.names) for i in other.digest.imports
        )
        fields = any(
            f.type in (f"{package}/{name}", f"{package}/msg/{name}") or (other.name == package and f.type == name)
            for i in other.digest.interfaces
            for s in i.definition.sections
            for f in s.fields
        )
        if includes or imports or fields:
            found.append(other.name)
    return tuple(found)


def users(workspace: Workspace, pair: Pair) -> str:
    """A clause that names the packages of the workspace that use the definition."""
    names = _users(workspace, pair.package.name, pair.file.name)
    if not names:
        return "nothing in the workspace uses it"
    more = f" and {len(names) - 4} more" if len(names) > 4 else ""
    return "used by " + ", ".join(f"`{n}`" for n in names[:4]) + more


def wire(workspace: Workspace) -> str:
    """What a change of fields does to nodes and bags that were built before it."""
    if workspace.ros == 1:
        return "its md5 changes, so nodes built before it do not connect and recorded bags need a migration rule"
    return (
        "its type hash changes, so nodes built before it do not match and recorded bags are read wrongly or not at all"
    )
