"""Whether nodes on two machines understand each other: topics, services and actions of a workspace whose type is
another one there.

ROS 1 refuses a connection whose md5 sums differ; in ROS 2 a type is known by its name, and what is read of other bytes
is wrong (from Iron on the hash of the type is told to the other side, REP 2011). Both sums are of names, types and
order of all fields, nested ones too; that of ROS 1 is of constants as well.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from ....edges.groups import group_pairs
from ...facts.interface import PRIMITIVES, TIMES, Interface, Section
from ...targets.distro.distro import DistroTarget
from ...targets.surface.store import load_shipped
from ...targets.version import find_newest_up_to, parse
from ..workspace import Workspace
from .graph import Graph
from .select import get_kind

_KINDS = {"topic": "msg", "service": "srv", "action": "action"}
_PLACES = 3
# What a node talks through where RMW_IMPLEMENTATION does not say: rmw_fastrtps_cpp but for this distro (REP 2000).
_OTHER_MIDDLEWARE = {"galactic": "rmw_cyclonedds_cpp"}
_MIDDLEWARE = "rmw_fastrtps_cpp"


class WireDifference(NamedTuple):
    """A topic, service or action that two machines have in different types. name: its full name; type: `package/Name`;
    why: what differs, in a clause; places: path and line of endpoints of it. kind `middleware`: of all of them; the
    other fields are empty then."""

    kind: str
    name: str
    type: str
    why: str
    places: tuple[tuple[str, int], ...] = ()


def list_wire_differences(
    graph: Graph, workspace: Workspace, first: DistroTarget, second: DistroTarget
) -> list[WireDifference]:
    """What nodes of a workspace's graph cannot talk about between two targets of one ROS generation, by name. Types of
    which a target's version is not stored are taken to be the same."""
    compared = _Types(workspace, first, second)
    found: list[WireDifference] = []
    mine, other = (_OTHER_MIDDLEWARE.get(target.distro, _MIDDLEWARE) for target in (first, second))
    if graph.ros == 2 and mine != other:
        why = f"by default `{mine}` on {first.name} and `{other}` on {second.name}: set RMW_IMPLEMENTATION"
        found.append(WireDifference("middleware", "", "", why))
    typed = (one for one in graph.endpoints if one.topic and one.type)
    named = group_pairs(((get_kind(one), one.topic, one.type), one) for one in typed)
    for (kind, name, type_), endpoints in sorted(named.items()):
        why = compared.compare(f"{_KINDS[kind]}/{type_}")
        if why:
            places = dict.fromkeys((one.path, one.line) for one in endpoints)
            found.append(WireDifference(kind, name, type_, why, tuple(places)[:_PLACES]))
    return found


class _Types:
    """Interfaces on both targets."""

    def __init__(self, workspace: Workspace, first: DistroTarget, second: DistroTarget):
        self._workspace, self._targets = workspace, (first, second)
        self._known: dict[str, str] = {}

    def compare(self, interface: str) -> str:
        """What differs of an interface, given as `kind/package/Name`; empty for nothing that is known."""
        if interface not in self._known:
            self._known[interface] = ""  # while it is looked at: a type may hold itself
            self._known[interface] = next(self._list_differences(interface), "")
        return self._known[interface]

    def _list_differences(self, interface: str) -> Iterator[str]:
        kind, package, name = interface.split("/")
        there = [self._find(target, kind, package, name) for target in self._targets]
        if None in there:
            return
        for found, target in zip(there, self._targets, strict=True):
            if not isinstance(found, Interface):
                yield f"{target.name} has no `{package}/{name}` ({found})"
                return
        one, other = (each for each in there if isinstance(each, Interface))
        ros1 = self._targets[0].ros == 1
        for mine, theirs in zip(one.sections, other.sections, strict=False):
            yield from self._compare_sections(mine, theirs, ros1)
        for field in (field for section in one.sections for field in section.fields):
            head, _, last = field.type.partition("<=")[0].rpartition("/")
            nested = head.partition("/")[0] or package
            if last not in PRIMITIVES and last not in TIMES:
                inner = self.compare(f"msg/{'std_msgs' if last == 'Header' and not head else nested}/{last}")
                if inner:
                    yield f"in `{field.name}`: {inner}"

    def _find(self, target: DistroTarget, kind: str, package: str, name: str) -> Interface | str | None:
        """An interface as a target has it, what it has instead, or None where that is not known."""
        own = self._workspace.packages.get(package)
        if own is not None:
            return next((file.definition for file in own.linked.interfaces if file.name == name), None)
        version = target.find_version(package)
        if version is None:
            return f"{package} is not released there" if target.was_ever_released(package) else None
        history = load_shipped().find_history(package, target.ros)
        stored = find_newest_up_to(version, history.versions) if history is not None else None
        # Interfaces stay the same from patch to patch.
        if history is None or stored is None or parse(stored)[:2] != parse(version)[:2]:
            return None
        interfaces = history.load_interfaces(stored)
        return interfaces.get(f"{kind}/{name}") or (f"{package} {version}" if interfaces else None)

    def _compare_sections(self, one: Section, other: Section, ros1: bool) -> Iterator[str]:
        first, second = (target.name for target in self._targets)
        mine = {field.name: f"{_get_bare(field.type)}{field.array}" for field in one.fields}
        theirs = {field.name: f"{_get_bare(field.type)}{field.array}" for field in other.fields}
        for name, type_ in mine.items():
            if name not in theirs:
                yield f"only {first} has the field `{name}`"
            elif theirs[name] != type_:
                yield f"the field `{name}` is `{type_}` on {first} and `{theirs[name]}` on {second}"
        yield from (f"only {second} has the field `{name}`" for name in theirs if name not in mine)
        if list(mine) != list(theirs):
            yield "the fields stand in another order"
        constants = [{(each.name, each.type, each.value) for each in section.constants} for section in (one, other)]
        if ros1 and constants[0] != constants[1]:
            yield "the constants differ"


def _get_bare(type_: str) -> str:
    """A field's type without `msg/`, which some write."""
    return type_.replace("/msg/", "/")
