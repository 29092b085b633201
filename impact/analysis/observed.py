"""What a file tells of a running system: dumps of `ros2 node info`, `rosnode info` and rosgraph_msgs, and bags."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

from ...edges.console import UserError, escape
from ...edges.documents import DocumentError, load_json, load_yaml_documents
from ...edges.files import open_regular, read_file
from ..model.flow.graph import Role
from ..model.flow.observed import Observation, SeenEndpoint

_LARGEST = 100_000_000
# The headings of `ros2 node info` and `rosnode info`, and the keys of dumps; those of rosgraph_msgs/Node among them.
_ROLES: dict[str, Role] = {
    "publishers": "publisher", "publications": "publisher", "subscribers": "subscriber",
    "subscriptions": "subscriber", "service servers": "server", "services": "server", "servers": "server",
    "service clients": "client", "clients": "client", "action servers": "action server",
    "action clients": "action client",
}  # fmt: skip
_ROS1_NODE = re.compile(r"Node \[(/[^\]\s]*)\]\s*\Z")
_ROS2_NODE = re.compile(r"(/[\w/]+)\s*\Z")
_HEADING = re.compile(r"\s*([A-Z][A-Za-z ]+):\s*(?:None\s*)?\Z")
_ENTRY = re.compile(r"\s+(?:\* )?(/\S*?)(?:: +(\S.*)| \[([^\]]*)\])?\s*\Z")
# Parts of an action, as `rosnode info` lists them of a server; a client has them the other way round.
_SERVED, _ASKED = ("status", "feedback", "result"), ("goal", "cancel")

_NO_DUMP = "nodes are objects with a `name`, and endpoints objects with a `name` and a `type`"

Rows = list[SeenEndpoint]


def read_observation(path: Path) -> Observation:
    """What a file, or the folder of a bag, tells of a running system. Raises UserError with the file's name."""
    name = escape(str(path))
    file = path / "metadata.yaml" if path.is_dir() else path
    try:
        read = _READERS.get(file.suffix.lower())
        if read is not None:
            os.close(open_regular(file))  # refuses what is no file before a library opens it
            rows = _read_safely(read, file)
            return Observation(dict.fromkeys((row.node for row in rows if row.node), frozenset()), tuple(rows))
        found = _parse_text(read_file(file, _LARGEST).decode("utf-8-sig", "replace"), file.name)
    except OSError as error:
        raise UserError(f"--observed {name}: {error.strerror or error}; give another file") from None
    except ImportError as error:
        raise UserError(
            f"--observed {name}: needs the Python package `{(error.name or '').partition('.')[0]}`; "
            "install it with `pip install 'rosimpact[bags]'`"
        ) from None
    except (KeyError, TypeError, AttributeError, RecursionError):
        raise UserError(f"--observed {name}: cannot be read: {_NO_DUMP}") from None
    except ValueError as error:
        raise UserError(f"--observed {name}: cannot be read: {escape(str(error))}") from None
    if not found.roles and not found.endpoints:
        raise UserError(
            f"--observed {name}: names no node; give what `ros2 node info` or `rosnode info` prints, a dump in JSON or "
            "YAML, or a bag"
        )
    return found


def _read_safely(read: Callable[[Path], Rows], file: Path) -> Rows:
    """What a library reads of a file; a ValueError for whatever it raises on a broken one."""
    try:
        return read(file)
    except (OSError, ImportError, MemoryError):
        raise
    except Exception as error:
        raise ValueError(str(error) or type(error).__name__) from None


def _parse_text(text: str, name: str) -> Observation:
    if text.lstrip()[:1] in ("{", "["):
        return _parse_dump(load_json(text))
    lines = text.splitlines()
    if any(_ROS1_NODE.match(line) for line in lines) or any(line.strip() == "Subscribers:" for line in lines):
        return _parse_info(lines)
    if name.endswith((".yaml", ".yml")) or any(line.startswith(("nodes:", "publishers:")) for line in lines):
        return _parse_yaml(text)
    return Observation({}, ())


def _parse_yaml(text: str) -> Observation:
    try:
        parts = [each for each in load_yaml_documents(text) if each]  # `ros2 topic echo` prints several
    except DocumentError as error:
        raise ValueError(f"not readable as YAML: {error}") from None
    bags = [each["rosbag2_bagfile_information"] for each in parts if "rosbag2_bagfile_information" in each]
    if bags:
        topics = (each["topic_metadata"] for bag in bags for each in bag["topics_with_message_count"])
        return Observation({}, tuple(_make_recorded(each["name"], each["type"]) for each in topics))
    return _parse_dump(parts)


