"""What is sent: synthetic messages, or a message of the user's workspace, filled as in a bag or with given lengths."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

import msgspec

from ...edges.console import UserError
from ..analysis.message_files import MessageFolders
from ..facts import interface
from ..facts.interface import Interface
from ..model.fields.report import PublisherFields
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


class MessageFilling(NamedTuple):
    """What a real message is filled with. lengths: of arrays and texts by path, as the user gives them. bag: whose
    messages are sent instead; topic: of that topic alone, where one is named. publishers: the statements of a workspace
    that publish it, whose lengths count where the user gives none. length: of what these set, and do not tell how
    long."""

    lengths: Mapping[str, int] = {}
    bag: Path | None = None
    topic: str = ""
    publishers: Sequence[PublisherFields] = ()
    length: int = 10


class RealMessages(NamedTuple):
    """A message of a workspace, whole and pruned. notes: on how it is filled. rate: of the bag's messages in Hz, None
    where that is not known."""

    messages: Messages
    notes: list[str]
    rate: float | None = None


def make_real_messages(type_: str, keep: Sequence[str], path: Path, filling: MessageFilling, ros: int) -> RealMessages:
    """The message `package/Name`, whole and with some fields alone. path: the workspace. ros: the generation of the
    nodes. Raises UserError."""
    if type_.replace("/msg/", "/").count("/") != 1:
        raise UserError(f"--message {type_}: write package/Type")
    type_ = type_.replace("/msg/", "/")
    definitions = _Definitions(path, ros)
    schema = make_schema(type_, definitions.find)
    rate = None
    if filling.bag is not None:
        values, notes, rate = _read_bag(filling.bag, type_, filling.topic, schema)
    else:
        lengths, notes = _choose_lengths(type_, schema, filling)
        _check_size(schema, lengths)
        values = [encode(schema, fill(schema, lengths))]
    made = {(0, FULL): PreparedMessage(schema, values)}
    if keep:
        pruned = make_schema(definitions.prune(type_, keep), definitions.find)
        made[0, PRUNED] = PreparedMessage(pruned, [encode(pruned, decode(schema, value)) for value in values])
    return RealMessages(made, notes, rate)


def _choose_lengths(type_: str, schema: SentSchema, filling: MessageFilling) -> tuple[dict[str, int], list[str]]:
    """The lengths of arrays and texts, and notes on them: those that the user gives, else those of the code that
    publishes the message. What nobody sets is empty, as in the message itself. Raises UserError."""
    known = list(dict.fromkeys(list_lengths(schema)))
    if wrong := [each for each in filling.lengths if each not in known]:
        can = f"can be given for {', '.join(known)}" if known else "are of no use: nothing in it varies in length"
        raise UserError(f"--length {wrong[0]}: `{type_}` has no such array or text; lengths {can}")
    lengths = dict(filling.lengths)
    left = [each for each in known if each not in lengths]
    if not filling.publishers:
        return lengths, [f"empty, since no --length is given: {', '.join(left)}"] if left else []
    written = {name: max(one.get(name, 0) for one in map(_get_lengths, filling.publishers)) for name in left}
    unsure = any(one.unknown for one in filling.publishers)
    taken = [name for name in left if not written[name] and (unsure or _is_set(name, filling.publishers))]
    lengths |= written | dict.fromkeys(taken, filling.length)
    told = [f"{name} {length}" for name, length in written.items() if length]
    places = ", ".join(dict.fromkeys(f"{one.path}:{one.line}" for one in filling.publishers))
    notes = [f"as {places} fills it: {', '.join(told) or 'no length is written there'}"] if left else []
    if taken:
        notes.append(f"of a length that is not known, taken as {filling.length}: {', '.join(taken)}")
    return lengths, notes


def _get_lengths(publisher: PublisherFields) -> dict[str, int]:
    return dict(publisher.lengths)


def _is_set(name: str, publishers: Iterable[PublisherFields]) -> bool:
    """Whether a publisher sets a field, what it is a part of, or something in it."""
    path = name.removesuffix("[]")
    return any(
        path == each or path.startswith((f"{each}.", f"{each}[]")) or each.startswith((f"{path}.", f"{path}[]"))
        for one in publishers
        for each in (field.field for field in one.sets)
    )


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


def _read_bag(bag: Path, type_: str, topic: str, schema: SentSchema) -> tuple[list[bytes], list[str], float | None]:
    """The first messages of a type in a bag, as ROS 1 has them on the wire, a note on them, and their rate in Hz.
    topic: of this one alone. Raises UserError."""
    try:
        from rosbags.highlevel import AnyReader  # pyright: ignore[reportMissingImports]
    except ImportError:
        raise UserError(f"--bag {bag}: needs rosbags; install it with `pip install 'rosimpact[measure]'`") from None
    if not bag.exists():
        raise UserError(f"--bag {bag}: no such file or folder; give a .bag, a .mcap, or the folder of a ROS 2 bag")
    package, _, name = type_.partition("/")
    found: list[bytes] = []
    times: list[int] = []
    topics: dict[str, None] = {}
    try:
        with AnyReader([bag]) as reader:
            chosen = [
                each for each in reader.connections
                if each.msgtype in (type_, f"{package}/msg/{name}") and topic in ("", each.topic)
            ]  # fmt: skip
            for connection, time, data in reader.messages(connections=chosen) if chosen else ():
                topics[connection.topic] = None
                times.append(time)
                _check_fields(schema, reader.typestore.fielddefs[connection.msgtype][1], bag, type_)
                found.append(encode(schema, reader.deserialize(data, connection.msgtype)))
                if len(found) >= _FROM_BAG or sum(map(len, found)) > _BYTES_FROM_BAG:
                    break
    except UserError:
        raise
    except Exception as error:  # whatever a damaged bag makes rosbags raise
        raise UserError(f"--bag {bag}: cannot be read: {' '.join(str(error).split())[:200]}") from None
    if not found:
        on = f" on {topic}" if topic else ""
        raise UserError(f"--bag {bag}: holds no message of the type {type_}{on}; give another bag, or --length")
    seconds = (max(times) - min(times)) / 1e9
    rate = (len(times) - 1) / seconds if seconds > 0 and len(topics) == 1 else None
    return found, [f"{len(found)} messages of {', '.join(topics)} are sent in turn"], rate


def _check_fields(schema: SentSchema, fields: Iterable[tuple[str, object]], bag: Path, type_: str) -> None:
    """Raises UserError where a message was recorded with another definition, whose fields are given."""
    recorded = {name for name, _ in fields}
    defined = {field.name for field in schema.list_fields()}
    if different := sorted((recorded ^ defined) - {"seq"}):
        raise UserError(
            f"--bag {bag}: {type_} was recorded with another definition, `{different[0]}` is in one of them alone; "
            "give a bag that was recorded with the definition of the workspace"
        )
