"""Methods whose answers are kept."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cache, wraps
from types import MethodType
from typing import TYPE_CHECKING, Any, TypeVar

Method = TypeVar("Method", bound=Callable[..., Any])


class CachedMethod:
    """The descriptor that cache_method() makes of a method."""

    def __init__(self, method: Callable[..., Any]):
        self.__func__ = method
        self.__doc__ = method.__doc__

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, instance: object | None, owner: type | None = None) -> Any:
        if instance is None:
            return self
        # From here on the object has it as an attribute of its own, which is found first.
        kept = instance.__dict__[self._name] = cache(MethodType(self.__func__, instance))
        return kept


if TYPE_CHECKING:

    def cache_method(method: Method) -> Method:
        """Runs a method once for the same arguments of one object, as functools.cached_property does for none.

        The arguments have to be hashable. The answers live as long as the object, which cannot be pickled with them."""
        return method
else:
    cache_method = CachedMethod


def cache_in_derived(function: Method) -> Method:
    """Runs a function once for the same arguments. The first has to have a dictionary `derived`, in which the answers
    are kept for as long as it lives; the others have to be hashable. What a generator yields is kept as a tuple."""

    @wraps(function)
    def ask(holder: Any, *arguments: Any) -> Any:
        key = function, *arguments
        if key not in holder.derived:
            found = function(holder, *arguments)
            holder.derived[key] = tuple(found) if isinstance(found, Iterator) else found
        return holder.derived[key]

    return ask  # type: ignore[return-value]
