"""Headers that bring back a name which a library took out of its usual ones (`_c.h` for OpenCV's C constants)."""

from functools import cached_property
from typing import Literal

from ...model.package import is_header
from ...targets.changes import excuses
from ...targets.providers.library import include_roots
from ...targets.target import ChangeInForce
from ..vocabulary import Package, TargetView

_CMAKE_NAME = {"opencv": "OpenCV", "boost": "Boost", "pcl": "PCL"}


class Headers:
    """What the files of a package include."""

    def __init__(self, view: TargetView, package: Package):
        self._view, self._package = view, package

    @cached_property
    def _included(self) -> dict[str, set[str]]:
        """What each file includes of others, with what the package's own headers do, since any of them may come
        before."""
        includes = self._package.digest.includes
        found: dict[str, set[str]] = {}
        found[""] = shared = {i.path for i in includes if is_header(i.at.path)}
        for include in includes:
            found.setdefault(include.at.path, set(shared)).add(include.path)
        return found

    def bring_back(self, file: str, change: ChangeInForce) -> Literal["yes", "maybe", "no"]:
        """Whether a file has a name in spite of a change, by what it includes."""
        paths = self._included.get(file, self._included[""])
        endings = excuses(change)
        if any(self._brings(change, endings, path) for path in paths):
            return "yes"
        return "maybe" if any(self._may_bring(change, path) for path in paths) else "no"

    def _brings(self, change: ChangeInForce, endings: tuple[str, ...], path: str) -> bool:
        """True for headers that bring the name back, and for those of other packages that include one of the library's
        that does, at whatever distance."""
        roots = include_roots(change.package)
        if path.endswith(endings) or not roots or path.startswith(roots):
            return path.endswith(endings)
        return any(h.startswith(roots) and h.endswith(endings) for h in self._view.machine.brought(path).headers)

    def _may_bring(self, change: ChangeInForce, path: str) -> bool:
        """True for headers of packages that depend on the changed library, and of nobody known."""
        view = self._view
        if path.startswith(include_roots(change.package) or "\0") or view.is_standard(path):
            return False
        providers = view.header(path)
        keys = {provider.name for provider in view.cmake(_CMAKE_NAME.get(change.package, change.package))}
        return not providers or any(p.kind == "ros" and not keys.isdisjoint(view.spread((p.name,))) for p in providers)
