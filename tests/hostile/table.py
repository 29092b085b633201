"""All attacks, of all classes."""

from __future__ import annotations

import importlib
from collections import Counter
from functools import cache
from pathlib import Path

from .harness import Attack


@cache
def attacks() -> tuple[Attack, ...]:
    """Every row of the modules attacks_*.py; their names differ."""
    found: list[Attack] = []
    for path in sorted(Path(__file__).parent.glob("attacks_*.py")):
        found += importlib.import_module(f".{path.stem}", __package__).ATTACKS
    twice = [name for name, count in Counter(attack.name for attack in found).items() if count > 1]
    assert not twice, twice
    return tuple(found)
