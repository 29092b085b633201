"""The interfaces of other packages that a source file can mean, and which of their members only some versions have.

What the files themselves say is read in cpp/uses.py and members_python.py.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from typing import NamedTuple

from ..facts.cpp.schema import CodeSpot
from ..targets.asked_versions import AskedVersions
from ..targets.surface.fields import ROS1_SUFFIXES, Definition, FieldMember, Fields


class NamedInterface(NamedTuple):
    """An interface that a file can mean. name: `kind/Name`."""

    package: str
    ros: int
    name: str

    @property
    def short(self) -> str:
        return self.name.rpartition("/")[2]


class MemberType(NamedTuple):
    """What an expression is. section: empty for a whole service or action, or all of its constants' scopes; that of a
    field (`message.center`) where what the field is made of differs between versions.
    several: a sequence of them."""

    interface: NamedInterface
    section: str
    several: bool = False


class FoundField(NamedTuple):
    """A use of a member. at: where its name stands, of C++ alone. sure: the receiver's type shows."""

    interface: NamedInterface
    section: str
    member: str
    at: CodeSpot | None
    sure: bool


def find_included_interfaces(paths: Iterable[str], table: Fields) -> tuple[list[NamedInterface], list[str]]:
    """The interfaces whose generated headers include paths name, and the paths that look so but are not known."""
    found: dict[NamedInterface, None] = {}
    unknown = []
    for path in paths:
        head, _, rest = path.partition("/")
        stem, _, ending = rest.rpartition(".")
        if not stem or ending not in ("h", "hpp"):
            continue
        parts = stem.split("/")
        if len(parts) == 2 and parts[0] in ("msg", "srv", "action"):
            ros = 2
        elif len(parts) == 1 and ending == "h" and stem[0].isupper():
            ros = 1
        else:
            continue
        history = table.find_history(head, ros)
        name = history.by_header.get(stem) if history is not None else None
        if name is not None:
            found[NamedInterface(head, ros, name)] = None
        else:
            unknown.append(path)
    return list(found), unknown


def find_interface(text: str, table: Fields) -> NamedInterface | None:
    """The interface that a qualified C++ name (`pkg::msg::Name`, `pkg::Name`, whatever stands behind) is of."""
    parts = text.split("::")
    if len(parts) > 2 and parts[1] in ("msg", "srv", "action"):
        history = table.find_history(parts[0], 2)
        name = f"{parts[1]}/{parts[2]}"
        return (
            NamedInterface(parts[0], 2, name) if history is not None and history.find_spans(name) is not None else None
        )
    history = table.find_history(parts[0], 1) if len(parts) > 1 else None
    known = history.by_header.get(parts[1].removesuffix("Ptr").removesuffix("Const")) if history is not None else None
    return NamedInterface(parts[0], 1, known) if known is not None and "/" not in parts[1] else None


def find_imported_interfaces(imports: Iterable[tuple[str, tuple[str, ...]]], table: Fields) -> list[NamedInterface]:
    """The interfaces that modules such as `pkg.msg` and names imported from them bring."""
    found: dict[NamedInterface, None] = {}
    for module, names in imports:
        package, _, kind = module.partition(".")
        if kind not in ("msg", "srv", "action"):
            continue
        for ros in (2, 1):
            history = table.find_history(package, ros)
            if history is None:
                continue
            for name in names:
                known = f"{kind}/{name}"
                if history.find_spans(known) is not None:
                    found[NamedInterface(package, ros, known)] = None
                elif ros == 1 and name in history.by_header and name not in ("", "*"):
                    found[NamedInterface(package, ros, history.by_header[name])] = None
    return list(found)


