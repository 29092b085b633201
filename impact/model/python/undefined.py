"""Names that the Python files of a package use and that nothing defines: neither the file itself, nor the module from
which it imports them, of the package itself or of another one of the workspace; modules that are not there; and
functions that entry points name and their modules lack."""

from __future__ import annotations

import itertools
import posixpath
import sys
from collections.abc import Collection, Iterable, Iterator, Mapping
from functools import cached_property

import msgspec

from ....edges.groups import group_pairs
from ....edges.memory import cache_method
from ....edges.reach import walk
from ...facts.python.bound import PYTHON2_BUILTINS
from ...facts.python.reader import Import
from ...facts.python.source import PythonFile
from ...facts.setup import SetupFile


def list_undefined(
    files: Mapping[str, PythonFile], others: Collection[str], paths: Iterable[str]
) -> Iterator[tuple[str, Import]]:
    """Such names, each as its import with the path it stands in; the module is empty for names that the file uses
    itself, marked as PythonFile has them, and for modules, whose names have a dot. With them star imports of a package
    from itself. files: the Python files of a package by their paths. others: what modules and libraries of the package,
    and what its build makes in ways that are not known, are called. paths: all its files, of which modules may be
    built."""
    modules = PackageModules(files, others, paths)
    for path, facts in files.items():
        if posixpath.basename(path).startswith("."):
            continue  # settings of tools, which define names for them
        for use in facts.unbound:
            yield path, Import("", (use.text,), 0, use.line, use.column, use.lazy, use.conditions)
        around = modules.list_around(path) if "." in posixpath.basename(_strip_ending(path)) else frozenset()
        for item in facts.imports:
            if not item.level and item.module.partition(".")[0] in around:
                continue  # a launch file is no module, so that the folder above its own is not searched
            meant = modules.make_absolute(path, item) if item.level else item.module
            program = path if facts.interpreter else ""
            if modules.lacks(meant, program) or (not item.level and modules.is_meant_by(item)):
                yield path, msgspec.structs.replace(item, module="", names=(meant,))
                continue
            module = modules.find(path, item) if item.names else None
            if "*" in item.names:
                if module == path and not item.level and path.endswith("/__init__.py"):
                    yield path, item
                continue
            bound = files[module].bound if module is not None else ""
            for name in item.names if bound and module != path else ():
                if f" {name} " not in bound and name not in others and not modules.may_be_built(name):
                    yield path, msgspec.structs.replace(item, module="." * item.level + item.module, names=(name,))


ABOVE = "..."
"""The name that list_above() gives to imports out of a Python package."""
ALONE = "...."
"""The name that list_above() gives to imports of programs."""


def list_above(
    files: Mapping[str, PythonFile], roots: Collection[str], programs: Collection[str]
) -> Iterator[tuple[str, Import]]:
    """Relative imports that lead out of the outermost Python package, and those of programs that lie in none. roots:
    the folders of Python packages that are installed. programs: what is installed to be started. The name of each is
    ABOVE or ALONE, its module is as written."""
    for path, facts in files.items():
        relative = [item for item in facts.imports if item.level]
        root = next((one for one in roots if path.startswith(f"{one}/")), None) if relative else None
        depth = path[len(root) :].count("/") if root is not None and f"{root}/__init__.py" in files else 0
        for item in relative:
            alone = root is None and path in programs and facts.interpreter
            name = ALONE if alone else ABOVE if 0 < depth < item.level else ""
            if name and " __package__ " not in facts.bound:
                yield path, msgspec.structs.replace(item, module="." * item.level + item.module, names=(name,))


def list_called_by_path(
    files: Mapping[str, PythonFile], folder: str, roots: Collection[str], programs: Collection[str]
) -> Iterator[tuple[str, Import]]:
    """Imports, in programs and installed modules, of a file of the package by its path from a folder above the package
    on, where they do not look; as list_undefined() has modules. folder: of the package. roots: as above. programs: what
    is started."""
    own, head = {posixpath.basename(root) for root in roots}, folder.partition("/")[0]
    stems = {_strip_ending(path) for path in files} if head and head not in own else ()
    found = [
        (path, msgspec.structs.replace(item, module="", names=(item.module,)))
        for path, facts in (files.items() if stems else ())
        if path in programs or any(path.startswith(f"{root}/") for root in roots)
        for item in facts.imports
        if not item.level and item.module.startswith(f"{head}.") and item.module.replace(".", "/") in stems
    ]
    beside = PackageModules(files, (), ()).list_loaded_beside("sys.path") if found else ()
    yield from (one for one in found if one[0] not in beside)


