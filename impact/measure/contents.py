"""What is sent: synthetic messages, or a message of the user's workspace, filled as in a bag or with given lengths."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from pathlib import Path

import msgspec

from ...edges.console import UserError
from ..facts import interface, manifest
from ..facts.interface import Interface
from ..targets.surface.store import load_shipped
from ..tree.paths import Tree, TreeError
from .bench import Messages, PreparedMessage
from .messages import WireSchema, decode, encode, fill, list_lengths, make_schema, make_synthetic, prune_schema
from .plan import FULL, PRUNED, Conditions, NetworkPlan

_FROM_BAG = 200
_BYTES_FROM_BAG = 64 << 20
_MOST = 100_000_000


def make_synthetic_messages(plan: NetworkPlan) -> Messages:
    """The messages of strings that a plan asks for."""
    size, keep = plan.conditions.field_bytes, plan.conditions.keep
    made: dict[tuple[int, str], PreparedMessage] = {}
    for number in plan.fields:
        for variant, fields in ((FULL, number), (PRUNED, keep)):
            if fields:
                schema = make_synthetic(fields)
                made[number, variant] = PreparedMessage(schema, [encode(schema, fill(schema, size))])
    return made


def make_real_messages(
    type_: str, keep: Sequence[str], tree: Tree, lengths: Mapping[str, int], bag: Path | None
) -> tuple[Messages, list[str]]:
    """The message `package/Type`, whole and with some fields alone, and notes on how it is filled. tree: the workspace.
    lengths: of arrays and texts by path. bag: whose messages are sent instead. Raises UserError."""
    if type_.replace("/msg/", "/").count("/") != 1:
        raise UserError(f"--message {type_}: write package/Type")
    type_ = type_.replace("/msg/", "/")
    definitions = _Definitions(tree)
    schema = make_schema(type_, definitions.find)
    notes: list[str] = []
    if bag is not None:
        values, topics = _read_bag(bag, type_, schema)
        notes.append(f"{len(values)} messages of {', '.join(topics)} are sent in turn")
    else:
        known = list(dict.fromkeys(list_lengths(schema)))
        if wrong := [path for path in lengths if path not in known]:
            can = f"can be given for {', '.join(known)}" if known else "are of no use: nothing in it varies in length"
            raise UserError(f"--length {wrong[0]}: `{type_}` has no such array or text; lengths {can}")
        _check_size(schema, lengths)
        if empty := [path for path in known if path not in lengths]:
            notes.append(f"empty, since no --length is given: {', '.join(empty)}")
        values = [encode(schema, fill(schema, lengths))]
    made = {(0, FULL): PreparedMessage(schema, values)}
    if keep:
        pruned = prune_schema(schema, keep)
        made[0, PRUNED] = PreparedMessage(pruned, [encode(pruned, decode(schema, value)) for value in values])
    return made, notes


def _check_size(schema: WireSchema, lengths: Mapping[str, int]) -> None:
    """Raises UserError before a message is made that no machine can hold: lengths of nested arrays multiply."""

    def estimate(name: str, above: str) -> int:
        total = 0
        for field in schema.messages[name]:
            path = f"{above}{field.name}"
            count = 1 if field.size < 0 else field.size or lengths.get(path, 0)
            inner = estimate(field.type, f"{path}.") if field.type in schema.messages else 8
            total += count * (lengths.get(path, 0) if field.type == "string" else inner)
        return total

    if (size := estimate(schema.name, "")) > _MOST:
        raise UserError(f"--length: makes a message of about {size:,} bytes; give smaller lengths")


def compute_digest(messages: Messages) -> str:
    """SHA-256 of definitions and contents."""
    digest = hashlib.sha256()
    for message in messages.values():
        digest.update(msgspec.json.encode(message.schema))
        for one in message.contents:
            digest.update(hashlib.sha256(one).digest())
    return digest.hexdigest()


def add_contents(conditions: Conditions, type_: str, keep: Sequence[str], messages: Messages) -> Conditions:
    """The conditions of measuring a real message."""
    return msgspec.structs.replace(
        conditions, message=type_.replace("/msg/", "/"), keep=0, field_bytes=0, kept=tuple(keep),
        contents=compute_digest(messages),
    )  # fmt: skip


class _Definitions:
    """Definitions of messages: the workspace's, else those of the newest release that is stored, of ROS 1 where the
    workspace's packages are built by catkin."""

    def __init__(self, tree: Tree):
        self._tree = tree
        try:
            paths = [entry.path for entry in tree.list_entries()]
        except TreeError as error:
            raise UserError(str(error)) from None
        self._manifests = {path.rpartition("/")[0] for path in paths if path.rpartition("/")[2] == "package.xml"}
        self._files = [path for path in paths if path.endswith(".msg")]
        self._names = {folder: self._read_name(folder) for folder in self._manifests}
        self.ros = 1 if any(tool == "catkin" for _, tool in self._names.values()) else 2

    def _read_name(self, folder: str) -> tuple[str, str]:
        try:
            found = manifest.extract(self._tree.read(f"{folder}/package.xml" if folder else "package.xml"))
        except OSError:
            return "", ""
        catkin = any(each.name == "catkin" for each in found.dependencies)
        return found.name, "catkin" if catkin else ""

    def find(self, type_: str) -> Interface | None:
        """A definition by `package/Name`."""
        package, _, name = type_.partition("/")
        for path in self._files:
            if path.rpartition("/")[2] == f"{name}.msg" and self._find_package(path) == package:
                return interface.extract(self._tree.read(path), "msg")
        generations = (self.ros, 3 - self.ros)
        return next((found for ros in generations if (found := _find_released(package, name, ros))), None)

    def _find_package(self, path: str) -> str:
        folder = path.rpartition("/")[0]
        while folder and folder not in self._manifests:
            folder = folder.rpartition("/")[0]
        return self._names.get(folder, ("", ""))[0]


