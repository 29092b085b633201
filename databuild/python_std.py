"""Adds Python's standard library to data/surfaces.sqlite: what each version of Python 3 offers, by typeshed's stubs.

    python -P -m rosimpact.databuild.python_std STUBS... --output DATA

STUBS are folders `stdlib` of typeshed, oldest first, as mypy's wheels carry them (`mypy/typeshed/stdlib`; the first
with a file VERSIONS came with mypy 0.900). A state of typeshed tells of the versions that its conditions name; what one
version has more or less than the next is told by the newest state that tells of both, so that stubs that were completed
meanwhile are no change. Of overloaded functions the parameters are not kept, of nothing the types, and
what all versions have alike is left out, but for classes and what is called like something that changed.
"""

from __future__ import annotations

import argparse
import ast
from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cached_property
from pathlib import Path

import msgspec

from ..impact.facts.python.surface import Bound, ImportedName, ModuleSurface
from ..impact.targets.changes import load_rows
from ..impact.targets.snapshot import load_snapshot
from ..impact.targets.surface.python import UNKNOWN, SurfaceNames
from ..impact.targets.surface.surface import BuildSurface, InstalledModule, PythonSurface, Surface
from ..impact.targets.tables import DATA
from .extract.python import extract
from .jobs import Packing
from .surface.compare import RepositorySurfaces
from .surface_file import read_packages, write

PACKAGE = "python"
"""The platform library that the surfaces are of."""
GENERATION = 0
"""Of ROS, in the file of surfaces: neither."""
_OLDEST = 4
# Stubs of other systems, of Python 2, and of what only tools import.
_ASIDE = frozenset(("@python2", "_msi", "_typeshed", "_winapi", "idlelib", "lib2to3", "msilib", "msvcrt", "winreg",
                    "winsound"))  # fmt: skip


class Stubs:
    """A state of typeshed's stubs of the standard library. folder: that has VERSIONS."""

    def __init__(self, folder: Path):
        self.folder = folder
        self._read: dict[int, dict[str, InstalledModule]] = {}

    @cached_property
    def lifetimes(self) -> dict[str, tuple[int, int]]:
        """Modules with the first and last minor version of Python 3 that has each."""
        found = {}
        for line in (self.folder / "VERSIONS").read_text(encoding="utf-8").splitlines():
            name, colon, span = line.partition("#")[0].partition(":")
            if colon:
                first, _, last = span.strip().partition("-")
                found[name.strip()] = (_get_minor(first), _get_minor(last) if last else 99)
        return found

    @cached_property
    def files(self) -> dict[str, Path]:
        """The stub of each module."""
        found = {}
        for path in sorted(self.folder.rglob("*.pyi")):
            parts = path.relative_to(self.folder).with_suffix("").parts
            if parts[0] not in _ASIDE:
                found[".".join(parts).removesuffix(".__init__")] = path
        return found

    @cached_property
    def span(self) -> tuple[int, int]:
        """The first and last minor version that it tells of: conditions of older ones were dropped."""
        asked = {
            minor
            for path in self.files.values()
            for node in ast.walk(ast.parse(path.read_bytes()))
            if isinstance(node, ast.Compare) and (minor := _get_asked_minor(node)) is not None and minor > 0
        }
        return max(min(asked) - 1, _OLDEST), max(asked)

    def read_modules(self, minor: int) -> dict[str, InstalledModule]:
        """The modules of a minor version."""
        if minor not in self._read:
            self._read[minor] = dict(self._iterate_modules(minor))
        return self._read[minor]

    def _iterate_modules(self, minor: int) -> Iterator[tuple[str, InstalledModule]]:
        for name, path in self.files.items():
            first, last = self._find_lifetime(name)
            if first <= minor <= last:
                surface = extract(prepare_stub(path.read_bytes(), minor))
                public = tuple(bound for bound in surface.names if not bound.private)
                surface = msgspec.structs.replace(surface, names=public)
                yield name, InstalledModule(name, "", path.name == "__init__.pyi", surface)

    def _find_lifetime(self, module: str) -> tuple[int, int]:
        while module:
            if module in self.lifetimes:
                return self.lifetimes[module]
            module = module.rpartition(".")[0]
        return 1, 0


