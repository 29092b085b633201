"""Names of other packages that Python files use and that only some stored versions have, or have in the same form."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

import msgspec

from ....edges.memory import cache_method
from ...facts.python.source import PythonFile
from ...facts.python.uses import PythonUse
from ...targets.providers.stdlib import is_in_any_stdlib
from .own_types import OwnTypes

if TYPE_CHECKING:
    from ...targets.surface.store import Surfaces


class Changing:
    """The words by which uses of names that change between versions are told. What they are uses of is told where the
    versions are known, see targets/offers_python.py."""

    def __init__(self, surfaces: Surfaces):
        self._surfaces = surfaces

    @cache_method
    def list_words(self, module: str) -> frozenset[str]:
        """Last parts of the changing names of a top-level module."""
        return frozenset(self._list_words(module))

    def _list_words(self, module: str) -> Iterator[str]:
        for package in list_packages(module):
            # A library has many top-level modules, whose C halves are called after them.
            heads = (module, f"_{module}") if self._surfaces.is_library(package) else ()
            for line in self._surfaces.find_lines(package).values():
                for name in line.events.get("python", ()):
                    parts = name.split(".")
                    if heads and parts[0] not in heads:
                        continue
                    if parts[-1] in ("__init__", "__new__"):
                        yield parts[-2] if len(parts) > 1 else parts[0]
                    elif not parts[-1].startswith("__"):
                        yield parts[-1]

    def is_stored(self, module: str) -> bool:
        """Whether versions of a package that a top-level module may come from are stored."""
        return not self._surfaces.packages.isdisjoint(list_packages(module))

    def may_change(self, name: str) -> bool:
        """Whether a dotted name may be, or lie in, one that changes."""
        head, *parts = name.split(".")
        words = self.list_words(head)
        return bool(words) and (head in words or not words.isdisjoint(parts))


def list_packages(module: str) -> tuple[str, ...]:
    """Packages that a top-level module may come from, or the library that it is part of. In ROS 2 the Python half of a
    package that has both is often one of its own, after which the module is not called."""
    return ("python",) if is_in_any_stdlib(module) else (module, f"{module}_py")


def find_python_packages(files: Iterable[str]) -> set[str]:
    """Names of the folders that are Python packages among some files."""
    return {path.split("/")[-2] for path in files if path.endswith("/__init__.py")}


def find_top_modules(files: Iterable[str]) -> set[str]:
    """The Python modules among some files that lie in no other one, each called as an import begins."""
    packages = {path.removesuffix("/__init__.py") for path in files if path.endswith("/__init__.py")}
    modules = packages.union(path.removesuffix(".py") for path in files if path.endswith(".py"))
    return {path.rpartition("/")[2] for path in modules if path.rpartition("/")[0] not in packages}


def find_uses(facts: PythonFile, own: frozenset[str], changing: Changing, types: OwnTypes,
              path: str) -> Iterator[PythonUse]:  # fmt: skip
    """Uses in one file of names that may have changed, or never been. own: top-level modules of the package itself.
    types: what these have. path: of the file.
    Besides what PythonUse tells, how is `import` for a module that is imported, `from` for a name that is imported from
    one, or a constant, and has not changed, and `name` for any other name."""
    reported: set[str] = set()
    for item in facts.imports:
        head = item.module.partition(".")[0]
        if item.level or head in own or not changing.is_stored(head):
            continue
        if changing.may_change(item.module):
            yield PythonUse(item.module, "import", item.line, item.column, None, "", item.lazy, True, item.conditions)
        for word in item.names:
            name = f"{item.module}.{word}"
            if word != "*" and name not in reported and not changing.may_change(name):
                reported.add(name)
                yield PythonUse(name, "from", item.line, item.column, None, "", item.lazy, True, item.conditions)
    for attribute in facts.attributes:
        head, *_, word = attribute.text.split(".")
        concerned = changing.may_change(attribute.text)
        constant = word.isupper() and attribute.text.count(".") > 1 and attribute.text not in reported
        if head not in own and (concerned or (constant and changing.is_stored(head))):
            yield PythonUse(
                attribute.text, "name" if concerned else "from", attribute.line, attribute.column, None, "",
                attribute.lazy, True, attribute.conditions,
            )  # fmt: skip
    for use in facts.uses:
        if use.name[0] not in ".*" and use.name.partition(".")[0] not in own:
            if changing.may_change(use.name):
                yield use
            continue
        names = types.resolve(path, use.name)
        for name in sorted(names):
            if name and changing.may_change(name):
                yield msgspec.structs.replace(use, name=name, alone=use.alone and len(names) == 1)


def count_unresolved(facts: PythonFile, changing: Changing) -> int:
    """Members that may be such names of what a file imports, of objects whose type is not known. Those of the standard
    library are called as anything is."""
    heads = {item.module.partition(".")[0] for item in facts.imports if not item.level}
    heads = {head for head in heads if not is_in_any_stdlib(head)}
    words = frozenset().union(*map(changing.list_words, heads)) if facts.unknown else frozenset()
    return sum(places for word, places in facts.unknown.items() if word in words)
