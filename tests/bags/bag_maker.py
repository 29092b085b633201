"""Bags of all three forms, written by rosbags, of messages that tests define."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

import numpy
from rosbags import rosbag1, rosbag2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

FORMS = ("rosbag", "sqlite3", "mcap")
SECOND = 10**9
DEFINITIONS = {
    "std_msgs/Header": "builtin_interfaces/Time stamp\nstring frame_id\n",
    "builtin_interfaces/Time": "int32 sec\nuint32 nanosec\n",
    "quay_msgs/Berth": "uint8 kind\nfloat64 depth\nfloat64 tide\n",
    "quay_msgs/Quay": (
        "std_msgs/Header header\nbool open\nfloat64[3] spare\nquay_msgs/Berth[] berths\nuint8[] picture\n"
        "string[] names\nfloat32[] levels\nstring note\n"
    ),
}


def make_store(definitions=DEFINITIONS):
    store = get_typestore(Stores.EMPTY)
    for name, text in definitions.items():
        store.register(get_types_from_msg(text, name.replace("/", "/msg/")))
    return store


def make_message(store, name: str, /, **values: Any):
    """A message whose fields are 0 or empty but for those given; of a nested message, or array of them, mappings."""
    type_ = name if "/msg/" in name else name.replace("/", "/msg/")
    fields = {}
    for field, (kind, what) in store.fielddefs[type_][1]:
        value = values.pop(field, None)
        kind = kind.name
        if kind == "BASE":
            fields[field] = value if value is not None else "" if what[0] == "string" else 0
        elif kind == "NAME":
            fields[field] = make_message(store, what, **(value or {}))
        else:
            (inner, of), length = what
            items = list(value if value is not None else [None] * (length if kind == "ARRAY" else 0))
            if inner.name == "NAME":
                fields[field] = [make_message(store, of, **(item or {})) for item in items]
            elif of[0] == "string":
                fields[field] = [item or "" for item in items]
            else:
                fields[field] = numpy.array([item or 0 for item in items], {"bool": "bool_"}.get(of[0], of[0]))
    assert not values
    return store.types[type_](**fields)


def write_bag(
    folder: Path, form: str, messages: Iterable[tuple[str, str, float, Any]], definitions=DEFINITIONS,
    store=None, compression: tuple[Any, ...] = (), **connection: Any,
) -> Path:  # fmt: skip
    """A bag of (topic, type, seconds, message or bytes), and its path."""
    store = store or make_store(definitions)
    if form == "rosbag":
        path = folder / "quay.bag"
        writer: Any = rosbag1.Writer(path)
    else:
        path = folder / f"quay_{form}"
        plugin = rosbag2.StoragePlugin.SQLITE3 if form == "sqlite3" else rosbag2.StoragePlugin.MCAP
        writer = rosbag2.Writer(path, version=9, storage_plugin=plugin)
    if compression:
        writer.set_compression(*compression)
    serialize = store.serialize_ros1 if form == "rosbag" else store.serialize_cdr
    with writer:
        connections = {}
        for topic, name, seconds, message in messages:
            type_ = name.replace("/", "/msg/")
            if (topic, name) not in connections:
                connections[topic, name] = writer.add_connection(topic, type_, typestore=store, **connection)
            if message is not None:
                data = message if isinstance(message, bytes) else bytes(serialize(message, type_))
                writer.write(connections[topic, name], round(seconds * SECOND), data)
    return path


def make_quays(store, number: int) -> Iterator[tuple[str, str, float, Any]]:
    """Messages of /quay, ten a second, with one of /empty and a topic without any."""
    for at in range(number):
        berths = [{"kind": 0, "depth": -0.0, "tide": 0.5 * step} for step in range(at % 3)]
        yield "/quay", "quay_msgs/Quay", 1 + at / 10, make_message(
            store, "quay_msgs/Quay", header={"stamp": {"sec": at}, "frame_id": "map"}, berths=berths,
            picture=[0] * 100, names=["a", "bcd"][: at % 2 + 1], levels=[0.0, 1.5],
        )  # fmt: skip
    yield "/berth", "quay_msgs/Berth", 1.0, make_message(store, "quay_msgs/Berth", kind=3)
    yield "/never", "quay_msgs/Berth", 1.0, None
