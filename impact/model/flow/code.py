"""The sources of a workspace or a package as one body of code: functions, classes and variables by their names."""

from __future__ import annotations

import posixpath
import re
from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
from functools import cached_property, lru_cache
from operator import attrgetter, itemgetter
from typing import Generic, NamedTuple, TypeVar

from ....edges.groups import group_pairs
from ....edges.memory import cache_method
from ...facts.cpp.flow_values import ELEMENTS
from ...facts.flow import (
    Alias,
    Assignment,
    DataMember,
    FlowCall,
    FlowExpr,
    FlowFunction,
    FlowParameter,
)
from ...facts.python.flow_expressions import make_join
from ...facts.python.text import split_percent_format
from .build_constants import BuildConstants
from .includes import SeenFiles
from .modules import CodeFile, PythonModules
from .types import UNKNOWN, Cls, FlowType, parse_flow_type, split_name

_Row = TypeVar("_Row", bound=tuple)


_HEADERS = (".h", ".hpp", ".hh", ".hxx")
# Bases outside of the code, with the methods of what derives from them that they call.
_CALLED_BY = {
    "Node": frozenset[str](), "object": frozenset[str](), "Object": frozenset[str](), "Thread": frozenset(("run",)),
    "LifecycleNode": frozenset(
        ("on_configure", "on_activate", "on_deactivate", "on_cleanup", "on_shutdown", "on_error")
    ),
    "enable_shared_from_this": frozenset[str](), "Nodelet": frozenset(("onInit",)),
}  # fmt: skip
# Methods of strings that change them; algorithms that write where they are pointed to; those of Boost's string library.
_CHANGE_STRING = frozenset(("insert", "erase", "replace", "push_back", "pop_back", "assign", "clear", "resize", "swap"))
_CHANGE_RANGE = frozenset(("transform", "replace", "replace_if", "remove", "remove_if", "reverse", "rotate", "fill"))
# What says how a parameter is handed over, and nothing of what it is.
_HANDED_OVER = re.compile(r"\bconst\b|\btypename\b|[&*]")
_CHANGE_IN_PLACE = ("replace_", "erase_", "trim", "to_lower", "to_upper")
# Methods of pluginlib's ClassLoader<T> that make a T.
MAKES_PLUGIN = frozenset(("createInstance", "createSharedInstance", "createUniqueInstance", "createUnmanagedInstance"))
# Endings of C++ files that hold no declarations for others.
SOURCES = (".cpp", ".cc", ".cxx", ".c++", ".c", ".cu")


class Fn:
    """A function with the file it stands in. place: tells it from all others. heads, identities, targets and made are
    what Code found out about it: variables by the head of a path and by the whole path, functions by a callee, and the
    objects that it makes."""

    __slots__ = (
        "_around", "_calls", "_lines", "assigned", "facts", "heads", "identities", "is_lambda", "locals", "made",
        "name", "owner", "place", "scope", "source", "targets",
    )  # fmt: skip

    def __init__(self, source: CodeFile, facts: FlowFunction):
        self.source, self.facts = source, facts
        self.name = facts.name
        self.place = f"{source.path}:{facts.line}:{facts.name}"
        self.heads: dict[str | tuple[str, ...], Variable] = {}
        self.identities: dict[str, Variable] = {}
        self.targets: dict[str, list[Fn]] = {}
        self.made: list[tuple[str, tuple[FlowExpr, ...], int]] | None = None
        # Namespaces and class around the function, joined as its language does.
        self.scope = get_outer(facts.name)
        self.owner = split_name(facts.owner)
        self.is_lambda = facts.name.startswith("lambda@", len(facts.name) - len(get_tail(facts.name)))
        self.assigned: dict[str, list[Assignment]] = {}
        # What is declared here hides members of the same name.
        self.locals = {p.name.lstrip("*") for p in facts.parameters}
        python = source.facts.language == "python"
        for each in facts.assignments:
            target = each.target
            self.assigned.setdefault(target, []).append(each)
            if (each.type or (python and each.operator == "=")) and "." not in target:
                self.locals.add(target)
        # What a module of Python assigns is everybody's in it.
        if python:
            self.locals = self.locals.difference(facts.outside) if facts.name else set()
        self._around: dict[int, tuple[int, ...]] = {}
        self._lines: dict[int, set[int]] | None = None
        self._calls: dict[str, list[FlowCall]] | None = None

    def list_guards_around(self, guard: int) -> tuple[int, ...]:
        """A guard, by its place, and those around it, the nearest first."""
        known = self._around.get(guard)
        if known is None:
            found: list[int] = []
            outer = guard
            while 0 <= outer < len(self.facts.guards) and len(found) < 64:
                found.append(outer)
                outer = self.facts.guards[outer].outer
            known = self._around[guard] = tuple(found)
        return known

    def collect_guards(self, line: int) -> Collection[int]:
        """The guards, by their places, that calls and assignments on a line are under, -1 for none."""
        if self._lines is None:
            self._lines = {}
            for row in (*self.facts.calls, *self.facts.assignments):
                self._lines.setdefault(row.line, set()).add(row.guard)
        return self._lines.get(line, ())

    def list_calls(self, callee: str) -> Sequence[FlowCall]:
        """The calls of a callee as it is written, in order."""
        if self._calls is None:
            self._calls = group_pairs((call.callee, call) for call in self.facts.calls)
        return self._calls.get(callee, ())

    def forget(self) -> None:
        """Drops what rests on the bodies of other functions."""
        self.identities = {}
        self.targets = {}

    def __repr__(self) -> str:
        return f"Fn({self.source.path}:{self.facts.line} {self.facts.name})"


Made = tuple[Fn, tuple[FlowExpr, ...], int]
"""Where an object is made: the function, the arguments and the line."""


class Variable(NamedTuple):
    """Which variable a name means. kind: `member` (owner: the class's key), `local` (owner: the function's place) or
    `global` (owner: path of the file)."""

    kind: str
    owner: str
    name: str


def _collect_names(source: CodeFile, files: Collection[str]) -> tuple[object, ...]:
    """What a file contributes to what names mean: where they are equal, names mean the same. files: the names of all,
    without their folders."""
    facts = source.facts
    included = tuple(header for header in facts.includes if posixpath.basename(header) in files)
    return source.path, source.package, facts.language, facts.aliases, included, id(facts) if facts.classes else 0


class _About(Generic[_Row]):
    """Rows by the variable that they are about. Which one that is, is asked only of rows that name it by its name.

    rows: the path, and the row itself, which begins with the function that it stands in."""

    def __init__(self, rows: Iterable[tuple[str, _Row]]):
        self._rows: list[_Row] = []
        # Places of rows by their path, and paths by their last part.
        self._places: dict[str, list[int]] = defaultdict(list)
        self._paths: dict[str, list[str]] = defaultdict(list)
        for place, (path, row) in enumerate(rows):
            self._rows.append(row)
            self._places[path].append(place)
        for path in self._places:
            pieces = _split_path(path)
            self._paths[pieces[-1] if pieces else path].append(path)
        self._found: dict[str, dict[Variable, list[_Row]]] = {}

    def select_rows(self, variable: Variable, meaning: Callable[[str, Fn], Variable]) -> Sequence[_Row]:
        """The rows about a variable, in order. meaning: of a path in a function."""
        known = self._found.get(variable.name)
        if known is None:
            known = self._found[variable.name] = {}
            for path, row in self.select_named(variable.name):
                known.setdefault(meaning(path, row[0]), []).append(row)
        return known.get(variable, ())

    def select_named(self, name: str) -> Iterator[tuple[str, _Row]]:
        """The rows whose path ends in a name, in order, with their path."""
        found = ((place, path) for path in self._paths.get(name, ()) for place in self._places[path])
        yield from ((path, self._rows[place]) for place, path in sorted(found))


@lru_cache(maxsize=100_000)
def _split_path(path: str) -> tuple[str, ...]:
    """The parts of a path, elements left out."""
    return tuple(part for part in path.replace("[]", "").split(".") if part)


def _list_assignments(fn: Fn) -> Iterable[Assignment]:
    """The assignments of a function in order, with what in C++ is added to the end of a string, or changed in it."""
    if fn.source.facts.language != "cpp":
        return fn.facts.assignments
    added = [
        Assignment(call.callee.rpartition(".")[0], call.arguments[0], call.line, call.guard, "", "+=")
        for call in fn.facts.calls
        if call.callee.endswith(".append") and len(call.arguments) == 1
    ]
    added += _list_changes(fn)
    return sorted([*fn.facts.assignments, *added], key=attrgetter("line")) if added else fn.facts.assignments