class InterfaceScope:
    """The interfaces that a file can name, with those nested in them. asked: the versions that members may be missing
    in, all when None. home: packages whose members are not looked for. changing: names of members that may be missing.
    """

    def __init__(
        self,
        included: Iterable[NamedInterface],
        table: Fields,
        asked: AskedVersions | None = None,
        home: Collection[str] = frozenset(),
    ):
        self.table = table
        self._lacking: dict[NamedInterface, frozenset[str]] = {}
        # What headers declare, kept by whoever reads them.
        self.declared: dict[tuple | None, dict] = {}
        self.definitions: dict[NamedInterface, Definition] = {}
        waiting = list(included)
        while waiting:
            interface = waiting.pop()
            if interface in self.definitions:
                continue
            history = table.find_history(interface.package, interface.ros)
            definition = history.find_definition(interface.name) if history is not None else None
            if history is None or definition is None:
                continue
            self.definitions[interface] = definition
            if interface.package in home:
                self._lacking[interface] = frozenset()
            elif asked is None:
                self._lacking[interface] = definition.changing
            else:
                versions = tuple(version for version, _ in asked.list_asked(interface.package, interface.ros))
                self._lacking[interface] = history.list_lacking(interface.name, versions) if versions else frozenset()
            for members in definition.sections.values():
                for rows in members.values():
                    waiting.extend(get_nested_interface(row, interface.ros) for row in rows if row.nested)
        self.changing = frozenset().union(*self._lacking.values())
        self.by_name: dict[str, list[tuple[NamedInterface, str]]] = {}
        for interface in sorted(self.definitions):
            kind = interface.name.partition("/")[0]
            for suffix in ROS1_SUFFIXES[kind] if interface.ros == 1 else ("",):
                section = "message" if kind == "msg" else suffix.lower()
                self.by_name.setdefault(interface.short + suffix, []).append((interface, section))
            if interface.ros == 2:
                for part in PARTS[kind]:
                    self.by_name.setdefault(f"{interface.short}_{part.capitalize()}", []).append((interface, part))

    def resolve_field(self, type_: MemberType, name: str) -> MemberType | None:
        """What a field of a value is; None when the versions differ in that, or it is no interface."""
        definition = self.definitions.get(type_.interface)
        if definition is None or type_.several:
            return None
        if type_.section in ("", *_WRAPPERS):
            return self._resolve_part(type_, name, definition)
        rows = definition.list_members(type_.section, name)
        kinds = {(row.nested, row.array) for row in rows if not row.constant}
        if len(kinds) != 1:
            inner = f"{type_.section}.{name}"
            return type_._replace(section=inner) if inner in definition.sections else None
        (inner, array), = kinds  # fmt: skip
        return MemberType(get_nested_interface(rows[0], type_.interface.ros), "message", array) if inner else None

    def _resolve_part(self, type_: MemberType, name: str, definition: Definition) -> MemberType | None:
        """`srv.request`, and `.goal` of what ROS 1 sends around a goal."""
        wanted = type_.section.removeprefix("action") or name
        return type_._replace(section=name) if wanted == name and name in definition.sections else None

    def find_changed_section(self, type_: MemberType, name: str) -> str | None:
        """The section in which a value has a member that some versions lack, None when it has not."""
        definition = self.definitions.get(type_.interface)
        if definition is None or type_.several or name not in self._lacking[type_.interface]:
            return None
        return type_.section if definition.list_members(type_.section, name) else None


FAR = 240
"""How many characters before a place are looked at."""
PARTS = {"msg": (), "srv": ("request", "response"), "action": ("goal", "result", "feedback")}
"""The sections that types of a kind of interface have names for."""
_WRAPPERS = ("action", "actiongoal", "actionresult", "actionfeedback")


def get_nested_interface(member: FieldMember, ros: int) -> NamedInterface:
    """The interface that a field is made of."""
    package, _, name = member.nested.partition("/")
    return NamedInterface(package, ros, f"msg/{name}")


def find_section(member: tuple[NamedInterface, str], words: list[str]) -> str | None:
    """The section of a type that scopes behind an interface's name tell; None when they name something else."""
    interface, section = member
    for word in words:
        part = word.lower()
        if word != word.capitalize() or part not in PARTS[interface.name.partition("/")[0]] or section:
            return None
        section = part
    return section
