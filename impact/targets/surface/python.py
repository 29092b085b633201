"""What a version of a package offers to Python: names, with re-exports followed."""

import builtins
import enum
import re
from collections.abc import Iterable, Iterator
from functools import cached_property
from typing import NamedTuple

from ....edges.groups import group_pairs
from ...facts.python.surface import LATE, Bound, ImportedName, PythonParameter, is_private
from .surface import InstalledModule, PythonSurface


class PythonName(NamedTuple):
    """What a dotted name stands for. where: where it is defined. bound: as written there; None for a module, or for
    what another package gives. conditional: it stands under an `if` or a `try`, so it may not be there."""

    where: str
    kind: str
    bound: Bound | None = None
    conditional: bool = False


UNKNOWN = PythonName("", "unknown")
"""Stands for a name of which it cannot be known whether it is there."""
# Methods that every object has, so that one that is taken away is still there, and those that nobody calls by name.
_OBJECT = frozenset((*dir(object), "__del__", "__slots__", "__post_init__", "__hash__", "__bool__"))
_NO_ATTRIBUTES = frozenset(("object", "ABC", "abc.ABC", "Protocol", "typing.Protocol", "Generic", "typing.Generic"))
# The classes of enumerations, which have no members but those that are written.
_ENUMS = {f"enum.{name}": getattr(enum, name) for name in ("Enum", "Flag", "IntEnum", "IntFlag")}
_DEPTH = 12


