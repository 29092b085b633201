"""The node objects that a program of ROS 2 makes, each a node by itself, and on which of them a call is made."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence, Set
from functools import cached_property
from typing import Any, NamedTuple, TypeVar

from ....edges.groups import group_pairs
from ...facts.flow import Assignment, FlowCall, FlowExpr
from .calls import Calls, FrameworkCall
from .code import Fn, Made, Variable, find_argument, find_parameter, get_tail
from .contexts import Contexts
from .graph import Role
from .names import RemappingRule, join_name, normalise
from .node_options import GivenPiece, NodeOptions
from .reaching import find_last_write, reaches
from .types import Cls, FlowType
from .values import NAMESPACE, FlowValues

_Row = TypeVar("_Row", bound=tuple[Any, ...])

_DEEPEST = 6
_OPEN = "/<namespace>"
_ROLES = frozenset(Role.__args__)
# What is the node itself in its methods.
_ITSELF = frozenset(("this", "self", "*this", "shared_from_this", "this.shared_from_this"))
# What gives what a pointer points to.
_HANDED = frozenset(("lock", "get"))
# Pointers that are made of another one, and functions that give what they are given.
_WRAPS = frozenset(
    ("shared_ptr", "unique_ptr", "weak_ptr", "SharedPtr", "WeakPtr", "static_pointer_cast", "dynamic_pointer_cast",
     "const_pointer_cast", "static_cast", "dynamic_cast", "move", "ref", "forward")
)  # fmt: skip


class NodeObject(NamedTuple):
    """An object that is a node, or some that nothing tells apart. keys: what tells that a call is made on it: the
    classes that it is of, or the place where it is made; and `any CLASS`, for any object of a class. name: full, with
    brackets for what is not known of it. values: what expressions are worth in its code. uses: those that name it.
    fixed: `name` and `namespace` where its options give it these, whatever a launch says; `below` where that namespace
    is below the one of another node; `all` where it takes nothing of what a launch gives; `handed` where it takes what
    a launch gives the component that makes it. remaps: its own remappings."""

    keys: frozenset[str]
    name: str
    values: FlowValues
    uses: tuple[FrameworkCall, ...]
    fixed: frozenset[str] = frozenset()
    remaps: tuple[RemappingRule, ...] = ()


class NodeObjects:
    """Asks a body of code for its node objects. values: what expressions are worth in it; ros: the generation where a
    framework does not tell."""

    def __init__(self, calls: Calls, values: FlowValues, ros: int):
        self.calls, self.code, self.values, self.ros = calls, calls.code, values, ros
        self._contexts, self._options = Contexts(calls.code), NodeOptions(calls.code)
        # By the id() of the use, which is kept for that: the functions that it rests on, those of them that ran, and
        # the keys then.
        self._known: dict[int, tuple[FrameworkCall, list[tuple[frozenset[Fn], frozenset[Fn], frozenset[str]]]]] = {}

    def list_objects(self, functions: Collection[Fn], loaded: Cls | None = None) -> list[NodeObject]:
        """The node objects of ROS 2 that some functions make. loaded: the class of the plugin that they are of, of
        which another program makes an object."""
        named = [use for use in self._named if use.fn in functions]
        by_class = group_pairs((owner.key, use) for use in named if (owner := self._find_named_class(use)))
        found: list[NodeObject] = []
        for cls in self._list_classes(by_class, functions, loaded):
            found += self._make_class_objects(cls, by_class, functions, loaded)
        for use in named:
            if self._find_named_class(use) is None:
                own = self._evaluate_name(use, self.values) or f"<{get_tail(use.call.target) or 'node'}>"
                keys = frozenset((make_key(use.fn, use.call.line),))
                full, fixed = self.join_namespace(use, own, self.values), self.find_fixed(use, self.values, loaded)
                remaps = self._options.list_remaps(use, self.values)
                found.append(NodeObject(keys, full, self.values, (use,), fixed, remaps))
        return found

    @cached_property
    def _named(self) -> list[FrameworkCall]:
        """The uses that make nodes of ROS 2; a member that is given a node is none."""
        generations = self.calls.table.generations
        of_ros2 = [u for u in self.calls.select_uses("node") if generations.get(u.row.framework, self.ros) == 2]
        named = ((use, self.calls.find_argument(use, use.row.topic)) for use in of_ros2)
        return [use for use, name in named if name is None or not self.calls.is_node(name, use.fn)]

    def _find_named_class(self, use: FrameworkCall) -> Cls | None:
        """The class of the code whose constructor gives its base a name by a use; None for a node that is made."""
        fn, call = use.fn, use.call
        if not self.code.is_constructor(fn):
            return None
        if fn.source.facts.language == "python":
            return self.code.find_owner(fn) if get_tail(call.callee) == "__init__" else None
        bases = (self.code.find_base_made(fn, each) for each in fn.facts.assignments if each.line == call.line)
        own = not call.target and any(base is not None and base[0] == call.callee for base in bases)
        return self.code.find_owner(fn) if own else None

    def _list_classes(
        self, by_class: Collection[str], functions: Collection[Fn], loaded: Cls | None
    ) -> list[Cls]:  # fmt: skip
        """The classes of the nodes that some functions make. by_class: keys of those that give themselves a name: one
        that nothing is seen to make an object of counts too, where that is so of all that derive from it."""
        made = [
            cls
            for key, rows in self.code.constructions.items()
            if any(maker in functions for maker, _, _ in rows)
            for cls in self.code.list_class_bodies(key)[:1]
            if self.is_node(cls)
        ]
        if loaded is not None and loaded not in made and self.is_node(loaded):
            made.insert(0, loaded)
        above = {one.key for cls in made for one in self.code.list_bases(cls)}
        alone = [self.code.list_class_bodies(key)[0] for key in by_class if key not in above]
        return [*made, *alone]

    def is_node(self, cls: Cls) -> bool:
        """Whether objects of a class are nodes."""
        kinds = self.calls.find_kinds(FlowType(cls.name, (), cls), self.code.find_first(cls.source, self._anybody))
        return "node" in kinds or any(one.key in self._node_like for one in self.code.list_bases(cls))

    @cached_property
    def _anybody(self) -> Fn:
        return self.code.functions[0]

    @cached_property
    def _node_like(self) -> set[str]:
        """Classes of Python that do on themselves what only nodes do, and have it from a class outside of the code."""
        found: set[str] = set()
        for use in self.calls.uses:
            if use.row.does in _ROLES and use.fn.source.facts.language == "python" and use.fn.owner:
                on_itself = self.calls.get_receiver(use) == "this" or any(
                    one.kind == "name" and one.text in _ITSELF for one in use.call.arguments[:1]
                )
                owner = self.code.find_owner(use.fn) if on_itself else None
                if owner is not None and self._has_base_elsewhere(owner):
                    found.add(owner.key)
        return found

    def _has_base_elsewhere(self, cls: Cls) -> bool:
        bases = ((base, one) for one in self.code.list_bases(cls) for base in one.facts.bases)
        return any(self.code.find_class(base, one.source, one.name) is None for base, one in bases)

    def _make_class_objects(
        self, cls: Cls, by_class: dict[str, list[FrameworkCall]], functions: Collection[Fn], loaded: Cls | None
    ) -> Iterator[NodeObject]:
        """The nodes of a class: those that it gives different names, as far as these are known. loaded: as for
        list_objects()."""
        chain = self.code.list_bases(cls)
        keys = frozenset(key for one in chain for key in (one.key, f"any {one.key}"))
        # That of the framework's own class is the name; what derived classes give may be anything.
        uses = [use for one in reversed(chain) for use in by_class.get(one.key, ())]
        rows = [row for row in self.code.constructions.get(cls.key, ()) if row[0] in functions]
        by_name: dict[tuple[str, frozenset[str], tuple[RemappingRule, ...]], list[Made]] = {}
        for row in rows or [None]:
            values = self._limit(chain, [row] if row is not None else None)
            known = ((use, self._evaluate_name(use, values)) for use in uses)
            own = next(((use, name) for use, name in known if name), None)
            full, fixed = f"/<{get_tail(cls.name)}>", frozenset[str]()
            remaps: tuple[RemappingRule, ...] = ()
            if own is None and uses:
                # Its namespace may be known where its name is not.
                full = self.join_namespace(uses[0], f"<{get_tail(cls.name)}>", values)
            if own is not None:
                # A derived class may hand the options to the one that names it.
                telling = next((use for use in uses if self._options.find_rule(use, "__ns:=", values)), own[0])
                full, fixed = self.join_namespace(telling, own[1], values), self.find_fixed(telling, values, loaded)
                remaps = self._options.list_remaps(telling, values)
            by_name.setdefault((full, fixed, remaps), []).extend([row] if row is not None else [])
        for (name, fixed, remaps), made in by_name.items():
            yield NodeObject(keys, name, self._limit(chain, made or None), tuple(uses), fixed, remaps)

    def _limit(self, chain: list[Cls], rows: list[Made] | None) -> FlowValues:
        """What expressions are worth in objects of a class. chain: with its bases; rows: where those are made, None for
        anywhere."""
        return self.values.limit_to_objects(self._contexts.find_made(chain, rows))

    def _evaluate_name(self, use: FrameworkCall, values: FlowValues) -> str:
        """The name that a use gives, without a namespace; empty where it is not known."""
        renamed = self._options.find_rule(use, "__node:=", values)
        if renamed is not None:
            texts = renamed.list_texts(values)
            text = texts.pop() if len(texts) == 1 else None
            return text if text and "{" not in text else ""
        found = values.evaluate(self.calls.find_argument(use, use.row.topic), use.fn, use.call.line)
        text = found[0].text if len(found) == 1 else None
        # `_` stands for a name that options give.
        return text if text and text != "_" and "{" not in text else ""

    def find_own_name(self, use: FrameworkCall, values: FlowValues) -> str | None:
        """The name that the options of a node give it, empty where it is not known, None where they give none."""
        renamed = self._options.find_rule(use, "__node:=", values)
        return None if renamed is None else self._evaluate_name(use, values)

    def join_namespace(self, use: FrameworkCall, own: str, values: FlowValues) -> str:
        """The full name of a node by its own name and the namespace that its code gives, if any."""
        remapped = self._options.find_rule(use, "__ns:=", values)
        if remapped is not None:
            texts = remapped.list_texts(values)
            spaces = {normalise("/" + (text or _OPEN).replace(NAMESPACE, "/")) for text in texts}
            return join_name(spaces.pop() if len(spaces) == 1 else _OPEN, own)
        written = self.calls.find_argument(use, use.row.namespace) if use.row.namespace else None
        if written is None:
            return join_name("/", own)
        texts = GivenPiece(written, use.fn, use.call.line).list_texts(values)
        space = texts.pop() if len(texts) == 1 else None
        if space is not None:
            space = space.replace(NAMESPACE, "")  # of another node, whose own is that of all where nothing is given
        return join_name(_OPEN if space is None or "{" in space else "/" + space.strip("/"), own)

    def find_fixed(self, use: FrameworkCall, values: FlowValues, loaded: Cls | None = None) -> frozenset[str]:
        """What the options of a node say of it, whatever a launch says, as NodeObject.fixed has it. loaded: as for
        list_objects()."""
        remapped = self._options.find_rule(use, "__ns:=", values)
        found = {"name"} if self._options.find_rule(use, "__node:=", values) is not None else set()
        written = self.calls.find_argument(use, use.row.namespace) if use.row.namespace else None
        if written is not None and remapped is None:
            given = GivenPiece(written, use.fn, use.call.line).list_texts(values)
            found |= {"below"} if any(NAMESPACE in (one or "") for one in given) else set()
        if self._options.is_alone(use, values):
            return frozenset(("name", "namespace", "all", *found))
        if loaded is not None and self._options.is_handed(use, loaded, values):
            found.add("handed")
        if remapped is not None:
            below = any(NAMESPACE in (one or "") for one in remapped.list_texts(values))
            found |= {"namespace", "below"} if below else {"namespace"}
        return frozenset(found)

    def leaves_options(self, loaded: Cls) -> bool:
        """Whether the class of a component does nothing with what a container hands to it: it is named like any other
        node of the process then."""
        return self.is_node(loaded) and self._options.are_dropped(loaded)

    def find_keys_on_way(self, use: FrameworkCall, functions: Set[Fn], way: FlowValues) -> frozenset[str]:
        """The same as find_keys(), on one of the ways that lead to the use."""
        return frozenset(_Trace(self, functions, way).find_keys(use))

    def find_keys(self, use: FrameworkCall, functions: Set[Fn]) -> frozenset[str]:
        """What tells on which node objects a use is made where some functions run, as NodeObject.keys has it; empty
        where nothing does."""
        _, rows = self._known.setdefault(id(use), (use, []))
        for rests_on, ran, keys in rows:
            if rests_on & functions == ran:
                return keys
        trace = _Trace(self, functions)
        keys = frozenset(trace.find_keys(use))
        rests_on = frozenset(trace.rests_on)
        rows.append((rests_on, rests_on & functions, keys))
        return keys

    def find_own_key(self, fn: Fn) -> set[str]:
        """The key of the class that a function belongs to; nothing for others."""
        owner = self.code.find_owner(fn)
        return {owner.key} if owner is not None else set()

    def find_named_key(self, use: FrameworkCall) -> str:
        """The key of the node that a use names."""
        cls = self._find_named_class(use)
        return cls.key if cls is not None else make_key(use.fn, use.call.line)

    @cached_property
    def made(self) -> set[str]:
        """The places where nodes are made that are of no class of the code."""
        return {make_key(use.fn, use.call.line) for use in self._named if self._find_named_class(use) is None}

    def find_class_key(self, kind: FlowType, fn: Fn) -> set[str]:
        """The key for any object of a class of the code, if its objects are nodes."""
        cls = self.code.find_class_of(kind, fn) if kind.name else None
        return {f"any {cls.key}"} if cls is not None and self.is_node(cls) else set()


class _Trace:
    """One search for the node objects that a use is made on. functions: those that run: of several that give or write
    a node, the ones among these count, where there are any. way: through what alone the use is come to, None for
    anything. rests_on: the functions of which it was asked whether they run."""

    def __init__(self, objects: NodeObjects, functions: Set[Fn], way: FlowValues | None = None):
        self._objects, self._code, self._functions, self._way = objects, objects.code, functions, way
        self.rests_on: set[Fn] = set()

    def find_keys(self, use: FrameworkCall) -> set[str]:
        """The keys of the node objects."""
        objects = self._objects
        if use.row.does == "node":
            return {objects.find_named_key(use)}
        receiver = "" if use.row.does == "publish" else objects.calls.get_receiver(use)
        arguments = [one.parts[0] if one.kind == "keyword" and one.parts else one for one in use.call.arguments]
        given = next((one for one in arguments if objects.calls.is_node(one, use.fn)), None)
        around = self._code.find_owner(use.fn)
        for value in (FlowExpr("name", receiver) if receiver else None, given):
            keys = self._follow(value, use.fn, around, frozenset(), use.call) if value is not None else set()
            if keys:
                return keys
        return objects.find_own_key(use.fn)

    def _follow(
        self, value: FlowExpr, fn: Fn, around: Cls | None, seen: frozenset[tuple[Variable, str]],
        at: FlowCall | Assignment | None = None,
    ) -> set[str]:  # fmt: skip
        """The keys of what an expression is, where it is a node object. around: the class of the object in which it is
        evaluated. at: the statement of the function that it stands in, None where that is not known."""
        objects, code = self._objects, self._code
        if value.kind == "call" and not value.parts and get_tail(value.text) in _HANDED and "." in value.text:
            value = FlowExpr("name", value.text.rpartition(".")[0])
        text = value.text.removesuffix("()")
        if text in _ITSELF or (value.kind == "other" and "this" in text):
            return objects.find_own_key(fn)
        if value.kind in ("make", "call"):
            wraps = value.parts and get_tail(value.text.partition("<")[0]) in _WRAPS
            keys = self._follow(value.parts[0], fn, around, seen, at) if wraps else set()
            return keys or objects.find_class_key(code.resolve_type(value, fn), fn)
        if value.kind != "name" or len(seen) > _DEEPEST:
            return set()
        variable = code.identify(text, fn)
        mark = variable, around.key if around is not None else ""
        if mark in seen:
            return set()
        seen |= {mark}
        keys: set[str] = set()
        written = self._select_running(self._select_own(code.list_writes(variable), variable, around))
        results = self._select_running(code.list_results(variable))
        own = variable.kind == "member" and text.startswith("this.") and "." not in text.removeprefix("this.")
        if at is not None and (own or variable.kind == "local"):
            last = find_last_write(fn, at, (*written, *results))
            # A variable may be written by a function inside at any time; a member is what the function has given it.
            elsewhere = not own or last is None
            written = [row for row in written if (elsewhere if row[0] is not fn else reaches(fn, row[1], at, last))]
            results = [row for row in results if (elsewhere if row[0] is not fn else reaches(fn, row[1], at, last))]
        for writer, each in written:
            made = make_key(writer, each.line)
            inner = around if variable.kind != "member" else self._find_around(writer, around)
            keys |= {made} if made in objects.made else self._follow(each.value, writer, inner, seen, each)
        for caller, call in results:
            made = make_key(caller, call.line)
            keys |= {made} if made in objects.made else set()
        for one in code.list_enclosing_chain(fn) if variable.kind == "local" and not keys else ():
            place = find_parameter(one, variable.name)
            if place is not None:
                for giver, given in self._select_running(self._list_given(one, place[0], variable.name, around)):
                    keys |= self._follow(given, giver, self._find_around(giver, around), seen)
                break
        return keys or objects.find_class_key(code.resolve_variable_type(variable, fn), fn)

    def _list_given(self, fn: Fn, place: int, name: str, around: Cls | None) -> list[tuple[Fn, FlowExpr]]:
        """Who gives what for the parameter of a function: on the way that leads to it alone, and for the constructor of
        a base in objects of a class alone."""
        only = self._way.way.get(fn) if self._way is not None else None
        made = self._way.made.get(fn) if self._way is not None else None
        if made is None and around is not None:
            made = self._objects.values.makers.find_inside(around).get(fn)
        if only is None and not made:
            return [(giver, given) for given, giver in self._code.list_given(fn, place, name)]
        rows = [(caller, call.arguments) for caller, call in self._code.callers.get(fn, ()) if call is only]
        rows = rows or [(maker, arguments) for maker, arguments, _ in made or ()]
        found = ((giver, find_argument(arguments, place, name)) for giver, arguments in rows)
        return [(giver, given) for giver, given in found if given is not None]

    def _find_around(self, fn: Fn, around: Cls | None) -> Cls | None:
        """The class of the object in which a function runs that is come to from an object of a class: the same where it
        belongs to a base of that."""
        owner = self._code.find_owner(fn)
        same = around is not None and owner is not None and owner.key in self._list_keys(around)
        return around if same else owner

    def _list_keys(self, cls: Cls) -> list[str]:
        return [one.key for one in self._code.list_bases(cls)]

    def _select_own(self, rows: Sequence[_Row], variable: Variable, around: Cls | None) -> Sequence[_Row]:
        """Of what writes a member that which may be of objects of a class; all where that is nothing."""
        if variable.kind != "member" or around is None or len(rows) < 2:
            return rows
        related = {*self._list_keys(around), *(one.key for one in self._code.derived.get(around.key, ()))}
        if variable.owner not in related:
            return rows
        owners = ((row, self._code.find_owner(row[0])) for row in rows)
        return [row for row, owner in owners if owner is None or owner.key in related] or rows

    def _select_running(self, rows: Sequence[_Row]) -> Sequence[_Row]:
        """Of rows that begin with a function those whose function runs; all where none does."""
        if len(rows) < 2:
            return rows
        self.rests_on.update(fn for fn, _ in rows)
        return [row for row in rows if row[0] in self._functions] or rows


def make_key(fn: Fn, line: int) -> str:
    """The key of what is made on a line of a function."""
    return f"{fn.source.path}:{line}"
