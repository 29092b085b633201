"""What is sent: synthetic messages, or a message of the user's workspace, filled as in a bag or with given lengths."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from pathlib import Path

import msgspec

from ...edges.console import UserError
from ..analysis.message_files import MessageFolders
from ..facts import interface
from ..facts.interface import Interface
from ..prune.light import lighten
from ..targets.surface.store import load_shipped
from .bench import Messages, PreparedMessage
from .messages import SentSchema, decode, encode, fill, list_lengths, make_schema, make_synthetic
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
    type_: str, keep: Sequence[str], path: Path, lengths: Mapping[str, int], bag: Path | None, ros: int
) -> tuple[Messages, list[str]]:  # fmt: skip
    """The message `package/Type`, whole and with some fields alone, and notes on how it is filled. path: the workspace.
    lengths: of arrays and texts by path. bag: whose messages are sent instead. ros: the generation of the nodes. Raises
    UserError."""
    if type_.replace("/msg/", "/").count("/") != 1:
        raise UserError(f"--message {type_}: write package/Type")
    type_ = type_.replace("/msg/", "/")
    definitions = _Definitions(path, ros)
    schema = make_schema(type_, definitions.find)
    notes: list[str] = []
    if bag is not None:
        values, topics = _read_bag(bag, type_, schema)
        notes.append(f"{len(values)} messages of {', '.join(topics)} are sent in turn")
    else:
        known = list(dict.fromkeys(list_lengths(schema)))
        if wrong := [each for each in lengths if each not in known]:
            can = f"can be given for {', '.join(known)}" if known else "are of no use: nothing in it varies in length"
            raise UserError(f"--length {wrong[0]}: `{type_}` has no such array or text; lengths {can}")
        _check_size(schema, lengths)
        if empty := [each for each in known if each not in lengths]:
            notes.append(f"empty, since no --length is given: {', '.join(empty)}")
        values = [encode(schema, fill(schema, lengths))]
    made = {(0, FULL): PreparedMessage(schema, values)}
    if keep:
        pruned = make_schema(definitions.prune(type_, keep), definitions.find)
        made[0, PRUNED] = PreparedMessage(pruned, [encode(pruned, decode(schema, value)) for value in values])
    return made, notes


def _check_size(schema: SentSchema, lengths: Mapping[str, int]) -> None:
    """Raises UserError before a message is made that no machine can hold: lengths of nested arrays multiply."""

    def estimate(name: str, above: str) -> int:
        total = 0
        for field in schema.messages[name]:
            path = f"{above}{field.name}"
            each = path if field.size < 0 else f"{path}[]"
            count = 1 if field.size < 0 else field.size or lengths.get(path, 0)
            inner = estimate(field.type, f"{each}.") if field.type in schema.messages else 8
            total += count * (4 + lengths.get(each, 0) if field.type == "string" else inner)
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
    """Definitions of messages: of a workspace or the sourced environment, else of the newest release that is stored.
    ros: the generation of ROS whose releases come first."""

    def __init__(self, path: Path, ros: int):
        self._folders, self._ros = MessageFolders((path,), os.environ), ros
        self.added: dict[str, bytes] = {}

    def read(self, type_: str) -> bytes | None:
        """The text of a definition by `package/Name`; None where it is not known. Raises UserError."""
        text = self.added.get(type_) or self._folders.find(type_)
        if text is not None:
            return text
        package, _, name = type_.partition("/")
        generations = (self._ros, 3 - self._ros)
        return next((text for ros in generations if (text := _read_released(package, name, ros))), None)

    def find(self, type_: str) -> Interface | None:
        """The facts of a definition."""
        text = self.read(type_)
        return None if text is None else interface.extract(text, "msg")

    def prune(self, type_: str, keep: Sequence[str]) -> str:
        """Makes the lighter form of a message, and gives its name. Raises UserError."""
        made = lighten(self.read, type_, keep)
        package = type_.partition("/")[0]
        self.added |= {f"{package}/{name}": light.text for name, light in made.items()}
        return f"{package}/{next(iter(made))}"


@cache
def _read_released(package: str, name: str, ros: int) -> bytes | None:
    history = load_shipped().find_history(package, ros)
    if history is None or not history.versions:
        return None
    found = history.load_interfaces(history.versions[-1]).get(f"msg/{name}")
    if found is None:
        return None
    return "".join(f"{each.type}{each.array} {each.name}\n" for each in found.sections[0].fields).encode()


def _read_bag(bag: Path, type_: str, schema: SentSchema) -> tuple[list[bytes], list[str]]:
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
                _check_fields(schema, reader.typestore.fielddefs[connection.msgtype][1], bag, type_)
                found.append(encode(schema, reader.deserialize(data, connection.msgtype)))
                if len(found) >= _FROM_BAG or sum(map(len, found)) > _BYTES_FROM_BAG:
                    break
    except UserError:
        raise
    except Exception as error:  # whatever a damaged bag makes rosbags raise
        raise UserError(f"--bag {bag}: cannot be read: {' '.join(str(error).split())[:200]}") from None
    if not found:
        raise UserError(f"--bag {bag}: holds no message of the type {type_}; give another bag, or --length")
    return found, list(topics)


def _check_fields(schema: SentSchema, fields: Iterable[tuple[str, object]], bag: Path, type_: str) -> None:
    """Raises UserError where a message was recorded with another definition, whose fields are given."""
    recorded = {name for name, _ in fields}
    defined = {field.name for field in schema.list_fields()}
    if different := sorted((recorded ^ defined) - {"seq"}):
        raise UserError(
            f"--bag {bag}: {type_} was recorded with another definition, `{different[0]}` is in one of them alone; "
            "give a bag that was recorded with the definition of the workspace"
        )
