"""What a Python source does with things of other packages: calls with their arguments, members of objects whose class
shows, methods that override.

A class shows where a name is bound to what its constructor gives, where a parameter or variable is annotated with it,
and in `self` and `super()` of a subclass. Nothing outside of the file is looked at.
"""

from __future__ import annotations

import ast
import re
import sys
from collections.abc import Callable, Iterator
from typing import NamedTuple

import msgspec

from ..condition import Condition
from .values import Scope, Values


class Given(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The arguments of a call. positional: how many. open: `*args` or `**kwargs` gives more."""

    positional: int
    keywords: tuple[str, ...] = ()
    open: bool = False


class PythonUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A use of something of another module, the first one like it.

    name: dotted, import aliases resolved; a relative import has leading dots. A member of an object is called by what
    made the object, `pkg.mod.Class.member`, whether that is a class or a function.
    how: `call`, `method` (a call of a member of an object), `member` (of an object, not called) or `override` (a method
    that a class defines; name is then that of the base's). given: of a call. parameters: of an override, as Python
    writes them, defaults as `...`.
    lazy: only a function that may not run uses it. alone: no other base class is known, or not known, that could have
    the member.
    """

    name: str
    how: str
    line: int
    column: int
    given: Given | None = None
    parameters: str = ""
    lazy: bool = False
    alone: bool = True
    conditions: tuple[Condition, ...] = ()


class _Class:
    """A class of the file. bases: as types. members: what it defines itself. objects: types of what `self` holds."""

    def __init__(self, bases: list[str]):
        self.bases = bases
        self.members: set[str] = set()
        self.objects: dict[str, str] = {}
        self.methods: dict[str, tuple[int, int, str]] = {}


class _Raw(NamedTuple):
    type: str
    attribute: str
    member: str
    given: Given | None
    line: int
    offset: int
    lazy: bool
    conditions: tuple[Condition, ...]


# A type is a dotted name; of the file's own classes the name after this mark. Empty: not known.
_OWN = ":"
_DOTTED = re.compile(r"\.*[A-Za-z_][\w.]*\Z")
SURE_TO_RUN = frozenset(("generate_launch_description", "main"))


class Objects(Values):
    """What the walk notes of objects and calls; finished by object_uses()."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.classes: dict[str, _Class] = {}
        self.inside_class: _Class | None = None
        # First parameters of the methods around, by which the object is called.
        self.me = ""
        self.raw: dict[tuple, _Raw] = {}
        # In a function that may not run, or under a condition.
        self.lazy = False
        self.conditional = False
        # Tests about the interpreter or the machine that hold here.
        self.use_conditions: tuple[Condition, ...] = ()
        # The same of calls alone.
        self.call_conditions: tuple[Condition, ...] = ()

    @property
    def may_not_run(self) -> bool:
        """True where reading or starting the file does not surely come by."""
        return self.lazy or self.conditional

    # What things are

    def type_of(self, node) -> str:
        """The type of an expression's value, empty where it does not show."""
        if node.__class__ is ast.Call:
            return self.called(node.func)
        if node.__class__ is ast.Name:
            return self.object(node.id)
        return ""

    def called(self, node) -> str:
        """What a callee is: a dotted name of another module, or a class of the file."""
        parts: list[str] = []
        while node.__class__ is ast.Attribute:
            parts.append(node.attr)
            node = node.value
        if node.__class__ is not ast.Name:
            return ""
        looking: Scope | None = self.scope
        while looking is not None:
            known = looking.imports.get(node.id)
            if known is not None:
                # What several imports bind, or one under a condition, is left to those who watch single names.
                plain = len(known) == 1 and not known[0][1]
                return ".".join([known[0][0], *reversed(parts)]) if plain else ""
            if node.id in looking.bound:
                return f"{_OWN}{node.id}" if not parts and node.id in self.classes else ""
            looking = looking.parent
        return ""

    def object(self, name: str) -> str:
        """The type of what a variable holds."""
        looking: Scope | None = self.scope
        while looking is not None:
            if name in looking.objects:
                return looking.objects[name]
            if name in looking.bound:
                return ""
            looking = looking.parent
        return ""

    def annotated(self, node) -> str:
        """The type that an annotation names, in quotes or not."""
        if node.__class__ is ast.Constant and node.value.__class__ is str and _DOTTED.match(node.value):
            try:
                node = ast.parse(node.value, mode="eval").body
            except (SyntaxError, ValueError):
                return ""
        return self.called(node) if node.__class__ in (ast.Name, ast.Attribute) else ""

    def hold(self, name: str, type_: str) -> None:
        """A variable of the scope is bound; bound to different things its type is not known."""
        objects = self.scope.objects
        if type_ or name in objects:
            objects[name] = type_ if objects.get(name, type_) == type_ else ""

    def hold_own(self, target: ast.Attribute, type_: str) -> bool:
        """`self.name = ...`; True where the target is such."""
        inside = self.inside_class
        if inside is None or target.value.__class__ is not ast.Name or target.value.id != self.me:  # type: ignore
            return False
        inside.members.add(target.attr)
        inside.objects[target.attr] = type_ if inside.objects.get(target.attr, type_) == type_ else ""
        return True

    # What is used

    def use_member(self, head: str, names: list[str], call: ast.Call | None, node) -> None:
        """`head.name` and `head.name.other`, called or not, where head is a plain name that no import binds."""
        given = _given(call) if call is not None else None
        if head == self.me and self.inside_class is not None:
            own = f"{_OWN}{id(self.inside_class)}"
            if len(names) == 1:
                self.note(own, "", names[0], given, node)
            elif len(names) == 2:
                self.note(own, names[0], names[1], given, node)
            return
        type_ = self.object(head)
        if type_:
            self.note(type_, "", names[0], given if len(names) == 1 else None, node)

    def use_of_value(self, value, member: str, call: ast.Call | None, node) -> None:
        """A member of what an expression gives: of super(), or of what a constructor has just made."""
        if value.__class__ is not ast.Call:
            return
        given = _given(call) if call is not None else None
        if value.func.__class__ is ast.Name and value.func.id == "super" and self.inside_class is not None:
            for base in self.inside_class.bases:
                self.note(base, "", member, given, node)
            return
        type_ = self.called(value.func)
        if type_:
            self.note(type_, "", member, given, node)

    def use_call(self, call: ast.Call) -> None:
        """A call of something that an import brought."""
        name = self.called(call.func)
        if name and name[0] != _OWN and not _standard(name):
            self.note(name, "", "", _given(call), call.func)

    def note(self, type_: str, attribute: str, member: str, given: Given | None, node) -> None:
        if not type_ or (type_[0] != _OWN and _standard(type_)):
            return
        conditions = self.use_conditions if given is None else (*self.use_conditions, *self.call_conditions)
        lazy = self.may_not_run
        key = (type_, attribute, member, given, conditions, lazy)
        if key not in self.raw:
            self.raw[key] = _Raw(type_, attribute, member, given, node.lineno, node.col_offset, lazy, conditions)

    # Classes and functions

    def enter_class(self, node: ast.ClassDef) -> _Class:
        """A class of the file, from here on known by its name."""
        found = _Class([self.called(base) for base in node.bases])
        if node.keywords:
            found.bases.append("")  # a metaclass may add members
        known = self.classes.get(node.name)
        self.classes[node.name] = found
        if known is not None:
            known.bases.append("")
            found.bases.append("")
        self.classes[str(id(found))] = found
        return found

    def enter_method(self, node) -> None:
        """A function right in the body of a class."""
        inside = self.inside_class
        if inside is None:
            return
        inside.members.add(node.name)
        plain = all(getattr(d, "id", "") in ("", "override") for d in node.decorator_list)
        if plain and not node.name.startswith("_"):
            column = node.col_offset + (4 if node.__class__ is ast.FunctionDef else 10)
            inside.methods[node.name] = (node.lineno, column, _parameters(node.args))

    # The end

    def object_uses(self, column: Callable[[int, int], int]) -> tuple[PythonUse, ...]:
        """Every use of what is not the file's own, in the order of the source. column: of a line and an offset."""
        found: dict[tuple, PythonUse] = {}
        for raw in self.raw.values():
            how = "member" if raw.given is None else "method" if raw.member else "call"
            for type_, alone in self.types(raw):
                name = f"{type_}.{raw.member}" if raw.member else type_
                key = (name, how, raw.given, raw.conditions)
                known = found.get(key)
                if known is None or (known.lazy and not raw.lazy):
                    at = column(raw.line, raw.offset)
                    found[key] = PythonUse(name, how, raw.line, at, raw.given, "", raw.lazy, alone, raw.conditions)
        for key, one in self.classes.items():
            bases = [] if key.isdigit() else [base for base, _ in self.bases(one) if base and not _standard(base)]
            for base in bases:
                for method, (line, offset, parameters) in one.methods.items():
                    name, at = f"{base}.{method}", column(line, offset)
                    found[name, line] = PythonUse(name, "override", line, at, None, parameters)
        return tuple(sorted(found.values(), key=lambda use: (use.line, use.column, use.name)))

    def types(self, raw: _Raw) -> Iterator[tuple[str, bool]]:
        """The types of other modules that a use may be of, and whether it is the only one."""
        if raw.type[0] != _OWN:
            if not raw.attribute:
                yield raw.type, True
            return
        one = self.classes.get(raw.type[1:])
        if one is None:
            return
        if raw.attribute:
            held = self.held(one, raw.attribute)
            if held and held[0] != _OWN:
                if not _standard(held):
                    yield held, True
            elif held:
                yield from self.types(raw._replace(type=held, attribute=""))
            return
        bases = list(self.bases(one))
        if raw.member in one.members or any(raw.member in self.classes[own].members for _, own in bases if own):
            return
        outside = [base for base, own in bases if not own]
        yield from ((base, len(outside) == 1) for base in outside if base and not _standard(base))

    def held(self, one: _Class, attribute: str) -> str:
        for own in (one, *(self.classes[name] for _, name in self.bases(one) if name)):
            if attribute in own.objects:
                return own.objects[attribute]
        return ""

    def bases(self, one: _Class) -> Iterator[tuple[str, str]]:
        """All base classes over any number of steps: (dotted, "") of other modules, ("", name) of the file, ("", "")
        where it is not known."""
        seen: set[str] = set()
        todo = list(one.bases)
        while todo:
            base = todo.pop(0)
            if not base or base[0] != _OWN:
                yield base, ""
            elif base not in seen:
                seen.add(base)
                yield "", base[1:]
                todo += self.classes[base[1:]].bases


def _standard(name: str) -> bool:
    """Whether a dotted name is one of Python's own library, in which no package of ROS has anything."""
    return name.partition(".")[0] in sys.stdlib_module_names


def _given(call: ast.Call) -> Given:
    positional = [a for a in call.args if a.__class__ is not ast.Starred]
    keywords = tuple(k.arg for k in call.keywords if k.arg is not None)
    return Given(len(positional), keywords, len(positional) + len(keywords) < len(call.args) + len(call.keywords))


def _parameters(arguments: ast.arguments) -> str:
    """Parameters of a method without the first, as Python writes them."""
    positional = [*arguments.posonlyargs, *arguments.args]
    required = len(positional) - len(arguments.defaults)
    texts = [a.arg + ("" if at < required else "=...") for at, a in enumerate(positional)]
    if arguments.posonlyargs:
        texts.insert(len(arguments.posonlyargs), "/")
    del texts[:1]
    if texts[:1] == ["/"]:
        del texts[:1]
    if arguments.vararg is not None:
        texts.append(f"*{arguments.vararg.arg}")
    elif arguments.kwonlyargs:
        texts.append("*")
    texts += [
        a.arg + ("" if default is None else "=...")
        for a, default in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True)
    ]
    if arguments.kwarg is not None:
        texts.append(f"**{arguments.kwarg.arg}")
    return f"({', '.join(texts)})"
