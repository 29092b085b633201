"""Message, service and action definitions that differ from the base's, and the types that hold them."""

from collections.abc import Iterator
from typing import NamedTuple

from ...edges.reach import walk
from ..facts.interface import Section
from ..model.workspace import Workspace
from ..rules.interfaces.comparison import SectionPair, find_changed_sections, format_type


class MessageChange(NamedTuple):
    """A definition that differs. name: `package/Name`; path, line: of the first difference, at the base where it is
    gone; why: what differs."""

    name: str
    change: str
    package: str
    path: str
    line: int
    why: str


def list_message_changes(workspace: Workspace, base: Workspace) -> Iterator[MessageChange]:
    """Definitions that both have and that differ for whoever sends or reads them, and those that are gone."""
    found: dict[tuple[str, str], list[tuple[int, str]]] = {}
    packages: dict[tuple[str, str], str] = {}
    for pair in find_changed_sections(workspace, base):
        key = (f"{pair.package.name}/{pair.file.name}", pair.file.path)
        packages[key] = pair.package.name
        found.setdefault(key, []).extend(_compare_sections(pair))
    for (name, path), rows in found.items():
        if rows:
            why = "; ".join(dict.fromkeys(text for _, text in rows))
            yield MessageChange(name, "changed", packages[name, path], path, rows[0][0], why)
    for package in base:
        now = workspace.packages.get(package.name)
        left = {(one.name, one.definition.kind) for one in now.linked.interfaces} if now is not None else set()
        for file in package.linked.interfaces:
            if (file.name, file.definition.kind) not in left:
                yield MessageChange(
                    f"{package.name}/{file.name}", "removed", package.name, file.path, 1, "the definition is gone"
                )


def find_containing_types(workspace: Workspace, name: str) -> set[str]:
    """A type and all of the workspace that have a field of it, or of one that has; as `package/Name`."""
    inside: dict[str, set[str]] = {}
    for package in workspace:
        for file in package.linked.interfaces:
            for section in file.definition.sections:
                for field in section.fields:
                    parts = field.type.split("/")
                    full = f"{parts[0]}/{parts[-1]}" if len(parts) > 1 else f"{package.name}/{parts[0]}"
                    inside.setdefault(full, set()).add(f"{package.name}/{file.name}")
    return set(walk([name], lambda one: inside.get(one, ())))


def _compare_sections(pair: SectionPair) -> Iterator[tuple[int, str]]:
    where = f" of the {pair.new.name}" if len(pair.file.definition.sections) > 1 else ""
    old, new = {f.name: f for f in pair.old.fields}, {f.name: f for f in pair.new.fields}
    for name, field in new.items():
        if name not in old:
            yield field.line, f"field `{name}`{where} is new (`{format_type(field)}`)"
        elif format_type(old[name]) != format_type(field):
            yield field.line, f"field `{name}`{where} is `{format_type(field)}`, was `{format_type(old[name])}`"
        elif old[name].default != field.default:
            yield field.line, f"field `{name}`{where} is `{field.default}` by default, was `{old[name].default}`"
    for name in old:
        if name not in new:
            yield 1, f"field `{name}`{where} is gone"
    if [name for name in old if name in new] != [name for name in new if name in old]:
        yield 1, f"the fields{where} stand in another order"
    yield from _compare_constants(pair.old, pair.new, where)


def _compare_constants(old: Section, new: Section, where: str) -> Iterator[tuple[int, str]]:
    before, after = {c.name: c for c in old.constants}, {c.name: c for c in new.constants}
    for name, constant in after.items():
        if name not in before:
            yield constant.line, f"constant `{name}`{where} is new"
        elif before[name].value != constant.value:
            yield constant.line, f"constant `{name}`{where} is `{constant.value}`, was `{before[name].value}`"
    for name in before:
        if name not in after:
            yield 1, f"constant `{name}`{where} is gone"
