"""Names that a library took out of its usual headers, and that others of its headers bring back."""

from __future__ import annotations

from functools import cached_property
from typing import Literal

from ..targets.providers.library import include_roots
from .package import is_header
from .view import TargetView
from .workspace import Package

_CMAKE_NAME = {"opencv": "OpenCV", "boost": "Boost", "pcl": "PCL"}


class ReturnedNames:
    """What the files of a package include: some headers bring back a name which a library took out of its usual ones
    (`_c.h` for OpenCV's C constants)."""

    def __init__(self, view: TargetView, package: Package):
        self._view, self._package = view, package

    @cached_property
    def _included(self) -> dict[str, set[str]]:
        """What each file includes of others, with what the package's own headers do, since any of them may come
        before."""
        includes = self._package.linked.includes
        found: dict[str, set[str]] = {}
        found[""] = shared = {i.path for i in includes if is_header(i.at.path)}
        for include in includes:
            found.setdefault(include.at.path, set(shared)).add(include.path)
        return found

    def bring_back(self, file: str, library: str, endings: tuple[str, ...]) -> Literal["yes", "maybe", "no"]:
        """Whether a file has a name that a library took out, by what it includes. endings: of what brings it back."""
        paths = self._included.get(file, self._included[""])
        if any(self._brings(library, endings, path) for path in paths):
            return "yes"
        return "maybe" if any(self._may_bring(library, path) for path in paths) else "no"

    def _brings(self, library: str, endings: tuple[str, ...], path: str) -> bool:
        """True for headers that bring the name back, and for those of other packages that include one of the library's
        that does, at whatever distance."""
        roots = include_roots(library)
        if path.endswith(endings) or not roots or path.startswith(roots):
            return path.endswith(endings)
        return any(h.startswith(roots) and h.endswith(endings) for h in self._view.machine.find_brought(path).headers)

    def _may_bring(self, library: str, path: str) -> bool:
        """True for headers of packages that depend on the changed library, and of nobody known."""
        view = self._view
        if path.startswith(include_roots(library) or "\0") or view.is_standard(path):
            return False
        providers = view.find_header(path)
        keys = {provider.name for provider in view.find_cmake(_CMAKE_NAME.get(library, library))}
        return not providers or any(
            p.kind == "ros" and not keys.isdisjoint(view.list_transitive((p.name,))) for p in providers
        )
