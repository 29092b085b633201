"""Nodes of a workspace: what runs which code, told by what can be reached from a main function or a loaded class."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from typing import NamedTuple, TypeVar

from ....edges.groups import group_pairs
from ....edges.memory import cache_method
from ....edges.reach import walk
from ...facts.flow import FlowExpr, FlowFile
from .code import SOURCES, FlowCode, Fn, get_tail, list_made
from .endpoints import Sites, unparse
from .modules import CodeFile
from .names import is_open, make_open_part
from .types import Cls, parse_flow_type

_Thing = TypeVar("_Thing")

# Kinds of arguments that may hand on a function.
_HANDING = frozenset(("function", "name", "bind", "keyword"))


class StartableProgram(NamedTuple):
    """Something that can be started. kind, executable and plugin as in Node; roots: where it begins; files: those it is
    built from, headers left out."""

    package: str
    kind: str
    executable: str
    plugin: str
    roots: tuple[Fn, ...]
    files: frozenset[str]
    path: str
    line: int


class BuiltPackage(NamedTuple):
    """What the build of one package tells. executables and libraries: target to its sources; components: class to the
    executables that are made to run it alone; scripts: name of an installed or executable Python file to its path,
    entry points with the function behind a colon; links: target to the targets of the workspace that it links. plugins:
    what pluginlib calls a class to the class."""

    package: str
    executables: Mapping[str, tuple[str, ...]]
    libraries: Mapping[str, tuple[str, ...]]
    components: Mapping[str, tuple[str, ...]]
    scripts: Mapping[str, str]
    links: Mapping[str, tuple[str, ...]]
    plugins: Mapping[str, str] = {}


def find_entry_point(module: str, function: str, folder: str, paths: Collection[str]) -> str:
    """The file and, behind a colon, the function that an entry point of a setup.py in a folder names; empty for a file
    that is not among the paths."""
    stem = module.strip().replace(".", "/")
    for inside in (f"{stem}.py", f"src/{stem}.py", f"{stem}/__init__.py"):
        path = f"{folder}/{inside}".lstrip("/")
        if path in paths:
            return f"{path}:{function.strip() or 'main'}"
    return ""


def asks_for_name(file: FlowFile) -> bool:
    """Whether a Python file asks for its `__name__`, as programs do."""
    top = (function for function in file.functions if not function.name)
    return any("__main__" in guard.text for function in top for guard in function.guards)


class CodeReach:
    """What code can run once something is started."""

    def __init__(self, sites: Sites):
        self.sites, self.code = sites, sites.code
        # Functions of classes that are loaded by name, to the key of the class.
        self._loaded: dict[Fn, str] = {}
        for source in self.code.sources:
            for name in source.facts.exports:
                cls = self.code.find_class(name.removeprefix("::"), source)
                if cls is not None:
                    self._loaded.update((fn, cls.key) for fn in self.code.list_functions(cls))
        self._lambdas = group_pairs(((fn.source.path, fn.scope), fn) for fn in self.code.functions if fn.is_lambda)

    def find_reached(
        self, roots: Iterable[Fn], classes: Iterable[Cls] = (), without: Collection[str] = (),
        cut: Mapping[Fn, Fn] = {},
    ) -> tuple[set[Fn], set[str]]:  # fmt: skip
        """Functions and classes (by key) reached from some functions, and from objects of some classes. without: paths
        of files that are not linked. cut: functions, with themselves as far as they run."""
        functions: set[Fn] = set()
        keys: set[str] = set()
        queue: list[Fn] = list(roots)
        begun = set(queue)
        made: list[Cls] = list(classes)
        while queue or made:
            while made:
                cls = made.pop()
                for one in self.code.list_bases(cls):
                    if one.key in keys:
                        continue
                    keys.add(one.key)
                    queue.extend(self.code.list_functions(one))
                    made.extend(self.list_held(one))
            if not queue:
                break
            fn = queue.pop()
            if fn in functions or fn.source.path in without:
                continue
            loaded = self._loaded.get(fn)
            if loaded is not None and loaded not in keys and fn not in begun:
                continue  # one of many that may be loaded at run time: a node of its own
            functions.add(fn)
            further, objects = self.find_edges(cut.get(fn, fn))
            queue += [one for one in further if one not in functions]
            if objects:
                made += [cls for cls in objects if cls.key not in keys]
        return functions, keys

    @cache_method
    def list_held(self, cls: Cls) -> list[Cls]:
        """Classes of the members that objects of a class hold."""
        # What is pointed to is made elsewhere, or by this class with code that is followed.
        types = (member.type for member in cls.facts.members if member.type and not _points(member.type))
        found = (self.code.find_class_of_type(type_, cls.source, cls.name) for type_ in types)
        return [inner for inner in found if inner is not None]

    @cache_method
    def find_edges(self, fn: Fn) -> tuple[Sequence[Fn], Sequence[Cls]]:
        """Functions that a function may lead to, and classes of objects that it makes."""
        code = self.code
        further = list(self._lambdas.get((fn.source.path, fn.name), ()))
        for call in fn.facts.calls:
            further.extend(code.list_targets(call.callee, fn))
            for argument in call.arguments:
                if argument.kind in _HANDING:
                    further.extend(self._list_handed(argument, fn))
        types = [name for name, _, _ in list_made(fn, code)]
        types += [each.type for each in fn.facts.assignments if each.type and not _points(each.type)]
        found = (code.find_class_of_type(type_, fn.source, fn.scope) for type_ in types)
        # What comes last is looked at first, so the last of those that are named twice is the one to keep.
        return _keep_last_of_each(further), _keep_last_of_each(cls for cls in found if cls is not None)

    def _list_handed(self, value: FlowExpr, fn: Fn) -> list[Fn]:
        """Functions outside of classes that an argument hands on; methods are reached through their class."""
        if value.kind in ("bind", "keyword") and value.parts:
            value = value.parts[0]
        if value.kind in ("function", "name") and "." not in value.text and get_tail(value.text) in self.code.by_tail:
            return [one for one in self.code.list_targets(value.text, fn) if not one.facts.owner]
        return []


def spell_unknown_name(written: FlowExpr) -> str:
    """A node's name as far as its expression tells it, the rest in brackets: `robot_<id>`; empty for a literal that
    leaves it to others."""
    if written.kind == "text":
        return ""
    parts = written.parts if written.kind == "join" and written.text in ("", "+") else (written,)
    known = "".join(part.text if part.kind == "text" else make_open_part(f"<{unparse(part)[:60]}>") for part in parts)
    return known if is_open(known) else ""


def _keep_last_of_each(found: Iterable[_Thing]) -> tuple[_Thing, ...]:
    """Things once each, where they stand for the last time."""
    return tuple(reversed(dict.fromkeys(reversed(list(found)))))


def _points(type_: str) -> bool:
    """Whether a variable of a type holds what is made elsewhere, or by code that is followed."""
    return "*" in type_ or "&" in type_ or "ptr" in type_.lower()


def list_programs(code: FlowCode, built: Iterable[BuiltPackage], kinds_of) -> Iterator[StartableProgram]:
    """Everything that can be started. kinds_of: a class's kinds by the table of frameworks."""
    by_path = group_pairs((fn.source.path, fn) for fn in code.functions)
    by_source = {source.path: source for source in code.sources}
    exported = group_pairs((one.package, (name, one.path)) for one in code.sources for name in one.facts.exports)
    for package in built:
        for name, sources in package.executables.items():
            mains = [fn for path in sources for fn in by_path.get(path, ()) if fn.name == "main"]
            files = frozenset(_list_linked_sources(name, package, sources))
            main = mains[0] if mains else None
            place = (main.source.path, main.facts.line) if main else (sources[0] if sources else "", 0)
            yield StartableProgram(package.package, "executable", name, "", tuple(mains), files, *place)
        components = {name.removeprefix("::"): executables for name, executables in package.components.items()}
        loaded = [(name.removeprefix("::"), path) for name, path in exported.get(package.package, ())]
        registered = {name for name, _ in loaded}
        loaded += [(name, "") for name in components if name not in registered]
        for name, path in loaded:
            cls = _find_class(code, name, package.package, by_source.get(path))
            if cls is None and not path:
                continue  # registered by the build, of another package's code
            kind = _classify_loading(cls, code, kinds_of) if cls is not None else "plugin"
            roots = tuple(code.list_functions(cls)) if cls is not None else ()
            place = (cls.source.path, cls.facts.line) if cls is not None else (path, 0)
            for executable in components.get(name) or ("",):
                yield StartableProgram(
                    package.package, kind, executable, name, roots, frozenset((path or place[0],)), *place
                )
        for name, where in package.scripts.items():
            path, _, function = where.partition(":")
            fns = by_path.get(path, ())
            roots = [fn for fn in fns if fn.name in ("", function or "main")]
            if function and fns and function not in {fn.name for fn in fns}:
                # The package has the function from one of its modules.
                roots += code.list_defined(function, fns[0].source)
            if roots:
                yield StartableProgram(
                    package.package, "script", name, "", tuple(roots), frozenset((path,)), path, roots[0].facts.line
                )