BESIDE = "."
"""The name that list_siblings() gives to imports."""
UNLISTED = ".."
"""The name that list_unlisted() gives to imports."""


_MARKS = {ABOVE: "above", ALONE: "alone", BESIDE: "beside", UNLISTED: "unlisted", "*": "itself"}


def classify_undefined(module: str, name: str) -> str:
    """What is wrong with a name: what ABOVE, ALONE, BESIDE and UNLISTED stand for, `itself` (a star import of a package
    from itself), `imported` (its module does not define it), `python 2` (Python 2 alone has it), `private` (a member of
    self), `module used`, `module` (that is not there) or `undefined`."""
    if name in _MARKS:
        return _MARKS[name]
    if module:
        return "imported"
    if name in PYTHON2_BUILTINS or name.startswith("."):
        return "python 2"
    if name.startswith("self."):
        return "private"
    if name.endswith("()"):
        return "module used"
    return "module" if "." in name else "undefined"


def list_siblings(
    files: Mapping[str, PythonFile], setup: Collection[tuple[str, SetupFile]]
) -> Iterator[tuple[str, Import]]:
    """Imports, in modules of a Python package, of another module of its folder as if it were at the top, which Python 3
    finds only where the importing file itself is started. files, setup: as above. Only of modules that are imported by
    their package, lazy but for those that starting a program imports. The name of each is BESIDE."""
    modules = PackageModules(files, (), ())
    imported = {
        place
        for path, facts in files.items()
        for item in facts.imports
        for place in modules.list_named_files(path, item)
    }
    started = modules.list_started(setup)
    for path in sorted((started | imported) - modules.list_loaded_beside("sys.path")):
        for item in files[path].imports:
            if not (item.level or item.started) and modules.is_beside(path, item.module.partition(".")[0]):
                yield path, msgspec.structs.replace(item, names=(BESIDE,), lazy=item.lazy or path not in started)


def list_unlisted(
    files: Mapping[str, PythonFile], setup: Collection[tuple[str, SetupFile]]
) -> Iterator[tuple[str, Import]]:
    """Imports of modules that lie in a Python package which setup() does not install, though it installs the outermost
    one, each as an import of that package, lazy but for those that starting a program imports. files, setup: as above.
    The name of each is UNLISTED."""
    modules = PackageModules(files, (), ())
    started = modules.list_started(setup) if setup else frozenset()
    for path, file in setup:
        folder, listed = posixpath.dirname(path), set(file.packages)
        if not listed or "*" in listed or any(one.startswith(("packages", "arguments")) for one in file.unresolved):
            continue
        roots = {posixpath.dirname(file.list_module_paths(folder, name)[1]) for name in listed if "." not in name}
        for importer, facts in files.items():
            if posixpath.dirname(importer) in roots or not f"{importer}/".startswith(tuple(f"{r}/" for r in roots)):
                for item in facts.imports:
                    owners = {modules.find_package(place, roots) for place in modules.list_named_files(importer, item)}
                    for owner in sorted(owners - listed - {""}):
                        lazy = item.lazy or not (importer in started or facts.interpreter)
                        yield importer, msgspec.structs.replace(item, module=owner, names=(UNLISTED,), lazy=lazy)


