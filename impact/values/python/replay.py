"""Replays witnesses: runs the real callback of a Python node on a stand-in message, in a process of its own."""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ....edges.documents import DocumentError, load_json
from ...facts.interface import Field, make_full_name
from ..harness.replay import Replayed
from ..ir.terms import read_signed
from ..outcomes import NOWHERE, CodeLine, CrashKind, InputKind, Observable, Reaction, Witness
from ..sandbox import run_apart
from .explore import find_crash_kind
from .messages import Messages

Kind = tuple[InputKind, int, bool]
_PROGRAM = Path(__file__).with_name("stand_in.py")
_SECONDS = 10.0
_MEMORY = 2_000_000_000
_DEEPEST = 12


class ReplayPlace(NamedTuple):
    """Where a callback is found on the disk. root: of the workspace; folders: where Python looks for its modules; file:
    of the module. given: path and type of the messages that it is given. replies: what it returns is an answer."""

    root: Path
    folders: tuple[Path, ...]
    module: str
    function: str
    given: tuple[tuple[str, str], ...]
    file: Path
    replies: bool = False


def replay_witness(
    place: ReplayPlace, witness: Witness, kinds: Mapping[str, Kind], messages: Messages, folder: Path
) -> Replayed:
    """Runs a callback on the message of a witness. kinds: what the bits of its values are. folder: an empty one, in
    which it runs. Raises OSError where no process can be started."""
    task = {
        "roots": [str(place.root)], "folders": [str(one) for one in place.folders], "module": place.module,
        "file": str(place.file),
        "function": place.function, "replies": place.replies,
        "messages": [_build_message(messages, type_, path, witness.values, 0) for path, type_ in place.given],
        "members": _list_members("this.", witness.values, kinds),
        "globals": _list_members("global.", witness.values, kinds),
        "answers": _list_answers(witness.values, kinds),
        "definitions": _describe_types(messages, [type_ for _, type_ in place.given]),
    }  # fmt: skip
    ended = run_apart(
        [sys.executable, "-I", str(_PROGRAM)], folder, text=json.dumps(task), seconds=_SECONDS, memory=_MEMORY
    )
    if ended.is_late:
        return Replayed(Reaction.CRASH, CrashKind.ENDLESS, is_isolated=ended.is_offline)
    try:
        found = load_json(ended.output)
    except DocumentError:
        reason = (ended.errors.strip().splitlines() or [f"it ended with status {ended.status}"])[-1]
        return Replayed(Reaction.UNKNOWN, reason=reason[:300], begun=False, is_isolated=ended.is_offline)
    return _adjust(witness, _read(found, place.root)._replace(is_isolated=ended.is_offline))


def _read(found: dict[str, Any], root: Path) -> Replayed:
    line = CodeLine(_shorten_path(found["line"][0], root), found["line"][1])
    if found["end"] == "not loaded":
        return Replayed(Reaction.UNKNOWN, place=line, reason=found["exception"], begun=False)
    events = found.get("events", ())
    effects = tuple(Observable(kind, name, NOWHERE) for kind, name in events if kind != "log")
    logs = tuple(name for kind, name in events if kind == "log")
    if found["end"] == "raised" and found["exception"] != "SystemExit":
        kind = find_crash_kind(found["exception"], found.get("detail", ""))
        detail = f"{found['exception']}: {found.get('detail', '')}".removesuffix(": ")
        return Replayed(Reaction.CRASH, kind, line, detail, effects, logs)
    if effects or found["end"] == "raised":
        return Replayed(Reaction.HANDLED, effects=effects, logs=logs)
    return Replayed(Reaction.LOG_ONLY if logs else Reaction.IGNORED, logs=logs)


def _adjust(witness: Witness, seen: Replayed) -> Replayed:
    """A replay, read as the exploration means it: a member that got another value is an effect only where somebody
    reads it, which a replay does not see."""
    only_members = (
        seen.result is Reaction.HANDLED and seen.effects and all(one.kind == "member" for one in seen.effects)
    )
    if only_members and witness.result in (Reaction.IGNORED, Reaction.LOG_ONLY):
        return seen._replace(result=Reaction.LOG_ONLY if seen.logs else Reaction.IGNORED)
    return seen


def _shorten_path(path: str, root: Path) -> str:
    try:
        return Path(path).relative_to(root.resolve()).as_posix() if path else ""
    except ValueError:
        return path


