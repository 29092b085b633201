"""What a definition looks like on the wire: ROS 1's md5 and ROS 2's type hash, through rosbags.

Definitions are handed to rosbags as its tables of fields, never through its parser: that one evaluates constants
(`0x01` becomes `1`, which changes the md5) and runs generated Python.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable, Mapping
from functools import cache
from typing import Any

from ..facts.interface import PRIMITIVES, Field, Interface, Section, extract

ROS1_ALIASES = {"Header": "std_msgs/msg/Header"}
ROS1_TIMES = {"time": "builtin_interfaces/msg/Time", "duration": "builtin_interfaces/msg/Duration"}
# https://docs.ros.org/en/rolling/Concepts/Basic/About-Interfaces.html: .msg `char` is an 8 bit number.
ROS2_PRIMITIVES = {"char": "uint8", "byte": "octet"}


class UnknownInterface(LookupError):
    """A definition names a type that is neither given nor known to rosbags, or a type contains itself; `name` is it."""

    def __init__(self, name: str):
        super().__init__(name)
        self.name = name


Definitions = Mapping[str, "Interface | str"]


def ros1_md5(name: str, definitions: Definitions) -> str:
    """The md5 sum that ROS 1 compares on connecting (http://wiki.ros.org/ROS/Technical%20Overview), 32 hex digits.

    name: `package/Name`. definitions: by full name (`package/Name` or `package/msg/Name`), as facts or as the text of a
    .msg file; what is not there is taken from the messages of noetic that rosbags carries. A service gives the sum of
    its two parts as genmsg makes it. An action has none of its own: ask for `package/NameGoal` and so on.
    Raises UnknownInterface, ValueError for an action.
    """
    full = _full_name(name, definitions)
    found = _definition(full, definitions)
    if full.split("/")[1:2] == ["action"]:
        raise ValueError(f"`{name}` is an action, which has no md5 of its own")
    table = _Table(definitions, "ros1_noetic", _ros1_type)
    if found is None or len(found.sections) == 1:
        return table.closed([full]).generate_msgdef(full)[1]
    lines = (_md5_text(section, full, table) for section in found.sections[:2])
    return hashlib.md5("".join(lines).encode(), usedforsecurity=False).hexdigest()


def ros2_hash(name: str, definitions: Definitions) -> str:
    """The type hash of REP 2016 (`RIHS01_` and 64 hex digits) of a message, service or action.

    name: `package/msg/Name`, `package/srv/Name` or `package/action/Name` (a name of two parts is told by its
    definition). definitions as for ros1_md5; what is not there is taken from the newest distro that rosbags carries.
    Raises UnknownInterface. A bound of a wstring does not count, as rosbags does not know it.
    """
    full = _full_name(name, definitions)
    table = _Table(definitions, "latest", _ros2_type)
    return table.closed([full]).hash_rihs01(full)


def _full_name(name: str, definitions: Definitions) -> str:
    """`package/msg/Name`, `package/srv/Name` or `package/action/Name`, whichever a name of two parts stands for."""
    parts = name.split("/")
    if len(parts) != 2:
        return name
    found = definitions.get(name)
    if isinstance(found, str):
        dashes = len(re.findall(r"^---", found, re.MULTILINE))
        folder = ("msg", "srv", "action")[min(dashes, 2)]
    elif found is not None:
        folder = {2: "srv", 3: "action"}.get(len(found.sections), "msg")
    else:
        folder = next((f for f in ("msg", "srv", "action") if f"{parts[0]}/{f}/{parts[1]}" in definitions), "msg")
    return f"{parts[0]}/{folder}/{parts[1]}"


def _definition(full: str, definitions: Definitions) -> Interface | None:
    """What is given for a name of three parts, under that name or its short form."""
    found = definitions.get(full)
    package, folder, short = full.split("/", 2) if full.count("/") >= 2 else ("", "msg", full)
    if found is None:
        brief = f"{package}/{short}"
        if brief not in definitions or _full_name(brief, definitions) != full:
            return None
        found = definitions[brief]
    if isinstance(found, str):
        return extract(found.encode(), folder if folder in ("srv", "action") else "msg")
    return found


def _ros1_type(type_: str, owner: str) -> str:
    if type_ in ROS1_ALIASES:
        return ROS1_ALIASES[type_]
    return ROS1_TIMES.get(type_) or _named(type_, owner)


def _ros2_type(type_: str, owner: str) -> str:
    if type_ in ("time", "duration"):
        return ROS1_TIMES[type_]
    return ROS2_PRIMITIVES.get(type_) or _named(type_, owner)


def _named(type_: str, owner: str) -> str:
    """A type as a full name; primitives stay as they are. owner: full name of the interface that uses it."""
    if type_.partition("<=")[0] in PRIMITIVES:
        return type_
    parts = type_.split("/")
    if len(parts) == 1:
        package = owner.split("/")[0]
        return f"{package}/msg/{type_}" if "_" not in type_ else f"{owner.rpartition('/')[0]}/{type_}"
    return f"{parts[0]}/msg/{parts[1]}" if len(parts) == 2 else type_


class _Table:
    """Definitions on their way into a rosbags type store: only what a name reaches, by a depth-first walk."""

    def __init__(self, definitions: Definitions, store: str, resolve: Callable[[str, str], str]):
        from rosbags.typesys import Stores, get_typestore

        self.definitions = definitions
        self.resolve = resolve
        self.shipped = store
        self.store = get_typestore(Stores.EMPTY)
        self.state: dict[str, bool] = {}

    def closed(self, names: list[str]) -> Any:
        """The store with names and everything they contain."""
        stack = [(name, False) for name in names]
        while stack:
            name, done = stack.pop()
            if done:
                self.state[name] = True
                continue
            if name in self.state:
                if not self.state[name]:
                    raise UnknownInterface(name)
                continue
            self.state[name] = False
            self.store.fielddefs[name] = entry = self.entry(name)
            stack.append((name, True))
            stack.extend((inner, False) for inner in _inner(entry) if not self.state.get(inner, False))
        return self.store

    def entry(self, name: str) -> Any:
        """(constants, fields) of one type as rosbags keeps them."""
        synthetic = _part(name, self.definitions)
        if synthetic is not None:
            section = synthetic
        else:
            found = _definition(name, self.definitions)
            if found is None or not found.sections:
                shipped = _shipped(self.shipped).get(name)
                if shipped is None:
                    raise UnknownInterface(name)
                return shipped
            section = found.sections[0]
        constants = [(c.name, c.type, c.value) for c in section.constants]
        return (constants, [(f.name, self.description(f, name)) for f in section.fields])

    def description(self, field: Field, owner: str) -> Any:
        """A field's type as rosbags describes it."""
        from rosbags.interfaces import Nodetype

        type_ = self.resolve(field.type, owner)
        plain, _, bound = type_.partition("<=")
        inner = (Nodetype.BASE, (plain, int(bound or 0))) if "/" not in plain else (Nodetype.NAME, plain)
        if not field.array:
            return inner
        size = field.array.strip("[]")
        if size.isdecimal():
            return (Nodetype.ARRAY, (inner, int(size)))
        return (Nodetype.SEQUENCE, (inner, int(size.removeprefix("<=") or 0) if size.strip("<=").isdecimal() else 0))


def _inner(entry: Any) -> list[str]:
    """Full names of the types that a definition contains directly."""
    from rosbags.interfaces import Nodetype

    found: list[str] = []
    for _, (node, detail) in entry[1]:
        if node in (Nodetype.ARRAY, Nodetype.SEQUENCE):
            node, detail = detail[0]
        if node == Nodetype.NAME:
            found.append(detail)
    return found


@cache
def _shipped(store: str) -> Mapping[str, Any]:
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores(store)).fielddefs