class PythonOffer(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What a package offers to Python code of others. modules: the names that each module binds, as PythonFile.bound.
    built: names of modules that may come from other files."""

    modules: dict[str, str] = {}
    built: frozenset[str] = frozenset()

    def list_lacking(self, module: str, names: Iterable[str]) -> Iterator[str]:
        """The module itself, where there is none, or those of these names that it does not bind."""
        head, *rest = module.split(".")
        generated = not _GENERATED.isdisjoint(rest) or any(self._may_be_built(part) for part in rest)
        if head not in self.modules or generated:
            return
        bound = self.modules.get(module)
        if bound is None:
            if not any(one.startswith(f"{module}.") for one in self.modules):
                yield module
            return
        for name in names if bound else ():
            there = f" {name} " in bound or f"{module}.{name}" in self.modules or name in _GENERATED or name == "*"
            if not there and not self._may_be_built(name):
                yield name

    def _may_be_built(self, name: str) -> bool:
        return name in self.built or _is_made(name, self.built)


def offer_python(
    files: Mapping[str, PythonFile], others: Collection[str], paths: Iterable[str], roots: Collection[str]
) -> PythonOffer:
    """What others can import of a package. files, others, paths: as above. roots: the folders of its Python packages
    that it installs."""
    modules = {}
    open_roots = {root for root in roots if any(_may_add_modules(files[p]) for p in files if p.startswith(f"{root}/"))}
    for path, facts in files.items():
        stem = _strip_ending(path)
        root = next((one for one in roots if stem == one or stem.startswith(f"{one}/")), None)
        if root is not None and root not in open_roots and f"{root}/__init__.py" in files:
            modules[stem[len(root) - len(posixpath.basename(root)) :].replace("/", ".")] = facts.bound
    return PythonOffer(modules, PackageModules(files, others, paths).built) if modules else PythonOffer()


def _may_add_modules(facts: PythonFile) -> bool:
    """Whether a file gives a package modules that have no files, or looks for them in other folders."""
    return any(use.text.startswith(("sys.modules", "pkgutil.extend_path")) for use in facts.attributes)


def list_undefined_functions(
    files: Mapping[str, PythonFile], setup: Iterable[tuple[str, SetupFile]]
) -> Iterator[tuple[str, Import]]:
    """Functions of entry points that their modules lack, as imports of them that stand in the setup file. files: as
    above. setup: the setup files of a package by their paths."""
    for path, file in setup:
        for _, module, line, function in file.entry_points:
            place = next((one for one in file.list_module_paths(posixpath.dirname(path), module) if one in files), None)
            name = function.partition(".")[0]
            if place is not None and name and files[place].bound and f" {name} " not in files[place].bound:
                yield path, Import(module, (name,), 0, line, 0)


# What interfaces and settings are generated into.
_GENERATED = frozenset(("action", "cfg", "msg", "srv"))
# How modules end that protoc and Qt's tools write.
_MADE = ("_pb2", "_pb2_grpc", "_rc", "_ui")
_SHORTEST = 4
"""Letters of a name that others begin with by no chance."""


def _is_made(name: str, sources: Iterable[str]) -> bool:
    """Whether a module may be made by a program: it is called as such are, or begins as one of these sources is
    called."""
    if name.startswith("_") or name.endswith(_MADE):
        return True
    return any(len(one) >= _SHORTEST and name.startswith(one) for one in sources)


class PackageModules:
    """The modules of a package. files, others, paths: as above."""

    def __init__(self, files: Mapping[str, PythonFile], others: Collection[str], paths: Iterable[str]):
        self._files, self._others, self._paths = files, others, paths
        there = self._there = frozenset(paths)
        self._folders = {posixpath.dirname(path) for path in files}
        self._by_name = group_pairs((posixpath.basename(_strip_ending(path)), path) for path in files)
        # Folders with an __init__.py that lie in none such, or in `src`, by their names.
        self._roots: dict[str, list[str]] = {}
        for path in files:
            root = _strip_ending(path)
            around = posixpath.dirname(root)
            outermost = f"{around}/__init__.py" not in files or posixpath.basename(around) == "src"
            # Where modules are installed from, a file that makes the folder itself one is of no consequence.
            if path.endswith("/__init__.py") and (outermost or f"{around}/setup.py" in there):
                self._roots.setdefault(posixpath.basename(root), []).append(root)

    @cached_property
    def built(self) -> frozenset[str]:
        """What may come from something else than Python, by name."""
        roots = tuple(f"{root}/" for several in self._roots.values() for root in several)
        inside = {p for folder in self._folders if f"{folder}/".startswith(roots) for p in folder.split("/")}
        return frozenset((*self.sources, *(o for o in self._others if o not in inside and o not in self._by_name)))

    @cached_property
    def _open(self) -> frozenset[str]:
        """The names of the outermost Python packages whose modules are not all known by their files."""
        adding = [path for path, facts in self._files.items() if _may_add_modules(facts)]
        roots = ((name, f"{root}/") for name, several in self._roots.items() for root in several)
        return frozenset(name for name, root in roots if any(path.startswith(root) for path in adding))

    @cached_property
    def sources(self) -> frozenset[str]:
        """What files with an ending, which modules may be made of, are called."""
        names = (posixpath.basename(path) for path in self._paths if not path.endswith(".py"))
        return frozenset(name.partition(".")[0] for name in names if "." in name)

    def may_be_built(self, name: str) -> bool:
        """Whether a module of this name may come from something else than Python: it is called like a file of another
        language, or begins as one is called."""
        return name in self.built or _is_made(name, self.sources)

    def is_meant_by(self, item: Import) -> bool:
        """Whether an import from a package of another name, all of whose names a module of this one at the same place
        binds, seems to mean it. Where that module has them from there itself, or the package imports of the other one
        what it does not have itself, the other package is one."""
        head, _, rest = item.module.partition(".")
        if not rest or not item.names or head in self._others or head in sys.stdlib_module_names:
            return False
        for roots in self._roots.values():
            for root in roots:
                file = self._find_file(f"{root}/{rest.replace('.', '/')}")
                if file is None or any(other.module == item.module for other in file.imports):
                    continue
                if any(self._is_of_another(other, root) for other in self._imports_of.get(head, ())):
                    continue
                if all(f" {name} " in file.bound for name in item.names):
                    return True
        return False

    @cached_property
    def _imports_of(self) -> dict[str, list[Import]]:
        """The absolute imports of modules in packages, by the package."""
        absolute = (item for facts in self._files.values() for item in facts.imports if not item.level)
        return group_pairs((item.module.partition(".")[0], item) for item in absolute if "." in item.module)

    def _is_of_another(self, item: Import, root: str) -> bool:
        """Whether what an import asks of another package is not at the same place below a root."""
        file = self._find_file(f"{root}/{item.module.partition('.')[2].replace('.', '/')}")
        return file is None or not all(f" {name} " in file.bound for name in item.names)

    def _find_file(self, stem: str) -> PythonFile | None:
        return self._files.get(f"{stem}.py") or self._files.get(f"{stem}/__init__.py")

    def lacks(self, module: str, program: str = "") -> bool:
        """Whether a module surely is to be one of the package, by its first name, and there is none. program: the file
        that imports it where that is started, which finds the folders beside it."""
        head, *rest = module.split(".")
        meant = self._list_module_paths(module) if rest else set()
        beside = posixpath.join(posixpath.dirname(program), head)
        if rest and program and beside in self._folders and head not in sys.stdlib_module_names:
            meant.add("/".join((beside, *rest)))
        if not meant or head in self._open or not _GENERATED.isdisjoint(rest):
            return False
        if any(self.may_be_built(part) for part in rest[min(self._count_folders(path, rest) for path in meant) :]):
            return False
        there = {_strip_ending(path) for path in self._by_name.get(rest[-1], ())}
        # Some files are there that nobody could read.
        there.update(root for root in meant if not {f"{root}.py", f"{root}/__init__.py"}.isdisjoint(self._there))
        return meant.isdisjoint(there) and not any(f"{f}/".startswith(f"{m}/") for m in meant for f in self._folders)

    def _count_folders(self, path: str, rest: list[str]) -> int:
        """How many of the last parts of a module's path, from the first of them on, are folders with Python files."""
        above = path.split("/")[: -len(rest)]
        folders = ("/".join((*above, *rest[:number])) for number in range(1, len(rest)))
        return sum(1 for _ in itertools.takewhile(self._folders.__contains__, folders))

    def list_around(self, path: str) -> frozenset[str]:
        """The names of the outermost Python packages that a file lies in."""
        return frozenset(name for name, roots in self._roots.items() if any(path.startswith(f"{r}/") for r in roots))

    def _list_module_paths(self, module: str) -> set[str]:
        """The paths, without endings, that a module has below folders which its first name may be."""
        head, *rest = module.split(".")
        roots = self._roots.get(head, ()) if head not in sys.stdlib_module_names else ()
        return {"/".join((root, *rest)) for root in roots}

    def make_absolute(self, path: str, item: Import) -> str:
        """The module that a relative import names, from its outermost package on; empty where that is not known."""
        folder = path
        for _ in range(item.level):
            folder = posixpath.dirname(folder)
        for several in self._roots.values():
            for root in several:
                if item.module and f"{folder}/".startswith(f"{root}/") and len(several) == 1:
                    return f"{folder[len(posixpath.dirname(root)) :].lstrip('/').replace('/', '.')}.{item.module}"
        return ""

    def list_named_files(self, path: str, item: Import) -> Iterator[str]:
        """The files that an import from a package names by their package: the module, or modules among the names."""
        module = self.make_absolute(path, item) if item.level else item.module
        for stem in self._list_module_paths(module) if module else ():
            if stem in self._stems and not stem.endswith("/__init__"):
                yield self._stems[stem]
            yield from (self._stems[f"{stem}/{name}"] for name in item.names if f"{stem}/{name}" in self._stems)

    def list_started(self, setup: Iterable[tuple[str, SetupFile]]) -> frozenset[str]:
        """The modules of entry points, and those that are imported, in any case, by them or by scripts."""
        found: set[str] = set()
        for path, file in setup:
            for _, module, *_ in file.entry_points:
                found.update(self._files.keys() & set(file.list_module_paths(posixpath.dirname(path), module)))
        scripts = {path for path, facts in self._files.items() if facts.interpreter}
        reached = set(walk((*found, *scripts), self._list_imported))
        # A script counts as a module where something imports it.
        return frozenset(found.union(*map(self._list_imported, reached)))

    def list_loaded_beside(self, name: str) -> frozenset[str]:
        """The files that a program may load which loads one that uses this name of another module: where one changes
        sys.path, more folders are looked into."""
        using = [path for path, facts in self._files.items() if any(u.text.startswith(name) for u in facts.attributes)]
        if not using:
            return frozenset()
        loads = {path: self._list_loaded(path) for path in self._files}
        loaded_by = group_pairs((to, path) for path, several in loads.items() for to in several)
        return frozenset(walk(walk(using, lambda path: loaded_by.get(path, ())), loads.__getitem__))

    def _list_loaded(self, path: str) -> list[str]:
        """The modules of the package that a file may import, of the folders that it lies in also those beside it."""
        found = []
        for item in self._files[path].imports:
            found += self.list_named_files(path, item)
            beside = posixpath.join(posixpath.dirname(path), item.module.partition(".")[0])
            found += [self._stems[beside]] if not item.level and beside in self._stems else ()
        return found

    @cache_method
    def _list_imported(self, path: str) -> set[str]:
        """The modules that a file imports in any case."""
        imports = (item for item in self._files[path].imports if not (item.lazy or item.conditions))
        return {place for item in imports for place in self.list_named_files(path, item)}

    def find_package(self, path: str, roots: Collection[str]) -> str:
        """The Python package that a module lies in, below one of these folders; empty for another module."""
        folder = posixpath.dirname(path)
        root = next((one for one in roots if f"{folder}/".startswith(f"{one}/")), None)
        return folder[len(posixpath.dirname(root)) :].strip("/").replace("/", ".") if root is not None else ""

    @cached_property
    def _stems(self) -> dict[str, str]:
        return {_strip_ending(path): path for path in self._files}

    def is_beside(self, path: str, name: str) -> bool:
        """Whether a module of a Python package lies beside one of this name, and none at the top is called so."""
        folder = posixpath.dirname(path)
        stem = posixpath.join(folder, name)
        if name in sys.stdlib_module_names or name in self._roots or f"{folder}/__init__.py" not in self._files:
            return False
        inside = [_strip_ending(one) == stem for one in self._by_name.get(name, ())]
        return bool(inside) and all(inside) and self._stems[stem] != path

    def find(self, path: str, item: Import) -> str | None:
        """The file that an import names, None where it may be another one or none."""
        ending = item.module.replace(".", "/")
        near = self._by_name.get(posixpath.basename(ending), ()) if ending else ()
        if item.level:
            folder = path
            for _ in range(item.level):
                folder = posixpath.dirname(folder)
            exact = posixpath.join(folder, ending).rstrip("/")
            near = near or self._by_name.get(posixpath.basename(exact), ())
            found = [one for one in near if _strip_ending(one) == exact]
        elif "/" in ending:
            meant = self._list_module_paths(item.module)
            found = [one for one in near if _strip_ending(one) in meant]
        else:  # of one word there are many modules elsewhere; the one beside a program comes first
            meant = {posixpath.join(posixpath.dirname(path), ending), *self._list_module_paths(item.module)}
            found = [one for one in near if len(near) == 1 and _strip_ending(one) in meant]
        return found[0] if len(found) == 1 else None


def _strip_ending(path: str) -> str:
    """The path of a module without its ending, the folder's of a package."""
    return path.removesuffix("/__init__.py").removesuffix(".py")