@cache
def _find_released(package: str, name: str, ros: int) -> Interface | None:
    history = load_shipped().find_history(package, ros)
    if history is None or not history.versions:
        return None
    return history.load_interfaces(history.versions[-1]).get(f"msg/{name}")


def _read_bag(bag: Path, type_: str, schema: WireSchema) -> tuple[list[bytes], list[str]]:
    """The first messages of a type in a bag, as ROS 1 has them on the wire, and their topics. Raises UserError."""
    try:
        from rosbags.highlevel import AnyReader  # pyright: ignore[reportMissingImports]
    except ImportError:
        raise UserError(f"--bag {bag}: needs rosbags; install it with `pip install 'rosimpact[measure]'`") from None
    if not bag.exists():
        raise UserError(f"--bag {bag}: no such file or folder; give a .bag, a .mcap, or the folder of a ROS 2 bag")
    package, _, name = type_.partition("/")
    found: list[bytes] = []
    topics: dict[str, None] = {}
    try:
        with AnyReader([bag]) as reader:
            chosen = [each for each in reader.connections if each.msgtype in (type_, f"{package}/msg/{name}")]
            for connection, _, data in reader.messages(connections=chosen) if chosen else ():
                topics[connection.topic] = None
                if reader.is2:
                    data = encode(schema, reader.deserialize(data, connection.msgtype))
                found.append(bytes(data))
                if len(found) >= _FROM_BAG or sum(map(len, found)) > _BYTES_FROM_BAG:
                    break
    except Exception as error:  # whatever a damaged bag makes rosbags raise
        raise UserError(f"--bag {bag}: cannot be read: {' '.join(str(error).split())[:200]}") from None
    if not found:
        raise UserError(f"--bag {bag}: holds no message of the type {type_}; give another bag, or --length")
    _check_contents(found, bag, type_, schema)
    return found, list(topics)


def _check_contents(found: Iterable[bytes], bag: Path, type_: str, schema: WireSchema) -> None:
    for number, data in enumerate(found, 1):
        try:
            decode(schema, data)
        except (ValueError, OverflowError, MemoryError):
            raise UserError(
                f"--bag {bag}: message {number} of {type_} does not have the fields that the workspace defines; give a "
                "bag that was recorded with this definition"
            ) from None
