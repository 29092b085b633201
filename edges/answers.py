"""Methods whose answers their object keeps."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import Concatenate, ParamSpec, TypeVar

Owner = TypeVar("Owner")
Asked = ParamSpec("Asked")
Answer = TypeVar("Answer")


def answer_once(method: Callable[Concatenate[Owner, Asked], Answer]) -> Callable[Concatenate[Owner, Asked], Answer]:
    """A method that is run once for each set of positional, hashable arguments; what it raises is not kept."""
    name = f"_answers_of_{method.__name__}"

    @wraps(method)
    def answer(self, *arguments):
        kept = self.__dict__.setdefault(name, {})
        if arguments not in kept:
            kept[arguments] = method(self, *arguments)  # type: ignore[call-arg]
        return kept[arguments]

    return answer  # type: ignore[return-value]
