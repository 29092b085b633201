"""Names of ROS's graph: what a topic, service, parameter or node is called once namespaces and remapping are applied.

Sources: http://wiki.ros.org/Names and rosgraph.names for ROS 1; https://design.ros2.org/articles/topic_and_service_names
and rcl's expand_topic_name.c and remap.c for ROS 2.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from functools import lru_cache
from typing import NamedTuple


class NameRefused(ValueError):
    """A name that ROS would not take; the message says why."""


def normalise(name: str) -> str:
    """The name without doubled and trailing slashes: `//a//b/` gives `/a/b`. `/` and the empty name stay."""
    if not name or name == "/":
        return name
    return ("/" if name[0] == "/" else "") + "/".join(part for part in name.split("/") if part)


def join_name(namespace: str, name: str) -> str:
    """A name put into a namespace, unless it is global (`/a`) or private (`~a`) and so knows its own."""
    if name[:1] in ("/", "~") or not namespace:
        return normalise(name)
    if not name:
        return normalise(namespace)
    return normalise(f"{namespace}/{name}")


def get_namespace(name: str) -> str:
    """The namespace a full name stands in: `/a/b` gives `/a`, `/a` gives `/`."""
    return normalise(name).rpartition("/")[0] or "/"


def resolve_ros1_name(name: str, node: str) -> str:
    """The full name that a ROS 1 node uses for a name before remapping. node: its own full name (`/robot/amcl`).

    Global names stay, relative ones go into the node's namespace, private ones (`~x`) below the node; the empty name is
    the namespace itself.
    """
    if not name:
        return get_namespace(node)
    if name[0] == "~":
        return normalise(f"{node}/{name[1:]}")
    return join_name(get_namespace(node), name)


def remap_ros1_name(name: str, node: str, remaps: Iterable[tuple[str, str]]) -> str:
    """The full name after a ROS 1 node's remappings: pairs of from and to as written, both resolved as the node's own
    names are. Of several for one name the last holds; what a remapping gives is not remapped again."""
    table = {resolve_ros1_name(old, node): resolve_ros1_name(new, node) for old, new in remaps}
    plain = resolve_ros1_name(name, node)
    return table.get(plain, plain)


class RemappingRule(NamedTuple):
    """A remapping rule of ROS 2: `node:kind://match:=replacement`, node and kind empty where the rule has none."""

    match: str
    replacement: str
    node: str = ""
    kind: str = ""


_RULE = re.compile(
    r"(?:(?P<node>[A-Za-z_]\w*):(?!//))?(?:(?P<kind>rostopic|rosservice|topic|service)://)?(?P<match>[^:=\s]+)"
    r":=(?P<replacement>\S+)\Z"
)
_KINDS = {"rostopic": "topic", "rosservice": "service"}


def parse_ros2_rule(text: str) -> RemappingRule | None:
    """The remapping rule that `text` writes (`scan:=/lidar/scan`, `talker:__ns:=/a`), None when it writes none."""
    m = _RULE.match(text.strip())
    if m is None:
        return None
    kind = m["kind"] or ""
    return RemappingRule(m["match"], m["replacement"], m["node"] or "", _KINDS.get(kind, kind))


_SUBSTITUTION = re.compile(r"\{(\w*)\}")
_LEGAL = re.compile(r"/?[A-Za-z_]\w*(?:/[A-Za-z_]\w*)*\Z")
_OPEN = re.compile(r"<[^<>/]*>")
_FILLED = re.compile(r"\$\((?:arg|var|env|optenv) (\w+)[^()]*\)")


def make_open_part(shown: str) -> str:
    """What stands in a name for what is not known: `<robot_name>`, without slashes, in one pair of brackets. shown: a
    text of which unknown parts stand in brackets, which may hold others."""
    found, depth = "", 0
    for character in _FILLED.sub(r"\1", shown):
        opens, closes = character == "<", character == ">" and depth
        if (depth == 0 and opens) or (depth == 1 and closes):
            found += character
        elif not opens and not closes:
            found += "_" if depth and character in "/ " else character
        depth += opens - bool(closes)
    return found + ">" * bool(depth)


OR = " or "
"""What stands between the patterns of several names."""
_SEGMENT = re.compile(r"\w+")


def has_known_segment(pattern: str) -> bool:
    """Whether of each name that a pattern is of a whole segment is known: of `/robot_*/scan`, not of `/robot_*`."""
    return all(any(map(_SEGMENT.fullmatch, one.split("/"))) for one in pattern.split(OR))


def is_open(name: str) -> bool:
    """Whether a part of a name is not known."""
    return _OPEN.search(name) is not None


@lru_cache(maxsize=10_000)
def resolve_ros2_name(name: str, node: str, namespace: str) -> str:
    """The full name that a ROS 2 node uses for a topic or service before remapping. node: its name without namespace.

    `~` is the node, `~/x` below it, `{node}`, `{ns}` and `{namespace}` are filled in, relative names go into the
    namespace. Parts that are not known stand in brackets. Raises NameRefused for a name that rcl refuses.
    """
    values = {"node": node, "ns": namespace.rstrip("/"), "namespace": namespace.rstrip("/")}

    def substitute_value(m: re.Match[str]) -> str:
        if m[1] not in values:
            raise NameRefused(f"`{name}` asks for the unknown `{{{m[1]}}}`")
        return values[m[1]]

    if not name:
        raise NameRefused("the name is empty")
    own = f"{namespace.rstrip('/')}/{node}"
    if name[0] == "~":
        if name[1:2] not in ("", "/"):
            raise NameRefused(f"`{name}` has no `/` after its `~`")
        full = own + name[1:]
    else:
        full = name
    full = _SUBSTITUTION.sub(substitute_value, full)
    if full[:1] != "/":
        full = f"{namespace.rstrip('/')}/{full}"
    if not _LEGAL.match(_OPEN.sub("x", full)):
        raise NameRefused(f"`{name}` is no name of a topic or service")
    return full


def remap_ros2_name(name: str, node: str, namespace: str, rules: Iterable[RemappingRule], kind: str = "topic") -> str:
    """The full name after remapping: the first rule that matches holds, and none is applied to what it gives.

    node and namespace: as they are once `__node` and `__ns` are applied. kind: `topic` or `service`.
    Raises NameRefused where the name, or the replacement of the rule that matches, is none; rules that match no legal
    name never match.
    """
    full = resolve_ros2_name(name, node, namespace)
    for rule in rules:
        if rule.match.startswith("__") or rule.node not in ("", node) or rule.kind not in ("", kind):
            continue
        try:
            matches = resolve_ros2_name(rule.match, node, namespace) == full
        except NameRefused:
            continue
        if matches:
            return resolve_ros2_name(rule.replacement, node, namespace)
    return full
