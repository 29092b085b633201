"""What names of a package's own Python modules are of other packages: base classes, functions and instances that one
file declares and others use."""

from __future__ import annotations

import sys
from collections.abc import Collection, Mapping

from ...facts.python.reader import Import
from ...facts.python.source import PythonFile
from ...facts.python.text import join_dotted
from ...facts.python.uses import CONSTRUCTORS, OWN, STARRED, TypedName
from .undefined import PackageModules

# Steps from one name to another, which may go in circles.
_DEEPEST = 20


class OwnTypes:
    """The names of the Python files of a package. own: the top-level modules of the package."""

    def __init__(self, files: Mapping[str, PythonFile], own: Collection[str]):
        self._files, self._own = files, own
        self._modules = PackageModules(files, (), ())
        self._typed: dict[str, dict[str, TypedName]] = {}

    def resolve(self, path: str, name: str, depth: int = 0) -> set[str]:
        """The names of other packages that a dotted name in a file may be, empty for one that is not known; none where
        the package has it itself. A class is those of its bases that its objects are constructed by."""
        if not name or depth > _DEEPEST:
            return {""}
        parts = name.lstrip(".").split(".")
        if name[0] == OWN:
            return self._follow(path, name[1:].split("."), depth)
        if name[0] == STARRED:
            return self._follow_starred(path, parts[1:], depth)
        if name[0] != "." and parts[0] not in self._own:
            return {name}
        level = len(name) - len(name.lstrip("."))
        for length in range(len(parts), -1 if level else 0, -1):
            module = self._modules.find(path, Import(".".join(parts[:length]), (), level, 0, 0))
            if module is not None and module != path:
                return self._follow(module, parts[length:], depth) if parts[length:] else set()
        return {""}

    def _follow(self, path: str, parts: list[str], depth: int) -> set[str]:
        """The same of a name of a module."""
        head, *rest = parts
        typed = self._load_typed(path)
        found = typed.get(head)
        if found is None:
            return self._follow_imported(path, parts, depth)
        if not found.members:
            return self.resolve(path, ".".join((found.types[0], *rest)), depth + 1) if rest and found.types[0] else {""}
        held = typed.get(f"{head}.{rest[0]}") if rest else None
        if held is not None:
            return self.resolve(path, ".".join((held.types[0], *rest[1:])), depth + 1) if rest[1:] else set()
        if any(f" {name} " in found.members for name in ((rest[0], "__getattr__") if rest else CONSTRUCTORS)):
            return {""} if rest[1:] else set()
        names: set[str] = set()
        for base in found.types:
            given = self.resolve(path, ".".join((base, *rest)) if base else "", depth + 1)
            if not given:
                return given
            names |= given
        return names

    def _follow_imported(self, path: str, parts: list[str], depth: int) -> set[str]:
        """The same of a name that a module imports itself, in any case and only once."""
        named = [item for item in self._files[path].imports if parts[0] in (item.called or item.names)]
        if not named:
            return self._follow_starred(path, parts, depth)
        if len(named) != 1 or named[0].lazy or named[0].conditions:
            return {""}
        (item,) = named
        original = item.names[(item.called or item.names).index(parts[0])]
        dotted = join_dotted("." * item.level + item.module, original)
        return self.resolve(path, ".".join((dotted, *parts[1:])), depth + 1)

    def _follow_starred(self, path: str, parts: list[str], depth: int) -> set[str]:
        """The same of a name that a star import of a module of the package brings; the last one holds."""
        for item in reversed(self._files[path].imports):
            if "*" in item.names and item.module.partition(".")[0] not in sys.stdlib_module_names:
                module = self._modules.find(path, item)
                bound = self._files[module].bound if module is not None else ""
                if module is not None and module != path and (not bound or f" {parts[0]} " in bound):
                    return self._follow(module, parts, depth + 1) if depth < _DEEPEST else {""}
                if not bound:
                    break
        return {""}

    def _load_typed(self, path: str) -> dict[str, TypedName]:
        if path not in self._typed:
            self._typed[path] = {one.name: one for one in self._files[path].typed}
        return self._typed[path]
