"""Arrays of numpy: their shapes where they are known, and what sets elements. Numbers in them are not followed."""

from __future__ import annotations

import ast
from collections.abc import Sequence
from typing import Any

import z3

from .operators import compare
from .run import PythonRun
from .terms import ArrayValue, ListValue, Opaque, Truth, Whole, make_truth

_BY_SHAPE = frozenset(("zeros", "ones", "empty", "full"))
_MAKERS = _BY_SHAPE | {
    "array", "asarray", "zeros_like", "ones_like", "empty_like", "eye", "identity", "arange", "linspace",
}  # fmt: skip


def make_array(name: str, given: Sequence[Any], named: dict[str, Any]) -> ArrayValue | None:
    """What a function of numpy makes, by its last name; None where it is none that makes arrays."""
    if name not in _MAKERS:
        return None
    first = given[0] if given else named.get("shape")
    shape: tuple[int, ...] | None = None
    if name in _BY_SHAPE:
        shape = _read_shape(first)
    elif name.endswith("_like") and isinstance(first, ArrayValue):
        shape = first.shape
    elif name in ("array", "asarray") and isinstance(first, ListValue) and first.size is None:
        plain = not any(isinstance(one, (ListValue, Opaque)) for one in first.elements)
        shape = (len(first.elements),) if plain else None
    elif name in ("eye", "identity") and isinstance(first, int) and len(given) == 1:
        shape = (first, first)
    return ArrayValue(f"numpy.{name}()", shape)


def _read_shape(value: Any) -> tuple[int, ...] | None:
    if isinstance(value, int) and not isinstance(value, bool):
        return (value,)
    if isinstance(value, ListValue) and value.size is None and all(type(one) is int for one in value.elements):
        return tuple(value.elements)
    return None


def check_index(run: PythonRun, array: ArrayValue, key: Any) -> None:
    """Raises what numpy raises for an index out of range, where the shape is known."""
    for part, count in zip(_list_parts(key), array.shape or (), strict=False):
        if not isinstance(part, (int, Whole)) or isinstance(part, bool):
            continue
        below, above = compare(ast.Lt, part, -count), compare(ast.GtE, part, count)
        for one in (below, above):
            if run.decide(one) if isinstance(one, Truth) else one:
                raise run.throw("IndexError", f"an index of an axis of {count}")


def set_elements(run: PythonRun, array: ArrayValue, key: Any, value: Any) -> None:
    """`array[key] = value`. Raises what numpy raises where the sizes do not go together, as far as they are known."""
    check_index(run, array, key)
    count = _count_chosen(array, key)
    if count is not None and isinstance(value, ListValue):
        size = value.size
        if size is None:
            fits = len(value.elements) in (1, count)
        else:
            fits = run.decide(make_truth(z3.Or(size.term == count, size.term == 1)))
        if not fits:
            raise run.throw("ValueError", f"could not broadcast into {count} elements")
    array.changes += 1


def _list_parts(key: Any) -> list[Any]:
    return key.elements if isinstance(key, ListValue) and key.is_frozen else [key]


def _count_chosen(array: ArrayValue, key: Any) -> int | None:
    """How many elements a key chooses, where they are one row."""
    parts = _list_parts(key)
    if array.shape is None or len(parts) > len(array.shape):
        return None
    counts: list[int] = []
    for count, part in zip(array.shape, [*parts, *[slice(None)] * (len(array.shape) - len(parts))], strict=True):
        if isinstance(part, slice):
            ends = (part.start, part.stop, part.step)
            if not all(one is None or type(one) is int for one in ends):
                return None
            counts.append(len(range(*part.indices(count))))
        elif not isinstance(part, (int, Whole)):
            return None
    return counts[0] if len(counts) == 1 else None