def _get_minor(version: str) -> int:
    major, _, minor = version.partition(".")
    return int(minor or 0) if major == "3" else 0


def _get_asked_minor(node: ast.Compare) -> int | None:
    """The minor version of Python 3 in a comparison of sys.version_info, None for what is none."""
    if ast.unparse(node.left) != "sys.version_info" or len(node.comparators) != 1:
        return None
    try:
        asked = ast.literal_eval(node.comparators[0])
    except ValueError:
        return None
    return asked[1] if isinstance(asked, tuple) and asked[:1] == (3,) and len(asked) > 1 else 0


class _Resolver(ast.NodeTransformer):
    """Makes of a stub a module of one minor version on Linux: conditions decided, names bound that stubs only announce,
    overloads without their parameters, and no types. What is deprecated without a condition was so at some time, and
    nobody knows since when."""

    def __init__(self, minor: int):
        self._minor = minor
        self._conditions = 0

    def visit_If(self, node: ast.If) -> list[ast.stmt]:
        holds = self._decide(node.test)
        chosen = [*(node.body if holds is not False else ()), *(node.orelse if holds is not True else ())]
        self._conditions += 1
        made = [one for statement in chosen for one in self._visit_each(statement)]
        self._conditions -= 1
        return made

    def _drop_deprecations(self, node: ast.ClassDef | ast.FunctionDef | ast.AsyncFunctionDef) -> None:
        if not self._conditions:
            kept = (one for one in node.decorator_list if not ast.unparse(one).startswith("deprecated"))
            node.decorator_list = list(kept)

    def _visit_each(self, statement: ast.stmt) -> list[ast.stmt]:
        made = self.visit(statement)
        return made if isinstance(made, list) else [made] if made is not None else []

    def _decide(self, test: ast.expr) -> bool | None:
        """Whether a condition holds; None where it cannot be known."""
        if isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
            inner = self._decide(test.operand)
            return None if inner is None else not inner
        if isinstance(test, ast.BoolOp):
            every = [self._decide(value) for value in test.values]
            decisive = isinstance(test.op, ast.Or)
            return decisive if decisive in every else None if None in every else not decisive
        if not isinstance(test, ast.Compare) or len(test.comparators) != 1:
            return False if ast.unparse(test) == "TYPE_CHECKING" else None
        try:
            asked = ast.literal_eval(test.comparators[0])
        except ValueError:
            return None
        left, here = ast.unparse(test.left), (3, self._minor, 0, "final", 0)
        if left == "sys.version_info" and isinstance(asked, tuple):
            return {ast.GtE: here >= asked, ast.Lt: here < asked}.get(type(test.ops[0]))
        if left == "sys.platform":
            return {ast.Eq: asked == "linux", ast.NotEq: asked != "linux"}.get(type(test.ops[0]))
        return None

    def visit_AnnAssign(self, node: ast.AnnAssign) -> ast.Assign:
        return ast.Assign([node.target], node.value or ast.Constant(...))

    def visit_arg(self, node: ast.arg) -> ast.arg:
        node.annotation = None
        return node

    def visit_ClassDef(self, node: ast.ClassDef) -> ast.ClassDef:
        self._drop_deprecations(node)
        node.body = [one for statement in node.body for one in self._visit_each(statement)] or [ast.Pass()]
        return node

    def visit_FunctionDef(self, node: ast.FunctionDef | ast.AsyncFunctionDef):
        self._drop_deprecations(node)
        if any(ast.unparse(one).rpartition(".")[2] == "overload" for one in node.decorator_list):
            first = node.args.args[:1] if node.args.args and node.args.args[0].arg in ("self", "cls") else []
            node.args = ast.arguments([], first, ast.arg("args"), [], [], ast.arg("kwargs"), [])
            kept = (one for one in node.decorator_list if ast.unparse(one) in ("classmethod", "staticmethod"))
            node.decorator_list = list(kept)
        old = [one for one in node.args.args if one.arg.startswith("__") and not one.arg.endswith("__")]
        if old:  # how positional parameters were written before Python 3.8
            place = node.args.args.index(old[-1]) + 1
            node.args.posonlyargs, node.args.args = node.args.args[:place], node.args.args[place:]
        node.returns, node.body = None, [ast.Pass()]
        self.visit(node.args)
        return node

    def visit_AsyncFunctionDef(self, node: ast.AsyncFunctionDef):
        return self.visit_FunctionDef(node)


