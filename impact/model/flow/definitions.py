"""What messages, services and actions consist of: as the workspace defines them, or as their newest release does."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain
from typing import NamedTuple

from ...facts.interface import PRIMITIVES, TIMES, Section, make_full_name
from ...targets.surface.fields import FieldsHistory, covers, load_fields
from ..package import InterfaceFile
from ..workspace import Workspace

_FOLDERS = {"topic": "msg", "service": "srv", "action": "action"}
# What a page can bear.
_MOST = 2_000


class DefinedMember(NamedTuple):
    """A field or constant. type: as written, its package included; empty for a primitive one of a released package,
    whose type is not kept. nested: the key of the interface that it is made of. value: of a constant, or a default."""

    name: str
    type: str
    nested: str = ""
    value: str = ""
    constant: bool = False


Sections = dict[str, list[DefinedMember]]
"""The members of each part of an interface: `message`; `request` and `response`; `goal`, `result` and `feedback`."""


def describe_interfaces(workspace: Workspace, types: Iterable[tuple[str, str]]) -> dict[str, Sections]:
    """What interfaces consist of, with those nested in them, by `package/msg/Name`; those not known are left out.

    types: kind (`topic`, `service`, `action`) and `package/Name`.
    """
    own = {
        f"{package.name}/{_find_folder(interface)}/{interface.name}": interface.definition
        for package in workspace
        for interface in package.linked.interfaces
    }
    found: dict[str, Sections] = {}
    left = [make_key(kind, name) for kind, name in types]
    while left and len(found) < _MOST:
        key = left.pop()
        if key in found:
            continue
        package = key.partition("/")[0]
        if key in own:
            sections = {section.name: list(_list_own(section, package)) for section in own[key].sections}
        else:
            sections = _read_released(key, workspace.ros)
        if sections:
            found[key] = sections
            left += [member.nested for member in chain.from_iterable(sections.values()) if member.nested]
    return found


def make_key(kind: str, type_: str) -> str:
    """`package/msg/Name`, from the kind of what has a type, and `package/Name`."""
    package, _, name = type_.partition("/")
    return f"{package}/{_FOLDERS[kind]}/{name}"


def _find_folder(interface: InterfaceFile) -> str:
    """`msg`, `srv` or `action`; that of an IDL file is the folder it lies in."""
    kind = interface.definition.kind
    return kind if kind != "idl" else interface.path.rpartition("/")[0].rpartition("/")[2]


def _list_own(section: Section, package: str) -> Iterator[DefinedMember]:
    for constant in section.constants:
        yield DefinedMember(constant.name, constant.type, value=constant.value, constant=True)
    for field in section.fields:
        plain = field.type.partition("<=")[0]
        primitive = plain in PRIMITIVES or plain in TIMES
        nested = "" if primitive else make_key("topic", make_full_name(plain, package))
        yield DefinedMember(field.name, field.type + field.array, nested, field.default)


def _read_released(key: str, ros: int) -> Sections:
    """An interface of a released package, as the newest release that has it; empty for one that is not known."""
    package, _, name = key.partition("/")
    history = load_fields().find_history(package, ros)
    definition = history.find_definition(name) if history is not None else None
    if history is None or definition is None:
        return {}
    newest = _find_newest_state(history, definition.spans)
    found: Sections = {}
    for section, members in definition.sections.items():
        if "." in section:
            continue
        found[section] = [
            DefinedMember(
                row.name, f"{row.nested}{'[]' if row.array else ''}", row.nested and make_key("topic", row.nested),
                constant=row.constant,
            )
            for rows in members.values()
            for row in rows
            if covers(row.spans, newest)
        ]  # fmt: skip
    return found


def _find_newest_state(history: FieldsHistory, spans: tuple[tuple[int, int], ...]) -> int:
    last = len(history.starts) - 1
    return max(last if end < 0 else end for _, end in spans)
