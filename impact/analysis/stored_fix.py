"""Actions of a fix in the form in which results of earlier runs are stored."""

from collections.abc import Sequence

from ..rules.fix_actions import Declare, Insert, Remove, Replace
from ..rules.rule import Edit, FixAction

_FIXES: dict[str, type] = {kind.__name__: kind for kind in (Declare, Remove, Replace, Insert, Edit)}
PackedFix = tuple[tuple[str, tuple[str | int, ...]], ...]
"""Actions of a fix as they are stored: the name of each, and its fields."""


def pack_fix(fix: Sequence[FixAction]) -> PackedFix:
    """Actions of a fix as they are stored."""
    return tuple((type(action).__name__, tuple(action)) for action in fix)


def unpack_fix(packed: PackedFix) -> tuple[FixAction, ...]:
    """Undoes pack_fix(). Raises KeyError or TypeError for what that does not make."""
    return tuple(_FIXES[kind](*fields) for kind, fields in packed)
