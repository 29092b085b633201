"""All attacks, of all classes."""

from __future__ import annotations

import hashlib
import importlib
from collections import Counter
from functools import cache
from pathlib import Path

from .harness import Attack

SAMPLE = 140
"""About how many attacks CI makes."""


@cache
def attacks() -> tuple[Attack, ...]:
    """Every row of the modules attacks_*.py; their names differ."""
    found: list[Attack] = []
    for path in sorted(Path(__file__).parent.glob("attacks_*.py")):
        found += importlib.import_module(f".{path.stem}", __package__).rows()
    twice = [name for name, count in Counter(attack.name for attack in found).items() if count > 1]
    assert not twice, twice
    return tuple(found)


def order(attack: Attack) -> bytes:
    """Where an attack comes in an order of chance that is always the same."""
    return hashlib.sha1(attack.name.encode("utf-8", "surrogateescape")).digest()


def sample() -> tuple[Attack, ...]:
    """Of each class its share of SAMPLE, and the installed command at least once. Rows that take long are left out."""
    found: list[Attack] = []
    for group in sorted({attack.group for attack in attacks()}):
        rows = sorted((attack for attack in attacks() if attack.group == group and not attack.dear), key=order)
        installed = [attack for attack in rows if attack.direct or attack.program][:1]
        share = max(6, SAMPLE * len(rows) // len(attacks()))
        found += installed + [attack for attack in rows[:share] if attack not in installed]
    return tuple(found)
