"""Headers that packages of a workspace offer each other, by the paths that others include them with."""

from __future__ import annotations

import hashlib
import posixpath
from collections.abc import Iterable, Mapping

from ....edges.memory import cache_method
from ....edges.reach import walk
from ...facts.cpp.lexical import CppFile
from ...facts.extract import ExtractedFacts


class OfferedHeaders:
    """The headers below the folders `include` of packages. folders: the paths of the files of each package, by its
    folder. What several packages offer under one path is left out, since it depends on the build which is taken."""

    def __init__(self, folders: Mapping[str, Iterable[str]], extraction: ExtractedFacts):
        self.extraction = extraction
        self._paths: dict[str, str] = {}
        self._owners: dict[str, str] = {}
        for folder, paths in folders.items():
            below = f"{folder}/include/" if folder else "include/"
            for path in paths:
                if path.startswith(below) and extraction.kinds.get(path) == "cpp":
                    include = path[len(below) :]
                    self._paths[include] = "" if include in self._paths else path
                    self._owners[path] = folder
        rows = "\n".join(f"{include} {path}" for include, path in sorted(self._paths.items()))
        self.key = hashlib.sha1(rows.encode("utf-8", "surrogateescape")).hexdigest()
        """Differs whenever other headers are offered, whatever they say."""

    def find(self, include: str, folder: str) -> str:
        """The header of another package than that of a folder, which an include path names; empty where none is."""
        path = self._paths.get(include, "")
        return path if path and self._owners[path] != folder else ""

    @cache_method
    def list_words(self, header: str) -> frozenset[str]:
        """Every word of a header, as collect_words() has them."""
        facts = self._get_facts(header)
        return collect_words(facts) if facts is not None else frozenset()

    @cache_method
    def list_with(self, header: str) -> frozenset[str]:
        """A header, and all that it includes, directly or not, and that packages of the workspace offer."""
        return frozenset(at for at in walk([header], self._list_included) if self._get_facts(at) is not None)

    def _get_facts(self, header: str) -> CppFile | None:
        return self.extraction.get_facts(header).facts

    @cache_method
    def _list_included(self, header: str) -> tuple[str, ...]:
        beside, facts = posixpath.dirname(header), self._get_facts(header)
        found = []
        for include in facts.includes if facts is not None else ():
            near = posixpath.normpath(posixpath.join(beside, include.path))
            to = near if near in self._owners else self._paths.get(include.path, "")
            if to:
                found.append(to)
        return tuple(found)

    def describe(self, header: str) -> str:
        """What a linked package that rests on a header remembers of it: its content id, then what its code says,
        without comments, and which headers it includes."""
        facts = self._get_facts(header)
        included = hashlib.sha1("\n".join(self._list_included(header)).encode("utf-8", "surrogateescape")).hexdigest()
        return f"{self.extraction.ids[header]} {facts.code if facts is not None else ''}{included[:8]}"

    def is_unchanged(self, header: str, described: str) -> bool:
        """Whether a header says what it did when it was described."""
        content, _, code = described.partition(" ")
        now = self.extraction.ids.get(header, "")
        return now == content or (header in self._owners and self.describe(header).partition(" ")[2] == code)


def collect_words(facts: CppFile) -> frozenset[str]:
    """Every word of a C++ file, and all parts of its qualified names."""
    parts = (part for name in facts.qualified for part in name.text.split("::"))
    return frozenset((*facts.words.split(" "), *facts.short.split(" "), *parts, *facts.using, *facts.opened))
