"""Whole numbers of message fields: how many bits they have, and whether one is a sign."""

from __future__ import annotations

from typing import NamedTuple


class FieldInteger(NamedTuple):
    """bits: of a field; is_signed: whether it may be below zero."""

    bits: int
    is_signed: bool


_INTEGERS = {
    **{f"int{bits}": FieldInteger(bits, True) for bits in (8, 16, 32, 64)},
    **{f"uint{bits}": FieldInteger(bits, False) for bits in (8, 16, 32, 64)},
    # Both generations make an unsigned number of a char (genmsg and rosidl_generator_cpp).
    "char": FieldInteger(8, False), "octet": FieldInteger(8, False),
}  # fmt: skip


def find_integer(type_: str, ros: int) -> FieldInteger | None:
    """The whole number that a field of a type is, None for other types. ros: the generation of ROS, of which the first
    has a `byte` that is signed, and the second one that is an octet (genmsg, rosidl)."""
    if type_ == "byte":
        return FieldInteger(8, ros == 1)
    return _INTEGERS.get(type_)
