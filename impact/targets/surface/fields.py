"""Which version of an interface package has which interface, with which fields and constants.

The facts are in `data/fields.json.zst`, made by build_fields.py from release tags. It holds a text for each package and
ROS generation:

    0.1.0 2.11.0 5.0.0                      versions at which anything changed: the states 0, 1, 2
    0.11.0 2.54.0 5.16.0                    the newest version that was read of each major one
    msg/ControllerState@1-                  an interface, and the states that have it (none told: all)
     message name state other:p/Type*@2-    a section and its members: `:` nested type, `*` array, `!` constant,
                                            `@` the states (none told: whenever the interface is there), `>` successor
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Iterable
from functools import cache, cached_property, lru_cache
from pathlib import Path
from typing import NamedTuple

from ....edges.groups import group_pairs
from ....edges.memory import cache_method
from ..tables import find_table
from ..unpacked import read_table
from ..version import is_at_least, parse


class FieldMember(NamedTuple):
    """A field or constant of one section. nested: `package/Type` where it is an interface; array: it holds several of
    them. spans: the first and last states that have it (-1: to the end). successor: what stands for it since."""

    name: str
    nested: str
    array: bool
    constant: bool
    spans: tuple[tuple[int, int], ...]
    successor: str


class Definition:
    """All that an interface ever was. sections: section to member name to what it was in some states each. Where the
    interface that a field is made of differs between states, `section.field` is a section too, with its members."""

    def __init__(self, spans: tuple[tuple[int, int], ...], sections: dict[str, dict[str, list[FieldMember]]]):
        self.spans, self.sections = spans, sections

    def list_members(self, section: str, name: str) -> list[FieldMember]:
        return self.sections.get(section, {}).get(name, [])

    @cached_property
    def names(self) -> frozenset[str]:
        """Every member of every section."""
        return frozenset(name for members in self.sections.values() for name in members)

    @cached_property
    def changing(self) -> frozenset[str]:
        """Members that some state of the interface lacks, in some section."""
        return frozenset(
            name
            for members in self.sections.values()
            for name, rows in members.items()
            if not set(self.spans) <= {span for row in rows for span in row.spans}
        )


_MEMBER = re.compile(r"(\w+)(!)?(?::([\w/]+))?(\*)?(?:@([\d,-]+))?(?:>(\w+))?")


class FieldsHistory:
    """All versions of one package in one ROS generation that were read. others: gives those of other packages."""

    def __init__(self, text: str, others: Callable[[str], FieldsHistory | None] = lambda _: None):
        self._others = others
        first, last, *lines = text.split("\n")
        self.starts, self._last = first.split(" "), last.split(" ")
        self._lines: dict[str, tuple[tuple[tuple[int, int], ...], list[str]]] = {}
        sections: list[str] = []
        for line in lines:
            if line[0] == " ":
                sections.append(line)
                continue
            name, _, spans = line.partition("@")
            sections = []
            self._lines[name] = _parse_spans(spans), sections

    @cache_method
    def find_state(self, version: str) -> int | None:
        """The state that holds for a version; None before the first that was read."""
        at = None
        for place, start in enumerate(self.starts):
            if is_at_least(version, start):
                at = place
        return at

    def read_up_to(self, version: str) -> bool:
        """False when newer releases of the version's line were not read: something may have come since."""
        major = parse(version)[:1]
        return any(parse(last)[:1] == major and is_at_least(last, version) for last in self._last)

    def may_be_back(self, spans: Iterable[tuple[int, int]], version: str) -> bool:
        """Whether what earlier states had and this one lacks may be in a version all the same: newer releases of its
        line were not read, and a later state has it again, so that it was brought to an older line and goes on there.
        """
        state = self.find_state(version)
        return state is not None and any(first > state for first, _ in spans) and not self.read_up_to(version)

    @property
    def interfaces(self) -> list[str]:
        """Every interface it ever had, as `kind/Name`."""
        return list(self._lines)

    def find_spans(self, interface: str) -> tuple[tuple[int, int], ...] | None:
        """The states that have an interface; None when it never was."""
        known = self._lines.get(interface)
        return known and known[0]

    @cache_method
    def find_definition(self, interface: str) -> Definition | None:
        if interface not in self._lines:
            return None
        spans, lines = self._lines[interface]
        sections: dict[str, dict[str, list[FieldMember]]] = {}
        for line in lines:
            section, *members = line[1:].split(" ")
            matches = (match for text in members if (match := _MEMBER.fullmatch(text)))
            sections[section] = group_pairs((match[1], _make_member(match, spans)) for match in matches)
        for section, members in [*sections.items()]:
            for name, rows in members.items():
                if len({row.nested for row in rows}) > 1 and (inner := self._list_members(rows)):
                    sections[f"{section}.{name}"] = inner
        return Definition(spans, sections)

    def _list_members(self, rows: Iterable[FieldMember]) -> dict[str, list[FieldMember]]:
        """The members of what a field is made of in some states each; none where one of these is no known interface."""
        found: dict[str, list[FieldMember]] = {}
        for row in rows:
            package, _, name = row.nested.partition("/")
            history = None if row.array or not name else self._others(package)
            definition = history.find_definition(f"msg/{name}") if history is not None else None
            if definition is None:
                return {}
            for member, inner in definition.sections.get("message", {}).items():
                found.setdefault(member, []).append(inner[-1]._replace(spans=row.spans, successor=""))
        return found

    @cache_method
    def list_lacking(self, interface: str, versions: tuple[str, ...]) -> frozenset[str]:
        """The members of an interface that one of these versions lacks in some section while it has the interface."""
        definition = self.find_definition(interface)
        states = {state for version in versions if (state := self.find_state(version)) is not None}
        return frozenset(
            name
            for state in states
            if definition is not None and covers(definition.spans, state)
            for members in definition.sections.values()
            for name, rows in members.items()
            if not any(covers(row.spans, state) for row in rows)
        )

    @cached_property
    def by_header(self) -> dict[str, str]:
        """Stems of generated headers in both generations' spelling to interfaces: `srv/set_bool`, `SetBoolRequest`."""
        found: dict[str, str] = {}
        for interface in self._lines:
            kind, _, name = interface.partition("/")
            found[f"{kind}/{make_snake_case(name)}"] = interface
            for suffix in ROS1_SUFFIXES[kind]:
                found.setdefault(name + suffix, interface)
        return found


