"""Names that the Python files of a package use and that nothing defines: neither the file itself, nor the module of the
package from which it imports them; and functions that entry points name and their modules lack."""

from __future__ import annotations

import posixpath
from collections.abc import Collection, Iterable, Iterator, Mapping

import msgspec

from ...facts.python.reader import Import
from ...facts.python.source import PythonFile
from ...facts.setup import SetupFile


def list_undefined(
    files: Mapping[str, PythonFile],
    others: Collection[str],
    paths: Iterable[str],
    setup: Iterable[tuple[str, SetupFile]] = (),
) -> Iterator[tuple[str, Import]]:
    """Such names, each as its import with the path it stands in; of those that the file uses itself the module is
    empty. files: the Python files of a package by their paths. others: what modules and libraries of the package are
    called. paths: all its files, of which modules may be built that are called like them. setup: its setup files."""
    modules: dict[str, list[str]] = {}
    built: set[str] = set()
    for path in files:
        modules.setdefault(posixpath.basename(_stem_of(path)), []).append(path)
    for path, facts in files.items():
        if posixpath.basename(path).startswith("."):
            continue  # settings of tools, which define names for them
        for use in facts.unbound:
            yield path, Import("", (use.text,), 0, use.line, use.column, use.lazy, use.conditions)
        for item in facts.imports:
            module = _find_module(path, item, modules) if item.names and "*" not in item.names else None
            bound = files[module].bound if module is not None else ""
            for name in item.names if bound and module != path else ():
                if f" {name} " in bound or name in others or name.startswith("_"):
                    continue
                built = built or {posixpath.basename(one).partition(".")[0] for one in paths}
                if name not in built:
                    yield path, msgspec.structs.replace(item, module="." * item.level + item.module, names=(name,))


    for path, told in setup:
        for _, module, line, function in told.entry_points:
            place = next((one for one in told.places_of(posixpath.dirname(path), module) if one in files), None)
            name = function.partition(".")[0]
            if place is not None and name and files[place].bound and f" {name} " not in files[place].bound:
                yield path, Import(module, (name,), 0, line, 0, False, ())


def _find_module(path: str, item: Import, modules: Mapping[str, list[str]]) -> str | None:
    """The file of a package that an import names, None where it may be another one or none. modules: all files by the
    last parts of their modules' names."""
    ending = item.module.replace(".", "/")
    near = modules.get(posixpath.basename(ending), ()) if ending else ()
    if item.level:
        folder = path
        for _ in range(item.level):
            folder = posixpath.dirname(folder)
        exact = posixpath.join(folder, ending).rstrip("/")
        found = [one for one in (near or modules.get(posixpath.basename(exact), ())) if _stem_of(one) == exact]
    elif "/" in ending:
        found = [one for one in near if f"/{_stem_of(one)}".endswith(f"/{ending}")]
    else:  # of one word there are many modules elsewhere; the one beside a program comes first
        found = [posixpath.join(posixpath.dirname(path), f"{ending}.py")] if len(near) == 1 else []
        found = [one for one in found if one in near]
    return found[0] if len(found) == 1 else None


def _stem_of(path: str) -> str:
    """The path of a module without its ending, the folder's of a package."""
    return path.removesuffix("/__init__.py").removesuffix(".py")
