"""Whether a condition written in a file holds on somebody's machine: true, false, or not to be told (None).

Each language is parsed once per text and evaluated per machine. Nothing here raises; text that is no expression of its
language is unknown.
"""

import re
from collections.abc import Iterable

from ..facts.condition import Condition
from . import cmake, manifest, preprocessor, python
from .environment import Environment

__all__ = ["Environment", "evaluate_all", "holds"]

_LANGUAGES = {
    "cpp": preprocessor.evaluate,
    "macro": cmake.evaluate,
    "manifest": manifest.evaluate,
    "python": python.evaluate,
}


def holds(condition: Condition, environment: Environment) -> bool | None:
    """Whether a condition holds on a machine; None when it cannot be known."""
    evaluate = _LANGUAGES.get(condition.language)
    try:
        if condition.language == "cmake":
            value = cmake.evaluate(condition.text, environment, condition.declared)
        else:
            value = evaluate(condition.text, environment) if evaluate is not None else None
    except (RecursionError, MemoryError, ValueError, TypeError, ArithmeticError, LookupError, re.error):
        value = None
    if value is None:
        # What stands behind a gate holds for everybody who builds the package at all.
        return True if condition.gate and not cmake.lacks(condition.text, environment) else None
    return (not value) if condition.negated else value


def evaluate_all(conditions: Iterable[Condition], environment: Environment) -> bool | None:
    """Whether all conditions hold; False as soon as one surely does not."""
    result: bool | None = True
    for condition in conditions:
        value = holds(condition, environment)
        if value is False:
            return False
        if value is None:
            result = None
    return result