def _parse_info(lines: list[str]) -> Observation:
    """What `ros2 node info` and `rosnode info` print of nodes, one after the other."""
    roles: dict[str, set[Role]] = {}
    rows: Rows = []
    node, role, old = "", None, set()
    for line in lines:
        first, second = _ROS1_NODE.match(line), _ROS2_NODE.match(line)
        heading, entry = _HEADING.match(line), _ENTRY.match(line)
        if first or second:
            node, role = (first or second)[1], None  # pyright: ignore[reportOptionalSubscript]
            roles.setdefault(node, set())
            old.update((node,) if first else ())
        elif heading is not None:
            role = _ROLES.get(heading[1].lower())
            if role is not None and node:
                roles[node].add(role)
        elif entry is not None and role is not None and node:
            for type_ in (entry[2] or entry[3] or "").split(", "):
                rows.append(SeenEndpoint(node, role, entry[1], _clean_type(type_)))
        elif line.strip() and not line.startswith(" "):
            role = None  # `contacting node ...`
    for node in old:
        roles[node] |= {"action server", "action client"}
    folded = _fold_actions([row for row in rows if row.node in old])
    return Observation(
        {node: frozenset(found) for node, found in roles.items()},
        (*folded, *(row for row in rows if row.node not in old)),
    )


def _fold_actions(rows: Rows) -> Iterator[SeenEndpoint]:
    """Endpoints of ROS 1, in which the topics of an action are one action."""
    of_node = {(row.node, row.role, row.name): row for row in rows}
    parts: set[tuple[str, Role, str]] = set()
    for row in rows:
        base, _, last = row.name.rpartition("/")
        if last != "status" or row.type.partition("/")[2] not in ("GoalStatusArray", ""):
            continue
        other: Role = "subscriber" if row.role == "publisher" else "publisher"
        served = [of_node.get((row.node, row.role, f"{base}/{part}")) for part in _SERVED]
        asked = [of_node.get((row.node, other, f"{base}/{part}")) for part in _ASKED]
        whole = [one for one in (*served, *asked) if one is not None]
        if len(whole) == len(_SERVED) + len(_ASKED):
            parts.update((one.node, one.role, one.name) for one in whole)
            types = (
                one.type.removesuffix(ending)
                for one, ending in ((whole[1], "ActionFeedback"), (whole[3], "ActionGoal"))
            )
            kind: Role = "action server" if row.role == "publisher" else "action client"
            yield SeenEndpoint(row.node, kind, base, next(filter(None, types), ""))
    yield from (row for row in rows if (row.node, row.role, row.name) not in parts)


def _parse_dump(dump: Any) -> Observation:
    """Nodes in JSON or YAML: a list of them, `{"nodes": [...]}` or rosgraph_msgs/Graph, or several of these."""
    roles: dict[str, set[Role]] = {}
    rows: Rows = []
    for node in _list_nodes(dump):
        name = "/" + node["name"].strip("/")
        roles.setdefault(name, set())
        for key, items in node.items():
            role = _ROLES.get(key.replace("_", " "))
            if role is not None:
                roles[name].add(role)
                rows += (SeenEndpoint(name, role, item["name"], _find_type(item)) for item in items or ())
    return Observation({name: frozenset(found) for name, found in roles.items()}, tuple(rows))


def _list_nodes(dump: Any) -> Iterator[dict[str, Any]]:
    if isinstance(dump, list):
        for each in dump:
            yield from _list_nodes(each)
    elif isinstance(dump, dict) and "nodes" in dump:
        yield from _list_nodes(dump["nodes"])
    elif isinstance(dump, dict) and isinstance(dump.get("name"), str):
        yield dump
    else:
        raise ValueError(_NO_DUMP)


def _find_type(item: Mapping[str, Any]) -> str:
    """The type of an endpoint: its `type`, as text or as rosgraph_msgs/InterfaceType, or that of its requests."""
    found = item.get("type") or item.get("request_type") or (item.get("send_goal") or {}).get("request_type") or ""
    return _clean_type(found["name"] if isinstance(found, Mapping) else found)


def _clean_type(written: str) -> str:
    """`package/Name` of a type; empty for one that is not known."""
    package, _, rest = written.strip().partition("/")
    return f"{package}/{rest.rpartition('/')[2].removesuffix('_SendGoal')}" if rest else ""


def _make_recorded(topic: str, type_: str, node: str = "") -> SeenEndpoint:
    return SeenEndpoint(node, "publisher", topic, _clean_type(type_))


def _read_bag(file: Path) -> Rows:
    from rosbags.rosbag1 import Reader  # pyright: ignore[reportMissingImports]

    with Reader(file) as bag:
        rows = ((one.topic, one.msgtype, getattr(one.ext, "callerid", None) or "") for one in bag.connections)
        return [_make_recorded(*row) for row in rows]


def _read_mcap(file: Path) -> Rows:
    from mcap.reader import make_reader  # pyright: ignore[reportMissingImports]

    with file.open("rb") as stream:
        summary = make_reader(stream).get_summary()
    if summary is None:
        raise ValueError("it has no summary; `mcap recover` writes one")
    types = {number: schema.name for number, schema in summary.schemas.items()}
    return [_make_recorded(one.topic, types.get(one.schema_id, "")) for one in summary.channels.values()]


def _read_sqlite(file: Path) -> Rows:
    import sqlite3
    from contextlib import closing

    with closing(sqlite3.connect(f"{file.absolute().as_uri()}?mode=ro&immutable=1", uri=True)) as bag:
        return [_make_recorded(name, kind) for name, kind in bag.execute("SELECT name, type FROM topics")]


_READERS: dict[str, Callable[[Path], Rows]] = {".bag": _read_bag, ".mcap": _read_mcap, ".db3": _read_sqlite}