def _list_changes(fn: Fn) -> Iterator[Assignment]:
    """What changes strings in a function in C++ otherwise than by `=`, as assignments of what is not known."""
    changed = [(path, row) for row in fn.facts.calls for path in _list_changed(row)]
    elements = (row for row in fn.facts.assignments if row.target.endswith(".[]"))
    changed += [(row.target.removesuffix(".[]"), row) for row in elements]
    yield from _list_printed(fn)
    if not changed:
        return
    strings = {row.name for row in fn.facts.parameters if _is_string_type(row.type)}
    strings.update(row.target for row in fn.facts.assignments if _is_string_type(row.type))
    for path, row in changed:
        # No container but a string has `replace`; and what holds characters or numbers is no list of names.
        own = row.callee == f"{path}.replace" if isinstance(row, FlowCall) else row.value.kind == "number"
        if path in strings or own:
            yield Assignment(path, FlowExpr("other", f"{path} changed in place"), row.line, row.guard)


def _list_printed(fn: Fn) -> Iterator[Assignment]:
    """What `snprintf` and `sprintf` write in a function, and what `str` begins a stream with."""
    for call in fn.facts.calls:
        name, arguments = get_tail(call.callee), call.arguments
        if name in ("snprintf", "sprintf") and arguments[:1] and arguments[0].kind == "name":
            place = 2 if name == "snprintf" else 1
            pieces = split_percent_format(arguments[place].text) if arguments[place:] else None
            known = pieces is not None and arguments[place].kind == "text"
            joined = make_join(pieces if known else None, arguments[place + 1 :])
            yield Assignment(arguments[0].text, joined or FlowExpr("other", name), call.line, call.guard)
        elif name == "str" and len(arguments) == 1 and call.callee.endswith(".str"):
            yield Assignment(call.callee.removesuffix(".str"), arguments[0], call.line, call.guard)


def _list_changed(call: FlowCall) -> Iterator[str]:
    """The paths of what a call in C++ changes where it is a string."""
    path, _, method = call.callee.rpartition(".")
    if path:
        if method in _CHANGE_STRING:
            yield path
        return
    name = get_tail(call.callee)
    if name in _CHANGE_RANGE:
        begins = (part.text for part in call.arguments if part.kind == "call" and part.text.endswith(".begin"))
        yield from {text.removesuffix(".begin") for text in begins}
    elif call.callee.startswith("boost::") and name.startswith(_CHANGE_IN_PLACE) and not name.endswith("_copy"):
        yield from (part.text for part in call.arguments[:1] if part.kind == "name")


def _is_string_type(written: str) -> bool:
    return "<" not in written and parse_flow_type(written).name.removeprefix("std::") in ("string", "String")


@lru_cache(maxsize=100_000)
def is_number(text: str) -> bool:
    """Whether a text is a whole number that a program could count to."""
    return len(text) < 19 and text.isdecimal() and (text[0] != "0" or text == "0")


@lru_cache(maxsize=100_000)
def get_tail(name: str) -> str:
    """The last part of a path or qualified name."""
    return parts[-1] if (parts := split_name(name)) else ""


def get_outer(name: str) -> str:
    """What stands before the last part of a qualified name."""
    return name.rpartition("::" if "::" in name else ".")[0]


