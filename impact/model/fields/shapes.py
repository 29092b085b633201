"""What the types of topics consist of, leaf by leaf, and what a path of a program is among them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import NamedTuple

from ..flow.definitions import DefinedMember, Sections, make_key

Path = tuple[str, ...]
"""Members from a message down: `("points", "[]", "x")`; `[]` for the elements of an array."""

_DEEPEST = 12
_MOST = 5_000
# What containers, pointers and iterators have between a variable and the message that it holds.
_TRANSPARENT = frozenset(("[]", "first", "second", "value", "data", "get()"))


# Nobody takes a time apart to send half of it.
_WHOLE = frozenset(("builtin_interfaces/msg/Time", "builtin_interfaces/msg/Duration"))


class Spot(NamedTuple):
    """What a path is. kind: `leaf`, `message`, `array` (of messages), or `none` for no field. path: of the field; type:
    `package/msg/Name` of a message or of what an array holds."""

    kind: str
    path: Path
    type: str = ""


def show(path: Path) -> str:
    """A path for people: `points[].x`."""
    return ".".join(path).replace(".[]", "[]")


class Shapes:
    """The shapes of types. sections: as describe_interfaces() gives them."""

    def __init__(self, sections: dict[str, Sections]):
        self._members: dict[str, dict[str, DefinedMember]] = {}
        for key, found in sections.items():
            if key in _WHOLE:
                continue
            # A service's callback is given one of its parts: a field is of whichever has it.
            rows = [row for members in found.values() for row in members if not row.constant]
            self._members[key] = {row.name: row for row in rows}

    def is_known(self, type_: str) -> bool:
        """Whether the fields of `package/Name` are known."""
        return make_key("topic", type_) in self._members

    def list_leaves(self, type_: str) -> list[Path]:
        """All leaves of a message `package/Name`, in order; a nested message that is not known is a leaf."""
        found: list[Path] = []
        for leaf in self._walk(make_key("topic", type_), (), 0):
            found.append(leaf)
            if len(found) >= _MOST:
                break
        return found

    def list_below(self, type_: str, path: Path) -> list[Path]:
        """The leaves of a message at or below a path."""
        return [leaf for leaf in self.list_leaves(type_) if leaf[: len(path)] == path]

    def _walk(self, key: str, outer: Path, depth: int) -> Iterator[Path]:
        members = self._members.get(key)
        if members is None or depth > _DEEPEST:
            yield outer
            return
        if not members:
            yield outer
        for member in members.values():
            path = (*outer, member.name)
            if member.nested in self._members:
                inner = (*path, "[]") if _is_array(member) else path
                yield from self._walk(member.nested, inner, depth + 1)
            else:
                yield path

    def find(self, type_: str, base: Path, parts: Sequence[str]) -> Spot:
        """What some parts of a program's path are, from a field of a message `package/Name` on."""
        spot = self._find_base(type_, base)
        for part in parts:
            if spot.kind in ("leaf", "none"):
                return spot
            spot = self._take_step(spot, part)
        return spot

    def _find_base(self, type_: str, base: Path) -> Spot:
        spot = Spot("message", (), make_key("topic", type_))
        for part in base:
            spot = self._take_step(spot, part)
        return spot

    def _take_step(self, spot: Spot, part: str) -> Spot:
        if spot.kind == "array":
            if part == "[]":
                return Spot("message", (*spot.path, "[]"), spot.type)
            return spot if part in _TRANSPARENT else Spot("none", spot.path)
        members = self._members.get(spot.type, {})
        member = members.get(part)
        if member is None:
            return spot if part in _TRANSPARENT else Spot("none", spot.path)
        path = (*spot.path, part)
        if member.nested not in self._members:
            return Spot("leaf", path)
        return Spot("array" if _is_array(member) else "message", path, member.nested)


def _is_array(member: DefinedMember) -> bool:
    return member.type.endswith("]")


