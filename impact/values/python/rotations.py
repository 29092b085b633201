"""Functions that calculate rotations (tf.transformations, tf_transformations): how many numbers they give, and between
which bounds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import z3

from .run import PythonRun
from .terms import FLOAT64, ArrayValue, ListValue, Real, Record

_MODULES = ("tf.transformations.", "tf_transformations.", "transformations.")
_EULER = (math.pi, math.pi, math.pi)
_TUPLES = {"euler_from_quaternion": _EULER, "euler_from_matrix": _EULER}
"""The largest magnitude of each number: with some orders of axes the second goes beyond a quarter turn, too."""
_SIZES = {
    "quaternion_from_euler": 4, "quaternion_multiply": 4, "quaternion_inverse": 4, "quaternion_conjugate": 4,
    "quaternion_from_matrix": 4, "quaternion_about_axis": 4, "quaternion_slerp": 4, "random_quaternion": 4,
    "translation_from_matrix": 3,
}  # fmt: skip
_MATRICES = frozenset(("quaternion_matrix", "euler_matrix", "translation_matrix", "rotation_matrix", "identity_matrix",
                       "concatenate_matrices", "inverse_matrix", "compose_matrix"))  # fmt: skip
_INDEXED = frozenset(("euler_from_quaternion", "quaternion_matrix", "quaternion_inverse", "quaternion_conjugate"))


def call_rotation(run: PythonRun, name: str, given: Sequence[Any]) -> Any:
    """What a function gives, by its dotted name; None where it is none of these."""
    word = name.rpartition(".")[2]
    if not name.startswith(_MODULES) or word not in _TUPLES.keys() | _SIZES.keys() | _MATRICES:
        return None
    if word in _INDEXED and given and isinstance(given[0], Record):
        # A message of a quaternion, where its four numbers are wanted.
        raise run.throw("TypeError", f"{given[0].type.rpartition('/')[2]} object is not subscriptable")
    run.assumed[f"{word}() gives any value"] = None
    if word not in _TUPLES:
        return ArrayValue(f"{word}()", (_SIZES[word],) if word in _SIZES else (4, 4))
    path = run.make_name(f"~{word}")
    made = [_make_number(run, f"{path}.{at}", most) for at, most in enumerate(_TUPLES[word])]
    return ListValue(made, is_frozen=True)


def _make_number(run: PythonRun, path: str, most: float) -> Real:
    value = run.get_real(path, 64)
    bound = z3.FPVal(most, FLOAT64)
    run.assume(z3.Or(z3.fpIsNaN(value.term), z3.fpLEQ(z3.fpAbs(value.term), bound)))
    return value
