"""Crashes after something that is not known was asked for: which of them come whatever the answer is."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import NamedTuple

import z3

from ....edges.groups import group_pairs
from ..outcomes import CallbackPath, CrashKind

_FOREIGN = "~foreign"
_MOST = 200
_MILLISECONDS = 1000
FindNames = Callable[[z3.BoolRef], Collection[str]]


class DoubtfulCrash(NamedTuple):
    """A crash that what is not known may prevent. number: of its path; the path itself says that it is unknown."""

    number: int
    kind: CrashKind


def list_certain(
    crashes: Sequence[DoubtfulCrash], paths: Sequence[CallbackPath], find_names: FindNames,
    begun: Sequence[Sequence[z3.BoolRef]] = (),
) -> list[DoubtfulCrash]:  # fmt: skip
    """Those crashes at which the same line is reached whatever the inputs are that nothing is known of, and that other
    inputs bring about. find_names: the inputs that a condition speaks of. begun: the conditions under which the
    callback begins, of each way that comes there; without any it begins in any case."""
    found: list[DoubtfulCrash] = []
    begins = z3.Or(*[z3.And(*_select_foreign(each, find_names)) for each in begun]) if begun else z3.BoolVal(True)
    for rows in group_pairs(((one.kind, paths[one.number].place), one) for one in crashes).values():
        parts: list[z3.BoolRef] = []
        taken: list[DoubtfulCrash] = []
        for one in rows[:_MOST]:
            foreign = split_foreign(paths[one.number].condition, find_names)
            if foreign is not None:
                parts.append(z3.And(*foreign))
                taken.append(one)
        if taken and _is_always(z3.Implies(begins, z3.Or(*parts))):
            found += taken
    return found


def split_foreign(conditions: Sequence[z3.BoolRef], find_names: FindNames) -> list[z3.BoolRef] | None:
    """The conditions that have to do with what is not known; None where the last one, which is the crash itself, is
    among them."""
    found = _select_foreign(conditions, find_names)
    return None if not conditions or any(each is conditions[-1] for each in found) else found


def _select_foreign(conditions: Sequence[z3.BoolRef], find_names: FindNames) -> list[z3.BoolRef]:
    names = [frozenset(find_names(each)) for each in conditions]
    reached = {name for each in names for name in each if name.startswith(_FOREIGN)}
    while more := {name for each in names if each & reached for name in each} - reached:
        reached |= more
    return [each for each, own in zip(conditions, names, strict=True) if own & reached]


def _is_always(term: z3.BoolRef) -> bool:
    solver = z3.Solver()
    solver.set("timeout", _MILLISECONDS)
    solver.add(z3.Not(term))
    return solver.check() == z3.unsat