ROS1_SUFFIXES = {
    "msg": ("",),
    "srv": ("", "Request", "Response"),
    "action": ("Action", "ActionGoal", "ActionResult", "ActionFeedback", "Goal", "Result", "Feedback"),
}
"""What ROS 1 appends to an interface's name in the names of its headers and types."""


@lru_cache(maxsize=20000)
def make_snake_case(name: str) -> str:
    """An interface's name as rosidl spells it in header names (`SetBool` gives `set_bool`).

    Source: rosidl_cmake's string_camel_case_to_lower_case_underscore."""
    name = re.sub(r"(.)([A-Z][a-z]+)", r"\1_\2", name)
    return re.sub(r"([a-z0-9])([A-Z])", r"\1_\2", name).lower()


def _make_member(found: re.Match[str], spans: tuple[tuple[int, int], ...]) -> FieldMember:
    """What a text of _MEMBER says of a member. spans: of its interface, which hold where it tells none."""
    name, constant, nested, array, there, successor = found.groups()
    own = _parse_spans(there) if there else spans
    return FieldMember(name, nested or "", bool(array), bool(constant), own, successor or "")


def _parse_spans(text: str) -> tuple[tuple[int, int], ...]:
    if not text:
        return ((0, -1),)
    found = []
    for run in text.split(","):
        first, _, last = run.partition("-")
        found.append((int(first), int(last) if last else -1))
    return tuple(found)


def covers(spans: tuple[tuple[int, int], ...], state: int) -> bool:
    """Whether a state is in the spans."""
    return any(first <= state and (last < 0 or state <= last) for first, last in spans)


def was_there_before(spans: tuple[tuple[int, int], ...], state: int) -> bool:
    """Whether an earlier state is in the spans."""
    return any(first < state for first, _ in spans)


class Fields:
    """The whole table, read when first asked. version differs whenever the file does."""

    def __init__(self, path: Path):
        self._path = path

    @cached_property
    def version(self) -> str:
        return hashlib.sha1(self._path.read_bytes()).hexdigest()

    @cached_property
    def _texts(self) -> dict[str, str]:
        return read_table(self._path, dict[str, str])

    def list_packages(self) -> list[str]:
        """Every package of every generation, as `package generation`."""
        return list(self._texts)

    @cache_method
    def find_history(self, package: str, ros: int) -> FieldsHistory | None:
        """A package's versions; None when it was not read."""
        text = self._texts.get(f"{package} {ros}")
        return FieldsHistory(text, lambda name: self.find_history(name, ros)) if text else None


@cache
def load_fields() -> Fields:
    """The shipped table."""
    return Fields(find_table("fields.json.zst"))
