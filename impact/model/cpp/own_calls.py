"""Functions of a package that its sources use and that other sources define, told by their headers: what a class of
`arm.hpp` defines in `arm.cpp`."""

from __future__ import annotations

import posixpath
from collections.abc import Callable, Collection, Iterator, Mapping


def list_own_calls(
    compiled: Mapping[str, Collection[str]],
    included: Callable[[str], Collection[str]],
    spoken: Callable[[str], frozenset[str]],
    defined: Callable[[Collection[str]], Mapping[str, Collection[str]]],
) -> Iterator[tuple[str, str, str]]:
    """Source, the other source that defines a function which it seems to use, and that function, `Class::function`.

    compiled: the targets of each source. included: the files of the package that a file includes itself. spoken: all
    words of a file. defined: the functions of classes and namespaces that each of some sources defines."""
    own_header = {path: next((h for h in included(path) if _stem_of(h) == _stem_of(path)), "") for path in compiled}
    sources: dict[str, list[str]] = {}
    for path, header in own_header.items():
        if header:
            sources.setdefault(header, []).append(path)
    pairs = [
        (path, other)
        for path, targets in compiled.items()
        for header in {*included(path), *(included(own_header[path]) if own_header[path] else ())}
        for other in sources.get(header, ())
        if header != own_header[path] and not set(targets) <= set(compiled[other])
    ]
    functions = defined(sorted({other for _, other in pairs}))
    for path, other in sorted(pairs):
        said = spoken(path)
        around = said | (spoken(own_header[path]) if own_header[path] else frozenset())
        own = {name.partition("::")[2] for name in defined((path,)).get(path, ())} if functions.get(other) else ()
        for name in sorted(functions.get(other, ())):
            owner, _, function = name.partition("::")
            if owner != function and owner in around and function in said and function not in own:
                yield path, other, name
                break


def _stem_of(path: str) -> str:
    return posixpath.basename(path).partition(".")[0]