class FlowCode:
    """Functions, classes and variables of many files.

    before: an earlier state of the same code. Where no name means anything else now, what was found out about names is
    taken from it, and it must not be asked again.
    """

    def __init__(
        self, sources: Iterable[CodeFile], before: FlowCode | None = None, built: BuildConstants | None = None
    ):
        self.sources, self.built = list(sources), built or BuildConstants()
        files = {posixpath.basename(source.path) for source in self.sources}
        self.names = tuple(_collect_names(source, files) for source in self.sources)
        if before is not None and before.names != self.names:
            before = None
        self.functions: list[Fn] = []
        self.functions_in: dict[str, list[Fn]] = {}
        self.by_tail: dict[str, list[Fn]] = {}
        self.by_name: dict[tuple[str, str], Fn] = {}
        # Objects that have an equal class each: what was found out about one holds for no other.
        self.classes: dict[str, list[Cls]] = before.classes if before is not None else {}
        self.aliases: dict[str, dict[str, list[Alias]]] = {}
        # Of C++, by the name: with the path of the file.
        self._shared: dict[str, list[tuple[str, Alias]]] = {}
        # Sources in C++ that others include.
        included = {header.rpartition("/")[2] for source in self.sources for header in source.facts.includes}
        for place, source in enumerate(self.sources):
            known = self.aliases.setdefault(source.path, {})
            for alias in source.facts.aliases:
                known.setdefault(alias.name, []).append(alias)
                if source.facts.language == "cpp" and alias.name != "*":
                    self._shared.setdefault(alias.name, []).append((source.path, alias))
            is_source = source.path.endswith(SOURCES) and source.path.rpartition("/")[2] not in included
            is_local = is_source or source.facts.language == "python"
            for cls in source.facts.classes if before is None else ():
                self.classes.setdefault(get_tail(cls.name), []).append(Cls(source, cls, is_local))
            if before is not None and before.sources[place].facts is source.facts:
                functions = before.functions_in[source.path]
                for fn in functions:
                    fn.forget()
            else:
                functions = [Fn(source, facts) for facts in source.facts.functions]
            self.functions_in[source.path] = functions
            for fn in functions:
                self.functions.append(fn)
                self.by_tail.setdefault(get_tail(fn.name), []).append(fn)
                self.by_name.setdefault((source.path, fn.name), fn)
        # Whether a function is the constructor of a class.
        self._begins: dict[Fn, bool] = {}
        # By names alone; a later state of the code may take these over.
        self._class_of: dict[tuple[str, str, str], Cls | None] = before._class_of if before is not None else {}
        self._meant: dict[tuple[str, str, str], str] = before._meant if before is not None else {}
        self._meant_types: dict[tuple[str, str, str], FlowType] = before._meant_types if before is not None else {}

    # Names

    def resolve_name(self, name: str, source: CodeFile, scope: str = "") -> str:
        """A name with aliases of its file (and, in C++, its package's headers) resolved, at most five times over."""
        key = (name, source.path, scope)
        known = self._meant.get(key)
        if known is None:
            known = self._meant[key] = self._find_meant(name, source, scope)
        return known

    def _find_meant(self, name: str, source: CodeFile, scope: str) -> str:
        # What Python imports is named as in the module that has it.
        for _ in range(5 if source.facts.language == "cpp" else 1):
            head, separator, rest = _split_first(name)
            alias = self._find_alias(head, source, scope)
            if alias is None and rest:
                alias = self._find_qualified_alias(name, source)
                separator, rest = ("", "") if alias is not None else (separator, rest)
            if alias is None or _is_within(name, alias.target):
                break
            target = parse_flow_type(alias.target).name if source.facts.language == "cpp" and not rest else alias.target
            new = f"{target}{separator}{rest}" if rest else target
            if new == name or not new:
                break
            name = new
        return name

    def resolve_written(self, text: str, source: CodeFile, scope: str = "") -> FlowType:
        """A type as written, aliases resolved; those that stand for types with template arguments too."""
        key = (text, source.path, scope)
        known = self._meant_types.get(key)
        if known is None:
            kind = self._find_meant_type(text, source, scope)
            name = kind.name if source.facts.language == "cpp" else parse_flow_type(text).name
            known = self._meant_types[key] = kind._replace(cls=self.find_class(name, source, scope))
        return known

    def _find_meant_type(self, text: str, source: CodeFile, scope: str) -> FlowType:
        kind = parse_flow_type(text)
        for _ in range(5 if source.facts.language == "cpp" else 1):
            head, _, rest = _split_first(kind.name)
            alias = self._find_alias(head, source, scope)
            if alias is None and rest:
                alias = self._find_qualified_alias(kind.name, source)
                rest = "" if alias is not None else rest
            if alias is None or _is_within(kind.name, alias.target):
                break
            if rest:
                new = FlowType(
                    f"{parse_flow_type(alias.target).name}{'::' if '::' in kind.name else '.'}{rest}", kind.arguments
                )
                # `using Msg = a::B; Msg::SharedPtr`
                new = FlowType(parse_flow_type(new.name).name, new.arguments or parse_flow_type(alias.target).arguments)
            else:
                new = parse_flow_type(alias.target)
                new = FlowType(new.name, new.arguments or kind.arguments)
            if new == kind or not new.name:
                break
            kind = new
        return kind

    def _find_alias(self, head: str, source: CodeFile, scope: str) -> Alias | None:
        found = self.aliases[source.path].get(head)
        if found is None and source.facts.language == "cpp":
            found = self._list_seen_aliases(head, source)
        if not found:
            return None
        fitting = [alias for alias in found if not alias.scope or _is_within(scope, alias.scope)]
        if not fitting and len({alias.target for alias in found}) == 1:
            fitting = found[:1]
        return max(fitting, key=lambda alias: len(alias.scope), default=None)

    def _find_qualified_alias(self, name: str, source: CodeFile) -> Alias | None:
        """What `ns::Name` is another name of, in C++."""
        if source.facts.language != "cpp" or "::" not in name:
            return None
        wanted = split_name(name)
        found = [
            alias
            for alias in self._list_seen_aliases(wanted[-1], source)
            if alias.scope and (*split_name(alias.scope), alias.name)[-len(wanted) :] == wanted
        ]
        return found[0] if len({alias.target for alias in found}) == 1 else None

    def _list_seen_aliases(self, name: str, source: CodeFile) -> list[Alias]:
        """The aliases of a name in C++ that a file sees."""
        found = self._shared.get(name, ())
        seen = self._seen_files.list_seen(source.path) if found else ()
        return [alias for path, alias in found if path in seen]

    def includes(self, path: str, other: str) -> bool:
        """Whether a file in C++ includes another, or is it."""
        return other in self._seen_files.list_seen(path)

    @cached_property
    def _seen_files(self) -> SeenFiles:
        return SeenFiles(self.sources)

    def find_class(self, name: str, source: CodeFile, scope: str = "") -> Cls | None:
        """The class that a name means in a file and scope; None when there is none, or several that fit as well."""
        key = (name, source.path, scope)
        try:
            return self._class_of[key]
        except KeyError:
            found = self._class_of[key] = self._find_class(name, source, scope)
            return found

    def _find_class(self, name: str, source: CodeFile, scope: str) -> Cls | None:
        if source.facts.language == "python":
            place = self.modules.find("class", name, source, scope)
            named = self.classes[get_tail(place[1])] if place is not None else ()
            found = [cls for cls in named if (cls.source.path, cls.name) == place]
        else:
            wanted = split_name(self.resolve_name(parse_flow_type(name).name if "<" in name else name, source, scope))
            named = self.classes.get(wanted[-1], ()) if wanted else ()
            found = [cls for cls in named if cls.parts[-len(wanted) :] == wanted and cls.source.facts.language == "cpp"]
        if len(found) > 1:
            seen = self._seen_files.list_seen(source.path) if source.facts.language == "cpp" else ()
            found = [cls for cls in found if cls.source.path in seen] or found
            groups = group_pairs((_rate_nearness(cls, source, scope), cls) for cls in found)
            found = groups[max(groups)]
        # Of several bodies under one name (behind `#if`, say) the largest.
        keys = {cls.key for cls in found}
        return max(found, key=lambda cls: cls.facts.end - cls.facts.line) if len(keys) == 1 else None

    @cached_property
    def modules(self) -> PythonModules:
        """Its modules of Python."""
        return PythonModules(self.sources, self.aliases, self._find_alias)

    def find_class_of_type(self, type_: str, source: CodeFile, scope: str) -> Cls | None:
        """The class that a type means, as class_of() says; of a pointer or container that of what it holds."""
        return self.resolve_written(type_, source, scope).cls

    def find_class_of(self, kind: FlowType, fn: Fn) -> Cls | None:
        """The class that a type is in a function."""
        return kind.cls or self.find_class(kind.name, fn.source, fn.scope)

    def list_class_bodies(self, key: str) -> list[Cls]:
        """The bodies of the class of a key."""
        return self._bodies.get(key, [])

    @cached_property
    def fields(self) -> dict[str, tuple[str, ...]]:
        """The data members of the classes of C++ that braces may fill one by one, in their order, by the classes' keys:
        those without a base or a constructor."""
        found: dict[str, tuple[str, ...]] = {}
        for key, (cls, *more) in self._bodies.items():
            names = tuple(one.name for one in cls.facts.members if one.type and not one.shared)
            plain = cls.source.facts.language == "cpp" and not more and not cls.facts.bases
            if plain and names and not any(map(self.is_constructor, self.list_functions(cls))):
                found[key] = names
        return found

    @cached_property
    def _bodies(self) -> dict[str, list[Cls]]:
        return group_pairs((cls.key, cls) for group in self.classes.values() for cls in group)

    @cache_method
    def list_bases(self, cls: Cls) -> list[Cls]:
        """The class and those it derives from, nearest first, as far as they are in the code."""
        known: list[Cls] = []
        queue = [cls]
        while queue and len(known) < 30:
            one = queue.pop(0)
            if one in known:
                continue
            known.append(one)
            found = (self.find_class(base, one.source, one.name) for base in one.facts.bases)
            queue.extend(base for base in found if base is not None)
        return known

    @cached_property
    def derived(self) -> dict[str, list[Cls]]:
        """Key of a class to the classes of the code that derive from it, at any distance."""
        return group_pairs(
            (base.key, cls) for group in self.classes.values() for cls in group for base in self.list_bases(cls)[1:]
        )

    def find_base_made(self, fn: Fn, each: Assignment) -> tuple[str, tuple[FlowExpr, ...]] | None:
        """The base class, as meant, and the arguments that a constructor's initialiser gives it; None for others."""
        if not each.target.startswith("this.") or fn.source.facts.language != "cpp":
            return None
        owner = self.find_owner(fn)
        if owner is None or not owner.facts.bases:
            return None
        name = get_tail(each.target[5:])
        for base in owner.facts.bases:
            if get_tail(parse_flow_type(base).name) == name:
                value = each.value
                made = value.kind in ("make", "list") and not value.text
                kind = self.resolve_written(base, owner.source, owner.name)
                return kind.name, value.parts if made else (value,)
        return None

    def list_base_names(self, cls: Cls) -> Iterator[str]:
        """Names of all bases, those outside of the code too, aliases resolved."""
        for one in self.list_bases(cls):
            for base in one.facts.bases:
                yield self.resolve_written(base, one.source, one.name).name

    @cache_method
    def find_owner(self, fn: Fn) -> Cls | None:
        """The class a function belongs to; that of the function around it for a lambda."""
        if not fn.owner:
            return None
        found = self.find_class(fn.facts.owner, fn.source, fn.scope)
        if found is None and fn.owner[:1] == fn.owner[1:2]:
            # `void a::B::f()` inside `namespace a`
            found = self.find_class("::".join(fn.owner[1:]), fn.source, fn.scope)
        return found

    @cache_method
    def find_method(self, cls: Cls, name: str) -> list[Fn]:
        """Bodies of a method, of the nearest class that has some; overloads are several."""
        return next(filter(None, (self._list_bodies(one, name) for one in self.list_bases(cls))), [])

    def _list_bodies(self, cls: Cls, name: str) -> list[Fn]:
        """Bodies of a method of one class."""
        candidates = self._methods.get((cls.parts[-1], name), ()) if cls.parts else ()
        return [fn for fn in candidates if self._is_owned(fn, cls)]

    @cached_property
    def _methods(self) -> dict[tuple[str, str], list[Fn]]:
        """Methods by the last parts of the names of their class and of themselves."""
        return group_pairs(
            ((fn.owner[-1], get_tail(fn.name)), fn) for fn in self.functions if fn.owner and not fn.is_lambda
        )

    @cache_method
    def list_overrides(self, cls: Cls, name: str) -> list[Fn]:
        """Bodies of a method in classes that derive from a class."""
        return [fn for one in self.derived.get(cls.key, ()) for fn in self._list_bodies(one, name)]

    def find_enclosing(self, fn: Fn) -> Fn | None:
        """The function that a lambda, or a function of Python, stands in."""
        if not fn.scope or (not fn.is_lambda and (fn.source.path, fn.scope) in self._class_bodies):
            return None
        return self.by_name.get((fn.source.path, fn.scope))

    def is_class_body(self, fn: Fn) -> bool:
        """Whether a function stands for the body of a class of Python."""
        return (fn.source.path, fn.facts.name) in self._class_bodies and fn.source.facts.language == "python"

    @cached_property
    def _class_bodies(self) -> set[tuple[str, str]]:
        return {(source.path, cls.name) for source in self.sources for cls in source.facts.classes}

    def list_enclosing_chain(self, fn: Fn) -> Iterator[Fn]:
        """The function, and for a lambda, or a function of Python, those around it whose variables it sees: for a
        method, those that its class stands in."""
        seen = 0
        while fn is not None and seen < 10:
            yield fn
            fn, seen = self.find_enclosing(fn) or self._find_around_class(fn), seen + 1  # type: ignore[assignment]

    def _find_around_class(self, fn: Fn) -> Fn | None:
        """The function of Python that the class of a method stands in."""
        if fn.source.facts.language != "python" or "." not in fn.scope:
            return None
        return self.by_name.get((fn.source.path, get_outer(fn.scope)))

    # Variables

    def resolve_variable(self, path: str, fn: Fn) -> tuple[Variable, tuple[str, ...]]:
        """What the head of a path means in a function, and the parts that follow it."""
        parts = _split_path(path)
        if not parts:
            return Variable("local", fn.place, path), ()
        head = parts[0]
        if head == "this":
            if len(parts) == 1:
                return Variable("this", owner.key if (owner := self.find_owner(fn)) else fn.facts.owner, "this"), ()
            known = fn.heads.get(parts[:2])
            if known is None:
                known = fn.heads[parts[:2]] = self.make_member(fn, parts[1])
            return known, parts[2:]
        known = fn.heads.get(head)
        if known is None:
            known = fn.heads[head] = self._resolve_head(head, fn)
        return known, parts[1:]

    def _resolve_head(self, head: str, fn: Fn) -> Variable:
        if head in fn.locals:
            return Variable("local", fn.place, head)
        for one in self.list_enclosing_chain(fn):
            if head in one.locals:
                return Variable("local", one.place, head)
        if fn.source.facts.language == "cpp" and fn.facts.owner and "::" not in head:
            owner = self.find_owner(fn)
            if owner is not None:
                for cls in self.list_bases(owner):
                    if head in self.list_members(cls):
                        return Variable("member", cls.key, head)
            elif head.endswith("_"):
                return Variable("member", fn.facts.owner, head)
        if fn.source.facts.language == "python" and (place := self.modules.find("constant", head, fn.source, fn.scope)):
            return Variable("global", *place)
        return Variable("global", self._find_definer(head, fn.source) or fn.source.path, head)

    def _find_definer(self, name: str, source: CodeFile) -> str:
        """The source file that defines a variable which another source of its package uses (`extern`); empty where the
        other has one of that name itself, and where it is not one file."""
        if source.facts.language != "cpp":
            return ""
        by_path = self._constants.get(get_tail(name), {})
        beside = [path for path, rows in by_path.items() if rows[0][1].package == source.package]
        found = [path for path in beside if path.endswith(SOURCES)]
        return found[0] if len(found) == 1 and source.path not in beside else ""

    @cache_method
    def list_members(self, cls: Cls) -> frozenset[str]:
        """Names of the members that a class declares."""
        return frozenset(member.name for member in cls.facts.members)

    def make_member(self, fn: Fn, name: str) -> Variable:
        """The member of a function's class, under the name of the class that declares it."""
        owner = self.find_owner(fn)
        if owner is None:
            return Variable("member", fn.facts.owner, name)
        return Variable("member", self._find_declaring_class(owner, name).key, name)

    def _find_declaring_class(self, cls: Cls, name: str) -> Cls:
        """The class that declares a member which a class has, as far as the code tells."""
        declaring = [one for one in self.list_bases(cls) if name in self.list_members(one)]
        return declaring[-1] if declaring else cls

    def identify(self, path: str, fn: Fn, depth: int = 0) -> Variable:
        """The variable that a whole path means: that of its last part, in the class of what stands before it.

        depth: how far types are followed already; from 5 on only declared ones count."""
        known = fn.heads.get(path)
        if known is not None:
            return known
        if depth == 0 and path in fn.identities:
            return fn.identities[path]
        found, rest = self.resolve_variable(path, fn)
        if "()." in path and (member := self._find_member_of_given(path, fn, depth)) is not None:
            found, rest = member
        if rest and found.kind == "global" and fn.source.facts.language == "python":
            place = self.modules.find("constant", f"{found.name}.{rest[0]}", fn.source, fn.scope)
            found, rest = (Variable("global", *place), rest[1:]) if place is not None else (found, rest)
        for part in rest:
            cls = self.find_class_of(self.resolve_variable_type(found, fn, depth), fn)
            owner = self._find_declaring_class(cls, part).key if cls else f"{found.owner}.{found.name}"
            found = Variable("member", owner, part)
        if depth == 0:
            fn.identities[path] = found
        return found

    def _find_member_of_given(self, path: str, fn: Fn, depth: int) -> tuple[Variable, tuple[str, ...]] | None:
        """The member of an object of a class of C++ that a call gives, and the parts that follow it; None where the
        path has no such object. Of `Settings::instance().handle` it is that of Settings."""
        callee, _, members = path.rpartition("().")
        parts = _split_path(members)
        if not parts or fn.source.facts.language != "cpp" or (depth > 4 and "." in callee):
            return None
        cls = self.find_class_of(self.resolve_call_type(callee, fn, min(depth, 4)), fn)
        if cls is None:
            return None
        return Variable("member", self._find_declaring_class(cls, parts[0]).key, parts[0]), parts[1:]

    @cache_method
    def list_functions(self, cls: Cls) -> list[Fn]:
        """The functions of one class, lambdas in them included."""
        return [fn for fn in self._by_owner.get(cls.parts[-1], ()) if self._is_owned(fn, cls)]

    def _is_owned(self, fn: Fn, cls: Cls) -> bool:
        own, wanted = fn.owner, cls.parts
        if own[-len(wanted) :] != wanted and wanted[-len(own) :] != own:
            return False
        if fn.source.path != cls.source.path and (cls.is_local or fn.source.package != cls.source.package):
            return False
        owner = self.find_owner(fn)
        return owner is None or owner.key == cls.key

    @cached_property
    def _by_owner(self) -> dict[str, list[Fn]]:
        return group_pairs((get_tail(fn.facts.owner), fn) for fn in self.functions if fn.facts.owner)

    def list_writes(self, variable: Variable) -> Sequence[tuple[Fn, Assignment]]:
        """All assignments that change a variable. What objects are made with counts where their constructor is not
        written, as that of a data class is not."""
        cls = next(iter(self.list_class_bodies(variable.owner)), None) if variable.kind == "member" else None
        if cls is None or cls.source.facts.language != "python":
            return self._writes.select_rows(variable, self._identify_declared)
        return self._list_python_member_writes(variable, cls)

    @cache_method
    def _list_python_member_writes(self, variable: Variable, cls: Cls) -> Sequence[tuple[Fn, Assignment]]:
        rows = self._writes.select_rows(variable, self._identify_declared)
        begun = [row for row in rows if row[0].facts.name == cls.name]
        others = [row for row in rows if row[0].facts.name != cls.name]
        if any(get_tail(fn.name) == "__init__" and each.guard < 0 and each.operator == "=" for fn, each in others):
            # Each object has what its constructor assigns.
            return [row for row in others if not self.is_class_body(row[0])]
        given = self._list_given_fields(variable, cls)
        made = [(fn, each) for fn, each in given if each is not None]
        return [*(begun if len(made) < len(given) else ()), *made, *others] if given else rows

    def _list_given_fields(self, variable: Variable, cls: Cls) -> list[tuple[Fn, Assignment | None]]:
        """What a field of a class of Python whose constructor is not written is given where its objects are made, None
        where it is left out; nothing where nobody gives it."""
        if self.find_method(cls, "__init__"):
            return []
        fields = [member.name for member in cls.facts.members if member.type]
        if variable.name not in fields:
            return []
        place = fields.index(variable.name) if not self.list_bases(cls)[1:] else len(fields)
        found: dict[tuple[Fn, int, FlowExpr | None], None] = {}
        for fn, arguments, line in self.constructions.get(cls.key, ()):
            keywords = {one.text: one.parts[0] for one in arguments if one.kind == "keyword" and one.parts}
            positional = [one for one in arguments if one.kind != "keyword"]
            value = keywords.get(variable.name, positional[place] if place < len(positional) else None)
            # What a dictionary gives may be of any field.
            found[fn, line, FlowExpr("other", "**") if value is None and "**" in keywords else value] = None
        rows = [
            (fn, Assignment(f"this.{variable.name}", value, line) if value is not None else None)
            for fn, line, value in found
        ]
        return rows if any(each is not None for _, each in rows) else []

    def list_results(self, variable: Variable) -> Sequence[tuple[Fn, FlowCall]]:
        """Calls whose result a variable keeps."""
        return self._results.select_rows(variable, self._identify_declared)

    def list_resets(self, variable: Variable) -> Sequence[tuple[Fn, FlowExpr]]:
        """What `variable.reset(...)` is given, with the function that calls it."""
        return self._resets.get(variable, ())

    @cached_property
    def _resets(self) -> dict[Variable, list[tuple[Fn, FlowExpr]]]:
        found: dict[Variable, list[tuple[Fn, FlowExpr]]] = {}
        for fn, call in self.list_calls_named(("reset",)):
            if "." in call.callee and call.arguments:
                variable = self.identify(call.callee.rpartition(".")[0], fn)
                found.setdefault(variable, []).append((fn, call.arguments[0]))
        return found

    def list_passed(self, variable: Variable) -> Sequence[tuple[Fn, FlowCall, int]]:
        """Calls of functions of the code that a variable is passed to, with the argument's number."""
        return self._passed.select_rows(variable, self.identify)

    def _identify_declared(self, path: str, fn: Fn) -> Variable:
        """What a path means by what is declared alone."""
        return self.identify(path, fn, 9)

    @cached_property
    def _writes(self) -> _About[tuple[Fn, Assignment]]:
        return _About((e.target, (fn, e)) for fn in self.functions for e in _list_assignments(fn) if e.target)

    @cached_property
    def _results(self) -> _About[tuple[Fn, FlowCall]]:
        return _About((c.target, (fn, c)) for fn in self.functions for c in fn.facts.calls if c.target)

    @cached_property
    def _passed(self) -> _About[tuple[Fn, FlowCall, int]]:
        return _About(
            (argument.text, (fn, call, place))
            for fn, call in self.list_calls_named(self.by_tail)
            if fn.source.facts.language == "cpp"
            for place, argument in enumerate(call.arguments)
            if argument.kind == "name"
        )

    def find_declared_type(self, variable: Variable, fn: Fn) -> tuple[str, CodeFile, str]:
        """The type a variable is declared with, as written, and the file and scope in which to read it."""
        if variable.kind == "member":
            return self._find_member_type(variable.owner, variable.name) or ("", fn.source, fn.scope)
        if variable.kind == "local":
            for one in self.list_enclosing_chain(fn):
                if one.place == variable.owner:
                    for parameter in one.facts.parameters:
                        if parameter.name == variable.name and parameter.type:
                            return parameter.type, one.source, one.name
                    for each in one.assigned.get(variable.name, ()):
                        if each.type and parse_flow_type(each.type).name:
                            return each.type, one.source, one.name
        else:
            own = self._by_path.get(variable.owner, fn.source)
            for source in (own, *self._list_declaring_headers(variable, own)):
                rows = [constant for constant in source.facts.constants if constant.type]
                named = [constant for constant in rows if constant.name == variable.name]
                # In a namespace around, or one that is used: where all of that name are of one type.
                same = [constant for constant in rows if get_tail(constant.name) == get_tail(variable.name)]
                if named or len({constant.type for constant in same}) == 1:
                    first = (named or same)[0]
                    return first.type, source, get_outer(first.name)
        return "", fn.source, fn.scope

    def _list_declaring_headers(self, variable: Variable, source: CodeFile) -> list[CodeFile]:
        """The headers that a file in C++ sees and that declare a variable outside of functions."""
        by_path = self._constants.get(get_tail(variable.name), {}) if source.facts.language == "cpp" else {}
        others = [path for path in by_path if path != source.path and not path.endswith(SOURCES)]
        seen = self._seen_files.list_seen(source.path) if others else ()
        return [self._by_path[path] for path in others if path in seen]

    @cache_method
    def list_copies(self, variable: Variable) -> list[Variable]:
        """What a variable that a header declares outside of functions is in the files that include the header."""
        rows = self._constants.get(get_tail(variable.name), {}).get(variable.owner, ())
        if variable.kind != "global" or not rows or not variable.owner.endswith(_HEADERS):
            return []
        including = sorted(self._seen_files.list_including(variable.owner))
        return [Variable("global", path, variable.name) for path in including if path.endswith(SOURCES)]

    def list_declared_values(self, variable: Variable, fn: Fn) -> Iterator[tuple[FlowExpr, Fn]]:
        """What a member or a constant is declared with, and a function of the file in which to read it."""
        if variable.kind == "member":
            rows = [
                (member, cls.source)
                for cls in self.list_class_bodies(variable.owner)
                for member in cls.facts.members
                if member.name == variable.name
            ]
        elif variable.kind == "global":
            rows = self.list_constants(variable, fn)
        else:
            return
        for member, source in rows:
            holder = self.find_first(source, fn)
            if member.value is not None:
                yield member.value, holder

    def list_constants(self, variable: Variable, fn: Fn) -> list[tuple[DataMember, CodeFile]]:
        """The constants that a global variable is. In C++ those of its name that the file of a function has or sees,
        also by headers of other packages; where it sees none, those of a file of its package. What is declared alone is
        what any file defines under the same name. None where files that it sees disagree."""
        by_path, source = self._constants.get(get_tail(variable.name), {}), fn.source
        if source.facts.language == "python":
            return by_path.get(variable.owner, [])
        if "::" in variable.name:
            # `namespace t = robot::topics`
            variable = variable._replace(name=self.resolve_name(variable.name, source, fn.scope))
        if not by_path:
            return []
        seen = self._seen_files.list_seen(source.path)
        beside = (path for path, rows in by_path.items() if rows[0][1].package == source.package)
        for paths in ([source.path], sorted(seen.intersection(by_path)), beside):
            found = _select_named(variable.name, fn, [row for path in paths for row in by_path.get(path, ())])
            if found:
                break
        else:
            return []
        if all(constant.value is None for constant, _ in found):
            names = {constant.name for constant, _ in found}
            found = (self.list_definitions(names.pop()) if len(names) == 1 else []) or found
        files = {one.path for _, one in found}
        return found if len(files) < 2 or len({constant.value for constant, _ in found}) == 1 else []

    def list_built_constants(self, name: str, fn: Fn) -> list[tuple[FlowExpr, bool]]:
        """As BuildConstants.list_values() tells it of a name in a function."""
        source = fn.source
        return self.built.list_values(name, source.path, source.package) if source.facts.language == "cpp" else []

    def list_seen_sources(self, path: str) -> list[CodeFile]:
        """The C++ files that one sees, itself among them."""
        return [self._by_path[seen] for seen in sorted(self._seen_files.list_seen(path)) if seen in self._by_path]

    def list_definitions(self, name: str) -> list[tuple[DataMember, CodeFile]]:
        """What C++ files define under a full name that another declares: a static member, a variable that is extern."""
        rows = (row for rows in self._constants.get(get_tail(name), {}).values() for row in rows)
        return [row for row in rows if row[0].name == name and row[0].value is not None]

    @cached_property
    def _by_path(self) -> dict[str, CodeFile]:
        return {source.path: source for source in self.sources}

    @cached_property
    def _constants(self) -> dict[str, dict[str, list[tuple[DataMember, CodeFile]]]]:
        """By the last part of their names, and by file."""
        found: dict[str, dict[str, list[tuple[DataMember, CodeFile]]]] = {}
        for source in self.sources:
            for constant in source.facts.constants:
                by_path = found.setdefault(get_tail(constant.name), {})
                by_path.setdefault(source.path, []).append((constant, source))
        return found

    def find_first(self, source: CodeFile, otherwise: Fn) -> Fn:
        """The first function of a file; `otherwise` for a file without functions."""
        return next(iter(self.functions_in.get(source.path, ())), otherwise)

    @cache_method
    def find_held_class(self, cls: Cls, name: str) -> Cls | None:
        """The class of the code of which a member holds an object itself."""
        for one in self.list_bases(cls):
            for member in one.facts.members:
                if member.name == name:
                    if not member.type or _points(member.type):
                        return None
                    if "<" in member.type:
                        # An object of a template of the code; what a container holds is another matter.
                        return self.find_class(parse_flow_type(member.type).name, one.source, one.name)
                    return self.find_class_of_type(member.type, one.source, one.name)
        return None

    def find_written_type(self, path: str, fn: Fn) -> str:
        """The type that a variable is declared with, as written."""
        return self.find_declared_type(self.identify(path, fn, 9), fn)[0]

    @cache_method
    def _find_member_type(self, owner: str, name: str) -> tuple[str, CodeFile, str] | None:
        for cls in self.list_class_bodies(owner):
            for member in cls.facts.members:
                if member.name == name and member.type:
                    return member.type, cls.source, cls.name
        return None

    def resolve_variable_type(self, variable: Variable, fn: Fn, depth: int = 0) -> FlowType:
        """The type of a variable, also where `auto` or Python leave it to what it is made from."""
        if variable.kind == "this":
            owner = self.find_owner(fn)
            return FlowType(owner.name if owner is not None else variable.owner, (), owner)
        text, source, scope = self.find_declared_type(variable, fn)
        kind = self.resolve_written(text, source, scope) if text else UNKNOWN
        if kind.name or depth > 4:
            return kind if kind.name or fn.source.facts.language == "cpp" else self._find_made_type(variable, fn)
        for writer, each in self.list_writes(variable):
            kind = self.resolve_type(each.value, writer, depth + 1)
            if kind.name:
                return kind
        return UNKNOWN

    def _find_made_type(self, variable: Variable, fn: Fn) -> FlowType:
        """The type of a variable of Python that a function, or a module, makes once: `settings = Settings()`."""
        if variable.kind == "local":
            holder = next((one for one in self.list_enclosing_chain(fn) if one.place == variable.owner), None)
        else:
            holder = self.by_name.get((variable.owner, "")) if variable.kind == "global" else None
        made = holder.assigned.get(variable.name, ()) if holder is not None else ()
        value = made[0].value if len(made) == 1 else None
        if holder is None or value is None or value.kind != "make":
            return UNKNOWN
        return self.resolve_written(value.text, holder.source, holder.scope)

    def resolve_type(self, value: FlowExpr, fn: Fn, depth: int = 0) -> FlowType:
        """The type of an expression as far as it shows."""
        if value.kind == "make":
            return self.resolve_written(value.text, fn.source, fn.scope)
        if value.kind == "name":
            return self.resolve_name_type(value.text, fn, depth)
        if value.kind == "call":
            return self.resolve_call_type(value.text, fn, depth)
        if (value.kind == "list" and len(value.parts) == 1) or (value.kind == "index" and value.parts):
            # The type of a container is that of its elements.
            return self.resolve_type(value.parts[0], fn, depth)
        return UNKNOWN

    def resolve_name_type(self, path: str, fn: Fn, depth: int = 0) -> FlowType:
        """The type of what a path means in a function."""
        variable, rest = self.resolve_variable(path, fn)
        return self.resolve_variable_type(self.identify(path, fn, depth + 1) if rest else variable, fn, depth)

    def resolve_call_type(self, callee: str, fn: Fn, depth: int = 0) -> FlowType:
        """The type that a call gives: the class for a constructor, the declared type of a function of the code."""
        name = callee.removesuffix("()")
        if depth > 4:
            return UNKNOWN
        last = get_tail(name)
        if last in ("make_shared", "make_unique") or (last == "create" and "::" in name):
            scope = get_outer(name)
            return self.resolve_written(scope, fn.source, fn.scope) if scope not in ("std", "boost", "") else UNKNOWN
        if last in MAKES_PLUGIN and "." in name:
            loader = self.resolve_name_type(name.rpartition(".")[0], fn, depth + 1)
            if loader.arguments:
                return self.resolve_written(loader.arguments[0], fn.source, fn.scope)
        for target in self.list_targets(name, fn, depth + 1):
            if target.facts.returns:
                return self.resolve_written(target.facts.returns, target.source, target.scope)
        meant = self.resolve_name(name, fn.source, fn.scope)
        if get_tail(meant)[:1].isupper() or self.is_class(name, fn):
            return FlowType(meant, (), self.find_class(name, fn.source, fn.scope))
        return UNKNOWN

    def is_class(self, name: str, fn: Fn) -> bool:
        """Whether a name in a function is that of a class of the code."""
        return get_tail(name) in self.classes and self.find_class(name, fn.source, fn.scope) is not None

    def find_default(self, fn: Fn, place: int, parameter: FlowParameter) -> FlowExpr | None:
        """The default of a parameter, which C++ writes where the function is declared."""
        if parameter.default is not None or fn.source.facts.language != "cpp":
            return parameter.default
        count = len(fn.facts.parameters)
        found = (defaults for name, defaults in self._defaults.get(get_tail(fn.name), ()) if name == fn.name)
        return next((defaults[place] for defaults in found if len(defaults) == count), None)

    @cached_property
    def _defaults(self) -> dict[str, list[tuple[str, tuple[FlowExpr | None, ...]]]]:
        return group_pairs((get_tail(row[0]), row) for source in self.sources for row in source.facts.defaults)

    def may_be_called(self, fn: Fn) -> bool:
        """False for a method that nothing in the code calls or mentions by its name, of a class that nobody else calls
        methods of."""
        name = get_tail(fn.facts.name)
        owner = self.find_owner(fn)
        if owner is None or fn.is_lambda or not name.isidentifier() or name[:2] == name[-2:] == "__":
            return True
        if name in ELEMENTS:
            return True  # facts have an element for such a call
        return not self.is_called_by_code(owner, name) or name in self.mentioned or name == get_tail(owner.name)

    @cache_method
    def is_called_by_code(self, cls: Cls, name: str) -> bool:
        """Whether nothing but the code calls a method of a class: all of its bases are in the code, or are known not to
        call it."""
        every = ((base, one) for one in self.list_bases(cls) for base in one.facts.bases)
        outside = (base for base, one in every if self.find_class(base, one.source, one.name) is None)
        known = (_CALLED_BY.get(get_tail(parse_flow_type(base).name)) for base in outside)
        return all(called is not None and name not in called for called in known)

    def is_idle(self, fn: Fn) -> bool:
        """Whether a function is a method that nothing calls, of a class that nobody else can call methods of, and that
        is handed to nobody."""
        owner, name = self.find_owner(fn), get_tail(fn.facts.name)
        if owner is None or fn.is_lambda or self.is_constructor(fn) or name in self.handed_on:
            return False
        return not self.callers.get(fn) and self.is_called_by_code(owner, name)

    @cached_property
    def handed_on(self) -> frozenset[str]:
        """The last parts of all names that the code hands on."""
        return frozenset(get_tail(one.text) for one in self._list_expressions() if one.kind in ("function", "name"))

    @cached_property
    def mentioned(self) -> frozenset[str]:
        """The last parts of all names that the code calls, or hands on."""
        called = frozenset(get_tail(call.callee) for fn in self.functions for call in fn.facts.calls)
        return called.union(get_tail(one.text) for one in self._list_expressions() if one.text)

    def _list_expressions(self) -> Iterator[FlowExpr]:
        """All arguments and values that are assigned, with their parts."""
        for fn in self.functions:
            waiting = [argument for call in fn.facts.calls for argument in call.arguments]
            waiting += [each.value for each in fn.facts.assignments]
            while waiting:
                one = waiting.pop()
                yield one
                waiting += one.parts

    @cached_property
    def unused_headers(self) -> frozenset[str]:
        """The headers that no file includes, by no path that they may be included by, and whose name another has too:
        old ones that were put aside."""
        included = {posixpath.normpath(path).lstrip("./") for one in self.sources for path in one.facts.includes}
        headers = [one.path for one in self.sources if one.path.endswith(_HEADERS)]
        count = Counter(map(posixpath.basename, headers))
        return frozenset(
            path
            for path in headers
            if count[posixpath.basename(path)] > 1
            and included.isdisjoint("/".join(path.split("/")[start:]) for start in range(path.count("/") + 1))
        )

    def list_kept(self, variable: Variable) -> Iterator[tuple[Fn, FlowCall | FlowExpr]]:
        """The calls whose result a variable keeps, and what is assigned to it, with the function they stand in; by the
        types that everything shows, where list_writes() and results() go by those declared."""
        for path, (fn, call) in self._results.select_named(variable.name):
            if self.identify(path, fn) == variable:
                yield fn, call
        for path, (fn, each) in self._writes.select_named(variable.name):
            if self.identify(path, fn) == variable:
                yield fn, each.value

    # Calls

    def list_calls_named(self, names: Iterable[str]) -> list[tuple[Fn, FlowCall]]:
        """Calls of functions of some names, by the last part of the callee; in the order of the code."""
        found = [row for name in names for row in self._calls.get(name, ())]
        found.sort(key=itemgetter(0))
        return [(fn, call) for _, fn, call in found]

    @cached_property
    def _calls(self) -> dict[str, list[tuple[int, Fn, FlowCall]]]:
        """All calls by the last part of the callee, with their place among all."""
        every = ((fn, call) for fn in self.functions for call in fn.facts.calls)
        return group_pairs((get_tail(call.callee), (place, fn, call)) for place, (fn, call) in enumerate(every))

    def list_targets(self, callee: str, fn: Fn, depth: int = 0) -> list[Fn]:
        """The functions of the code that a call may reach; none when it leaves the code or cannot be known."""
        known = fn.targets.get(callee)
        if known is None:
            last = get_tail(callee)
            if last not in self.by_tail and last not in self.classes and last not in self._lambda_names:
                return []
            known = self._find_targets(callee, fn, depth)
            if depth == 0:
                fn.targets[callee] = known
        return known

    def _find_targets(self, callee: str, fn: Fn, depth: int) -> list[Fn]:
        last = get_tail(callee)
        candidates = self.by_tail.get(last)
        head = callee.rpartition(".")[0] if "." in callee else ""
        if "." in callee:
            return self._list_called_methods(head, last, fn, depth)
        if "::" in callee:
            meant = self.resolve_name(callee, fn.source, fn.scope)
            cls = self.find_class(get_outer(meant), fn.source, fn.scope)
            if cls is not None and (get_tail(cls.name), last) in self._methods:
                return self.find_method(cls, last)
            wanted = split_name(meant)
            found = [f for f in candidates or () if not f.facts.owner and split_name(f.name)[-len(wanted) :] == wanted]
            return self._select_nearest(found, fn) or self._select_only(found, wanted)
        for one in self.list_enclosing_chain(fn):
            local = self.by_name.get(
                (fn.source.path, f"{one.name}{'::' if fn.source.facts.language == 'cpp' else '.'}{last}")
            )
            if local is not None:
                return [local]
            kept = self._list_kept_lambdas(last, one)
            if kept:
                return kept
        if fn.source.facts.language == "cpp":
            owner = self.find_owner(fn)
            if owner is not None:
                found = self.find_method(owner, last)
                if found:
                    return [*found, *self.list_overrides(owner, last)]
        else:
            return self.list_defined(last, fn.source, fn.scope)
        return self._select_nearest([f for f in candidates or () if not f.facts.owner and f.name], fn)

    @cached_property
    def _lambda_names(self) -> frozenset[str]:
        """The names of variables that lambdas are kept in."""
        rows = (each for fn in self.functions for each in fn.facts.assignments)
        return frozenset(each.target for each in rows if each.value.kind == "lambda" and each.target.isidentifier())

    def _list_kept_lambdas(self, name: str, fn: Fn) -> list[Fn]:
        """The lambdas that a local variable of a function is, when it is nothing else."""
        rows = fn.assigned.get(name, ()) if name in self._lambda_names and name in fn.locals else ()
        if any(each.value.kind != "lambda" for each in rows):
            return []
        found = (self.by_name.get((fn.source.path, each.value.text)) for each in rows)
        return [one for one in found if one is not None]

    def _list_called_methods(self, receiver: str, name: str, fn: Fn, depth: int) -> list[Fn]:
        if receiver in ("this", "super()", "super"):
            owner = self.find_owner(fn)
            if owner is None:
                return [f for f in self.by_tail.get(name, ()) if f.facts.owner == fn.facts.owner]
            found = self.find_method(owner, name)
            if receiver != "this":
                return [f for f in found if self.find_owner(f) is not owner]
            return [*found, *self.list_overrides(owner, name)]
        if fn.source.facts.language == "python":
            variable, _ = self.resolve_variable(receiver, fn)
            found = self.list_defined(f"{receiver}.{name}", fn.source) if variable.kind == "global" else []
            if found:
                return found
            named = self.find_class(receiver, fn.source, fn.scope) if variable.kind == "global" else None
            if named is not None:
                # As of its objects; but the method of a base is given the object.
                owner = self.find_owner(fn)
                inherits = owner is not None and named.key in {one.key for one in self.list_bases(owner)[1:]}
                return self.find_method(named, name) if not inherits or name == "__init__" else []
        cls = self._find_receiver_class(receiver, fn) if depth == 0 else self._resolve_receiver(receiver, fn, depth)
        return [] if cls is None else [*self.find_method(cls, name), *self.list_overrides(cls, name)]

    @cache_method
    def _find_receiver_class(self, receiver: str, fn: Fn) -> Cls | None:
        return self._resolve_receiver(receiver, fn, 0)

    def _resolve_receiver(self, receiver: str, fn: Fn, depth: int) -> Cls | None:
        """The class of what a method is called on."""
        if receiver.endswith("()"):
            kind = self.resolve_call_type(receiver, fn, depth + 1)
        else:
            kind = self.resolve_name_type(receiver, fn, depth)
        return self.find_class_of(kind, fn)

    def list_defined(self, name: str, source: CodeFile, scope: str = "") -> list[Fn]:
        """The functions of Python, outside of classes, that a name means in a file and scope."""
        place = self.modules.find("function", name, source, scope)
        candidates = self.by_tail.get(get_tail(place[1]), ()) if place is not None else ()
        return [f for f in candidates if (f.source.path, f.name) == place and not f.facts.owner]

    def _select_nearest(self, found: list[Fn], fn: Fn) -> list[Fn]:
        for near in (
            [f for f in found if f.source.path == fn.source.path],
            [
                f
                for f in found
                if f.source.package == fn.source.package and f.source.facts.language == fn.source.facts.language
            ],
        ):
            if near:
                return near
        return []

    def _select_only(self, found: list[Fn], name: tuple[str, ...]) -> list[Fn]:
        """The functions of another package in C++ that a whole name means, where one file alone has them."""
        same = [f for f in found if split_name(f.name) == name and f.source.facts.language == "cpp"]
        return same if len({f.source.path for f in same}) == 1 else []

    @cached_property
    def callers(self) -> dict[Fn, list[tuple[Fn, FlowCall]]]:
        """Calls that reach a function of the code, by the function."""
        calls = self.list_calls_named(self.by_tail.keys() | self.classes.keys() | self._lambda_names)
        reached = (
            (target, (fn, call))
            for fn, call in calls
            for target in select_overloads(self.list_targets(call.callee, fn), call, fn)
        )
        return group_pairs((target, caller) for target, caller in reached if caller[0] is not target)

    @cached_property
    def bound(self) -> dict[Fn, list[tuple[Fn, tuple[FlowExpr, ...]]]]:
        """Functions of the code that are bound with arguments (std::bind, partial), by the function."""
        found: dict[Fn, list[tuple[Fn, tuple[FlowExpr, ...]]]] = {}

        def walk(value: FlowExpr, fn: Fn, depth: int) -> None:
            if value.kind == "bind" and value.parts and value.parts[0].kind in ("function", "name"):
                name, arguments = value.parts[0].text, value.parts[1:]
                method = "::" in name and bool(arguments) and arguments[0].text == "this"
                for target in self.list_targets(name, fn):
                    found.setdefault(target, []).append((fn, arguments[1:] if method else arguments))
            for part in value.parts if depth < 3 else ():
                if part.parts:
                    walk(part, fn, depth + 1)

        for fn in self.functions:
            given = (argument for call in fn.facts.calls for argument in call.arguments)
            for value in (*given, *(each.value for each in fn.facts.assignments)):
                if value.parts:
                    walk(value, fn, 0)
        return found

    @cached_property
    def constructions(self) -> dict[str, list[Made]]:
        """Where objects of a class of the code are made: key of the class to function, arguments and line."""
        found: dict[str, list[Made]] = {}
        for fn in self.functions:
            for name, arguments, line in list_made(fn, self):
                last = get_tail(name)
                if last in self.classes or last in self._shared:
                    cls = self.find_class(name, fn.source, fn.scope)
                    if cls is not None:
                        found.setdefault(cls.key, []).append((fn, arguments, line))
        for cls in (cls for group in self.classes.values() for cls in group if cls.source.facts.language == "cpp"):
            for member in cls.facts.members:
                given = member.value
                held = self.find_held_class(cls, member.name) if given is not None and given.kind == "make" else None
                maker = next(iter(self.list_functions(cls)), None) if held is not None else None
                if held is not None and given is not None and maker is not None:
                    found.setdefault(held.key, []).append((maker, given.parts, member.line))
        return found

    @cached_property
    def bases_made(self) -> dict[str, list[Made]]:
        """Constructors that initialise a base class of the code, or call another constructor of their own class: key of
        that class to function, arguments and line."""
        found: dict[str, list[Made]] = {}
        for fn in self.functions:
            owner = self.find_owner(fn) if fn.facts.owner else None
            if owner is None:
                continue
            for call in fn.facts.calls:
                for base in self._list_initialised_bases(call, owner):
                    found.setdefault(base.key, []).append((fn, call.arguments, call.line))
            for each in fn.facts.assignments:
                if each.target == f"this.{get_tail(owner.name)}" and each.value.kind == "make":
                    found.setdefault(owner.key, []).append((fn, each.value.parts, each.line))
                made = self.find_base_made(fn, each)
                cls = self.find_class(made[0], fn.source, fn.scope) if made is not None else None
                if made is not None and cls is not None:
                    found.setdefault(cls.key, []).append((fn, made[1], each.line))
        return found

    def _list_initialised_bases(self, call: FlowCall, owner: Cls) -> list[Cls]:
        """The bases of a class of Python that a call initialises: `super().__init__()`, `Base.__init__(self)`."""
        if not call.callee.endswith(".__init__"):
            return []
        bases = self.list_bases(owner)[1:]
        if call.callee == "super().__init__":
            return bases[:1]
        named = self.find_class(call.callee.removesuffix(".__init__"), owner.source, owner.name)
        return [one for one in bases if named is not None and one.key == named.key]

    def is_constructor(self, fn: Fn) -> bool:
        """Whether a function is the constructor of a class of the code."""
        known = self._begins.get(fn)
        if known is None:
            owner = self.find_owner(fn)
            known = owner is not None and get_tail(fn.name) in (get_tail(owner.name), "__init__")
            self._begins[fn] = known
        return known

    def list_constructed(self, fn: Fn) -> Iterator[Made]:
        """Who makes objects by a constructor, with its arguments and line; nothing for other functions."""
        owner = self.find_owner(fn)
        if owner is not None and self.is_constructor(fn):
            inheriting = (one for one in self.derived.get(owner.key, ()) if self._is_inheriting(one, fn, owner))
            for cls in (owner, *inheriting):
                yield from (row for row in self.constructions.get(cls.key, ()) if self._is_chosen(fn, owner, row[1]))
            made = self.constructions.get(owner.key, ())
            for row in self.bases_made.get(owner.key, ()):
                # Another constructor of the class, where that makes an object.
                used = self.find_owner(row[0]) != owner or any(self._is_chosen(row[0], owner, one[1]) for one in made)
                if self._is_chosen(fn, owner, row[1]) and (used or not made):
                    yield row

    def _is_inheriting(self, cls: Cls, fn: Fn, owner: Cls) -> bool:
        """Whether objects of a class are made by a constructor of a base: in C++ by `using Base::Base`."""
        if get_tail(fn.name) == "__init__":
            return fn in self.find_method(cls, "__init__")
        written = (one for one in self.list_bases(cls) if any(map(self.is_constructor, self.list_functions(one))))
        return next((one.key for one in written), "") == owner.key

    def _is_chosen(self, fn: Fn, cls: Cls, arguments: tuple[FlowExpr, ...]) -> bool:
        """Whether a constructor is the one that arguments are for: of several, one with as many parameters, if there is
        any."""
        if len(fn.facts.parameters) == len(arguments) or fn.source.facts.language != "cpp":
            return True
        return len(arguments) not in self._count_parameters(cls)

    @cache_method
    def _count_parameters(self, cls: Cls) -> frozenset[int]:
        """How many parameters the constructors of a class have."""
        return frozenset(len(one.facts.parameters) for one in self.list_functions(cls) if self.is_constructor(one))

    def list_given(self, fn: Fn, place: int, name: str) -> Iterator[tuple[FlowExpr, Fn]]:
        """What is given for the parameter of a function, where it is called, bound, or makes an object; with who gives
        it."""
        called = ((caller, call.arguments) for caller, call in self.callers.get(fn, ()))
        made = ((maker, arguments) for maker, arguments, _ in self.list_constructed(fn))
        for giver, arguments in (*called, *self.bound.get(fn, ()), *made):
            argument = find_argument(arguments, place, name)
            if argument is not None:
                yield argument, giver