def collect_sources_of_others(program: StartableProgram, built: Iterable[BuiltPackage]) -> frozenset[str]:
    """The sources that are compiled into other executables alone, so that an executable does not have them."""
    every = list(built)
    in_executables = {path for package in every for paths in package.executables.values() for path in paths}
    in_libraries = {path for package in every for paths in package.libraries.values() for path in paths}
    return frozenset(in_executables - in_libraries - program.files)


def collect_replaced_sources(program: StartableProgram, code: FlowCode) -> set[str]:
    """The sources of a program's package that define a method which a source of the program defines too, of one class
    of a header: the program is linked without them."""
    own = [fn for path in program.files for fn in code.functions_in.get(path, ()) if fn.owner and not fn.is_lambda]
    return {
        other.source.path
        for fn in own
        if (cls := code.find_owner(fn)) is not None and not cls.is_local
        for other in code.find_method(cls, get_tail(fn.name))
        if other.source.path.endswith(SOURCES) and other.source.path not in program.files
    }


def _list_linked_sources(name: str, package: BuiltPackage, sources: Iterable[str]) -> Iterator[str]:
    yield from sources
    for one in walk([name], lambda one: package.links.get(one, ())):
        if one != name:
            yield from package.libraries.get(one, ())


def _find_class(code: FlowCode, name: str, package: str, source: CodeFile | None) -> Cls | None:
    """A class by the name that it is registered under in a file, or by the build."""
    wanted = parse_flow_type(name).name.removeprefix("::").split("::")
    found = [
        cls
        for cls in code.classes.get(wanted[-1], ())
        if cls.source.package == package and cls.name.split("::")[-len(wanted) :] == wanted
    ]
    if not found and source is not None:
        meant = code.find_class(name.removeprefix("::"), source)
        found = [meant] if meant is not None else []
    return found[0] if found else None


def _classify_loading(cls: Cls, code: FlowCode, kinds_of) -> str:
    names = [get_tail(name) for name in code.list_base_names(cls)]
    if "Nodelet" in names or any(name.endswith("Nodelet") for name in names):
        return "nodelet"
    if "node" in kinds_of(cls):
        return "component"
    return "plugin"
