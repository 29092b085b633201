"""Types as sources write them: what stands behind pointers, qualifiers and template arguments, and message types."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import NamedTuple

from ...facts.cpp.names import find_closing_angle, split_at_commas
from ...facts.flow import FlowClass
from .modules import CodeFile

_QUALIFIERS = re.compile(
    r"\b(?:const|constexpr|static|mutable|volatile|inline|extern|typename|struct|class|explicit|virtual|thread_local)\b"
)
_POINTERS = frozenset(
    ("shared_ptr", "unique_ptr", "weak_ptr", "scoped_ptr", "optional", "intrusive_ptr", "reference_wrapper", "Optional",
     "atomic", "RealtimeBox", "lock_guard")
)  # fmt: skip
_CONTAINERS = frozenset(
    ("vector", "list", "deque", "array", "set", "unordered_set", "map", "unordered_map", "pair", "List", "Dict")
)
_INNER = frozenset(
    ("SharedPtr", "ConstSharedPtr", "UniquePtr", "ConstUniquePtr", "WeakPtr", "ConstWeakPtr", "Ptr", "ConstPtr",
     "SharedConstPtr", "ConstRef")
)  # fmt: skip
_MESSAGE_ENDINGS = ("ConstSharedPtr", "ConstPtr", "SharedPtr", "Ptr")
_SPACE = re.compile(r"\s+")


@lru_cache(maxsize=100_000)
def split_name(name: str) -> tuple[str, ...]:
    """The parts of a path or qualified name of either language."""
    return tuple(part for part in name.replace("::", ".").split(".") if part)


class Cls:
    """A class with the file it stands in. name: as its facts have it; parts: of the name. is_local: no other file can
    name it by its name alone. key: tells it from all others; bodies of one class share it."""

    __slots__ = ("facts", "is_local", "key", "name", "parts", "source")

    def __init__(self, source: CodeFile, facts: FlowClass, is_local: bool):
        self.source, self.facts, self.name, self.is_local = source, facts, facts.name, is_local
        self.parts = split_name(facts.name)
        self.key = f"{source.path if is_local else source.package}::{facts.name}"


class FlowType(NamedTuple):
    """name: qualified as written, without template arguments. arguments: template arguments as written. cls: what the
    name means where it is written, None for no class of the code."""

    name: str
    arguments: tuple[str, ...] = ()
    cls: Cls | None = None


UNKNOWN = FlowType("")


@lru_cache(maxsize=20_000)
def parse_flow_type(text: str) -> FlowType:
    """What a type is of once qualifiers, references, smart pointers, `::SharedPtr` and containers are taken off.

    text: in C++ or Python. Gives UNKNOWN for `auto` and what is no type.
    """
    text = _QUALIFIERS.sub(" ", text).replace("&", " ").replace("*", " ").strip()
    text = _SPACE.sub(" ", text).removeprefix("::")
    if not text or text in ("auto", "void", "decltype(auto)"):
        return UNKNOWN
    head, arguments, rest = _split_template(text)
    parts = rest.split("::") if rest else []
    if parts and parts[-1].strip() in _INNER:
        rest = "::".join(parts[:-1])
    name = head + rest if not rest or rest.startswith("::") else head
    if not arguments and name.rpartition("::")[2] in _INNER:
        name = name.rpartition("::")[0]
    bare = name.rpartition("::")[2].rpartition(".")[2]
    if arguments and not rest.strip(":"):
        if bare in _POINTERS:
            return parse_flow_type(arguments[0])
        if bare in _CONTAINERS:
            return parse_flow_type(arguments[-1] if bare in ("map", "unordered_map", "pair", "Dict") else arguments[0])
    return FlowType(name.replace(" ", ""), arguments)


def is_pointer(text: str) -> bool:
    """Whether a type in C++ is a smart pointer: `boost::shared_ptr<T>`, `T::Ptr`."""
    head, arguments, rest = _split_template(text.strip())
    last = (rest or head).rpartition("::")[2].strip()
    return last in (_INNER if rest or not arguments else _POINTERS)


def _split_template(text: str) -> tuple[str, tuple[str, ...], str]:
    """`a::b<c, d>::e` as `a::b`, (`c`, `d`), `::e`."""
    start = text.find("<")
    if start < 0:
        bracket = text.find("[")
        if bracket > 0 and text.endswith("]"):
            return text[:bracket].strip(), tuple(split_at_commas(text[bracket + 1 : -1])), ""
        return text, (), ""
    at = find_closing_angle(text, start)
    at = len(text) if at < 0 else at
    return text[:start].strip(), tuple(split_at_commas(text[start + 1 : at])), text[at + 1 :].strip()


_HEADER = re.compile(r"(\w+)/(?:(?:msg|srv|action)/)?(\w+)\.h(?:pp)?\Z")


def find_header_interface(header: str) -> str:
    """`package/Name` of the interface that a generated header is of: `sensor_msgs/Image.h`,
    `sensor_msgs/msg/camera_info.hpp`; empty for a path of another shape."""
    found = _HEADER.match(header)
    if found is None:
        return ""
    name = found[2]
    if name.islower():
        name = "".join(part.capitalize() for part in name.split("_"))
    return f"{found[1]}/{name}"


_SUFFIXES = re.compile(r"(?:_?<.*>|_)\Z")
_KINDS = {"msg": "", "srv": "", "action": ""}


def find_interface(name: str, lower: bool = False) -> str:
    """`package/Name` of a message, service or action type, by its qualified name in C++ or Python; empty when the name
    does not tell a package. In Python the kind belongs to it: `std_msgs.String` is none. lower: names that begin with a
    small letter, and packages that begin with a large one, are taken too, which other things have as well.

    `std_msgs::msg::String`, `std_msgs::String_<A>`, `std_msgs.msg.String` all give `std_msgs/String`; pointers,
    `::Request`, `::Goal` and `sensor_msgs::ImageConstPtr` are taken off, and modules that Python generates
    (`std_msgs.msg._string.String`).
    """
    kind = parse_flow_type(name)
    parts = [part for part in _SUFFIXES.sub("", kind.name).replace("::", ".").split(".") if part]
    if len(parts) > 3 and parts[-2] == "Impl":
        # What an action sends by itself: https://design.ros2.org/articles/actions.html, "Topics".
        if parts[-1] == "GoalStatusMessage":
            return "action_msgs/GoalStatusArray"
        if parts[-1] == "FeedbackMessage":
            action = find_interface("::".join(parts[:-2]))
            return action and f"{action}_FeedbackMessage"
    if parts and parts[-1] in ("Request", "Response", "Goal", "Result", "Feedback", "Impl", *_INNER) and len(parts) > 2:
        parts = parts[:-1]
    if parts and parts[-1] not in _MESSAGE_ENDINGS:
        for ending in _MESSAGE_ENDINGS:
            if parts[-1].endswith(ending):
                parts[-1] = parts[-1].removesuffix(ending)
                break
    if len(parts) >= 4 and parts[-2][:1] == "_" and parts[-3] in _KINDS:
        del parts[-2]
    if len(parts) >= 3 and parts[-2] in _KINDS:
        return f"{parts[-3]}/{parts[-1]}"
    usual = parts[0][:1].islower() and parts[-1][:1].isupper() if parts else False
    if len(parts) == 2 and "::" in kind.name and (lower or usual):
        return f"{parts[0]}/{parts[1]}"
    return ""