def find_argument(arguments: tuple[FlowExpr, ...], place: int, name: str) -> FlowExpr | None:
    """The argument that is given for a parameter, by its name or its place; None where none is."""
    for argument in arguments:
        if argument.kind == "keyword" and argument.text == name and argument.parts:
            return argument.parts[0]
    positional = [argument for argument in arguments if argument.kind != "keyword"]
    return positional[place] if 0 <= place < len(positional) else None


def list_made(fn: Fn, code: FlowCode) -> list[tuple[str, tuple[FlowExpr, ...], int]]:
    """Objects that a function makes: type as meant (template arguments kept), arguments, line."""
    if fn.made is None:
        fn.made = list(_find_made(fn, code))
    return fn.made


def _find_made(fn: Fn, code: FlowCode) -> Iterator[tuple[str, tuple[FlowExpr, ...], int]]:
    for call in fn.facts.calls:
        last = get_tail(call.callee)
        if last in ("make_shared", "make_unique", "allocate_shared") and call.types:
            yield call.types, call.arguments, call.line
        elif last == "make_shared" and "::" in call.callee:
            yield get_outer(call.callee), call.arguments, call.line
        elif fn.source.facts.language == "python" and (last[:1].isupper() or code.is_class(call.callee, fn)):
            yield code.resolve_name(call.callee, fn.source), call.arguments, call.line
        elif call.callee == "this" and (own := code.find_owner(fn)) and not code.find_method(own, "__call__"):
            # `cls(...)` in a method of the class.
            yield own.name, call.arguments, call.line
        elif last == "emplace_back" and call.callee != last and fn.source.facts.language == "cpp":
            # Into a container of objects: of pointers, it is given one.
            written = code.find_written_type(call.callee.rpartition(".")[0], fn)
            cls = code.find_class_of_type(written, fn.source, fn.scope) if written and not _points(written) else None
            if cls is not None and not _is_one_of(call.arguments, cls, fn, code):
                yield cls.name, call.arguments, call.line
        elif "." not in call.callee and fn.source.facts.language == "cpp" and code.is_class(call.callee, fn):
            yield call.callee, call.arguments, call.line
        for argument in call.arguments:
            if argument.parts or argument.kind == "make":
                for value in _list_makes(argument):
                    yield value.text, value.parts, call.line
    for each in fn.facts.assignments:
        if each.value.parts or each.value.kind == "make":
            for value in _list_makes(each.value):
                yield value.text, value.parts, each.line
        if each.target.startswith("this.") and fn.source.facts.language == "cpp":
            yield from _list_initialised(each, fn, code)


