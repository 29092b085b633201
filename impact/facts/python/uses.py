"""What a Python source does with things of other packages: calls with their arguments, members of objects whose class
shows, methods that override; and fields and constants of interfaces.

A class shows where a name is bound to what its constructor gives, where a parameter or variable is annotated with it,
in `self` and `super()` of a subclass, and in what functions and methods of the file give; that of a message also in the
callback it is handed to, and in what is a field of another. Nothing outside of the file is looked at.
"""

import ast
import re
from collections.abc import Callable, Iterator
from typing import NamedTuple

import msgspec

from ..condition import Condition
from .bound import ALWAYS
from .constants import MORE
from .text import join_dotted, walk_nodes
from .values import PythonScope, PythonValues


class CallArguments(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The arguments of a call. positional: how many. open: `*args` or `**kwargs` gives more."""

    positional: int
    keywords: tuple[str, ...] = ()
    open: bool = False


class PythonUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """A use of something of another module, the first one like it. more: lines and columns of further calls like it.

    name: dotted, import aliases resolved; a relative import has leading dots. A member of an object is called by what
    made the object, `pkg.mod.Class.member`, whether that is a class or a function. A subclass that is constructed, and
    `super().__init__()`, is a call of the class whose constructor that is.
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
    given: CallArguments | None = None
    parameters: str = ""
    lazy: bool = False
    alone: bool = True
    conditions: tuple[Condition, ...] = ()
    more: tuple[tuple[int, int], ...] = ()


class TypedName(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """What a name that the module binds is by types, for those who import it: of a class its bases, of a function and a
    variable the only type of what it gives or holds. name: `Class.member` for what objects hold or methods give. types:
    as the name of a PythonUse, of the module's own after the mark OWN; empty where one is not known. members: of a
    class, between spaces, what it defines itself.
    """

    name: str
    types: tuple[str, ...]
    members: str = ""


class FieldUse(msgspec.Struct, frozen=True, array_like=True, gc=False):
    """The first use like it of a member of an interface. type: dotted, `pkg.msg.Name`, `pkg.srv.Name.Request`. steps:
    fields on the way, ELEMENT for an element of a sequence; the last is the member that is used. line, column: of it.
    conditions: as in PythonUse.
    """

    type: str
    steps: tuple[str, ...]
    line: int
    column: int
    conditions: tuple[Condition, ...] = ()


class _Class(msgspec.Struct, eq=False):
    """A class of the file. bases: as types. members: what it defines itself. objects: types of what `self` holds.
    above: what super() of it is, a class of the same bases that defines nothing."""

    bases: list[str]
    members: set[str] = set()
    objects: dict[str, str] = {}
    methods: dict[str, tuple[int, int, str]] = {}
    above: "_Class | None" = None


class _Raw(NamedTuple):
    type: str
    member: str
    given: CallArguments | None
    line: int
    offset: int
    lazy: bool
    conditions: tuple[Condition, ...]
    more: list[tuple[int, int]]


# A type is a dotted name; of the file's own classes and functions the name after this mark. Empty: not known. Behind a
# dot stands what is a member of such an object; whether that is a field shows at the end.
OWN = ":"
# A parameter of a function that may be a callback: `@class/name:how many:which`.
_PARAMETER = "@"
KINDS = frozenset(("msg", "srv", "action"))
SECTIONS = frozenset(("Request", "Response", "Goal", "Result", "Feedback"))
ELEMENT = "[]"
CONSTRUCTORS = ("__init__", "__new__")
# Before what one of several star imports brings.
STARRED = "*"
# Of types whose objects have the members of what stands in brackets, the names.
_TRANSPARENT = frozenset(("Annotated", "ClassVar", "Final", "InitVar", "Optional"))
# Decorators behind which a call or member gives what the function gives.
_PLAIN_DECORATORS = frozenset(("cached_property", "classmethod", "override", "property", "staticmethod"))
_LITERALS = frozenset((ast.Constant, ast.Dict, ast.JoinedStr, ast.List, ast.ListComp, ast.Set, ast.Tuple))
_INTERFACE = re.compile(rf"\w+\.(?:{'|'.join(sorted(KINDS))})\.[A-Z]\w*(?:\.(?:{'|'.join(sorted(SECTIONS))}))?(?![^.])")
_MENTIONS_INTERFACES = re.compile(r"\b(?:msg|srv|action)\b")
_ASK_FOR_MESSAGES = frozenset(("create_subscription", "Subscriber"))
CALLBACK_CALLS = _ASK_FOR_MESSAGES | {"create_service", "Service"}
_DEEPEST = 40
_QUOTED_TYPE = re.compile(r"[A-Za-z_][\w.\[\], |]*\Z")
SURE_TO_RUN = frozenset(("generate_launch_description", "main"))


class ObjectUses(PythonValues):
    """What the walk notes of objects and calls; finished by list_object_uses()."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.classes: dict[str, _Class] = {}
        # What functions of the module give, by name, and what the one that is read gave so far; None for a generator.
        self.results: dict[str, str] = {}
        self.given: set[str] | None = set()
        # Names that the module itself binds, here or further below, and the modules whose star imports may.
        self.module_names: set[str] = set()
        self.starred: list[str] = []
        # Whether names that nothing binds tell anything.
        self.watches_names = "sys.modules" not in text
        # Members of objects whose types do not show, with the number of places.
        self.unknown: dict[str, int] = {}
        self.declared_global: list[tuple[PythonScope, str]] = []
        self.inside_class: _Class | None = None
        # First parameters of the methods around, by which the object is called.
        self.me = ""
        self.raw: dict[tuple, _Raw] = {}
        self.has_interfaces = _MENTIONS_INTERFACES.search(text) is not None
        # Type and member to the place.
        self.raw_fields: dict[tuple[str, str, tuple[Condition, ...]], tuple[int, int]] = {}
        # Of functions that are handed over as callbacks, by class and name: the types of their parameters.
        self.called_back: dict[str, set[tuple[str, ...]]] = {}
        # What names hold at the end of the branches of the statement that is read.
        self.ways: list[dict[str, str]] = []
        # In a function that may not run, or under a condition.
        self.lazy = False
        self.conditional = False
        # Under a condition that does not tell about the interpreter or the machine.
        self.undecided = False
        # Tests about the interpreter or the machine that hold here.
        self.use_conditions: tuple[Condition, ...] = ()
        # The same of calls alone.
        self.call_conditions: tuple[Condition, ...] = ()

    @property
    def may_not_run(self) -> bool:
        """True where reading or starting the file does not surely come by."""
        return self.lazy or self.conditional

    def find_type(self, node) -> str:
        """The type of an expression's value, empty where it does not show."""
        if node.__class__ is ast.Call:
            func = node.func
            if func.__class__ is ast.Attribute and self.is_me(func.value):
                return f"{OWN}{id(self.inside_class)}.{func.attr}"
            return self.resolve_callee(func)
        if node.__class__ is ast.Name:
            return self.find_object_type(node.id)
        if node.__class__ is ast.Attribute and self.is_me(node.value):
            return f"{OWN}{id(self.inside_class)}.{node.attr}"
        if not self.has_interfaces:
            return ""
        if node.__class__ is ast.Attribute:
            return make_field_type(self.find_type(node.value), node.attr)
        if node.__class__ is ast.Subscript and node.slice.__class__ is not ast.Slice:
            return make_field_type(self.find_type(node.value), ELEMENT)
        return ""

    def is_unbound(self, name: str) -> bool:
        """Whether nothing is known to bind a name that is used here."""
        known = name in ALWAYS or name in self.module_names or not self.watches_names
        return not known and not self.scope.knows(name)

    def is_me(self, node) -> bool:
        """Whether an expression is the object whose method is read."""
        return node.__class__ is ast.Name and node.id == self.me and self.inside_class is not None

    def resolve_callee(self, node) -> str:
        """What a callee is: a dotted name of another module, or a class or function of the file."""
        parts: list[str] = []
        while node.__class__ is ast.Attribute:
            parts.append(node.attr)
            node = node.value
        if node.__class__ is not ast.Name:
            return ""
        for looking in self.scope.chain:
            known = looking.imports.get(node.id)
            if known is not None:
                # What several imports bind, or one under a condition, is left to those who watch single names.
                plain = len(known) == 1 and not known[0][1] and node.id not in looking.bound
                return ".".join([known[0][0], *reversed(parts)]) if plain else ""
            if node.id in looking.bound:
                own = not parts and (node.id in self.classes or (looking.parent is None and node.id in self.results))
                return f"{OWN}{node.id}" if own else ""
        if self.starred and self.is_unbound(node.id):
            only = join_dotted(self.starred[0], node.id) if len(self.starred) == 1 else f"{STARRED}.{node.id}"
            return ".".join([only, *reversed(parts)])
        return ""

    def find_object_type(self, name: str) -> str:
        """The type of what a variable holds."""
        for looking in self.scope.chain:
            if name in looking.objects or name in looking.bound:
                return looking.objects.get(name, "")
        return ""

    def find_annotated(self, node) -> str:
        """The type that an annotation names, in quotes or not."""
        if node.__class__ is ast.Constant and node.value.__class__ is str and _QUOTED_TYPE.match(node.value):
            try:
                return self.find_annotated(ast.parse(node.value, mode="eval").body)
            except (SyntaxError, ValueError):
                return ""
        if node.__class__ is ast.BinOp:  # `X | None`
            node = node.left if getattr(node.right, "value", "") is None else None
        elif node.__class__ is ast.Subscript and self.resolve_callee(node.value).rpartition(".")[2] in _TRANSPARENT:
            return self.find_annotated(node.slice.elts[0] if node.slice.__class__ is ast.Tuple else node.slice)
        return self.resolve_callee(node) if node.__class__ in (ast.Name, ast.Attribute) else ""

    def forget_rebound(self, loop: ast.AST) -> None:
        """A loop begins, in which a variable that it binds itself has a type only where that stays the same."""
        objects = self.scope.objects
        same: set[int] = set()
        for node in walk_nodes(loop) if any(objects.values()) else ():
            if node.__class__ is ast.Assign:
                type_ = self.find_type(node.value)  # type: ignore[attr-defined]
                targets = node.targets if type_ else ()  # type: ignore[attr-defined]
                same.update(id(target) for target in targets if objects.get(getattr(target, "id", "")) == type_)
            elif getattr(node, "id", "") in objects and isinstance(node.ctx, ast.Store) and id(node) not in same:  # type: ignore[attr-defined]
                objects[node.id] = ""  # type: ignore[attr-defined]

    def note_parameters(self, function) -> None:
        """Parameters of a function that is entered, which show their types where it is a callback."""
        positional = [*function.args.posonlyargs, *function.args.args]
        # None stands for what is yet to come.
        defaults = zip(reversed(positional), reversed(function.args.defaults), strict=False)
        given = {argument.arg for argument, default in defaults if getattr(default, "value", 0) is None}
        self.scope.objects.update(dict.fromkeys(self.scope.bound - given, ""))
        owner = ""
        if self.inside_class is not None and positional[:1] and positional[0].arg == "self":
            owner = str(id(self.inside_class))
            del positional[0]
        if self.has_interfaces and 0 < len(positional) < 3 and not any(one.annotation for one in positional):
            for place, one in enumerate(positional):
                self.scope.objects[one.arg] = f"{_PARAMETER}{owner}/{function.name}:{len(positional)}:{place}"

    def note_callback(self, call: ast.Call, function: str) -> None:
        """A call that asks for messages or requests of one interface, and names who gets them."""
        arguments = [*call.args, *(keyword.value for keyword in call.keywords)]
        types = [type_ for one in arguments if _INTERFACE.fullmatch(type_ := self.find_annotated(one))]
        if len(types) != 1:
            return
        given = (types[0],) if function in _ASK_FOR_MESSAGES else (f"{types[0]}.Request", f"{types[0]}.Response")
        for one in arguments:
            own = isinstance(one, ast.Attribute) and isinstance(one.value, ast.Name) and one.value.id == "self"
            name = one.attr if own else getattr(one, "id", "")  # type: ignore[attr-defined]
            if name and not (own and self.inside_class is None):  # of `self` outside of a class, nothing is known
                owner = str(id(self.inside_class)) if own and self.inside_class is not None else ""
                self.called_back.setdefault(f"{owner}/{name}", set()).add(given)

    def merge(self, first: int, *others: dict[str, str]) -> None:
        """Names hold behind a statement what they hold at the end of those of its branches that bind them: of those
        noted since first, and others."""
        merged: dict[str, str] = {}
        for way in (*self.ways[first:], *others):
            for name, type_ in way.items():
                merged[name] = type_ if merged.get(name, type_) == type_ else ""
        self.scope.objects = merged
        del self.ways[first:]

    def hold_own(self, target: ast.Attribute, value: ast.expr | None, annotated: str = "") -> bool:
        """`self.name = value`; True where the target is such."""
        inside = self.inside_class
        if inside is None or target.value.__class__ is not ast.Name or target.value.id != self.me:  # type: ignore
            return False
        inside.members.add(target.attr)
        if value.__class__ is ast.Constant and value.value is None:  # type: ignore
            return True  # which stands for what is yet to come
        type_ = annotated or self.find_type(value)
        inside.objects[target.attr] = type_ if inside.objects.get(target.attr, type_) == type_ else ""
        return True

    def use_member(self, type_: str, steps: list[ast.Attribute], call: ast.Call | None) -> None:
        """`object.a.b`, called or not. type_: of the object. steps: the nodes of its members, the last is the whole."""
        own, outer = type_[:1] == OWN and "." not in type_, steps[-1]
        if outer.ctx.__class__ is ast.Load:
            given = self.make_call_arguments(call) if call is not None else None
            if not own or len(steps) == 1:
                self.note(type_, steps[0].attr, given if len(steps) == 1 else None, outer)
            elif len(steps) == 2:
                self.note(f"{type_}.{steps[0].attr}", steps[1].attr, given, outer)
        if self.has_interfaces:
            if own:
                type_, steps = f"{type_}.{steps[0].attr}", steps[1:]
            self.use_fields(type_, steps, call)

    def use_constant(self, steps: list[ast.Attribute], call: ast.Call | None) -> None:
        """`Name.CONSTANT`, and what follows, of an interface that an import brings."""
        path = self.resolve_callee(steps[-1])
        known = _INTERFACE.match(path)
        if known is not None:
            self.use_fields(known.group(), steps[len(steps) - path.count(".", known.end()) :], call)

    def use_fields(self, type_: str, steps: list[ast.Attribute], call: ast.Call | None) -> None:
        """Members of an object that may be fields of an interface; what is called is none."""
        for step in steps if call is None else steps[:-1]:
            if not _has_fields(type_):
                break
            line, end = step.end_lineno or 0, step.end_col_offset or 0
            self.use_field(type_, step.attr, (line, end - len(step.attr.encode())))
            type_ = make_field_type(type_, step.attr)

    def use_of_super(self, member: str, call: ast.Call | None, node) -> None:
        """`super().member`."""
        if self.inside_class is not None:
            given = self.make_call_arguments(call) if call is not None else None
            self.note(f"{OWN}{id(self.inside_class.above)}", member, given, node)

    def use_call(self, call: ast.Call) -> None:
        """A call of something that an import brought, or of a class of the file."""
        name = self.resolve_callee(call.func)
        if name[:1] == OWN and name[1:] in self.classes:
            self.note(name, "__init__", self.make_call_arguments(call), call.func)
        elif name and name[0] != OWN:
            self.note(name, "", self.make_call_arguments(call), call.func)
            if _INTERFACE.fullmatch(name):
                for keyword in call.keywords:
                    if keyword.arg is not None:
                        self.use_field(name, keyword.arg, (keyword.lineno, keyword.col_offset))

    def make_call_arguments(self, call: ast.Call) -> CallArguments:
        positional = sum(argument.__class__ is not ast.Starred for argument in call.args)
        keywords: list[str] = []
        for keyword in call.keywords:
            unpacked = self.find_value(keyword.value) if keyword.arg is None else None
            keywords += map(str, unpacked) if isinstance(unpacked, dict) else (keyword.arg or MORE,)
        named = tuple(name for name in keywords if name != MORE)
        return CallArguments(positional, named, positional < len(call.args) or len(named) < len(keywords))

    def use_field(self, type_: str, name: str, place: tuple[int, int]) -> None:
        key = (type_, name, self.use_conditions)
        self.raw_fields[key] = min(place, self.raw_fields.get(key, place))

    def note(self, type_: str, member: str, given: CallArguments | None, node) -> None:
        if not type_ or _is_field(type_):
            return
        conditions = self.use_conditions if given is None else (*self.use_conditions, *self.call_conditions)
        lazy = self.may_not_run
        key = (type_, member, given, conditions, lazy)
        if key not in self.raw:
            self.raw[key] = _Raw(type_, member, given, node.lineno, node.col_offset, lazy, conditions, [])
        elif given is not None:
            self.raw[key].more.append((node.lineno, node.col_offset))

    def enter_class(self, node: ast.ClassDef) -> _Class:
        """A class of the file, from here on known by its name."""
        found = _Class([self.resolve_callee(base) for base in node.bases if getattr(base, "id", "") != "object"])
        if node.keywords:
            found.bases.append("")  # a metaclass may add members
        known = self.classes.get(node.name)
        self.classes[node.name] = found
        if known is not None:
            known.bases.append("")
            found.bases.append("")
        found.above = _Class(found.bases)
        self.classes.update((str(id(one)), one) for one in (found, found.above))
        if node.decorator_list:
            found.members.update(CONSTRUCTORS)  # which a decorator may make
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
            inside.methods[node.name] = (node.lineno, column, _format_parameters(node.args))

    def list_object_uses(self, column: Callable[[int, int], int]) -> tuple[PythonUse, ...]:
        """Every use of what is not the file's own, in the order of the source. column: of a line and an offset."""
        found: dict[tuple, PythonUse] = {}
        for raw in self.raw.values():
            constructs = raw.member == "__init__" and raw.given is not None
            how = "member" if raw.given is None else "method" if raw.member and not constructs else "call"
            types = list(self.list_types(raw))
            if raw.member and not self.resolve(raw.type):
                self.count_unknown(raw.member, 1 + len(raw.more))
            for type_, alone in types:
                name = f"{type_}.{raw.member}" if raw.member and not constructs else type_
                key = (name, how, raw.given, raw.conditions)
                more = tuple((line, column(line, offset)) for line, offset in raw.more)
                use = PythonUse(name, how, raw.line, column(raw.line, raw.offset), raw.given, "", raw.lazy, alone,
                                raw.conditions, more)  # fmt: skip
                known = found.get(key)
                if known is not None and raw.given is not None and known.line != use.line:
                    first, other = (use, known) if known.lazy and not raw.lazy else (known, use)
                    places = (*first.more, (other.line, other.column), *other.more)
                    found[key] = msgspec.structs.replace(first, more=places)
                elif known is None or (known.lazy and not raw.lazy):
                    found[key] = use
        for key, one in self.classes.items():
            bases = [] if key.isdigit() else [base for base, _ in self.list_bases(one) if base]
            for base in bases:
                for method, (line, offset, parameters) in one.methods.items():
                    name, at = f"{base}.{method}", column(line, offset)
                    found[name, line] = PythonUse(name, "override", line, at, None, parameters)
        return tuple(sorted(found.values(), key=lambda use: (use.line, use.column, use.name)))

    def list_field_uses(self, column: Callable[[int, int], int]) -> tuple[FieldUse, ...]:
        """Every use of a field or constant of an interface, in the order of the source."""
        found: dict[tuple[str, tuple[Condition, ...]], FieldUse] = {}
        for (type_, member, conditions), (line, offset) in self.raw_fields.items():
            path = f"{self.resolve(type_)}.{member}"
            known = _INTERFACE.match(path)
            if known is not None and known.end() < len(path):
                steps = tuple(path[known.end() + 1 :].split("."))
                use = FieldUse(known.group(), steps, line, column(line, offset), conditions)
                key = (path, conditions)
                found[key] = min(use, found.get(key, use), key=lambda use: (use.line, use.column))
        return tuple(sorted(found.values(), key=lambda use: (use.line, use.column)))

    def resolve(self, type_: str) -> str:
        """A type whose first part is one of another module, where it shows; empty elsewhere."""
        for _ in range(_DEEPEST):
            head, _, rest = type_[1:].partition(".")
            if type_[:1] == _PARAMETER:
                name, count, place = head.split(":")
                (types, *others) = self.called_back.get(name, ((),))
                type_ = types[int(place)] if not others and int(count) <= len(types) else ""
            elif type_[:1] == OWN and rest and head in self.classes:
                name, _, rest = rest.partition(".")
                type_ = self.find_member_type(self.classes[head], name)
            elif type_[:1] == OWN and head not in self.classes:
                type_ = self.results.get(head, "")
            else:
                return type_
            if rest:
                type_ = f"{type_}.{rest}" if type_ and (type_[0] == OWN or _has_fields(type_)) else ""
        return ""

    def list_types(self, raw: _Raw) -> Iterator[tuple[str, bool]]:
        """The types of other modules that a use may be of, and whether it is the only one."""
        type_ = self.resolve(raw.type)
        if type_[:1] != OWN:
            if type_:
                yield type_, True
            return
        one = self.classes.get(type_[1:])
        if one is None:
            return
        bases = list(self.list_bases(one))
        members = one.members.union(*(self.classes[own].members for _, own in bases if own))
        if not members.isdisjoint(CONSTRUCTORS if raw.member == "__init__" else (raw.member, "__getattr__")):
            return
        outside = [base for base, own in bases if not own]
        yield from ((base, len(outside) == 1) for base in outside if base)

    def find_member_type(self, one: _Class, attribute: str) -> str:
        bases = list(self.list_bases(one))
        for own in (one, *(self.classes[name] for _, name in bases if name)):
            if attribute in own.objects or attribute in own.members:
                return own.objects.get(attribute, "")
        outside = [base for base, name in bases if not name]
        return f"{outside[0]}.{attribute}" if len(outside) == 1 and outside[0] else ""

    def count_unknown(self, member: str, places: int = 1) -> None:
        """Places that use a member of an object whose type is not known."""
        self.unknown[member] = self.unknown.get(member, 0) + places

    def note_unknown(self, node: ast.Attribute) -> None:
        """A member of what no name and no import tells the type of."""
        if node.value.__class__ not in _LITERALS and node.ctx.__class__ is ast.Load:
            self.count_unknown(node.attr)

    def note_result(self, node, annotated: str) -> None:
        """A function has been read, which gives what its annotation or all that it returns tells."""
        decorators = {getattr(one, "id", getattr(one, "attr", "")) for one in node.decorator_list}
        if not decorators.isdisjoint(("deleter", "setter")):
            return
        plain = node.__class__ is ast.FunctionDef and decorators <= _PLAIN_DECORATORS
        types = {annotated} if annotated else self.given or ()
        type_ = next(iter(types)) if plain and len(types) == 1 else ""
        if self.scope.is_class and self.inside_class is not None:
            self.inside_class.objects[node.name] = type_
        elif self.scope.parent is None:
            self.results[node.name] = type_ if self.results.get(node.name, type_) == type_ else ""

    def list_typed_names(self) -> tuple[TypedName, ...]:
        """What the names are that others can import, as far as types show."""
        own = self.scope.bound.difference(name for _, name in self.declared_global)
        objects = {name: self.scope.objects.get(name, "") for name in own}
        found = [TypedName(name, (reported,)) for name, type_ in {**objects, **self.results}.items()
                 if name not in self.classes and (reported := self._tell_type(type_))]  # fmt: skip
        for name in self.scope.bound & self.classes.keys():
            one = self.classes[name]
            found.append(TypedName(name, tuple(map(self._tell_type, one.bases)), f" {' '.join(sorted(one.members))} "))
            held = ((f"{name}.{attribute}", self._tell_type(type_)) for attribute, type_ in one.objects.items())
            found += [TypedName(attribute, (reported,)) for attribute, reported in held if reported]
        return tuple(sorted(found, key=lambda one: one.name))

    def _tell_type(self, type_: str) -> str:
        """A type as others can know it."""
        type_ = self.resolve(type_) if type_ else ""
        inside = type_[:1] == OWN and type_[1:].partition(".")[0].isdigit()
        return "" if inside or type_[:1] in (_PARAMETER, STARRED) else type_

    def list_bases(self, one: _Class) -> Iterator[tuple[str, str]]:
        """All base classes over any number of steps: (dotted, "") of other modules, ("", name) of the file, ("", "")
        where it is not known."""
        seen: set[str] = set()
        todo = list(one.bases)
        while todo:
            base = todo.pop(0)
            if not base or base[0] != OWN:
                yield base, ""
            elif base not in seen:
                seen.add(base)
                yield "", base[1:]
                todo += self.classes[base[1:]].bases


def _has_fields(type_: str) -> bool:
    """Whether members of an object may be fields of an interface."""
    return type_[:1] == _PARAMETER or ("." in type_ if type_[:1] == OWN else _INTERFACE.match(type_) is not None)


def _is_field(type_: str) -> bool:
    """Whether a type is none but what a field holds, so that its members are nobody else's."""
    if type_[0] in (OWN, _PARAMETER):
        return type_[0] == _PARAMETER or type_.count(".") > 1
    known = _INTERFACE.match(type_)
    return known is not None and known.end() < len(type_)


def make_field_type(type_: str, name: str) -> str:
    """The type of a field of an object, empty where it has none that anybody asks for."""
    return f"{type_}.{name}" if type_ and _has_fields(type_) and type_.count(".") < _DEEPEST else ""



def _format_parameters(arguments: ast.arguments) -> str:
    """Parameters of a method without the first, as Python writes them, with `...` for defaults."""
    some = ast.Constant(...)
    first = [ast.arg(one.arg) for one in arguments.posonlyargs[1:]]
    rest = [ast.arg(one.arg) for one in arguments.args[not arguments.posonlyargs :]]
    shown = ast.arguments(
        first,
        rest,
        arguments.vararg and ast.arg(arguments.vararg.arg),
        [ast.arg(one.arg) for one in arguments.kwonlyargs],
        [default and some for default in arguments.kw_defaults],
        arguments.kwarg and ast.arg(arguments.kwarg.arg),
        [some] * min(len(arguments.defaults), len(first) + len(rest)),
    )
    return f"({ast.unparse(shown)})"