def prepare_stub(data: bytes, minor: int) -> bytes:
    """A stub as a module of one minor version of Python 3."""
    tree = _Resolver(minor).visit(ast.parse(data))
    tree = _Hider(tree).visit(tree)
    return ast.unparse(ast.fix_missing_locations(tree)).encode()


# A decorator, and bases without members, that readers of surfaces know by their names.
_KNOWN_BY_NAME = ("ABC", "Generic", "Protocol", "deprecated")


class _Hider(ast.NodeTransformer):
    """Gives what a stub imports for itself a private name: only `import a as a`, and what `__all__` lists, is there for
    those who import the module (PEP 484)."""

    def __init__(self, tree: ast.Module):
        exported = {
            one.value
            for node in ast.walk(tree)
            if isinstance(node, (ast.Assign, ast.AugAssign))
            and "__all__" in map(ast.unparse, node.targets if isinstance(node, ast.Assign) else [node.target])
            for one in ast.walk(node.value)
            if isinstance(one, ast.Constant)
        }
        self._names = {
            alias.name: f"_own_{alias.name}"
            for node in ast.walk(tree)
            if isinstance(node, (ast.Import, ast.ImportFrom))
            for alias in node.names
            if alias.asname is None and alias.name.isidentifier() and alias.name not in exported
        }
        for name in _KNOWN_BY_NAME:
            self._names.pop(name, None)

    def visit_alias(self, node: ast.alias) -> ast.alias:
        if node.asname is None:
            node.asname = self._names.get(node.name)
        return node

    def visit_Name(self, node: ast.Name) -> ast.Name:
        node.id = self._names.get(node.id, node.id)
        return node


def read_versions(states: Iterable[Stubs]) -> dict[int, dict[str, InstalledModule]]:
    """The modules of every minor version that one of the states tells of. states: oldest first."""
    ordered = sorted(states, key=lambda one: one.span[1])
    newest = ordered[-1]
    found = {minor: newest.read_modules(minor) for minor in range(newest.span[0], newest.span[1] + 1)}
    while (minor := min(found) - 1) >= ordered[0].span[0]:
        telling = [one for one in ordered if one.span[0] <= minor < one.span[1]]
        if not telling:
            break
        state = telling[-1]
        found[minor] = _go_back(found[minor + 1], state.read_modules(minor), state.read_modules(minor + 1))
    return dict(sorted(found.items()))


def _go_back(
    after: Mapping[str, InstalledModule], old: Mapping[str, InstalledModule], new: Mapping[str, InstalledModule]
) -> dict[str, InstalledModule]:
    """The modules of a version. after: those of the next one; old, new: how a state of the stubs tells of both."""
    found = {}
    before = SurfaceNames(PythonSurface(PACKAGE, tuple(old.values())))
    for name, module in after.items():
        if name in new and name not in old:
            continue
        if name in new and new[name].surface != old[name].surface:
            surface = _change_back(module.surface, old[name].surface, new[name].surface)
            # What another module defined before, and this one took from there, was here all the same.
            every = {one.name for one in module.surface.names}
            moved = {one for one in every if before.find(f"{name}.{one}") not in (None, UNKNOWN)}
            kept = {one.name for one in surface.names}
            back = (one for one in module.surface.names if one.name in moved - kept)
            surface = msgspec.structs.replace(surface, names=(*surface.names, *back))
            module = msgspec.structs.replace(module, surface=surface)
        found[name] = module
    found.update({name: module for name, module in old.items() if name not in new and name not in after})
    return dict(sorted(found.items()))


def _change_back(after: ModuleSurface, old: ModuleSurface, new: ModuleSurface) -> ModuleSurface:
    names = _merge(after.names, old.names, new.names)
    imports = _merge(after.imports, old.imports, new.imports)
    everything = after.all if old.all == new.all else old.all
    return msgspec.structs.replace(after, names=names, imports=imports, all=everything)