class SurfaceNames:
    """The names of a surface, ready to be asked."""

    def __init__(self, surface: PythonSurface):
        self.surface = surface
        self.modules: dict[str, InstalledModule] = {module.name: module for module in surface.modules}
        # What modules lie in, with or without a file of its own.
        self._folders = {name[:at] for name in self.modules for at, char in enumerate(name) if char == "."}
        self._bound: dict[str, dict[str, list[Bound]]] = {}
        self._taken: dict[str, dict[str, list[ImportedName]]] = {}

    def find(self, dotted: str) -> PythonName | None:
        """What a dotted name (`rclpy.node.Node.create_timer`) stands for; None where it is surely not there, UNKNOWN
        where that cannot be known."""
        parts = dotted.split(".")
        for length in range(len(parts), 0, -1):
            module = self.modules.get(".".join(parts[:length]))
            if module is not None:
                return self.follow_names(self.make_module_entry(module), parts[length:])
        if self._is_hidden(dotted) or self.surface.unresolved:
            return UNKNOWN
        if dotted in self._folders:
            return PythonName(dotted, "module")  # a folder without __init__.py
        return None

    def make_module_entry(self, module: InstalledModule) -> PythonName:
        """The entry of a module itself."""
        return PythonName(module.name, "module")

    def follow_names(self, entry: PythonName | None, parts: Iterable[str]) -> PythonName | None:
        """Goes on from an entry, name by name."""
        for part in parts:
            if entry is None or entry.kind in ("unknown", "external"):
                return entry and UNKNOWN
            if entry.kind == "module":
                entry = self._find_in_module(self.modules.get(entry.where), entry.where, part, 0)
            elif entry.kind == "class" and entry.bound is not None:
                entry = self.find_member(entry, part)
            else:
                return UNKNOWN
        return entry

    def _is_hidden(self, dotted: str) -> bool:
        return any(dotted == name or dotted.startswith(f"{name}.") for name in self.surface.unknown)

    def list_bound(self, module: InstalledModule) -> dict[str, list[Bound]]:
        """The names of a module in order of the source, those of classes dotted."""
        known = self._bound.get(module.name)
        if known is None:
            known = self._bound[module.name] = group_pairs((bound.name, bound) for bound in module.surface.names)
        return known

    def index_imports(self, module: InstalledModule) -> dict[str, list[ImportedName]]:
        """The imports of a module by the name they bind."""
        known = self._taken.get(module.name)
        if known is None:
            outside = (taken for taken in module.surface.imports if not taken.scope)
            known = self._taken[module.name] = group_pairs((taken.name, taken) for taken in outside)
        return known

    def _find_in_module(self, module: InstalledModule | None, where: str, name: str, depth: int) -> PythonName | None:
        dotted = f"{where}.{name}"
        if module is not None:
            written = self.list_bound(module).get(name)
            if written:
                return _make_entry(dotted, written)
            for taken in reversed(self.index_imports(module).get(name, ())):
                return self._resolve_import(module, taken, depth)
        if dotted in self.modules or dotted in self._folders:
            return PythonName(dotted, "module")
        if self._is_hidden(dotted):
            return UNKNOWN
        if module is None:
            return None
        unsure = not module.surface.parsed or any(scope == "" for scope, _ in module.surface.open)
        for taken in self.index_imports(module).get("*", ()):
            found = self._find_through_star(module, taken, name, depth)
            if found is UNKNOWN:
                unsure = True
            elif found is not None:
                return found
        return UNKNOWN if unsure else None

    def resolve_target(self, module: InstalledModule, taken: ImportedName) -> str:
        """The dotted name of the module that an import is about."""
        if not taken.level:
            return taken.module
        parts = module.name.split(".")
        up = taken.level - 1 if module.package else taken.level
        parts = parts[: len(parts) - up] if up else parts
        return ".".join([*parts, *([taken.module] if taken.module else [])])

    def _resolve_import(self, module: InstalledModule, taken: ImportedName, depth: int) -> PythonName:
        """What an import binds. It binds something, whatever becomes of it."""
        target = self.resolve_target(module, taken)
        if not taken.original:
            return PythonName(taken.name, "module") if taken.name in self.modules else PythonName(target, "external")
        of = self.modules.get(target)
        if of is None or depth > _DEPTH:
            implicit = ""
            if not taken.level:  # Python 2 looks beside the module first
                implicit = ".".join([*module.name.split(".")[: None if module.package else -1], target])
            of = self.modules.get(implicit)
            if of is None or depth > _DEPTH:
                return PythonName(f"{target}.{taken.original}", "external")
        found = self._find_in_module(of, of.name, taken.original, depth + 1)
        if found is None or found is UNKNOWN:
            return PythonName(f"{target}.{taken.original}", "external")
        return found._replace(conditional=True) if taken.conditions else found

    def _find_through_star(
        self, module: InstalledModule, taken: ImportedName, name: str, depth: int
    ) -> PythonName | None:
        of = self.modules.get(self.resolve_target(module, taken))
        if of is None or depth > _DEPTH:
            return UNKNOWN
        listed = of.surface.all
        if listed is not None and not of.surface.all_open and not any(one.startswith("+") for one in listed):
            if name not in listed:
                return None
        elif name.startswith("_"):
            return None
        return self._find_in_module(of, of.name, name, depth + 1)

    # -- classes

    def find_member(self, entry: PythonName, name: str, depth: int = 0) -> PythonName | None:
        """A member of a class, its base classes included."""
        split = self._split(entry.where)
        if split is None or entry.bound is None or depth > _DEPTH:
            return UNKNOWN
        module, inside = split
        written = self.list_bound(module).get(f"{inside}.{name}")
        if written:
            return _make_entry(f"{entry.where}.{name}", written)
        if any(t.scope == inside and t.name == name for t in module.surface.imports):
            return PythonName(f"{entry.where}.{name}", "external")
        unsure = any(scope == inside for scope, _ in module.surface.open)
        for base in entry.bound.bases:
            found = self.find_in_base(module, inside, base, name, depth)
            if found is UNKNOWN:
                unsure = True
            elif found is not None:
                return found
        return UNKNOWN if unsure else None

    def find_in_base(self, module: InstalledModule, inside: str, base: str, name: str, depth: int) -> PythonName | None:
        """A member by way of a base class, as written."""
        base = base.partition("[")[0].strip()
        if base in _NO_ATTRIBUTES:
            return PythonName(f"object.{name}", "external") if name in _OBJECT else None
        if not re.fullmatch(r"[\w.]+", base):
            return UNKNOWN
        found = self.resolve_base(module, base)
        if (known := _ENUMS.get(base if base in _ENUMS else found.where if found is not None else "")) is not None:
            return PythonName(f"{base}.{name}", "external") if hasattr(known, name) or name[0] == "_" else None
        if found is not None and found.kind == "class":
            return self.find_member(found, name, depth + 1)
        known = getattr(builtins, base, None)
        if found is None and isinstance(known, type):
            return PythonName(f"{base}.{name}", "external") if hasattr(known, name) else None
        return UNKNOWN

    def resolve_base(self, module: InstalledModule, base: str) -> PythonName | None:
        """What the name of a base class stands for in its module."""
        head, *rest = base.split(".")
        return self.follow_names(self._find_in_module(module, module.name, head, 0), rest)

    def _split(self, where: str) -> tuple[InstalledModule, str] | None:
        """The module of something defined here, and its name in it."""
        parts = where.split(".")
        for length in range(len(parts) - 1, 0, -1):
            module = self.modules.get(".".join(parts[:length]))
            if module is not None:
                return module, ".".join(parts[length:])
        return None

    # -- all of them

    @cached_property
    def offered(self) -> dict[str, PythonName]:
        """Every public name that modules offer: their own, and in packages what they re-export. Members of classes are
        not among them, see members()."""
        found: dict[str, PythonName] = {}
        for module in self.surface.modules:
            if any(is_private(part) for part in module.name.split(".")):
                continue
            for name in self.list_bound(module):
                if "." not in name and not is_private(name) and not name.startswith("__"):
                    found[f"{module.name}.{name}"] = _make_entry(f"{module.name}.{name}", self.list_bound(module)[name])
            for name in self.iterate_reexported(module):
                dotted = f"{module.name}.{name}"
                entry = self._find_in_module(module, module.name, name, 0)
                if dotted not in found and entry is not None and entry.kind not in ("unknown", "module"):
                    found[dotted] = entry
        return found

    def iterate_reexported(self, module: InstalledModule, seen: frozenset[str] = frozenset()) -> Iterator[str]:
        """Public names that a module has from others of its package and means to offer: what is in its `__all__`, and
        in an `__init__.py` what it imports from below itself; what it takes from elsewhere it needs for itself. seen:
        modules that lead here, as they may take all names from each other."""
        listed = module.surface.all or ()
        for name, taken in self.index_imports(module).items():
            for one in taken:
                own = f"{self.resolve_target(module, one)}.".startswith(f"{module.name}.")
                if name == "*" and own:
                    of = self.modules.get(self.resolve_target(module, one))
                    yield from self.iterate_starred(of, seen | {module.name}) if of is not None else ()
                elif name != "*" and not is_private(name) and (name in listed or (own and module.package)):
                    yield name

    def iterate_starred(self, module: InstalledModule, seen: frozenset[str] = frozenset()) -> Iterator[str]:
        """Names that `from module import *` gives, as far as they are written. seen: as of iterate_reexported()."""
        if module.surface.all is not None:
            yield from (name for name in module.surface.all if not name.startswith("+"))
            return
        yield from (name for name in self.list_bound(module) if "." not in name and not name.startswith("_"))
        if module.package and module.name not in seen:
            yield from self.iterate_reexported(module, seen)

    def list_members(self, entry: PythonName) -> dict[str, PythonName]:
        """Public members that a class itself has, and `__init__`."""
        split = self._split(entry.where)
        if split is None:
            return {}
        module, inside = split
        found = {}
        for name, written in self.list_bound(module).items():
            head, _, last = name.rpartition(".")
            if head == inside and (last == "__init__" or not (is_private(last) or last in _OBJECT)):
                found[last] = _make_entry(f"{entry.where}.{last}", written)
        if "__init__" not in found:
            fields = self.list_dataclass_fields(entry, 0)
            if fields is not None:
                found["__init__"] = PythonName(
                    f"{entry.where}.__init__", "method", Bound("__init__", "method", 0, tuple(fields.values()))
                )
        return found

    def list_dataclass_fields(self, entry: PythonName, depth: int) -> dict[str, PythonParameter] | None:
        """The constructor's parameters of a dataclass; None for any other class, and where a base cannot be known."""
        split = self._split(entry.where)
        if entry.bound is None or split is None or depth > _DEPTH:
            return None
        module, inside = split
        if not any(d.rpartition(".")[2] == "dataclass" for d in entry.bound.decorators):
            return None
        found: dict[str, PythonParameter] = {}
        for base in reversed(entry.bound.bases):
            of = self.resolve_base(module, base.partition("[")[0])
            more = self.list_dataclass_fields(of, depth + 1) if of is not None and of.kind == "class" else None
            if more is None and base not in _NO_ATTRIBUTES:
                return None
            found.update(more or {})
        for bound in module.surface.names:
            head, _, last = bound.name.rpartition(".")
            field = head == inside and bound.kind == "attribute" and bound.annotation
            if field and not re.match(r"['\"]?(?:typing\.)?ClassVar\b", bound.annotation):
                # Which value it has by default is told where that is a literal.
                found[last] = PythonParameter(last, "normal", bound.value or "?", bound.annotation)
        return found


