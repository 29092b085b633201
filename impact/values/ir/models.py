"""Models of functions: by name, what the executor does instead of calling them."""

from __future__ import annotations

import re
from collections.abc import Callable

from .executor import CallModel

_EXACT: dict[str, CallModel] = {}
_PREFIXES: list[tuple[str, CallModel]] = []
_PATTERNS: list[tuple[re.Pattern[str], CallModel]] = []


def model(*names: str) -> Callable[[CallModel], CallModel]:
    """Registers a model for functions of some mangled names; one that ends in `*` is the beginning of names."""

    def register(call_model: CallModel) -> CallModel:
        for name in names:
            if name.endswith("*"):
                _PREFIXES.append((name[:-1], call_model))
            else:
                _EXACT[name] = call_model
        return call_model

    return register


def model_pattern(pattern: str) -> Callable[[CallModel], CallModel]:
    """The same for all names that a regular expression matches as a whole."""

    def register(call_model: CallModel) -> CallModel:
        _PATTERNS.append((re.compile(pattern), call_model))
        return call_model

    return register


def find_model(name: str) -> CallModel | None:
    """The model of a function, or None."""
    found = _EXACT.get(name)
    if found is not None:
        return found
    for prefix, each in _PREFIXES:
        if name.startswith(prefix):
            return each
    for pattern, each in _PATTERNS:
        if pattern.fullmatch(name):
            return each
    return None