def _list_initialised(each: Assignment, fn: Fn, code: FlowCode) -> Iterator[tuple[str, tuple[FlowExpr, ...], int]]:
    """The object that the initialiser of a constructor makes as a member: `left_(node, "left")`."""
    value, name = each.value, each.target[5:]
    given = value.parts if value.kind in ("make", "list") and not value.text else (value,)
    if (value.kind == "make" and value.text) or value.kind not in ("make", "list", "name", "text"):
        return
    owner = code.find_owner(fn) if code.is_constructor(fn) else None
    cls = code.find_held_class(owner, name) if owner is not None else None
    if cls is not None and not _is_one_of(given, cls, fn, code):
        yield cls.name, given, each.line


def _is_one_of(arguments: tuple[FlowExpr, ...], cls: Cls, fn: Fn, code: FlowCode) -> bool:
    """Whether arguments are one object of a class, which is copied or moved then."""
    if len(arguments) != 1:
        return False
    one = arguments[0]
    if one.kind == "call" and get_tail(one.text) == "move" and len(one.parts) == 1:
        one = one.parts[0]
    return code.find_class_of(code.resolve_type(one, fn, 3), fn) is cls


def _points(type_: str) -> bool:
    return "*" in type_ or "&" in type_ or "ptr" in type_.lower()