def _build_message(messages: Messages, type_: str, path: str, values: dict[str, int], deep: int) -> Any:
    fields = messages.find_fields(type_) or ()
    made = {one.name: _build_field(messages, one, type_, f"{path}.{one.name}", values, deep) for one in fields}
    return {"message": {"type": type_, "fields": made}}


def _build_field(messages: Messages, field: Field, owner: str, path: str, values: dict[str, int], deep: int) -> Any:
    if not field.array:
        return _build_one(messages, field.type, owner, path, values, deep)
    fixed = re.fullmatch(r"\[(\d+)\]", field.array)
    count = int(fixed.group(1)) if fixed else values.get(f"{path}.size", 0)
    return {"list": [_build_one(messages, field.type, owner, f"{path}[{at}]", values, deep) for at in range(count)]}


def _build_one(messages: Messages, type_: str, owner: str, path: str, values: dict[str, int], deep: int) -> Any:
    plain = type_.partition("<")[0]
    if (kind := messages.find_integer(plain)) is not None:
        number = values.get(path, 0)
        return read_signed(number, kind.bits) if kind.is_signed else number
    if plain == "bool":
        return bool(values.get(path, 0))
    if plain in ("float32", "float64"):
        return {plain: values.get(path, 0)}
    if plain in ("string", "wstring"):
        return _build_text(path, values)
    if deep > _DEEPEST:
        return None
    return _build_message(messages, make_full_name(plain, owner.partition("/")[0]), path, values, deep + 1)


def _build_text(path: str, values: dict[str, int]) -> dict[str, str]:
    size = values.get(f"{path}.size", 0)
    return {"text": bytes(values.get(f"{path}[{at}]", 0) & 0xFF for at in range(size)).hex()}


def _list_members(start: str, values: dict[str, int], kinds: Mapping[str, Kind]) -> dict[str, Any]:
    """Members of the node by their inputs `this.name`, or names of the module by theirs, `global.name`."""
    return {path[len(start) :]: value for path, value in _list_scalars(start, values, kinds)}


def _list_answers(values: dict[str, int], kinds: Mapping[str, Kind]) -> dict[str, Any]:
    """What the callback's surroundings answer, by their inputs `~name`."""
    return dict(_list_scalars("~", values, kinds))


def _list_scalars(start: str, values: dict[str, int], kinds: Mapping[str, Kind]) -> Iterator[tuple[str, Any]]:
    for path, bits in sorted(values.items()):
        kind, width, is_signed = kinds.get(path, (InputKind.INTEGER, 64, True))
        if not path.startswith(start) or kind is InputKind.CHARACTER:
            continue
        if kind is InputKind.SIZE:
            yield path.removesuffix(".size"), _build_text(path.removesuffix(".size"), values)
        elif kind is InputKind.BOOLEAN:
            yield path, bool(bits)
        elif kind in (InputKind.FLOAT32, InputKind.FLOAT64):
            yield path, {kind.value: bits}
        else:
            yield path, bits - (1 << width) if is_signed and bits >> (width - 1) else bits


def _describe_types(messages: Messages, given: Sequence[str]) -> dict[str, Any]:
    """The definitions of all types that a callback may meet: those that were asked for, and what they consist of."""
    found: dict[str, Any] = {}
    wanted = sorted({*given, *messages.asked})
    while wanted:
        type_ = wanted.pop()
        fields = messages.find_fields(type_)
        if type_ in found or fields is None:
            continue
        inner = {
            make_full_name(one.type.partition("<")[0], type_.partition("/")[0])
            for one in fields
            if messages.find_integer(one.type.partition("<")[0]) is None and one.type.partition("<")[0] not in _SCALARS
        }
        wanted.extend(sorted(inner - set(found)))
        constants = {name: _encode(value) for name, value in messages.find_constants(type_).items()}
        defaults = {one.name: _build_field(messages, one, type_, "", {}, _DEEPEST - 3) for one in fields}
        found[type_] = {"fields": defaults, "constants": constants}
    return found


_SCALARS = ("bool", "float32", "float64", "string", "wstring")


def _encode(value: Any) -> Any:
    return {"text": value.encode("latin-1", "replace").hex()} if isinstance(value, str) else value


def list_folders(paths: Sequence[Path]) -> tuple[Path, ...]:
    """Folders from which Python finds the modules of some files: above the outermost folder that has an __init__.py."""
    found: dict[Path, None] = {}
    for path in paths:
        folder = path.parent
        while (folder / "__init__.py").exists() and folder != folder.parent:
            folder = folder.parent
        found[folder] = None
    return tuple(found)