def _md5_text(section: Section, owner: str, table: _Table) -> str:
    """The text that genmsg sums up for one part of a service."""
    lines = [f"{c.type} {c.name}={c.value}" for c in section.constants]
    for field in section.fields:
        type_ = _ros1_type(field.type, owner)
        if "/" not in type_ or field.type in ROS1_TIMES:
            lines.append(f"{field.type}{field.array} {field.name}")
        else:
            lines.append(f"{table.closed([type_]).generate_msgdef(type_)[1]} {field.name}")
    return "\n".join(lines)


# What rosidl makes of a service and an action, as https://design.ros2.org/articles/actions.html and REP 2016 have it.
# `{}` is the interface's full name.
SERVICE = {
    "": (("request_message", "{}_Request"), ("response_message", "{}_Response"), ("event_message", "{}_Event")),
    "_Event": (
        ("info", "service_msgs/msg/ServiceEventInfo"),
        ("request", "{}_Request", "[<=1]"),
        ("response", "{}_Response", "[<=1]"),
    ),
}
ACTION = {
    "": (
        ("goal", "{}_Goal"),
        ("result", "{}_Result"),
        ("feedback", "{}_Feedback"),
        ("send_goal_service", "{}_SendGoal"),
        ("get_result_service", "{}_GetResult"),
        ("feedback_message", "{}_FeedbackMessage"),
    ),
    "_SendGoal_Request": (("goal_id", "unique_identifier_msgs/msg/UUID"), ("goal", "{}_Goal")),
    "_SendGoal_Response": (("accepted", "bool"), ("stamp", "builtin_interfaces/msg/Time")),
    "_GetResult_Request": (("goal_id", "unique_identifier_msgs/msg/UUID"),),
    "_GetResult_Response": (("status", "int8"), ("result", "{}_Result")),
    "_FeedbackMessage": (("goal_id", "unique_identifier_msgs/msg/UUID"), ("feedback", "{}_Feedback")),
}
# Carried by every distro since Iron, and not by rosbags.
EVENT_INFO = Section(
    "message",
    (
        Field("event_type", "uint8", "", "", 1),
        Field("stamp", "builtin_interfaces/Time", "", "", 1),
        Field("client_gid", "char", "[16]", "", 1),
        Field("sequence_number", "int64", "", "", 1),
    ),
    (),
)
PARTS = re.compile(
    r"(?P<base>.+?)(?P<part>_(?:SendGoal|GetResult))?"
    r"(?P<end>_(?:Request|Response|Event|Goal|Result|Feedback|FeedbackMessage))?$"
)


def _part(name: str, definitions: Definitions) -> Section | None:
    """The struct that rosidl generates under a name such as `p/srv/Set_Event`, None for a message."""
    if name == "service_msgs/msg/ServiceEventInfo" and _definition(name, definitions) is None:
        return EVENT_INFO
    package, folder, short = name.split("/", 2) if name.count("/") >= 2 else ("", "", name)
    if folder not in ("srv", "action"):
        return None
    base, part, end = name, "", ""
    whole = _definition(name, definitions)
    split = PARTS.match(short)
    if whole is None and split is not None:
        base, part, end = f"{package}/{folder}/{split['base']}", split["part"] or "", split["end"] or ""
        whole = _definition(base, definitions)
    if whole is None:
        raise UnknownInterface(base)
    given = {s.name: s for s in whole.sections}.get(end[1:].lower())
    if given is not None and not part:
        return given
    if folder == "action" and not (part and end in ("", "_Event")):
        fields = ACTION.get(part + end)
    else:
        fields = SERVICE.get(end)
        base += part
    if fields is None:
        raise UnknownInterface(name)
    return Section(
        "message",
        tuple(Field(f[0], f[1].format(base), f[2] if len(f) > 2 else "", "", 1) for f in fields),
        (),
    )
