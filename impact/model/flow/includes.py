"""Which files of the code a C++ file sees: those that it includes, and for a header those of whoever includes it."""

from __future__ import annotations

import posixpath
from collections import defaultdict
from collections.abc import Sequence
from functools import cached_property

from ....edges.groups import group_pairs
from ....edges.memory import cache_method
from ....edges.reach import walk
from .modules import CodeFile


class SeenFiles:
    """The files that the C++ files of a body of code see. An include may mean any file of its package whose path ends
    like it, and where its package has none, any of the other packages."""

    def __init__(self, sources: Sequence[CodeFile]):
        self._sources = {source.path: source for source in sources if source.facts.language == "cpp"}

    @cache_method
    def list_seen(self, path: str) -> frozenset[str]:
        """The files that one sees, itself among them. What a header leaves to whoever includes it counts as seen."""
        compiled = walk([path], lambda one: self._includers.get(one, ()))
        return frozenset(walk(compiled, lambda one: self._included.get(one, ())))

    @cache_method
    def list_including(self, path: str) -> frozenset[str]:
        """The files that include one, also by way of others; without itself."""
        return frozenset(walk(self._includers.get(path, ()), lambda one: self._includers.get(one, ())))

    @cached_property
    def _by_last(self) -> dict[str, list[CodeFile]]:
        return group_pairs((posixpath.basename(path), source) for path, source in self._sources.items())

    @cached_property
    def _included(self) -> dict[str, set[str]]:
        return {
            path: {one for header in source.facts.includes for one in self._find_included(header, source)}
            for path, source in self._sources.items()
        }

    @cached_property
    def _includers(self) -> dict[str, set[str]]:
        found: dict[str, set[str]] = defaultdict(set)
        for path, headers in self._included.items():
            for header in headers:
                found[header].add(path)
        return dict(found)

    def _find_included(self, header: str, source: CodeFile) -> list[str]:
        """The files that an include of a file may mean."""
        beside = posixpath.normpath(posixpath.join(posixpath.dirname(source.path), header))
        if beside in self._sources:
            return [beside]
        ending = "/" + posixpath.normpath(header).lstrip("./")
        named = [one for one in self._by_last.get(posixpath.basename(header), ()) if f"/{one.path}".endswith(ending)]
        found = [one for one in named if self._may_search(f"/{one.path}".removesuffix(ending)[1:], one, source)]
        own = [one for one in found if one.package == source.package]
        return [one.path for one in own or found]

    def _may_search(self, folder: str, file: CodeFile, source: CodeFile) -> bool:
        """Whether a compiler may look in a folder for the header that a file includes. Copies of other packages'
        headers that a package carries, for firmware say, are found by what lies around them alone."""
        parent, name = posixpath.split(folder)
        if name == "include" or posixpath.basename(parent) == "include":
            return True
        top = self._tops[file.package]
        if folder != top and f"{top}/".startswith(f"{folder}/" if folder else ""):
            return True  # `<package/header.h>`
        if file.package != source.package:
            return False
        plain = posixpath.dirname(file.path) == folder
        return plain or top in (folder, parent) or source.path.startswith(f"{folder}/")

    @cached_property
    def _tops(self) -> dict[str, str]:
        """The folder that has all files of a package."""
        folders = group_pairs((one.package, posixpath.dirname(one.path)) for one in self._sources.values())
        return {package: posixpath.commonpath(paths) for package, paths in folders.items()}
