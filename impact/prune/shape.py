"""What a lighter message keeps: leaves that are read, put together into fields."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import NamedTuple

from ..facts.interface import PRIMITIVES, TIMES, Field, extract, make_full_name

FindDefinition = Callable[[str], "bytes | None"]
_HEADERS = ("std_msgs/Header", "roslib/Header")
_DEEPEST = 20


class LightField(NamedTuple):
    """A field that is kept. type: `package/Name` of a message, empty for a primitive one. members: those that are kept
    of a message of which some are not; light: the type that it has then. fixed: an array of fixed length."""

    name: str
    type: str = ""
    array: bool = False
    fixed: bool = False
    members: tuple[LightField, ...] = ()
    light: str = ""


def list_fields(find_definition: FindDefinition, type_: str) -> tuple[Field, ...] | None:
    """The fields of a message `package/Name`, None where its definition is not known."""
    data = find_definition(type_)
    if data is None:
        return None
    facts = extract(data, "msg")
    return facts.sections[0].fields if facts.sections and not facts.problems else None


def keep_fields(
    find_definition: FindDefinition, type_: str, leaves: Iterable[Sequence[str]]
) -> tuple[LightField, ...] | None:
    """What is kept of a message so that some leaves are there (paths with `[]` for elements), in the order of its
    fields. None where the definition is not known. A header is kept whole or not at all, since the clients of ROS fill
    and look at it; so is a message of which nothing is known."""
    return _keep(find_definition, type_, [tuple(leaf) for leaf in leaves], 0)


def _keep(
    find_definition: FindDefinition, type_: str, leaves: list[tuple[str, ...]], depth: int
) -> tuple[LightField, ...] | None:
    fields = list_fields(find_definition, type_)
    if fields is None or depth > _DEEPEST:
        return None
    kept: list[LightField] = []
    for field in fields:
        below = [leaf[1:] for leaf in leaves if leaf and leaf[0] == field.name]
        if not below:
            continue
        plain = field.type.partition("<=")[0]
        nested = "" if plain in PRIMITIVES or plain in TIMES else make_full_name(plain, type_.partition("/")[0])
        array = bool(field.array)
        inner = [leaf[1:] if leaf[:1] == ("[]",) else leaf for leaf in below]
        members: tuple[LightField, ...] = ()
        if nested and nested not in _HEADERS and all(inner):
            found = _keep(find_definition, nested, inner, depth + 1)
            if found is not None and not _is_whole(find_definition, nested, found):
                members = found
        kept.append(LightField(field.name, nested, array, array and field.array[1:-1].isdecimal(), members))
    return tuple(kept)


def _is_whole(find_definition: FindDefinition, type_: str, kept: tuple[LightField, ...]) -> bool:
    fields = list_fields(find_definition, type_) or ()
    return len(fields) == len(kept) and not any(field.members for field in kept)


def list_paths(fields: Sequence[LightField], outer: str = "") -> list[str]:
    """The paths of the fields that are kept whole, as `msg light --keep` takes them."""
    found: list[str] = []
    for field in fields:
        path = f"{outer}{field.name}"
        found += list_paths(field.members, f"{path}.") if field.members else [path]
    return found


def name_nested(
    fields: Sequence[LightField], light: str, find_light: FindDefinition
) -> tuple[LightField, ...]:
    """The same fields, each with the lighter message that it is of. light: `package/Name` of the message that has them;
    find_light: gives the text of lighter definitions."""
    package = light.partition("/")[0]
    types = {one.name: make_full_name(one.type, package) for one in list_fields(find_light, light) or ()}
    return tuple(
        field._replace(light=types[field.name], members=name_nested(field.members, types[field.name], find_light))
        if field.members
        else field
        for field in fields
    )
