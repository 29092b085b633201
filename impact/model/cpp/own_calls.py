"""Functions of a package that its sources use and that other sources define, told by their headers: what a class of
`arm.hpp` defines in `arm.cpp`, and the functions without a class beside it."""

from __future__ import annotations

import posixpath
from collections.abc import Callable, Collection, Iterator, Mapping

from ....edges.groups import group_pairs
from ....edges.reach import Reach
from ...facts.searches import CalledCpp


def list_own_calls(
    sources: Mapping[str, Collection[str]],
    included: Callable[[str], Collection[str]],
    spoken: Callable[[str], frozenset[str]],
    may_lack: Callable[[str, str], bool],
    declared: Callable[[Collection[str]], Mapping[str, CalledCpp]],
) -> Iterator[tuple[str, str, str]]:
    """Source, the other source that defines a function which it seems to use, and that function, `Class::function`.

    sources: the targets of each source; none where nothing compiles it. included: the files of the package that a file
    includes itself. spoken: all words of a file. may_lack: whether a target of the first source may have no part in the
    second. declared: what each of some sources defines and calls."""
    own_header = {
        path: min((h for h in included(path) if _get_stem(h) == _get_stem(path)), default="") for path in sources
    }
    beside = group_pairs((header, path) for path, header in own_header.items() if header)
    # Of several, those that nothing compiles are for other platforms.
    beside = {header: [o for o in others if sources[o]] or others for header, others in beside.items()}
    reach = Reach(lambda path: (included(path), ()))
    with_source, stems = reach.combine_bits(beside), {header: _normalise(_get_stem(header)) for header in beside}
    pairs = []
    for path, targets in sources.items():
        own = own_header[path]
        if not targets or not (reached := reach.collect_masks((path,))[0] & with_source & ~reach.assign_bit(own)):
            continue
        direct, words = {*included(path), *(included(own) if own else ())}, {_normalise(word) for word in spoken(path)}
        for header in reach.list_names(reached):
            # What comes from far counts where the file names the class that the header is called after.
            if header in direct or stems[header] in words:
                pairs += [(path, other) for other in beside[header] if may_lack(path, other)]
    known = declared(sorted({path for pair in pairs for path in pair}))
    for path, other in sorted(pairs):
        if path not in known or other not in known:
            continue
        said, called = spoken(path), known[path].called
        around = said | (spoken(own_header[path]) if own_header[path] else frozenset())
        own = {name.partition("::")[2] for name in known[path].functions}
        for name in sorted(known[other].functions):
            owner, _, function = name.partition("::")
            if owner == function or not owner:  # a constructor, or a function without a class
                used = function in called and function in spoken(own_header[other])
            else:
                used = owner in around and (function in said or f".{function}" in called)
                # Where the header of the source itself speaks of such a function, that one is meant most likely.
                used = used and not (own_header[path] and function in spoken(own_header[path]))
            if used and function not in own and not _is_defined_along(name, sources, path, declared):
                yield path, other, name.removeprefix("::")
                break


def _is_defined_along(
    name: str,
    sources: Mapping[str, Collection[str]],
    path: str,
    declared: Callable[[Collection[str]], Mapping[str, CalledCpp]],
) -> bool:
    """Whether a source that goes into every target of a file defines a function too: two programs may each have their
    own version of a class."""
    along = sorted(other for other, targets in sources.items() if other != path and set(sources[path]) <= set(targets))
    return any(name in facts.functions for facts in declared(along).values())


def _get_stem(path: str) -> str:
    return posixpath.basename(path).partition(".")[0]


def _normalise(name: str) -> str:
    return name.replace("_", "").lower()
