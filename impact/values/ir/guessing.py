"""Guesses for inputs that fulfil conditions: floats that conditions compare with, texts that are numbers, and searches
along one float. Each guess is checked by calculating the conditions."""

from __future__ import annotations

import itertools
import math
import random
import re
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

import z3

from ..outcomes import InputKind, SymbolicInput
from .terms import pack_float, unpack_float

_FLOATS = (InputKind.FLOAT32, InputKind.FLOAT64)
_USUAL = (0.0, 1.0, -1.0, 0.5, 2.0, math.nan, 100.0, math.inf, -math.inf, 1e10, -0.5)
_NUMBERS = (b"0", b"7", b"-1", b"2147483648", b"99999999999", b"1.5", b"1e999", b"nan")
_SIZES = (
    0.0, 1e-6, 0.01, 0.1, 0.5, 1.0, 2.0, 3.0, 5.0, 7.5, 10.0, 15.0, 20.0, 30.0, 50.0, 100.0, 360.0, 1e3, 1e4, 1e6, 1e10,
    1e20, 1e38,
)  # fmt: skip
_LINE = tuple(sign * each for each in _SIZES for sign in (1.0, -1.0))
_CHARACTER = re.compile(r"(.*)\[(\d+)\]")

Check = Callable[[Iterable[z3.BoolRef], dict[str, int]], bool]


class Guessing:
    """Guesses of one exploration. holds: whether conditions are fulfilled, after variables that are derived from others
    are calculated."""

    def __init__(self, inputs: Mapping[str, SymbolicInput], derived: Mapping[str, object], holds: Check):
        self._inputs = inputs
        self._derived = derived
        self._holds = holds
        self._random = random.Random(1)

    def guess_floats(
        self,
        conditions: Sequence[z3.BoolRef],
        names: frozenset[str],
        constants: Iterable[float],
        base: Mapping[str, int],
        tries: int,
        deadline: float,
    ) -> dict[str, int] | None:
        """Values for the floats among names; the others stay as in base. The newest condition comes last."""
        floats = self._list_floats(names)
        if not floats:
            return None
        start = {name: base.get(name, 0) for name in names}
        # What is hardest is asked first.
        ordered = list(reversed(conditions))
        finite = sorted({abs(value) for value in constants if math.isfinite(value)}, key=lambda x: (x == 0, x))[:6]
        for values in itertools.islice(self._list_guesses(floats, finite), tries):
            trial = dict(start)
            for name, value in values.items():
                trial[name] = pack_float(value, self._inputs[name].bits)
            if self._holds(ordered, trial):
                return trial
            if time.monotonic() > deadline:
                return None
        return None

    def _list_floats(self, names: Iterable[str]) -> list[str]:
        return sorted(name for name in names if self._inputs[name].kind in _FLOATS and name not in self._derived)

    def _list_guesses(self, floats: Sequence[str], constants: Sequence[float]) -> Iterator[dict[str, float]]:
        near = [
            signed
            for value in constants
            for each in (value, math.nextafter(value, math.inf), value * 1.5, value * 0.5)
            for signed in (each, -each)
        ]
        pool = [*_USUAL[:6], *near, *_USUAL[6:]]
        yield {}
        for value in (0.0, 1.0):
            yield dict.fromkeys(floats, value)
        if len(floats) > 1:
            # No rotation, if there are quaternions.
            yield {each: 1.0 if each.endswith(".w") else 0.0 for each in floats}
            for name in floats[:8]:
                yield {each: 1.0 if each == name else 0.0 for each in floats}
        for value in pool[:16]:
            for name in floats[:3]:
                yield {name: value}
        while True:
            yield {
                name: self._random.choice(pool) if self._random.random() < 0.7 else self._random.uniform(-10, 10)
                for name in floats
            }

    def search_line(
        self,
        conditions: Sequence[z3.BoolRef],
        names: frozenset[str],
        constants: Iterable[float],
        base: Mapping[str, int],
        deadline: float,
    ) -> dict[str, int] | None:
        """Varies one float: where the last condition changes between two values, what lies between is looked at."""
        start = {name: base.get(name, 0) for name in names}
        finite = {value for value in constants if math.isfinite(value)}
        for name in self._list_floats(names)[:3]:
            bits = self._inputs[name].bits
            now = unpack_float(start[name], bits)
            points = sorted({*_LINE, *finite, *(-value for value in finite), *((now,) if math.isfinite(now) else ())})

            def judge(value: float, name: str = name, bits: int = bits) -> tuple[bool, bool]:
                trial = {**start, name: pack_float(value, bits)}
                return self._holds(conditions[:-1], trial), self._holds(conditions[-1:], trial)

            verdicts = [judge(value) for value in points]
            if (True, True) in verdicts:
                return {**start, name: pack_float(points[verdicts.index((True, True))], bits)}
            for number in range(len(points) - 1):
                if verdicts[number] == verdicts[number + 1] or time.monotonic() > deadline:
                    continue
                low, high = points[number], points[number + 1]
                first, last = verdicts[number], verdicts[number + 1]
                for _ in range(48):
                    middle = low + (high - low) / 2
                    found = judge(middle)
                    if found == (True, True):
                        return {**start, name: pack_float(middle, bits)}
                    if found == first:
                        low = middle
                    elif found == last:
                        high = middle
                    else:
                        break
        return None

    def guess_texts(
        self, conditions: Sequence[z3.BoolRef], names: frozenset[str], base: Mapping[str, int], deadline: float
    ) -> dict[str, int] | None:
        """Writes numbers into the texts among names, behind what they begin with."""
        ordered = list(reversed(conditions))
        start = {name: base.get(name, 0) for name in names}
        for text, most in self._find_texts(names).items():
            size = text + ".size"
            for number in _NUMBERS:
                for place in range(most - len(number) + 1):
                    trial = dict(start)
                    for index, byte in enumerate(number, place):
                        trial[f"{text}[{index}]"] = byte
                    if size in self._inputs:
                        trial[size] = place + len(number)
                    trial = {name: value for name, value in trial.items() if name in self._inputs}
                    if self._holds(ordered, trial):
                        return {name: value for name, value in trial.items() if name in names}
                    if time.monotonic() > deadline:
                        return None
        return None

    def _find_texts(self, names: Iterable[str]) -> dict[str, int]:
        """Paths of texts, with the number of their bytes among names."""
        texts: dict[str, int] = {}
        for name in names:
            if self._inputs[name].kind is InputKind.CHARACTER and (found := _CHARACTER.fullmatch(name)):
                texts[found[1]] = max(texts.get(found[1], 0), int(found[2]) + 1)
        return texts