def _make_entry(dotted: str, written: list[Bound]) -> PythonName:
    """What several bindings of one name come to: the last that does not depend on a condition, else the first."""
    written = [b for b in written if not any(c.text == "overload" for c in b.conditions)] or written
    plain = [b for b in written if not b.conditions]
    bound = plain[-1] if plain else written[0]
    others = [b for b in written if b.conditions and LATE not in b.conditions]
    return PythonName(dotted, bound.kind, bound, not plain or bool(others))


_KEEPS = frozenset((
    "property", "cached_property", "abstractproperty", "staticmethod", "classmethod", "abstractmethod", "overload",
    "abstractclassmethod", "abstractstaticmethod", "contextmanager", "asynccontextmanager", "cache", "lru_cache",
    "override", "final", "deprecated", "deprecate", "dataclass", "no_type_check", "wraps", "coroutine",
))  # fmt: skip
"""Decorators that leave the parameters as they are."""


def is_wrapped(bound: Bound) -> bool:
    """True where a decorator that is not known may give it other parameters."""
    return any(decorator.rpartition(".")[2] not in _KEEPS for decorator in bound.decorators)


def is_callable(kind: str) -> bool:
    """Whether things of this kind are functions."""
    return kind in ("function", "method", "classmethod", "staticmethod")


def describe(entry: PythonName) -> str:
    """What stands behind a name where it is defined: parameters, bases or a value."""
    bound = entry.bound
    if bound is None:
        return entry.where
    if is_callable(bound.kind):
        return write_signature(bound.parameters)
    return f"({', '.join(bound.bases)})" if bound.kind == "class" else bound.value


def write_signature(parameters: Iterable[PythonParameter]) -> str:
    """Parameters as Python writes them, without annotations."""
    texts: list[str] = []
    last = ""
    for parameter in parameters:
        if last == "positional" and parameter.kind != "positional":
            texts.append("/")
        if parameter.kind == "keyword" and last not in ("keyword", "args"):
            texts.append("*")
        star = {"args": "*", "kwargs": "**"}.get(parameter.kind, "")
        default = "" if parameter.default is None else f"={parameter.default}"
        texts.append(f"{star}{parameter.name}{default}")
        last = parameter.kind
    if last == "positional":
        texts.append("/")
    return f"({', '.join(texts)})"