def _list_makes(value: FlowExpr, depth: int = 0) -> list[FlowExpr]:
    found = [value] if value.kind == "make" and value.text else []
    for part in value.parts if depth < 4 else ():
        if part.parts or part.kind == "make":
            found += _list_makes(part, depth + 1)
    return found


def find_parameter(fn: Fn, name: str) -> tuple[int, FlowParameter] | None:
    """The place and facts of a parameter. The object of a method is none, a function's own `self` is."""
    return next(((place, one) for place, one in enumerate(fn.facts.parameters) if one.name == name), None)


def _split_first(name: str) -> tuple[str, str, str]:
    """Head, separator and rest of a qualified name."""
    one, other = name.find("::"), name.find(".")
    if one < 0 and other < 0:
        return name, "", ""
    if other < 0 or (0 <= one < other):
        return name[:one], "::", name[one + 2 :]
    return name[:other], ".", name[other + 1 :]


def _is_within(scope: str, outer: str) -> bool:
    return scope == outer or scope.startswith((outer + "::", outer + "."))


def _rate_nearness(cls: Cls, source: CodeFile, scope: str) -> int:
    """How near a class is to whoever names it."""
    same = cls.source.path == source.path
    near = 8 * (same or not cls.is_local) + 4 * same + 2 * (cls.source.package == source.package)
    return near + (_is_within(scope, get_outer(cls.name)) if get_outer(cls.name) else 0)


