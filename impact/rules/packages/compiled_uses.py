"""What the sources of a package use of libraries that need a link, for the rules on links."""

from collections.abc import Callable, Collection, Iterator
from typing import NamedTuple

from ...model.package import IncludeUse
from ...targets.platform import strip_separators
from ...targets.providers.compiled import CompiledName, load_compiled
from ...targets.providers.libraries import load_libraries
from ..vocabulary import Package, TargetView


class LibraryUse(NamedTuple):
    """A file that surely uses what is compiled into a platform library. name: what it uses. words: one of them stands
    in every name that the library is linked by, without separators."""

    path: str
    name: str
    library: str
    words: tuple[str, ...]


def list_library_uses(package: Package) -> Iterator[LibraryUse]:
    """The uses of platform libraries in files that targets compile, one for each file and library."""
    for path, name, found in _list_first_uses(package, lambda found: not found.ros):
        yield LibraryUse(path, name, found.owner, _list_words(found.owner, found.stem))


def _list_words(library: str, stem: str) -> tuple[str, ...]:
    whole = [strip_separators(one).removeprefix("lib") for one in (stem, library)]
    plain = [word.rstrip("0123456789") for word in whole]
    return tuple(dict.fromkeys(short if len(short) > 2 else long for short, long in zip(plain, whole, strict=True)))


def find_library_include(view: TargetView, package: Package, use: LibraryUse, target: str) -> IncludeUse | None:
    """An include of a library in a use's file, or in another one of a target; None where none surely is."""
    return _find_include(
        view, package, use.path, target, lambda path: load_libraries().find_by_header(path) == use.library
    )


def list_package_uses(view: TargetView, package: Package) -> Iterator[tuple[str, str, str]]:
    """Of files that targets compile: (path, a released package of which it surely uses something that is compiled, that
    name), one for each file and package."""
    left_out = {package.name, *view.workspace.packages}
    uses = _list_first_uses(package, lambda found: view.target.ros in found.ros, left_out)
    yield from ((path, found.owner, name) for path, name, found in uses)


def _list_first_uses(
    package: Package, fits: Callable[[CompiledName], bool], left_out: Collection[str] = ()
) -> Iterator[tuple[str, str, CompiledName]]:
    """(path, name, whose it is) of what files that targets compile use of owners that fit, one for each file and owner,
    a function before a class."""
    known = load_compiled()
    for path, names in package.linked.compiled:
        seen = set(left_out)
        for name in sorted(names, key=lambda name: name not in known.functions):
            found = known.find(name)
            if fits(found) and found.owner not in seen:
                seen.add(found.owner)
                yield path, name, found


def find_package_include(
    view: TargetView, package: Package, path: str, target: str, owner: str
) -> IncludeUse | None:
    """An include of a header of a package in a file, or in another one of a target; None where none surely is."""

    def is_of_owner(header: str) -> bool:
        providers = view.find_header(header)
        return len(providers) == 1 and providers[0].kind == "ros" and providers[0].sure and providers[0].name == owner

    return _find_include(view, package, path, target, is_of_owner)


def _find_include(
    view: TargetView, package: Package, path: str, target: str, fits: Callable[[str], bool]
) -> IncludeUse | None:
    there = (one for one in package.linked.includes if target in one.targets and view.is_sure(one.conditions))
    return next((one for one in sorted(there, key=lambda one: one.at.path != path) if fits(one.path)), None)