def _merge(after: tuple, old: tuple, new: tuple) -> tuple:
    """The names of a version, from those of the next one and from what a state of the stubs tells of both."""

    had, has, here = _index_names(old), _index_names(new), _index_names(after)
    kept = {name: had.get(name, items) if had.get(name) != has.get(name) and name in has else items
            for name, items in here.items() if name in had or name not in has}  # fmt: skip
    back = {name: items for name, items in had.items() if name not in has and name not in here}
    return tuple(item for items in (*kept.values(), *back.values()) for item in items)


def leave_out_alike(versions: Mapping[int, Mapping[str, InstalledModule]]) -> dict[int, dict[str, InstalledModule]]:
    """The versions without what never changes: a name that is not there is not asked about. Kept are classes with what
    tells their bases, and all that is called like something that changed, or that a reviewed row names."""
    words = {row.old.rpartition(".")[2] for row in load_rows() if row.package == PACKAGE}
    names = {name for modules in versions.values() for name in modules}
    words.update(name.rpartition(".")[2] for name in names if any(name not in modules for modules in versions.values()))
    for name in names:
        surfaces = [modules[name].surface for modules in versions.values() if name in modules]
        states = [_index_names((*surface.names, *surface.imports)) for surface in surfaces]
        every = {bound for state in states for bound in state}
        words.update(
            bound.rpartition(".")[2] for bound in every if any(s.get(bound) != states[0].get(bound) for s in states)
        )
    surfaces = (module.surface for modules in versions.values() for module in modules.values())
    taken = words | {one.name for surface in surfaces for one in surface.names if one.kind == "class"}
    return {
        minor: {name: kept for name, module in modules.items() if (kept := _select(module, words, taken)) is not None}
        for minor, modules in versions.items()
    }


def _index_names(items: Iterable[Bound | ImportedName]) -> dict[str, tuple]:
    found: dict[str, tuple] = {}
    for item in items:
        found[item.name] = (*found.get(item.name, ()), msgspec.structs.replace(item, line=0))
    return found


def _select(module: InstalledModule, words: Collection[str], taken: Collection[str]) -> InstalledModule | None:
    """What of a module may be asked about; None for nothing. words: last parts of what is kept besides classes. taken:
    the same of what imports are kept of."""
    surface = module.surface
    names = tuple(one for one in surface.names if one.kind == "class" or one.name.rpartition(".")[2] in words)
    imports = tuple(one for one in surface.imports if one.name == "*" or one.name in taken or one.original in taken)
    if not names and not imports and module.name.rpartition(".")[2] not in words:
        return None
    kept = msgspec.structs.replace(surface, names=names, imports=imports, all=None)
    return msgspec.structs.replace(module, surface=kept)


def pack_versions(versions: Mapping[int, Mapping[str, InstalledModule]]):
    """The versions as they are stored, by package and generation."""
    packing = Packing()
    for minor, modules in versions.items():
        version = f"3.{minor}"
        python = PythonSurface(PACKAGE, tuple(modules.values()))
        surface = Surface(PACKAGE, version, BuildSurface(PACKAGE, version), python)
        packing.add(PACKAGE, version, (GENERATION,), RepositorySurfaces({PACKAGE: surface}))
    return packing.pack_packages()


def main(arguments: list[str] | None = None) -> None:
    """The command line described at the top."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("stubs", nargs="+", type=Path)
    parser.add_argument("--output", type=Path, default=DATA)
    given = parser.parse_args(arguments)
    states = [Stubs(folder) for folder in given.stubs]
    for state in states:
        print(f"{state.folder}: Python 3.{state.span[0]} to 3.{state.span[1]}, {len(state.files)} modules", flush=True)
    versions = leave_out_alike(read_versions(states))
    made = pack_versions(versions)
    file = given.output / "surfaces.sqlite"
    packages, distros = read_packages(file)
    write(file, {**packages, **made}, distros, load_snapshot().date)
    size = sum(map(len, made[PACKAGE, GENERATION]))
    print(f"{len(versions)} versions of Python, {len(versions[max(versions)])} modules, {size} bytes")


if __name__ == "__main__":
    main()