def select_overloads(targets: list[Fn], call: FlowCall, fn: Fn) -> list[Fn]:
    """Of functions of one name in C++ those that take as many arguments as a call has, and of these those that take
    variables of the types it gives; all where none does."""
    if len(targets) < 2 or targets[0].source.facts.language != "cpp":
        return targets
    given = len(call.arguments)
    fitting = [one for one in targets if len(one.facts.parameters) == given]
    if len(fitting) < 2:
        return fitting or targets
    types = [_find_declared_type(argument, fn) for argument in call.arguments]
    exact = [one for one in fitting if _takes_types(one, types)] if any(types) else []
    return exact or fitting


def _find_declared_type(argument: FlowExpr, fn: Fn) -> str:
    """The type that a variable of a function is declared with, empty for what is no variable, or of no such type."""
    if argument.kind != "name" or not argument.text.isidentifier():
        return ""
    made = fn.assigned.get(argument.text, ()) if argument.text in fn.locals else ()
    declared = {row.type for row in made if row.type}
    declared |= {one.type for one in fn.facts.parameters if one.name == argument.text}
    found = _read_plain_type(declared.pop()) if len(declared) == 1 else ""
    return "" if found == "auto" else found


def _takes_types(fn: Fn, types: list[str]) -> bool:
    """Whether the parameters of a function are of these types, as far as they are known."""
    taken = [_read_plain_type(one.type) for one in fn.facts.parameters]
    return all(not given or f"::{given}".endswith(f"::{own}") or f"::{own}".endswith(f"::{given}")
               for given, own in zip(types, taken, strict=True))  # fmt: skip


def _read_plain_type(written: str) -> str:
    """A type without what says how it is handed over."""
    return "".join(_HANDED_OVER.sub(" ", written).split())


def _select_named(
    name: str, fn: Fn, rows: list[tuple[DataMember, CodeFile]]
) -> list[tuple[DataMember, CodeFile]]:  # fmt: skip
    """Of constants in C++ those that a name means in a function: by the scopes around it from the innermost on; else
    those that end like it, where they are of one scope."""
    scope = split_name(fn.scope)
    for count in range(len(scope), -1, -1):
        full = "::".join((*scope[:count], *split_name(name)))
        found = [row for row in rows if row[0].name == full]
        if found:
            return found
    ending = f"::{name.removeprefix('::')}"
    found = [row for row in rows if f"::{row[0].name}".endswith(ending)]
    return found if len({constant.name for constant, _ in found}) < 2 else []
