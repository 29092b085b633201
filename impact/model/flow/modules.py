"""What names of Python mean across files: their own file's first, else what is imported, else nothing."""

from __future__ import annotations

import posixpath
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from typing import Literal, NamedTuple

from ....edges.groups import group_pairs
from ...facts.flow import Alias, FlowFile
from ...facts.python.text import join_dotted

Kind = Literal["class", "function", "constant"]
# Modules that hand on a name from one another.
_FURTHEST = 5


class CodeFile(NamedTuple):
    """A file of the code. package: its name, empty for none."""

    path: str
    package: str
    facts: FlowFile


class PythonModules:
    """The modules of a body of code. aliases: of all files by path and name; find_alias: what a name is imported as in
    a file and scope."""

    def __init__(
        self, sources: Sequence[CodeFile], aliases: Mapping[str, Mapping[str, list[Alias]]],
        find_alias: Callable[[str, CodeFile, str], Alias | None],
    ):  # fmt: skip
        self._sources = {source.path: source for source in sources if source.facts.language == "python"}
        self._aliases, self._find_alias = aliases, find_alias
        self._known: dict[tuple[Kind, str, str, str], tuple[str, str] | None] = {}
        self._defined: dict[tuple[Kind, str], frozenset[str]] = {}
        self._modules: dict[tuple[tuple[str, ...], str], CodeFile | None] = {}
        self._imported: dict[str, list[CodeFile]] = {}

    def find(self, kind: Kind, name: str, source: CodeFile, scope: str = "") -> tuple[str, str] | None:
        """The file and the name in it of what a name means in a file and scope; None for what is not in the code, or
        may be in several files. name: as written, or with its module."""
        key = (kind, name, source.path, scope)
        if key not in self._known:
            self._known[key] = self._find(kind, name, source, scope)
        return self._known[key]

    def _find(self, kind: Kind, name: str, source: CodeFile, scope: str) -> tuple[str, str] | None:
        inside, defined = scope, self._list_defined(kind, source)
        while inside:
            if f"{inside}.{name}" in defined:
                return source.path, f"{inside}.{name}"
            inside = inside.rpartition(".")[0]
        head, dot, rest = name.partition(".")
        alias = self._find_alias(head, source, scope) if head and name not in defined else None
        found = self._find_imported(kind, f"{alias.target}{dot}{rest}", source, 0) if alias is not None else None
        found = found or (self._find_in(kind, name, source, 0) if head else None)
        return found or (self._find_imported(kind, name, source, 0) if dot else None)

    def _find_in(self, kind: Kind, name: str, source: CodeFile, depth: int) -> tuple[str, str] | None:
        """What a module has under a name, itself or from others."""
        if name in self._list_defined(kind, source):
            return source.path, name
        if depth == _FURTHEST:
            return None
        head, dot, rest = name.partition(".")
        aliases = self._aliases[source.path]
        targets = [f"{alias.target}{dot}{rest}" for alias in aliases.get(head, ()) if not alias.scope]
        stars = [alias.target for alias in aliases.get("*", ())]
        targets += [join_dotted(star, name) for star in stars]
        # Of several that have it, the last that is imported.
        found = (self._find_imported(kind, target, source, depth + 1) for target in reversed(targets))
        return next(filter(None, found), None)

    def _find_imported(self, kind: Kind, target: str, source: CodeFile, depth: int) -> tuple[str, str] | None:
        """What a name with its module means to a file that imports it."""
        found = (self._find_in(kind, name, module, depth) for module, name in self._list_beginnings(target, source))
        return next(filter(None, found), None)

    def find_beginning(self, target: str, source: CodeFile) -> tuple[CodeFile, str] | None:
        """The module that a name with its module begins with, to a file that imports it, and the rest of the name."""
        return next(self._list_beginnings(target, source), None)

    def _list_beginnings(self, target: str, source: CodeFile) -> Iterator[tuple[CodeFile, str]]:
        """All of them, the longest first."""
        up = len(target) - len(target.lstrip("."))
        path = target[up:].split(".")
        for cut in range(len(path) - 1, -1 if up else 0, -1):
            module = self.find_module(path[:cut], source, up)
            if module is not None and module is not source:
                yield module, ".".join(path[cut:])

    def list_imported(self, source: CodeFile) -> list[CodeFile]:
        """The modules that a file imports, or imports something of."""
        known = self._imported.get(source.path)
        if known is not None:
            return known
        found: dict[str, CodeFile] = {}
        for alias in source.facts.aliases:
            name = alias.target.lstrip(".")
            path, up = tuple(filter(None, name.split("."))), len(alias.target) - len(name)
            for module in (self.find_module(path, source, up), self.find_module(path[:-1], source, up)):
                if module is not None and module is not source:
                    found[module.path] = module
        return self._imported.setdefault(source.path, list(found.values()))

    def find_module(self, module: Sequence[str], source: CodeFile, up: int = 0) -> CodeFile | None:
        """The file that a module is to a file that imports it. up: dots before the module's name."""
        folder = source.path.split("/")[:-1]
        if up:
            if up > len(folder) + 1:
                return None
            path = "/".join((*folder[: len(folder) - up + 1], *module))
            return self._sources.get(f"{path}.py") or self._sources.get(f"{path}/__init__.py".lstrip("/"))
        key = (tuple(module), "/".join((source.package, *folder)))
        if key not in self._modules:
            self._modules[key] = self._find_absolute(list(module), folder, source.package)
        return self._modules[key]

    def _find_absolute(self, module: list[str], folder: list[str], package: str) -> CodeFile | None:
        rated: dict[tuple[int, int], list[CodeFile]] = {}
        for parts, candidate in self._by_last.get(module[-1], ()) if module else ():
            if parts[-len(module) :] != module:
                continue
            root = parts[: -len(module)]
            own = candidate.package == package
            if not own and len(module) == 1 and not candidate.path.endswith("/__init__.py"):
                continue  # a program's own helper, which no other package finds
            is_root = "/".join((*root, "__init__.py")) not in self._sources
            near = len(posixpath.commonpath(("/".join(root), "/".join(folder))).split("/"))
            rated.setdefault((4 * (root == folder) + 2 * own + is_root, near), []).append(candidate)
        found = rated[max(rated)] if rated else []
        return found[0] if len(found) == 1 else None

    @cached_property
    def _by_last(self) -> dict[str, list[tuple[list[str], CodeFile]]]:
        """Files by the last part of the module that they are, with all parts of the path."""
        paths = ((path.removesuffix(".py").removesuffix("/__init__"), source) for path, source in self._sources.items())
        rows = ((path.split("/"), source) for path, source in paths)
        return group_pairs((parts[-1], (parts, source)) for parts, source in rows)

    def _list_defined(self, kind: Kind, source: CodeFile) -> frozenset[str]:
        """Names of what a file defines itself, those inside functions and classes with their scopes."""
        known = self._defined.get((kind, source.path))
        if known is None:
            facts = source.facts
            every = {
                "class": (cls.name for cls in facts.classes),
                "function": (fn.name for fn in facts.functions if fn.name and not fn.owner),
                "constant": (constant.name for constant in facts.constants),
            }
            known = self._defined[kind, source.path] = frozenset(every[kind])
        return known
